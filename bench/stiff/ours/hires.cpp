#include <bench/stiff/ours/ours.hpp>

template <>
std::vector<continuo::bench::Solver> continuo::bench::our_stiff_solvers<continuo::bench::Hires<>>() {
  return all_our_stiff_solvers<Hires<>>();
}

template <>
std::vector<continuo::bench::Solver> continuo::bench::our_unraced_solvers<continuo::bench::Hires<>>() {
  return all_our_unraced_solvers<Hires<>>();
}
