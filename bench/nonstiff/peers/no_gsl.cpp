#include <bench/nonstiff/measure.hpp>

namespace continuo::bench {

template <class Problem>
std::vector<Solver> gsl_solvers(double) {
  return {};
}

template std::vector<Solver> gsl_solvers<Lorenz>(double);
template std::vector<Solver> gsl_solvers<Arenstorf>(double);
template std::vector<Solver> gsl_solvers<Kepler>(double);
template std::vector<Solver> gsl_solvers<Pleiades>(double);
template std::vector<Solver> gsl_solvers<OuterPlanets>(double);

}  // namespace continuo::bench
