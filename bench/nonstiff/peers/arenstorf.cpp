#include <bench/nonstiff/peers/odeint.hpp>
#include <bench/problems/arenstorf.hpp>

template std::vector<continuo::bench::Solver> continuo::bench::odeint_solvers<continuo::bench::Arenstorf>(double);
