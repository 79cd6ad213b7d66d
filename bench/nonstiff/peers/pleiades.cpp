#include <bench/nonstiff/peers/odeint.hpp>
#include <bench/problems/pleiades.hpp>

template std::vector<continuo::bench::Solver> continuo::bench::odeint_solvers<continuo::bench::Pleiades>(double);
