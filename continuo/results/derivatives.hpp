// What `check --jacobian` shows: how large and full df/dx is, where it agrees with differences and where it does not.
#pragma once
#include <string>

#include <continuo/simulation/check_derivatives.hpp>

namespace continuo::results {

/// A few lines, indented.
[[nodiscard]] std::string derivatives_text(const model::DerivativeReport& report);

/// One object, without a line end.
[[nodiscard]] std::string derivatives_json(const model::DerivativeReport& report);

}  // namespace continuo::results
