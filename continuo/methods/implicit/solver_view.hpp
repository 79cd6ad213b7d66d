// A system as a method sees it whose equations are solved by a linear solver of the user's: the members of the system,
// and the making of solvers. It lives for one step and collects what happened in it.
#pragma once
#include <cmath>
#include <cstddef>
#include <functional>
#include <limits>
#include <memory>
#include <span>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include <continuo/methods/implicit/linearization.hpp>
#include <continuo/methods/implicit/solver_of_shift.hpp>
#include <continuo/methods/implicit/weighted_gmres.hpp>
#include <continuo/methods/linear_solver.hpp>
#include <continuo/methods/method.hpp>
#include <continuo/methods/support/tolerance_proportionality.hpp>
#include <continuo/numerics/finite.hpp>
#include <continuo/system/jacobian.hpp>
#include <continuo/system/system_reference.hpp>

namespace continuo::detail {

template <class View, class Solver, State X>
class SourceOf;

template <class System, class Solver, State X>
class SolverView : public SystemReference<System> {
 public:
  using Real = Scalar<X>;
  using Source = SourceOf<SolverView, Solver, X>;

  SolverView(System& system, const Tolerance<Real>& weights)
      : SystemReference<System>(std::ref(system)), tolerance(weights) {}

  [[nodiscard]] std::unique_ptr<SolverSource<X>> solver_source(const X& x) {
    return std::make_unique<Source>(*this, x, make_solver());
  }
  void bind(SolverSource<X>& source) {
    static_cast<Source&>(source).bind(*this);
    bound = true;
  }
  /// Keeps the first failure since J was evaluated.
  void note(StepStatus how, const Status& why) {
    if (status != StepStatus::done) return;
    status = how;
    reason = why.message;
  }
  void forget_failure() {
    status = StepStatus::done;
    reason.clear();
  }

  Tolerance<Real> tolerance;
  int evaluations = 0;  // for products with J
  StepStatus status = StepStatus::done;
  std::string reason;
  bool bound = false;  // whether the method has asked for solvers

 private:
  [[nodiscard]] Solver make_solver() {
    using Referred = ReferredSystem<System>;
    if constexpr (std::is_constructible_v<Solver, const Referred&> && !std::is_default_constructible_v<Solver>) {
      if constexpr (std::is_same_v<Referred, System>) {
        return Solver(std::as_const(this->get()));
      } else {
        return Solver(std::as_const(this->get().get()));
      }
    } else {
      return Solver{};
    }
  }
};

/// A solver of the user's that takes matrices of this Number.
template <class View, class Solver, State X, class Number>
class DirectSolver final : public SolverOfShift<X, Number> {
 public:
  using Source = SourceOf<View, Solver, X>;
  using Matrix = std::conditional_t<SolvesShift<Solver, ShiftedMatrix<X>, Scalar<X>>, ShiftedMatrix<X, Number>,
                                    ShiftedOperator<X, Number>>;

  explicit DirectSolver(Solver solver) : solver_(std::move(solver)) {}
  [[nodiscard]] std::unique_ptr<SolverOfShift<X, Number>> clone() const override {
    return std::make_unique<DirectSolver>(*this);
  }
  [[nodiscard]] bool factor(const Linearization<X>& linear, const Number& c) override {
    shift_ = c;
    Matrix a(linear, c);
    const Status done = solver_.factor(a);
    if (!done) Source::of(linear).note_factor(done);
    return static_cast<bool>(done);
  }
  void solve(const Linearization<X>& linear, Number* b) override {
    Matrix a(linear, shift_);
    Source::of(linear).guard(std::span<Number>(b, linear.size()),
                             [&](std::span<Number> right) { return solver_.solve(a, right); });
  }

 private:
  Solver solver_;
  Number shift_{};
};

/// A complex system by a solver of real ones: GMRES with the solution of (b M - J) y = r, b = |c|, as a preconditioner.
/// Of an eigenvalue z of J with a real part below 0, (c - z) / (b - z) lies within |c/b - 1| of 1 or nearer, on a line
/// to c / b if z is real: some ten products make it 1e-6.
template <class View, class Solver, State X>
class ComplexByRealSolver final : public SolverOfShift<X, ComplexNumber<Scalar<X>>> {
 public:
  using Real = Scalar<X>;
  using Number = ComplexNumber<Real>;
  using Source = SourceOf<View, Solver, X>;

