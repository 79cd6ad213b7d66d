// The peer: CVODE of SUNDIALS with Adams' methods and its fixed-point iteration, its own defaults but for the number of
// steps.
#include <cstddef>
#include <memory>
#include <stdexcept>

#include <bench/nonstiff/measure.hpp>
#include <bench/nonstiff/peers/for_c.hpp>
#include <cvode/cvode.h>
#include <nvector/nvector_serial.h>
#include <sunnonlinsol/sunnonlinsol_fixedpoint.h>

namespace continuo::bench {
namespace {

/// One run: everything CVODE is given and gives back.
template <class Problem>
class AdamsRun {
 public:
  using State = std::array<double, Problem::size>;

  explicit AdamsRun(double tolerance) : x_(Problem::start()) {
    SUNContext_Create(nullptr, &context_);
    vector_ = N_VMake_Serial(static_cast<sunindextype>(x_.size()), x_.data(), context_);
    solver_ = CVodeCreate(CV_ADAMS, context_);
    iteration_ = SUNNonlinSol_FixedPoint(vector_, 0, context_);
    check(CVodeInit(solver_, f, 0, vector_));
    check(CVodeSStolerances(solver_, tolerance, tolerance));
    check(CVodeSetErrHandlerFn(solver_, [](int, const char*, const char*, char*, void*) {}, nullptr));
    check(CVodeSetMaxNumSteps(solver_, 3'000'000));
    check(CVodeSetNonlinearSolver(solver_, iteration_));
  }
  AdamsRun(const AdamsRun&) = delete;
  AdamsRun& operator=(const AdamsRun&) = delete;
  ~AdamsRun() {
    CVodeFree(&solver_);
    SUNNonlinSolFree(iteration_);
    N_VDestroy(vector_);
    SUNContext_Free(&context_);
  }

  const State& advance() {
    double t = 0;
    check(CVodeSetStopTime(solver_, Problem::duration));
    check(CVode(solver_, Problem::duration, vector_, &t, CV_NORMAL));
    return x_;
  }
  std::size_t evaluations() const {
    long count = 0;
    CVodeGetNumRhsEvals(solver_, &count);
    return static_cast<std::size_t>(count);
  }

 private:
  static void check(int flag) {
    if (flag < 0) throw std::runtime_error("CVODE gave up");
  }
  static int f(double t, N_Vector x, N_Vector dxdt, void*) {
    evaluate_by_pointers<Problem>(t, NV_DATA_S(x), NV_DATA_S(dxdt));
    return 0;
  }

  State x_;
  SUNContext context_ = nullptr;
  N_Vector vector_ = nullptr;
  SUNNonlinearSolver iteration_ = nullptr;
  void* solver_ = nullptr;
};

}  // namespace

template <class Problem>
std::vector<Solver> cvode_adams_solvers() {
  return {{"cvode adams", false,
           [](double tolerance) {
             try {
               AdamsRun<Problem> run(tolerance);
               const double error = end_error<Problem>(run.advance());
               return Answer{error, run.evaluations()};
             } catch (const std::exception&) {
               return Answer{};
             }
           },
           [](double tolerance) { return timed([&] { return AdamsRun<Problem>(tolerance).advance(); }); }}};
}

template std::vector<Solver> cvode_adams_solvers<Lorenz>();
template std::vector<Solver> cvode_adams_solvers<Arenstorf>();
template std::vector<Solver> cvode_adams_solvers<Kepler>();
template std::vector<Solver> cvode_adams_solvers<Pleiades>();
template std::vector<Solver> cvode_adams_solvers<OuterPlanets>();

}  // namespace continuo::bench
