// bench/stiff/peers/cvode.hpp
// The peer: CVODE of SUNDIALS, BDF with Newton's method, the problem's own Jacobian dense or sparse (KLU), its own
// defaults but for the number of steps.
#pragma once
#include <algorithm>
#include <array>
#include <cstddef>
#include <memory>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include <bench/stiff/measure.hpp>
#include <cvode/cvode.h>
#include <nvector/nvector_serial.h>
#include <sunlinsol/sunlinsol_dense.h>
#include <sunlinsol/sunlinsol_klu.h>
#include <sunmatrix/sunmatrix_dense.h>
#include <sunmatrix/sunmatrix_sparse.h>

namespace continuo::bench {

/// One run: everything CVODE is given and gives back.
template <class System>
class CvodeRun {
 public:
  static constexpr bool sparse = requires(const System& system) { system.jacobian_pattern(); };

  CvodeRun(double rtol, double atol) {
    const auto start = system_.start();
    x_.assign(start.begin(), start.end());
    const auto size = static_cast<sunindextype>(x_.size());
    SUNContext_Create(nullptr, &context_);
    vector_ = N_VMake_Serial(size, x_.data(), context_);
    solver_ = CVodeCreate(CV_BDF, context_);
    check(CVodeInit(solver_, f, 0, vector_));
    check(CVodeSStolerances(solver_, rtol, atol));
    check(CVodeSetUserData(solver_, this));
    check(CVodeSetErrHandlerFn(solver_, [](int, const char*, const char*, char*, void*) {}, nullptr));
    check(CVodeSetMaxNumSteps(solver_, 3'000'000));
    if constexpr (sparse) {
      matrix_ = SUNSparseMatrix(size, size, static_cast<sunindextype>(system_.jacobian_pattern().entries()), CSC_MAT,
                                context_);
      linear_ = SUNLinSol_KLU(vector_, matrix_, context_);
    } else {
      rows_.resize(x_.size() * x_.size());
      matrix_ = SUNDenseMatrix(size, size, context_);
      linear_ = SUNLinSol_Dense(vector_, matrix_, context_);
    }
    check(CVodeSetLinearSolver(solver_, linear_, matrix_));
    check(CVodeSetJacFn(solver_, jacobian));
  }
  CvodeRun(const CvodeRun&) = delete;
  CvodeRun& operator=(const CvodeRun&) = delete;
  ~CvodeRun() {
    CVodeFree(&solver_);
    SUNLinSolFree(linear_);
    SUNMatDestroy(matrix_);
    N_VDestroy(vector_);
    SUNContext_Free(&context_);
  }

  std::vector<double> advance(double end) {
    double t = 0;
    check(CVode(solver_, end, vector_, &t, CV_NORMAL));
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
  std::span<double> part(N_Vector v) const { return {NV_DATA_S(v), x_.size()}; }
  static int f(double t, N_Vector x, N_Vector dxdt, void* self) {
    const CvodeRun& run = *static_cast<CvodeRun*>(self);
    std::span<double> slope = run.part(dxdt);
    run.system_(t, run.part(x), slope);
    return 0;
  }
  static int jacobian(double t, N_Vector x, N_Vector, SUNMatrix matrix, void* self, N_Vector, N_Vector, N_Vector) {
    CvodeRun& run = *static_cast<CvodeRun*>(self);
    const std::size_t size = run.x_.size();
    if constexpr (sparse) {
      const SparsePattern& pattern = run.system_.jacobian_pattern();
      SUNMatZero(matrix);
      std::ranges::copy(pattern.starts(), SUNSparseMatrix_IndexPointers(matrix));
      std::ranges::copy(pattern.rows(), SUNSparseMatrix_IndexValues(matrix));
      run.system_.jacobian_values(t, run.part(x), std::span<double>(SUNSparseMatrix_Data(matrix), pattern.entries()));
    } else {
      run.system_.jacobian(t, run.part(x), std::span<double>(run.rows_));
      double* columns = SUNDenseMatrix_Data(matrix);
      for (std::size_t i = 0; i < size; ++i)
        for (std::size_t j = 0; j < size; ++j) columns[j * size + i] = run.rows_[i * size + j];
    }
    return 0;
  }

  System system_{};
  std::vector<double> x_, rows_;
  SUNContext context_ = nullptr;
  N_Vector vector_ = nullptr;
  SUNMatrix matrix_ = nullptr;
  SUNLinearSolver linear_ = nullptr;
  void* solver_ = nullptr;
};

template <class Problem, class System = Problem>
Solver cvode_solver() {
  const auto make = [](double tolerance) {
    return std::make_unique<CvodeRun<System>>(tolerance, tolerance * absolute_part<Problem>);
  };
  return {CvodeRun<System>::sparse ? "cvode klu" : "cvode dense", false,
          [make](double tolerance) {
            try {
              const auto run = make(tolerance);
              const std::vector<double> end = run->advance(Problem::duration);
              return judged<Problem>(end, tolerance, run->evaluations());
            } catch (const std::exception&) {
              return Answer{};
            }
          },
          [make](double tolerance) { return timed([&] { return make(tolerance)->advance(Problem::duration); }); }};
}

}  // namespace continuo::bench
