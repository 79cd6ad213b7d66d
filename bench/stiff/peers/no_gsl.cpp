#include <bench/stiff/measure.hpp>

namespace continuo::bench {

template <class Problem>
std::vector<Solver> gsl_stiff_solvers() {
  return {};
}

template std::vector<Solver> gsl_stiff_solvers<Robertson<>>();
template std::vector<Solver> gsl_stiff_solvers<Hires<>>();
template std::vector<Solver> gsl_stiff_solvers<Oregonator<>>();
template std::vector<Solver> gsl_stiff_solvers<VanDerPol<>>();
template std::vector<Solver> gsl_stiff_solvers<VanDerPolScaled<>>();
template std::vector<Solver> gsl_stiff_solvers<Pollution<>>();

}  // namespace continuo::bench
