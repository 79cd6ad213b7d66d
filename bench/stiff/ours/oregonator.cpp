#include <bench/stiff/ours/ours.hpp>

template <>
std::vector<continuo::bench::Solver> continuo::bench::our_stiff_solvers<continuo::bench::Oregonator<>>() {
  return all_our_stiff_solvers<Oregonator<>>();
}