  explicit ComplexByRealSolver(Solver solver) : real_(std::move(solver)) {}
  [[nodiscard]] std::unique_ptr<SolverOfShift<X, Number>> clone() const override {
    return std::make_unique<ComplexByRealSolver>(*this);
  }
  [[nodiscard]] bool factor(const Linearization<X>& linear, const Number& c) override {
    shift_ = c;
    return real_.factor(linear, PartsOf<Number>::size(c));
  }
  void solve(const Linearization<X>& linear, Number* b) override {
    Source& source = Source::of(linear);
    ShiftedOperator<X, Number> a(linear, shift_);
    part_.resize(linear.size());
    source.guard(std::span<Number>(b, linear.size()), [&](std::span<Number> right) {
      precondition(linear, right);
      return gmres_.solve(
          right,
          [&](std::span<const Number> v, std::span<Number> image) {
            a.multiply(v, image);
            precondition(linear, image);
          },
          [&](std::size_t i) { return source.scale(i); });
    });
  }

 private:
  void precondition(const Linearization<X>& linear, std::span<Number> r) {
    for (std::size_t k = 0; k < 2; ++k) {
      for (std::size_t i = 0; i < r.size(); ++i) part_[i] = PartsOf<Number>::part(r[i], k);
      real_.solve(linear, part_.data());
      for (std::size_t i = 0; i < r.size(); ++i) PartsOf<Number>::part(r[i], k) = part_[i];
    }
  }

  DirectSolver<View, Solver, X, Real> real_;
  WeightedGmres<Number> gmres_;
  Number shift_{};
  std::vector<Real> part_;
};

template <class View, class Solver, State X>
class SourceOf final : public SolverSource<X> {
 public:
  using Real = Scalar<X>;
  using Number = ComplexNumber<Real>;

  SourceOf(View& view, const X& x, Solver solver) : view_(&view), solver_(std::move(solver)), x_(x), f_(x), moved_(x) {}
  [[nodiscard]] static SourceOf& of(const Linearization<X>& linear) { return static_cast<SourceOf&>(*linear.own()); }
  void bind(View& view) { view_ = &view; }

  [[nodiscard]] std::unique_ptr<SolverSource<X>> clone() const override { return std::make_unique<SourceOf>(*this); }
  [[nodiscard]] bool reads_entries() const override { return MatrixSolver<Solver, X>; }
  void set_point(const Real& t, const X& x, const X&) override {
    t_ = t;
    x_ = x;
    knows_f_ = knows_entries_ = is_set_up_ = false;
    view_->forget_failure();
  }
  [[nodiscard]] const Real& time() const override { return t_; }
  [[nodiscard]] const X& state() const override { return x_; }
  [[nodiscard]] Real scale(std::size_t i) const override {
    using std::max;
    return max(view_->tolerance.scale(i, x_.data()[i], x_.data()[i]), std::numeric_limits<Real>::min());
  }
  void multiply_jacobian(const X& v, X& product) override {
    if constexpr (HasJacobianAction<View, X>) {
      view_->jacobian_action(t_, x_, v, product);
      keep_size(x_, product);
    } else if constexpr (HasSparseJacobian<View, X> || HasJacobian<View, X>) {
      multiply_entries(v, product);
    } else {
      multiply_difference(v, product);
    }
  }
  [[nodiscard]] bool has_preconditioner() const override { return HasPreconditioner<View, X>; }
  void precondition(const Real& c, const Real& slack, X& r) override {
    if constexpr (HasPreconditioner<View, X>) {
      if (!is_set_up_ || c > slack * set_up_for_ || set_up_for_ > slack * c) {
        view_->set_up_preconditioner(t_, x_, c);
        set_up_for_ = c;
        is_set_up_ = true;
      }
      view_->precondition(r);
      keep_size(x_, r);
    }
  }
  [[nodiscard]] std::unique_ptr<SolverOfShift<X, Real>> real_solver() const override {
    return std::make_unique<DirectSolver<View, Solver, X, Real>>(solver_);
  }
  [[nodiscard]] std::unique_ptr<SolverOfShift<X, Number>> complex_solver() const override {
    if constexpr (SolvesShift<Solver, ShiftedMatrix<X, Number>, Number> ||
                  SolvesShift<Solver, ShiftedOperator<X, Number>, Number>) {
      return std::make_unique<DirectSolver<View, Solver, X, Number>>(solver_);
    } else {
      return std::make_unique<ComplexByRealSolver<View, Solver, X>>(solver_);
    }
  }

