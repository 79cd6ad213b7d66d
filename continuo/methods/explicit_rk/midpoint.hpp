// continuo/methods/explicit_rk/midpoint.hpp
#pragma once
#include <string_view>

#include <continuo/methods/explicit_rk/explicit_runge_kutta.hpp>

namespace continuo {

/// The explicit midpoint rule, order 2.
/// C. Runge, "Ueber die numerische Aufloesung von Differentialgleichungen", Math. Ann. 46 (1895) 167-178.
struct Midpoint : ExplicitRungeKutta<Midpoint> {
  static constexpr std::string_view name = "midpoint";
  static constexpr int order = 2, dense_order = 2;
  static constexpr Tableau<2> tableau{.c = {0, 1_c / 2}, .a = {{}, {1_c / 2}}, .b = {0, 1}};
};

}  // namespace continuo
