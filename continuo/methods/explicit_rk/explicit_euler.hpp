// continuo/methods/explicit_rk/explicit_euler.hpp
#pragma once
#include <string_view>

#include <continuo/methods/explicit_rk/explicit_runge_kutta.hpp>

namespace continuo {

/// x_new = x + h f(t, x).
/// L. Euler, "Institutionum calculi integralis" I (1768), section II, chapter 7.
struct ExplicitEuler : ExplicitRungeKutta<ExplicitEuler> {
  static constexpr std::string_view name = "explicit_euler";
  static constexpr int order = 1, dense_order = 1;
  static constexpr Tableau<1> tableau{.c = {0}, .a = {{}}, .b = {1}};
};

}  // namespace continuo
