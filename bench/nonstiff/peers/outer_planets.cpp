#include <bench/nonstiff/peers/odeint.hpp>
#include <bench/problems/outer_planets.hpp>

template std::vector<continuo::bench::Solver> continuo::bench::odeint_solvers<continuo::bench::OuterPlanets>(double);
