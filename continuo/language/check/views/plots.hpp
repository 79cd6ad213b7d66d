// continuo/language/check/views/plots.hpp
// `plot ...`: curves kept for those who show them.
#pragma once
#include <vector>

#include <continuo/language/check/expressions/expressions.hpp>

namespace continuo::model::detail {

[[nodiscard]] std::vector<Plot> make_plots(Expressions& expressions);

}  // namespace continuo::model::detail
