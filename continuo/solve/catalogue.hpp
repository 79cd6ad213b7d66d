// continuo/solve/catalogue.hpp
// The list of all methods, by the names that models and the command line use. <continuo/solve/with_method.hpp> gives
// the methods themselves by name.
#pragma once
#include <string_view>
#include <vector>

namespace continuo {

/// The properties of a method.
struct MethodInfo {
  std::string_view name;     // by which with_method finds it
  int order;                 // the greatest, where it varies;
  int order_of_fixed_steps;  // then the order of steps of fixed size
  int error_order;           // 0: no error estimate, needs a step
  int dense_order;           // of the polynomial between the ends of a step
  bool second_order;         // only for x'' = a(t, x)
  bool implicit;             // solves equations in each step: for stiff systems and algebraic equations
  bool automatic;            // switches between an explicit and a stiff method
  bool needs_series;         // only for systems of which the Taylor series is known: models, and f of any number type
};

/// Other names of a method: `euler` for explicit_euler, `crank_nicolson` for trapezoidal.
[[nodiscard]] std::string_view canonical_name(std::string_view name);

/// All methods, simplest first.
[[nodiscard]] const std::vector<MethodInfo>& method_catalogue();

/// The method of that name (canonical or not); null where there is none.
[[nodiscard]] const MethodInfo* find_method(std::string_view name);

}  // namespace continuo
