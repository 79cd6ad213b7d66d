// A linear solver of the user's in place of a factorization, without its type: what Linearization and Factorization
// keep of it. What stands behind is in with_solver.hpp.
#pragma once
#include <cstddef>
#include <memory>
#include <utility>

#include <continuo/numerics/complex_number.hpp>
#include <continuo/numerics/state.hpp>

namespace continuo {

template <State X>
class Linearization;

namespace detail {

/// A pointer that copies what it points to.
template <class T>
class Cloned {
 public:
  Cloned() = default;
  explicit(false) Cloned(std::unique_ptr<T> held) : held_(std::move(held)) {}
  Cloned(const Cloned& other) : held_(other.held_ ? other.held_->clone() : nullptr) {}
  Cloned(Cloned&&) noexcept = default;
  Cloned& operator=(const Cloned& other) { return *this = Cloned(other); }
  Cloned& operator=(Cloned&&) noexcept = default;
  ~Cloned() = default;

  explicit operator bool() const { return held_ != nullptr; }
  T& operator*() const { return *held_; }
  T* operator->() const { return held_.get(); }

 private:
  std::unique_ptr<T> held_;
};

/// Solves (c M - J) y = b.
template <State X, class Number>
class SolverOfShift {
 public:
  virtual ~SolverOfShift() = default;
  [[nodiscard]] virtual std::unique_ptr<SolverOfShift> clone() const = 0;
  /// False where that failed.
  [[nodiscard]] virtual bool factor(const Linearization<X>& linear, const Number& c) = 0;
  /// b becomes the solution; not a number where that failed.
  virtual void solve(const Linearization<X>& linear, Number* b) = 0;

 protected:
  SolverOfShift() = default;
  SolverOfShift(const SolverOfShift&) = default;
  SolverOfShift(SolverOfShift&&) = default;
  SolverOfShift& operator=(const SolverOfShift&) = default;
  SolverOfShift& operator=(SolverOfShift&&) = default;
};

/// Makes solvers for one system, and applies its J, that of the point that was set last, without a matrix.
template <State X>
class SolverSource {
 public:
  using Real = Scalar<X>;

  virtual ~SolverSource() = default;
  [[nodiscard]] virtual std::unique_ptr<SolverSource> clone() const = 0;
  /// Whether solvers read the entries of J.
  [[nodiscard]] virtual bool reads_entries() const = 0;
  virtual void set_point(const Real& t, const X& x, const X& fx) = 0;
  [[nodiscard]] virtual const Real& time() const = 0;
  [[nodiscard]] virtual const X& state() const = 0;
  /// The size against which an error of component i is measured.
  [[nodiscard]] virtual Real scale(std::size_t i) const = 0;
  virtual void multiply_jacobian(const X& v, X& product) = 0;
  [[nodiscard]] virtual bool has_preconditioner() const = 0;
  /// One that was set up for another c within a factor of `slack` will do.
  virtual void precondition(const Real& c, const Real& slack, X& r) = 0;
  [[nodiscard]] virtual std::unique_ptr<SolverOfShift<X, Real>> real_solver() const = 0;
  [[nodiscard]] virtual std::unique_ptr<SolverOfShift<X, ComplexNumber<Real>>> complex_solver() const = 0;

 protected:
  SolverSource() = default;
  SolverSource(const SolverSource&) = default;
  SolverSource(SolverSource&&) = default;
  SolverSource& operator=(const SolverSource&) = default;
  SolverSource& operator=(SolverSource&&) = default;
};

/// A system whose equations are solved by solvers of the user's.
template <class F, class X>
concept GivesSolver = requires(F& f, const X& x, SolverSource<X>& source) {
  f.solver_source(x);
  f.bind(source);
};

}  // namespace detail
}  // namespace continuo
