// continuo/solve/choice.hpp
// Which method to take where nobody names one, and why.
#pragma once
#include <cstddef>
#include <string_view>

namespace continuo {

/// What the choice depends on.
struct SystemTraits {
  std::size_t size = 0;
  double rtol = 1e-6;
  bool algebraic = false;      // M x' = f with a singular M
  bool accelerations = false;  // all of it is x'' = a(t, x)
  bool sparse = false;         // most entries of df/dx are known to be zero
  bool banded = false;         // and the others lie near its diagonal
};

struct Choice {
  std::string_view method, reason;
};

/// By tolerance, size and kind: every choice takes stiff systems as they come.
[[nodiscard]] Choice choose_method(const SystemTraits& system);

}  // namespace continuo
