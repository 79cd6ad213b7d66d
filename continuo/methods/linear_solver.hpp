// A linear solver of your own for the equations (c M - J) y = b of implicit steps, J = df/dx at one (t, x). It gets the
// matrix with its entries, or as an operator that multiplies, and keeps what it makes of it:
//
//   struct Diagonal {
//     std::vector<double> inverse;
//     Status factor(const ShiftedMatrix<X>& a);                         // or ShiftedOperator<X>
//     Status solve(const ShiftedMatrix<X>& a, std::span<double> b);     // b becomes the solution
//   };
//
// WithSolver (with_solver.hpp) gives it to an implicit method. docs/extending.md has an example.
#pragma once
#include <cmath>
#include <concepts>
#include <cstddef>
#include <span>
#include <type_traits>

#include <continuo/methods/implicit/linearization.hpp>
#include <continuo/numerics/complex_number.hpp>
#include <continuo/status/status.hpp>

namespace continuo {

/// c M - J with the entries of J: those of its pattern where the system gives one (`jacobian_pattern`), else all. Valid
/// within the call that it is an argument of.
template <State X, class Number = Scalar<X>>
class ShiftedMatrix {
 public:
  using Real = Scalar<X>;

  /// A view of what a method keeps.
  ShiftedMatrix(const Linearization<X>& linear, const Number& shift) : linear_(&linear), shift_(shift) {}

  /// The number of rows.
  [[nodiscard]] std::size_t size() const { return linear_->size(); }
  /// c, in units of 1/t.
  [[nodiscard]] const Number& shift() const { return shift_; }
  /// Whether the entries of J are those of a pattern.
  [[nodiscard]] bool sparse() const { return linear_->sparse(); }
  /// The pattern of J; of a sparse one only.
  [[nodiscard]] const SparsePattern& pattern() const { return linear_->pattern(); }
  /// The entries of J in the order of the pattern, or row by row.
  [[nodiscard]] std::span<const Real> jacobian() const { return linear_->entries(); }
  /// An entry of M.
  [[nodiscard]] Real mass(std::size_t row, std::size_t column) const { return linear_->mass(row, column); }
  /// An entry of c M - J. Of a sparse one this looks the place up.
  [[nodiscard]] Number operator()(std::size_t row, std::size_t column) const {
    const Number mass_part = shift_ * Number(linear_->mass(row, column));
    if (!sparse()) return mass_part - Number(jacobian()[row * size() + column]);
    const std::size_t place = pattern().find(row, column);
    return place < pattern().entries() ? mass_part - Number(jacobian()[place]) : mass_part;
  }

 private:
  const Linearization<X>* linear_;
  Number shift_;
};

namespace detail {
/// The real numbers of which a Number consists.
template <class Number>
struct PartsOf {
  using Real = Number;
  static constexpr std::size_t count = 1;
  static Real& part(Number& value, std::size_t) { return value; }
  static const Real& part(const Number& value, std::size_t) { return value; }
  static Real size(const Number& value) { return value < Real(0) ? Real(-value) : value; }
};
template <class R>
struct PartsOf<ComplexNumber<R>> {
  using Real = R;
  static constexpr std::size_t count = 2;
  static Real& part(ComplexNumber<R>& value, std::size_t k) { return k == 0 ? value.re : value.im; }
  static const Real& part(const ComplexNumber<R>& value, std::size_t k) { return k == 0 ? value.re : value.im; }
  static Real size(const ComplexNumber<R>& value) {
    using std::sqrt;
    return sqrt(value.re * value.re + value.im * value.im);
  }
};
}  // namespace detail

/// c M - J by what it does to a vector; the entries of J are never computed unless the system gives nothing else
/// than them. J v is the system's `jacobian_action`, else from its entries, else a difference of f. Valid within the
/// call that it is an argument of; made by a copy of two states.
template <State X, class Number = Scalar<X>>
class ShiftedOperator {
 public:
  using Real = Scalar<X>;

  /// A view of what a method keeps.
  ShiftedOperator(const Linearization<X>& linear, const Number& shift)
      : linear_(&linear), shift_(shift), v_(linear.own()->state()), product_(v_) {}

