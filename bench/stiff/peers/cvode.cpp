#include <bench/stiff/brusselator_sparse.hpp>
#include <bench/stiff/peers/cvode.hpp>

namespace continuo::bench {

template <>
std::vector<Solver> cvode_solvers<Robertson<>>() {
  return {cvode_solver<Robertson<>>()};
}
template <>
std::vector<Solver> cvode_solvers<Hires<>>() {
  return {cvode_solver<Hires<>>()};
}
template <>
std::vector<Solver> cvode_solvers<Oregonator<>>() {
  return {cvode_solver<Oregonator<>>()};
}
template <>
std::vector<Solver> cvode_solvers<VanDerPol<>>() {
  return {cvode_solver<VanDerPol<>>()};
}
template <>
std::vector<Solver> cvode_solvers<VanDerPolScaled<>>() {
  return {cvode_solver<VanDerPolScaled<>>()};
}
template <>
std::vector<Solver> cvode_solvers<Pollution<>>() {
  return {cvode_solver<Pollution<>>()};
}
template <>
std::vector<Solver> cvode_solvers<BrusselatorLine<>>() {
  return {cvode_solver<BrusselatorLine<>, SparseBrusselator>()};
}

}  // namespace continuo::bench
