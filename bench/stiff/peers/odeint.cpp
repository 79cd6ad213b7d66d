#include <bench/stiff/peers/odeint.hpp>

namespace continuo::bench {

template <>
std::vector<Solver> odeint_stiff_solvers<Robertson<>>() {
  return all_odeint_stiff_solvers<Robertson<>>();
}
template <>
std::vector<Solver> odeint_stiff_solvers<Hires<>>() {
  return all_odeint_stiff_solvers<Hires<>>();
}
template <>
std::vector<Solver> odeint_stiff_solvers<Oregonator<>>() {
  return all_odeint_stiff_solvers<Oregonator<>>();
}
template <>
std::vector<Solver> odeint_stiff_solvers<VanDerPol<>>() {
  return all_odeint_stiff_solvers<VanDerPol<>>();
}
template <>
std::vector<Solver> odeint_stiff_solvers<VanDerPolScaled<>>() {
  return all_odeint_stiff_solvers<VanDerPolScaled<>>();
}
template <>
std::vector<Solver> odeint_stiff_solvers<Pollution<>>() {
  return all_odeint_stiff_solvers<Pollution<>>();
}

}  // namespace continuo::bench
