// continuo/solve/catalogue.hpp
// What methods there are, by the names that models and the command line speak of them. <continuo/solve/with_method.hpp>
// has the methods themselves by name.
#pragma once
#include <string_view>
#include <vector>

namespace continuo {

/// What there is to say of a method before using it.
struct MethodInfo {
  std::string_view name;
  int order;                 // the greatest, where it varies;
  int order_of_fixed_steps;  // then this is what steps of a fixed size keep
  int error_order;           // 0: no error estimate, needs a step
  int dense_order;
  bool second_order;  // only for x'' = a(t, x)
  bool implicit;      // solves equations in each step: for stiff systems and algebraic equations
  bool automatic;     // an explicit and a stiff method that hand over to each other
};

/// Other names of a method: `euler` for explicit_euler, `crank_nicolson` for trapezoidal.
[[nodiscard]] std::string_view canonical_name(std::string_view name);

/// All methods, simplest first.
[[nodiscard]] const std::vector<MethodInfo>& method_catalogue();

/// The method of that name (canonical or not); null where there is none.
[[nodiscard]] const MethodInfo* find_method(std::string_view name);

}  // namespace continuo
