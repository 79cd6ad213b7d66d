#include <bench/stiff/ours/ours.hpp>

template <>
std::vector<continuo::bench::Solver> continuo::bench::our_stiff_solvers<continuo::bench::VanDerPol<>>() {
  return all_our_stiff_solvers<VanDerPol<>>();
}

template <>
std::vector<continuo::bench::Solver> continuo::bench::our_unraced_solvers<continuo::bench::VanDerPol<>>() {
  return all_our_unraced_solvers<VanDerPol<>>();
}

template <>
std::vector<continuo::bench::Solver> continuo::bench::our_stiff_solvers<continuo::bench::VanDerPolScaled<>>() {
  return all_our_stiff_solvers<VanDerPolScaled<>>();
}

template <>
std::vector<continuo::bench::Solver> continuo::bench::our_unraced_solvers<continuo::bench::VanDerPolScaled<>>() {
  return all_our_unraced_solvers<VanDerPolScaled<>>();
}
