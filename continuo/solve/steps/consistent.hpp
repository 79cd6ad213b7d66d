// continuo/solve/steps/consistent.hpp
// Consistent values for the unknowns of algebraic equations: of M x' = f(t, x) with a diagonal M the rows without mass
// read 0 = g(t, x, z), and a run can only begin where they hold.
//
//   const Consistency found = make_consistent(system, t, x, tolerance);
//   if (!found) report(found.equation);
#pragma once
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>
#include <vector>

#include <continuo/methods/method.hpp>
#include <continuo/methods/support/weighted_norm.hpp>
#include <continuo/numerics/dense_lu.hpp>
#include <continuo/system/jacobian.hpp>
#include <continuo/system/mass.hpp>

namespace continuo {

struct Consistency {
  enum class Result { consistent, singular, not_found };
  Result result = Result::consistent;
  std::size_t equation = 0;  // the component whose equation is farthest from holding
  int evaluations = 0;

  explicit operator bool() const { return result == Result::consistent; }
};

/// The hint where there are no consistent values.
[[nodiscard]] constexpr const char* hint_of(const Consistency& found) {
  return found.result == Consistency::Result::singular
             ? "the algebraic equations do not determine their unknowns here: an unknown appears in no equation, two "
               "equations say the same, or the index is above 1"
             : "no values of the unknowns satisfy the algebraic equations: begin nearer to them, or look for a "
               "contradiction in the equations";
}

/// How accurately unknowns are solved for. For guards, which are evaluated at many places of a step, they are solved
/// for to rounding, so that guards have no other noise.
enum class SolvedTo { tolerance, rounding };

/// Solves for the unknowns without mass, the other components stay. It keeps its memory and the last decomposed matrix
/// between calls, for the many places of a step at which guards are evaluated.
template <State X>
class UnknownsSolver {
 public:
  using Real = Scalar<X>;

  explicit UnknownsSolver(const X& x) : f_(x), moved_(x), slope_(x), lu_(0) {}

  /// Newton's iteration; a correction is halved until the next one, with the same matrix, is shorter (P. Deuflhard,
  /// "Newton Methods for Nonlinear Problems", 3.3: natural monotonicity, which does not depend on how the equations are
  /// scaled). `x` becomes the solution; where there is none, it is the last iterate.
  template <class F>
  [[nodiscard]] Consistency solve(F& system, const Real& t, X& x, const Tolerance<Real>& tolerance,
                                  SolvedTo solved_to) {
    Consistency found;
    list_unknowns(system, x);
    if (unknown_.empty()) return found;
    if (solved_to == SolvedTo::rounding && solve_with_last_matrix(system, t, x, tolerance, found)) return found;
    for (int iteration = 0; iteration < most_iterations; ++iteration) {
      residual(system, t, x, correction_, found);
      if (!decompose(system, t, x, found)) {
        name_worst(found);
        found.result = Consistency::Result::singular;
        return found;
      }
      lu_.solve(correction_.data());
      take_scale(x, tolerance);
      const Real size = size_of(correction_);
      if (!(size < std::numeric_limits<Real>::infinity())) break;
      if (size <= target()) {
        add(correction_, Real(1), x);
        if (solved_to == SolvedTo::rounding) improve(system, t, x, size, found);
        return found;
      }
      if (!shorten(system, t, x, size, found)) break;
    }
    has_matrix_ = false;
    evaluate(system, t, x, f_);
    name_worst(found);
    found.result = Consistency::Result::not_found;
    return found;
  }

  /// For checkpoints: the matrix of the last place, which the next one may do with.
  template <class Archive>
  void transfer(Archive& archive, const X& x) {
    bool has_matrix = has_matrix_;
    archive(has_matrix);
    if (!has_matrix) return;
    if constexpr (Archive::reads) list_unknowns(archive.system(), x);
    const std::size_t n = dimension(x), m = unknown_.size();
    for (const std::size_t row : unknown_)
      for (const std::size_t column : unknown_) archive(rows_[row * n + column]);
    if constexpr (Archive::reads) {
      for (std::size_t i = 0; i < m; ++i)
        for (std::size_t j = 0; j < m; ++j) lu_.matrix()[i * m + j] = -rows_[unknown_[i] * n + unknown_[j]];
      has_matrix_ = lu_.factor();
    }
  }

 private:
  static constexpr int most_iterations = 50, most_halvings = 20, most_further = 4;

  /// A hundredth of the tolerance, so that the errors of the run itself are larger.
  [[nodiscard]] static Real target() { return Real(1) / Real(100); }

  template <class F>
  void list_unknowns(F& system, const X& x) {
    unknown_.clear();
    for (std::size_t i = 0; i < dimension(x); ++i)
      if (is_algebraic<X>(system, i)) unknown_.push_back(i);
    const std::size_t m = unknown_.size();
    if (m == correction_.size() && dimension(f_) == dimension(x)) return;
    f_ = moved_ = slope_ = x;
    rows_.resize(dimension(x) * dimension(x));
    for (std::vector<Real>* row : {&correction_, &next_, &scale_}) row->resize(m);
    lu_ = DenseLU<Real>(m);
    has_matrix_ = false;
  }

