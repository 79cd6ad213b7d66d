// continuo/solve/choice.hpp
// The choice of a method where none is named, with the reason.
#pragma once
#include <cstddef>
#include <string_view>

namespace continuo {

/// The properties on which the choice depends.
struct SystemTraits {
  std::size_t size = 0;        // the number of components
  double rtol = 1e-6;          // the relative tolerance, the least of all components
  bool algebraic = false;      // M x' = f with a singular M
  bool accelerations = false;  // all of it is x'' = a(t, x)
  bool sparse = false;         // most entries of df/dx are known to be zero
  bool banded = false;         // and the others lie near its diagonal
};

/// A method and why it was chosen, each as a text.
struct Choice {
  std::string_view method;  // its name
  std::string_view reason;  // a sentence
};

/// Chooses by tolerance, size and kind. Every choice can solve stiff systems.
[[nodiscard]] Choice choose_method(const SystemTraits& system);

}  // namespace continuo
