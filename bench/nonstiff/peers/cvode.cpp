// The peer: CVODE of SUNDIALS with Adams' methods and its fixed-point iteration.
#include <array>
#include <cstddef>
#include <memory>

#include <bench/nonstiff/measure.hpp>
#include <bench/nonstiff/peers/for_c.hpp>
#include <bench/peers/cvode.hpp>
#include <sunnonlinsol/sunnonlinsol_fixedpoint.h>

namespace continuo::bench {
namespace {

/// One run: everything CVODE is given and gives back.
template <class Problem>
class AdamsRun {
 public:
  using State = std::array<double, Problem::size>;

  explicit AdamsRun(double tolerance)
      : x_(Problem::start()),
        cvode_(CV_ADAMS, x_, f, nullptr, tolerance, tolerance),
        iteration_(SUNNonlinSol_FixedPoint(cvode_.vector(), 0, cvode_.context())) {
    Cvode::check(CVodeSetNonlinearSolver(cvode_.solver(), iteration_));
  }
  AdamsRun(const AdamsRun&) = delete;
  AdamsRun& operator=(const AdamsRun&) = delete;
  ~AdamsRun() { SUNNonlinSolFree(iteration_); }

  const State& advance(double end) {
    Cvode::check(CVodeSetStopTime(cvode_.solver(), end));
    cvode_.advance(end);
    return x_;
  }
  std::size_t evaluations() const { return cvode_.evaluations(); }

 private:
  static int f(double t, N_Vector x, N_Vector dxdt, void*) {
    evaluate_by_pointers<Problem>(t, NV_DATA_S(x), NV_DATA_S(dxdt));
    return 0;
  }

  State x_;
  Cvode cvode_;
  SUNNonlinearSolver iteration_;
};

}  // namespace

template <class Problem>
std::vector<Solver> cvode_adams_solvers() {
  return {solver_of_cvode(
      "cvode adams", Problem::duration, [](double tolerance) { return std::make_unique<AdamsRun<Problem>>(tolerance); },
      [](const auto& x, double, std::size_t evaluations) { return Answer{end_error<Problem>(x), evaluations}; })};
}

template std::vector<Solver> cvode_adams_solvers<Lorenz>();
template std::vector<Solver> cvode_adams_solvers<Arenstorf>();
template std::vector<Solver> cvode_adams_solvers<Kepler>();
template std::vector<Solver> cvode_adams_solvers<Pleiades>();
template std::vector<Solver> cvode_adams_solvers<OuterPlanets>();

}  // namespace continuo::bench