  void note_factor(const Status& why) { view_->note(StepStatus::singular_matrix, why); }
  /// Solves for b, where all of it is finite; b becomes not a number where that fails.
  template <class N, class Solve>
  void guard(std::span<N> b, const Solve& solve) {
    const bool was_finite = is_finite_span(b);
    if (was_finite) {
      const Status done = solve(b);
      if (done && is_finite_span(b)) return;
      if (!done)
        view_->note(done.ending == Ending::not_finite ? StepStatus::not_finite : StepStatus::newton_diverged, done);
    }
    for (N& value : b) value = N(std::numeric_limits<Real>::quiet_NaN());
  }

 private:
  template <class N>
  [[nodiscard]] static bool is_finite_span(std::span<const N> b) {
    for (const N& value : b)
      for (std::size_t k = 0; k < PartsOf<N>::count; ++k)
        if (!is_finite(PartsOf<N>::part(value, k))) return false;
    return true;
  }
  template <class N>
  [[nodiscard]] static bool is_finite_span(std::span<N> b) {
    return is_finite_span(std::span<const N>(b));
  }

  void multiply_entries(const X& v, X& product) {
    const std::size_t n = dimension(x_);
    if constexpr (HasSparseJacobian<View, X>) {
      const SparsePattern& pattern = view_->jacobian_pattern();
      if (!knows_entries_) {
        entries_.assign(pattern.entries(), Real(0));
        view_->jacobian_values(t_, x_, std::span<Real>(entries_));
      }
      for (std::size_t i = 0; i < n; ++i) product.data()[i] = Real(0);
      for (std::size_t j = 0; j < n; ++j)
        for (std::size_t p = pattern.begin(j); p < pattern.end(j); ++p)
          product.data()[pattern.row(p)] += entries_[p] * v.data()[j];
    } else {
      if (!knows_entries_) {
        entries_.assign(n * n, Real(0));
        view_->jacobian(t_, x_, std::span<Real>(entries_));
      }
      for (std::size_t i = 0; i < n; ++i) {
        product.data()[i] = Real(0);
        for (std::size_t j = 0; j < n; ++j) product.data()[i] += entries_[i * n + j] * v.data()[j];
      }
    }
    knows_entries_ = true;
  }

  /// x moves by about its tolerance in every component, and never by so little that rounding shows.
  void multiply_difference(const X& v, X& product) {
    using std::max, std::sqrt;
    const std::size_t n = dimension(x_);
    if (!knows_f_) {
      evaluate(*view_, t_, x_, f_);
      ++view_->evaluations;
      knows_f_ = true;
    }
    Real sum(0);
    for (std::size_t i = 0; i < n; ++i) {
      const Real part = v.data()[i] / scale(i);
      sum += part * part;
      product.data()[i] = Real(0);
    }
    if (sum == Real(0)) return;
    const Real wanted =
        max(Real(1), Real(sqrt(std::numeric_limits<Real>::epsilon()) / relative_as_number(view_->tolerance)));
    const Real increment = wanted * sqrt(Real(static_cast<Real>(n)) / sum);
    for (std::size_t i = 0; i < n; ++i) moved_.data()[i] = x_.data()[i] + increment * v.data()[i];
    evaluate(*view_, t_, moved_, product);
    ++view_->evaluations;
    for (std::size_t i = 0; i < n; ++i) product.data()[i] = (product.data()[i] - f_.data()[i]) / increment;
  }

  View* view_;     // of the present step
  Solver solver_;  // what copies are made of
  Real t_{}, set_up_for_{};
  X x_, f_, moved_;
  std::vector<Real> entries_;
  bool knows_f_ = false, knows_entries_ = false, is_set_up_ = false;
};

}  // namespace continuo::detail
