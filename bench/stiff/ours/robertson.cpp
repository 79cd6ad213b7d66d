#include <bench/stiff/ours/ours.hpp>

template <>
std::vector<continuo::bench::Solver> continuo::bench::our_stiff_solvers<continuo::bench::Robertson<>>() {
  return all_our_stiff_solvers<Robertson<>>();
}

template <>
std::vector<continuo::bench::Solver> continuo::bench::our_unraced_solvers<continuo::bench::Robertson<>>() {
  return all_our_unraced_solvers<Robertson<>>();
}
