// continuo/methods/explicit_rk/heun.hpp
#pragma once
#include <string_view>

#include <continuo/methods/explicit_rk/explicit_runge_kutta.hpp>

namespace continuo {

/// The explicit trapezoidal rule, order 2, known as Heun's method or improved Euler.
/// C. Runge, "Ueber die numerische Aufloesung von Differentialgleichungen", Math. Ann. 46 (1895) 167-178;
/// K. Heun, "Neue Methoden zur approximativen Integration ...", Z. Math. Phys. 45 (1900) 23-38.
struct Heun : ExplicitRungeKutta<Heun> {
  static constexpr std::string_view name = "heun";
  static constexpr int order = 2, dense_order = 2;
  static constexpr Tableau<2> tableau{.c = {0, 1}, .a = {{}, {1}}, .b = {1_c / 2, 1_c / 2}};
};

}  // namespace continuo
