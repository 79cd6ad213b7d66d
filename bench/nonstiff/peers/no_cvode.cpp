#include <bench/nonstiff/measure.hpp>

namespace continuo::bench {

template <class Problem>
std::vector<Solver> cvode_adams_solvers() {
  return {};
}

template std::vector<Solver> cvode_adams_solvers<Lorenz>();
template std::vector<Solver> cvode_adams_solvers<Arenstorf>();
template std::vector<Solver> cvode_adams_solvers<Kepler>();
template std::vector<Solver> cvode_adams_solvers<Pleiades>();
template std::vector<Solver> cvode_adams_solvers<OuterPlanets>();

}  // namespace continuo::bench
