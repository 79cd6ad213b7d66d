#include <bench/nonstiff/ours/ours.hpp>
#include <bench/problems/pleiades.hpp>

template std::vector<continuo::bench::Solver> continuo::bench::our_solvers<continuo::bench::Pleiades>();