  template <class F>
  void residual(F& system, const Real& t, const X& x, std::vector<Real>& g, Consistency& found) {
    evaluate(system, t, x, f_);
    ++found.evaluations;
    for (std::size_t k = 0; k < unknown_.size(); ++k) g[k] = f_.data()[unknown_[k]];
  }

  /// Of the unknowns' equations by the unknowns; f_ is f there.
  template <class F>
  [[nodiscard]] bool decompose(F& system, const Real& t, const X& x, Consistency& found) {
    using std::sqrt;
    const std::size_t n = dimension(x), m = unknown_.size();
    found.evaluations += evaluate_jacobian(
        system, t, x, f_, moved_, slope_,
        // The magnitude of an unknown with the guess 0 is not known: the increment is that of Hairer & Wanner's RADAU5.
        [](std::size_t) { return Real(sqrt(std::numeric_limits<Real>::epsilon() / Real(100000))); },
        std::span<Real>(rows_));
    for (std::size_t i = 0; i < m; ++i)
      for (std::size_t j = 0; j < m; ++j) lu_.matrix()[i * m + j] = -rows_[unknown_[i] * n + unknown_[j]];
    has_matrix_ = lu_.factor();
    return has_matrix_;
  }

  /// The scale is that of the iterate. A scale that changed with the result of a correction would make a correction
  /// towards zero seem longer than it is.
  void take_scale(const X& x, const Tolerance<Real>& tolerance) {
    using std::max;
    for (std::size_t k = 0; k < unknown_.size(); ++k) {
      const Real& value = x.data()[unknown_[k]];
      scale_[k] = max(tolerance.scale(unknown_[k], value, value), std::numeric_limits<Real>::min());
    }
  }
  [[nodiscard]] Real size_of(const std::vector<Real>& step) const {
    return root_mean_square<Real>(unknown_.size(), [&](std::size_t k) { return Real(step[k] / scale_[k]); });
  }
  void add(const std::vector<Real>& step, const Real& part, X& x) const {
    for (std::size_t k = 0; k < unknown_.size(); ++k) x.data()[unknown_[k]] += part * step[k];
  }
  void name_worst(Consistency& found) const {
    using std::abs;
    Real worst(-1);
    for (const std::size_t i : unknown_) {
      const Real here = abs(f_.data()[i]);
      if (!(here <= worst)) worst = here, found.equation = i;
    }
  }

  /// Iterates on to rounding, with the same matrix.
  template <class F>
  void improve(F& system, const Real& t, X& x, Real last, Consistency& found) {
    for (int more = 0; more < most_further; ++more) {
      residual(system, t, x, correction_, found);
      lu_.solve(correction_.data());
      const Real left = size_of(correction_);
      if (!(left < last / 2)) return;
      add(correction_, Real(1), x);
      last = left;
    }
  }

  /// The matrix of the last place is good enough here where the first correction is short and the next one is shorter
  /// by four digits: the iteration then arrives at rounding like Newton's. Else x is unchanged.
  template <class F>
  [[nodiscard]] bool solve_with_last_matrix(F& system, const Real& t, X& x, const Tolerance<Real>& tolerance,
                                            Consistency& found) {
    if (!has_matrix_) return false;
    residual(system, t, x, correction_, found);
    lu_.solve(correction_.data());
    take_scale(x, tolerance);
    const Real size = size_of(correction_);
    if (size == Real(0)) return true;
    if (!(size <= target())) return false;
    before_.resize(unknown_.size());
    for (std::size_t k = 0; k < unknown_.size(); ++k) before_[k] = x.data()[unknown_[k]];
    add(correction_, Real(1), x);
    residual(system, t, x, correction_, found);
    lu_.solve(correction_.data());
    const Real left = size_of(correction_);
    if (left <= size / 10000) {
      add(correction_, Real(1), x);
      if (left > Real(0)) improve(system, t, x, left, found);
      return true;
    }
    for (std::size_t k = 0; k < unknown_.size(); ++k) x.data()[unknown_[k]] = before_[k];
    return false;
  }

  /// Halves the correction until the next one is shorter.
  template <class F>
  [[nodiscard]] bool shorten(F& system, const Real& t, X& x, const Real& size, Consistency& found) {
    Real part(1);
    for (int halving = 0; halving < most_halvings; ++halving) {
      add(correction_, part, x);
      residual(system, t, x, next_, found);
      lu_.solve(next_.data());
      if (size_of(next_) < size) return true;
      add(correction_, Real(-part), x);
      part /= Real(2);
    }
    return false;
  }

  X f_, moved_, slope_;
  std::vector<std::size_t> unknown_;
  std::vector<Real> rows_, correction_, next_, scale_, before_;
  DenseLU<Real> lu_;
  bool has_matrix_ = false;
};

/// Solves for the unknowns without mass once: see UnknownsSolver.
template <class F, State X>
Consistency make_consistent(F& system, const Scalar<X>& t, X& x, const Tolerance<Scalar<X>>& tolerance,
                            SolvedTo solved_to = SolvedTo::tolerance) {
  return UnknownsSolver<X>(x).solve(system, t, x, tolerance, solved_to);
}

}  // namespace continuo
