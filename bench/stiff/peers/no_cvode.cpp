#include <bench/stiff/measure.hpp>

namespace continuo::bench {

template <>
std::vector<Solver> cvode_solvers<Robertson<>>() {
  return {};
}
template <>
std::vector<Solver> cvode_solvers<Hires<>>() {
  return {};
}
template <>
std::vector<Solver> cvode_solvers<Oregonator<>>() {
  return {};
}
template <>
std::vector<Solver> cvode_solvers<VanDerPol<>>() {
  return {};
}
template <>
std::vector<Solver> cvode_solvers<VanDerPolScaled<>>() {
  return {};
}
template <>
std::vector<Solver> cvode_solvers<Pollution<>>() {
  return {};
}
template <>
std::vector<Solver> cvode_solvers<BrusselatorLine<>>() {
  return {};
}

}  // namespace continuo::bench
