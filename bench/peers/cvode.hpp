// bench/peers/cvode.hpp
// The peer CVODE of SUNDIALS, its own defaults but for the number of steps: what its runs by Adams' methods and by BDF
// have in common.
#pragma once
#include <cstddef>
#include <exception>
#include <span>
#include <stdexcept>
#include <string>
#include <utility>

#include <bench/solver.hpp>
#include <cvode/cvode.h>
#include <nvector/nvector_serial.h>

namespace continuo::bench {

/// CVODE between its creation and its end. The state is the caller's memory.
class Cvode {
 public:
  /// `family` is CV_ADAMS or CV_BDF; `f` gets `user` with every call.
  Cvode(int family, std::span<double> x, CVRhsFn f, void* user, double rtol, double atol) {
    SUNContext_Create(nullptr, &context_);
    vector_ = N_VMake_Serial(static_cast<sunindextype>(x.size()), x.data(), context_);
    solver_ = CVodeCreate(family, context_);
    check(CVodeInit(solver_, f, 0, vector_));
    check(CVodeSStolerances(solver_, rtol, atol));
    check(CVodeSetUserData(solver_, user));
    check(CVodeSetErrHandlerFn(solver_, [](int, const char*, const char*, char*, void*) {}, nullptr));
    check(CVodeSetMaxNumSteps(solver_, 3'000'000));
  }
  Cvode(const Cvode&) = delete;
  Cvode& operator=(const Cvode&) = delete;
  ~Cvode() {
    CVodeFree(&solver_);
    N_VDestroy(vector_);
    SUNContext_Free(&context_);
  }

  SUNContext context() const { return context_; }
  N_Vector vector() const { return vector_; }
  void* solver() const { return solver_; }

  static void check(int flag) {
    if (flag < 0) throw std::runtime_error("CVODE gave up");
  }
  void advance(double end) {
    double t = 0;
    check(CVode(solver_, end, vector_, &t, CV_NORMAL));
  }
  std::size_t evaluations() const {
    long count = 0;
    CVodeGetNumRhsEvals(solver_, &count);
    return static_cast<std::size_t>(count);
  }

 private:
  SUNContext context_ = nullptr;
  N_Vector vector_ = nullptr;
  void* solver_ = nullptr;
};

/// `begin(tolerance)` makes a run on the heap, whose `advance(end)` returns the state there and whose `evaluations()`
/// counts; `judge(state, tolerance, evaluations)` says what it is worth.
template <class Begin, class Judge>
Solver solver_of_cvode(std::string name, double end, Begin begin, Judge judge) {
  return {std::move(name), false,
          [=](double tolerance) {
            try {
              const auto run = begin(tolerance);
              const auto x = run->advance(end);
              return judge(x, tolerance, run->evaluations());
            } catch (const std::exception&) {
              return Answer{};
            }
          },
          [=](double tolerance) { return timed([&] { return begin(tolerance)->advance(end); }); }};
}

}  // namespace continuo::bench
