#include <bench/stiff/brusselator_sparse.hpp>
#include <bench/stiff/ours/ours.hpp>

template <>
std::vector<continuo::bench::Solver> continuo::bench::our_stiff_solvers<continuo::bench::BrusselatorLine<>>() {
  return all_our_stiff_solvers<BrusselatorLine<>, SparseBrusselator>();
}

template <>
std::vector<continuo::bench::Solver> continuo::bench::our_unraced_solvers<continuo::bench::BrusselatorLine<>>() {
  return all_our_unraced_solvers<BrusselatorLine<>, SparseBrusselator>();
}
