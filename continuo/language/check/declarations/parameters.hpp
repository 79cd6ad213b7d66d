// continuo/language/check/declarations/parameters.hpp
// Parameters and inputs with their values as written, ranges and comments.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include <continuo/language/check/expressions/expressions.hpp>

namespace continuo::model::detail {

struct Parameters {
  std::vector<Parameter> all;      // in the order of the text
  std::vector<std::size_t> order;  // in which their expressions can be evaluated
};

/// Their values go to the registers of the workspace.
[[nodiscard]] Parameters make_parameters(Expressions& expressions);
/// E210: overrides whose name is not that of a parameter.
void check_overrides(const std::vector<Parameter>& parameters, Expressions& expressions);
/// Which of them decide the size of a family is known only when the whole text has been read.
void mark_structural(std::vector<Parameter>& parameters, Workspace& workspace);

[[nodiscard]] std::vector<Input> make_inputs(Expressions& expressions);

}  // namespace continuo::model::detail