  /// The number of rows.
  [[nodiscard]] std::size_t size() const { return linear_->size(); }
  /// c, in units of 1/t.
  [[nodiscard]] const Number& shift() const { return shift_; }
  /// The t of J.
  [[nodiscard]] const Real& time() const { return linear_->own()->time(); }
  /// The x of J.
  [[nodiscard]] const X& state() const { return linear_->own()->state(); }
  /// The size against which an error of component i is measured: its tolerance.
  [[nodiscard]] Real scale(std::size_t i) const { return linear_->own()->scale(i); }
  /// An entry of M.
  [[nodiscard]] Real mass(std::size_t row, std::size_t column) const { return linear_->mass(row, column); }

  /// product = J v.
  void multiply_jacobian(std::span<const Number> v, std::span<Number> product) {
    for_each_part(v, product, [&] {
      if (linear_->own()->reads_entries()) {
        linear_->multiply_jacobian(v_, product_);
      } else {
        linear_->own()->multiply_jacobian(v_, product_);
      }
    });
  }
  /// product = (c M - J) v.
  void multiply(std::span<const Number> v, std::span<Number> product) {
    multiply_jacobian(v, product);
    for (std::size_t i = 0; i < size(); ++i) product[i] = shift_ * mass_times(v, i) - product[i];
  }
  /// r becomes an approximation of (c M - J)^-1 r: by the preconditioner of the system, for |c| where c is complex; a
  /// system without one gets r / c M by the diagonal.
  void precondition(std::span<Number> r) {
    // One preconditioner serves all the c of a step that are complex: where z is an eigenvalue of J with a real part
    // below 0, (c - z) / (b - z) with b = |c| / s lies near 1 for s of the order of 1.
    const Real slack(detail::PartsOf<Number>::count == 1 ? 1 : 4);
    if (!linear_->own()->has_preconditioner()) return divide_by_mass_part(r);
    for_each_part(r, r, [&] {
      product_ = v_;
      linear_->own()->precondition(detail::PartsOf<Number>::size(shift_), slack, product_);
    });
  }

 private:
  template <class Act>
  void for_each_part(std::span<const Number> v, std::span<Number> product, const Act& act) {
    using Parts = detail::PartsOf<Number>;
    for (std::size_t k = 0; k < Parts::count; ++k) {
      for (std::size_t i = 0; i < size(); ++i) v_.data()[i] = Parts::part(v[i], k);
      act();
      for (std::size_t i = 0; i < size(); ++i) Parts::part(product[i], k) = product_.data()[i];
    }
  }
  [[nodiscard]] Number mass_times(std::span<const Number> v, std::size_t i) const {
    if (!linear_->has_mass()) return v[i];
    if (!linear_->mass_diagonal().empty()) return Number(linear_->mass_diagonal()[i]) * v[i];
    Number sum{};
    for (std::size_t j = 0; j < size(); ++j) sum += Number(linear_->mass(i, j)) * v[j];
    return sum;
  }
  // An algebraic equation stands as it is written: see KrylovEquations.
  void divide_by_mass_part(std::span<Number> r) const {
    const bool diagonal = !linear_->mass_diagonal().empty();
    for (std::size_t i = 0; i < size(); ++i) {
      const Real mass_part = diagonal ? linear_->mass_diagonal()[i] : Real(1);
      if (mass_part != Real(0)) r[i] = r[i] * reciprocal(Number(shift_ * Number(mass_part)));
    }
  }

