// bench/stiff/peers/cvode.hpp
// The peer: CVODE of SUNDIALS, BDF with Newton's method, the problem's own Jacobian dense or sparse (KLU).
#pragma once
#include <algorithm>
#include <cstddef>
#include <memory>
#include <span>
#include <vector>

#include <bench/peers/cvode.hpp>
#include <bench/stiff/measure.hpp>
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

  CvodeRun(double rtol, double atol) : x_(start_of(system_)), cvode_(CV_BDF, x_, f, this, rtol, atol) {
    const auto size = static_cast<sunindextype>(x_.size());
    if constexpr (sparse) {
      matrix_ = SUNSparseMatrix(size, size, static_cast<sunindextype>(system_.jacobian_pattern().entries()), CSC_MAT,
                                cvode_.context());
      linear_ = SUNLinSol_KLU(cvode_.vector(), matrix_, cvode_.context());
    } else {
      rows_.resize(x_.size() * x_.size());
      matrix_ = SUNDenseMatrix(size, size, cvode_.context());
      linear_ = SUNLinSol_Dense(cvode_.vector(), matrix_, cvode_.context());
    }
    Cvode::check(CVodeSetLinearSolver(cvode_.solver(), linear_, matrix_));
    Cvode::check(CVodeSetJacFn(cvode_.solver(), jacobian));
  }
  CvodeRun(const CvodeRun&) = delete;
  CvodeRun& operator=(const CvodeRun&) = delete;
  ~CvodeRun() {
    SUNLinSolFree(linear_);
    SUNMatDestroy(matrix_);
  }

  std::vector<double> advance(double end) {
    cvode_.advance(end);
    return x_;
  }
  std::size_t evaluations() const { return cvode_.evaluations(); }

 private:
  static std::vector<double> start_of(const System& system) {
    const auto start = system.start();
    return {start.begin(), start.end()};
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
  Cvode cvode_;
  SUNMatrix matrix_ = nullptr;
  SUNLinearSolver linear_ = nullptr;
};

template <class Problem, class System = Problem>
Solver cvode_solver() {
  return solver_of_cvode(
      CvodeRun<System>::sparse ? "cvode klu" : "cvode dense", Problem::duration,
      [](double tolerance) {
        return std::make_unique<CvodeRun<System>>(tolerance, tolerance * absolute_part<Problem>);
      },
      [](const std::vector<double>& x, double tolerance, std::size_t evaluations) {
        return judged<Problem>(x, tolerance, evaluations);
      });
}

}  // namespace continuo::bench