  const Linearization<X>* linear_;
  Number shift_;
  X v_, product_;
};

namespace detail {

template <class S, class A>
concept Factors =
    requires(S& solver, const A& a) { solver.factor(a); } || requires(S& solver, A& a) { solver.factor(a); };
template <class S, class A>
concept FactorReports = requires(S& solver, A& a) {
  { solver.factor(a) } -> std::same_as<Status>;
};
template <class S, class A, class Number>
concept SolvesFor = requires(S& solver, A& a, std::span<Number> b) { solver.solve(a, b); };
template <class S, class A, class Number>
concept SolveReports = requires(S& solver, A& a, std::span<Number> b) {
  { solver.solve(a, b) } -> std::same_as<Status>;
};
template <class S, class A, class Number>
concept SolvesShift = FactorReports<S, A> && SolveReports<S, A, Number>;

}  // namespace detail

/// S solves (c M - J) y = b for states X from the entries of the matrix.
template <class S, class X>
concept MatrixSolver = State<X> && detail::SolvesShift<S, ShiftedMatrix<X>, Scalar<X>>;
/// S solves it from products of the matrix with vectors.
template <class S, class X>
concept OperatorSolver = State<X> && detail::SolvesShift<S, ShiftedOperator<X>, Scalar<X>>;
/// S solves linear systems for implicit methods, one way or the other: `factor` gets the matrix, and `solve` the same
/// matrix and a right-hand side, which becomes the solution. Both report by a Status whether they could. A solver that
/// takes matrices of ComplexNumber<Real> as well does so for the methods that need it.
template <class S, class X>
concept LinearSolver = std::copyable<S> && (MatrixSolver<S, X> != OperatorSolver<S, X>);

/// Refuses, by a sentence, a type that is no LinearSolver for states X; true where it is one.
template <class S, State X>
[[nodiscard]] consteval bool check_linear_solver() {
  using Real = Scalar<X>;
  using Matrix = ShiftedMatrix<X>;
  using Operator = ShiftedOperator<X>;
  using ComplexMatrix = ShiftedMatrix<X, ComplexNumber<Real>>;
  using ComplexOperator = ShiftedOperator<X, ComplexNumber<Real>>;
  constexpr bool copyable = std::copyable<S>;
  static_assert(copyable, "the linear solver cannot be copied: a copy of a run has solvers of its own");
  constexpr bool from_matrix = detail::Factors<S, Matrix>, from_operator = detail::Factors<S, Operator>;
  constexpr bool factors = from_matrix || from_operator, factors_both = from_matrix && from_operator;
  static_assert(factors,
                "the linear solver lacks a public member `factor` that gets the matrix, with its entries or as an "
                "operator: Status factor(const ShiftedMatrix<X>& a) or Status factor(ShiftedOperator<X>& a)");
  static_assert(
      !factors_both,
      "`factor` of the linear solver takes both kinds of matrices, so that nobody knows whether to compute the "
      "entries: name the type of its argument, ShiftedMatrix<X> or ShiftedOperator<X>");
  constexpr bool factor_reports = detail::FactorReports<S, Matrix> || detail::FactorReports<S, Operator>,
                 factor_is_silent = factors && !factor_reports;
  static_assert(!factor_is_silent,
                "`factor` of the linear solver must return a Status: a singular matrix is a failure");
  constexpr bool solves = from_matrix ? detail::SolvesFor<S, Matrix, Real> : detail::SolvesFor<S, Operator, Real>;
  static_assert(solves,
                "the linear solver lacks a public member `solve` that gets the argument of `factor` and the right-hand "
                "side, which becomes the solution: Status solve(const ShiftedMatrix<X>& a, std::span<Real> b)");
  constexpr bool solve_reports =
                     from_matrix ? detail::SolveReports<S, Matrix, Real> : detail::SolveReports<S, Operator, Real>,
                 solve_is_silent = solves && !solve_reports;
  static_assert(!solve_is_silent,
                "`solve` of the linear solver must return a Status: an iteration that does not converge is a failure");
  constexpr bool factors_complex = detail::Factors<S, ComplexMatrix> || detail::Factors<S, ComplexOperator>,
                 complex_is_ignored =
                     factors_complex && !(detail::SolvesShift<S, ComplexMatrix, ComplexNumber<Real>> ||
                                          detail::SolvesShift<S, ComplexOperator, ComplexNumber<Real>>);
  static_assert(!complex_is_ignored,
                "`factor` of the linear solver takes complex matrices, and would be ignored without a `solve` of them: "
                "Status solve(const ShiftedMatrix<X, ComplexNumber<Real>>& a, std::span<ComplexNumber<Real>> b)");
  return LinearSolver<S, X>;
}

}  // namespace continuo
