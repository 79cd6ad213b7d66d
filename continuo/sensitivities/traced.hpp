// Numbers that write down how they were computed, so that a function of any number type can be differentiated backwards
// at the cost of a few evaluations, however many variables it has (reverse mode; A. Griewank, A. Walther, "Evaluating
// Derivatives", SIAM 2008, chapter 3):
//
//   Trace<double> trace;
//   const Traced<double> x = trace.variable(2.0), y = trace.variable(3.0);
//   const Traced<double> z = x * sin(y);
//   const std::span<const double> slopes = trace.slopes_of(z);  // dz/dx, dz/dy
//
// A trace is a list of operations, each with at most two operands and its two partial derivatives. Functions must be
// found by their argument: sin, not std::sin.
#pragma once
#include <algorithm>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <type_traits>
#include <vector>

namespace continuo {

template <class Real>
class Traced;

/// The operations by which traced numbers were computed, in order. The variables come first.
template <class Real>
class Trace {
 public:
  /// Forgets all operations; the numbers that they gave must not be used any more.
  void clear() {
    operations_.clear();
    variables_ = 0;
  }
  /// A new variable. All variables are made before the first operation.
  [[nodiscard]] Traced<Real> variable(const Real& value) {
    ++variables_;
    return Traced<Real>(value, *this, add(none, Real(0), none, Real(0)));
  }

  /// The derivatives of `result` by the variables, in their order; valid until the next call. Costs two products for
  /// each operation.
  [[nodiscard]] std::span<const Real> slopes_of(const Traced<Real>& result) {
    begin_sweep();
    add_seed(result, Real(1));
    return sweep();
  }

  /// The derivatives of sum_i weights_i results_i by the variables, in their order: all results in one sweep.
  [[nodiscard]] std::span<const Real> slopes_of(std::span<const Traced<Real>> results, std::span<const Real> weights) {
    begin_sweep();
    for (std::size_t i = 0; i < results.size(); ++i) add_seed(results[i], weights[i]);
    return sweep();
  }

  /// Of the last sweep, the derivative by variable i.
  [[nodiscard]] const Real& slope_of_variable(std::size_t i) const { return slopes_[i]; }

  /// The operation that this one has added, by its operands and its partial derivatives.
  [[nodiscard]] std::uint32_t add(std::uint32_t first, const Real& by_first, std::uint32_t second,
                                  const Real& by_second) {
    operations_.push_back({first, second, by_first, by_second});
    return static_cast<std::uint32_t>(operations_.size() - 1);
  }
  /// In the place of an operand that is a constant.
  static constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();

 private:
  struct Operation {
    std::uint32_t first, second;
    Real by_first, by_second;
  };

  void begin_sweep() { slopes_.assign(operations_.size(), Real(0)); }
  void add_seed(const Traced<Real>& result, const Real& weight) {
    if (!result.is_constant()) slopes_[result.place()] += weight;
  }
  [[nodiscard]] std::span<const Real> sweep() {
    for (std::size_t k = operations_.size(); k-- > variables_;) {
      const Real slope = slopes_[k];
      if (slope == Real(0)) continue;  // it may be the factor of an infinite one that is not asked for
      const Operation& operation = operations_[k];
      if (operation.first != none) slopes_[operation.first] += slope * operation.by_first;
      if (operation.second != none) slopes_[operation.second] += slope * operation.by_second;
    }
    return {slopes_.data(), variables_};
  }

  std::vector<Operation> operations_;
  std::vector<Real> slopes_;
  std::size_t variables_ = 0;
};

/// A number that is a constant, or the result of an operation of a trace.
template <class Real>
class Traced {
 public:
  /// The constant 0.
  Traced() = default;
  /// A constant.
  template <class Number>
    requires std::is_arithmetic_v<Number> || std::same_as<Number, Real>
  explicit(false) Traced(Number value) : value_(static_cast<Real>(value)) {}
  /// The result of the operation at this place of a trace.
  Traced(const Real& value, Trace<Real>& trace, std::uint32_t place) : value_(value), trace_(&trace), place_(place) {}

  /// The number itself.
  [[nodiscard]] const Real& value() const { return value_; }
  /// Whether it depends on no variable.
  [[nodiscard]] bool is_constant() const { return trace_ == nullptr; }
  /// The place of its operation; of a number that is no constant.
  [[nodiscard]] std::uint32_t place() const { return place_; }

  /// g(a) with g' at a.
  [[nodiscard]] static Traced of(const Traced& a, const Real& value, const Real& slope) {
    if (a.is_constant()) return Traced(value);
    return Traced(value, *a.trace_, a.trace_->add(a.place_, slope, Trace<Real>::none, Real(0)));
  }
  /// g(a, b) with its partial derivatives at (a, b).
  [[nodiscard]] static Traced of(const Traced& a, const Traced& b, const Real& value, const Real& by_a,
                                 const Real& by_b) {
    if (b.is_constant()) return of(a, value, by_a);
    if (a.is_constant()) return of(b, value, by_b);
    return Traced(value, *a.trace_, a.trace_->add(a.place_, by_a, b.place_, by_b));
  }

  /// Arithmetic.
  /// @{
  friend Traced operator+(const Traced& a) { return a; }
  friend Traced operator-(const Traced& a) { return of(a, -a.value_, Real(-1)); }
  friend Traced operator+(const Traced& a, const Traced& b) { return of(a, b, a.value_ + b.value_, Real(1), Real(1)); }
  friend Traced operator-(const Traced& a, const Traced& b) { return of(a, b, a.value_ - b.value_, Real(1), Real(-1)); }
  friend Traced operator*(const Traced& a, const Traced& b) {
    return of(a, b, a.value_ * b.value_, b.value_, a.value_);
  }
  friend Traced operator/(const Traced& a, const Traced& b) {
    const Real value = a.value_ / b.value_;
    return of(a, b, value, Real(1) / b.value_, -value / b.value_);
  }
  Traced& operator+=(const Traced& b) { return *this = *this + b; }
  Traced& operator-=(const Traced& b) { return *this = *this - b; }
  Traced& operator*=(const Traced& b) { return *this = *this * b; }
  Traced& operator/=(const Traced& b) { return *this = *this / b; }
  /// @}

  /// Functions of two numbers, of which one may be a constant.
  /// @{
  [[nodiscard]] friend Traced atan2(const Traced& y, const Traced& x) {
    using std::atan2;
    const Real square = x.value_ * x.value_ + y.value_ * y.value_;
    return of(y, x, atan2(y.value_, x.value_), x.value_ / square, -y.value_ / square);
  }
  [[nodiscard]] friend Traced hypot(const Traced& a, const Traced& b) {
    using std::hypot;
    const Real value = hypot(a.value_, b.value_);
    return of(a, b, value, a.value_ / value, b.value_ / value);
  }
  [[nodiscard]] friend Traced max(const Traced& a, const Traced& b) { return a.value_ < b.value_ ? b : a; }
  [[nodiscard]] friend Traced min(const Traced& a, const Traced& b) { return b.value_ < a.value_ ? b : a; }
  /// @}

  /// Comparisons are those of the values: a branch is differentiated as the one that was taken.
  /// @{
  friend bool operator==(const Traced& a, const Traced& b) { return a.value_ == b.value_; }
  friend auto operator<=>(const Traced& a, const Traced& b) { return a.value_ <=> b.value_; }
  /// @}

 private:
  Real value_{};
  Trace<Real>* trace_ = nullptr;
  std::uint32_t place_ = 0;
};

/// Functions of traced numbers.
/// @{
template <class Real>
[[nodiscard]] Traced<Real> sqrt(const Traced<Real>& a) {
  using std::sqrt;
  const Real root = sqrt(a.value());
  return Traced<Real>::of(a, root, Real(1) / (2 * root));
}
template <class Real>
[[nodiscard]] Traced<Real> cbrt(const Traced<Real>& a) {
  using std::cbrt;
  const Real root = cbrt(a.value());
  return Traced<Real>::of(a, root, Real(1) / (3 * root * root));
}
template <class Real>
[[nodiscard]] Traced<Real> exp(const Traced<Real>& a) {
  using std::exp;
  const Real value = exp(a.value());
  return Traced<Real>::of(a, value, value);
}
template <class Real>
[[nodiscard]] Traced<Real> expm1(const Traced<Real>& a) {
  using std::exp, std::expm1;
  return Traced<Real>::of(a, expm1(a.value()), exp(a.value()));
}
template <class Real>
[[nodiscard]] Traced<Real> log(const Traced<Real>& a) {
  using std::log;
  return Traced<Real>::of(a, log(a.value()), Real(1) / a.value());
}
template <class Real>
[[nodiscard]] Traced<Real> log1p(const Traced<Real>& a) {
  using std::log1p;
  return Traced<Real>::of(a, log1p(a.value()), Real(1) / (1 + a.value()));
}
template <class Real>
[[nodiscard]] Traced<Real> log10(const Traced<Real>& a) {
  using std::log, std::log10;
  return Traced<Real>::of(a, log10(a.value()), Real(1) / (a.value() * log(Real(10))));
}
template <class Real>
[[nodiscard]] Traced<Real> sin(const Traced<Real>& a) {
  using std::cos, std::sin;
  return Traced<Real>::of(a, sin(a.value()), cos(a.value()));
}
template <class Real>
[[nodiscard]] Traced<Real> cos(const Traced<Real>& a) {
  using std::cos, std::sin;
  return Traced<Real>::of(a, cos(a.value()), -sin(a.value()));
}
template <class Real>
[[nodiscard]] Traced<Real> tan(const Traced<Real>& a) {
  using std::tan;
  const Real value = tan(a.value());
  return Traced<Real>::of(a, value, 1 + value * value);
}
template <class Real>
[[nodiscard]] Traced<Real> asin(const Traced<Real>& a) {
  using std::asin, std::sqrt;
  return Traced<Real>::of(a, asin(a.value()), Real(1) / sqrt((1 - a.value()) * (1 + a.value())));
}
template <class Real>
[[nodiscard]] Traced<Real> acos(const Traced<Real>& a) {
  using std::acos, std::sqrt;
  return Traced<Real>::of(a, acos(a.value()), Real(-1) / sqrt((1 - a.value()) * (1 + a.value())));
}
template <class Real>
[[nodiscard]] Traced<Real> atan(const Traced<Real>& a) {
  using std::atan;
  return Traced<Real>::of(a, atan(a.value()), Real(1) / (1 + a.value() * a.value()));
}
template <class Real>
[[nodiscard]] Traced<Real> sinh(const Traced<Real>& a) {
  using std::cosh, std::sinh;
  return Traced<Real>::of(a, sinh(a.value()), cosh(a.value()));
}
template <class Real>
[[nodiscard]] Traced<Real> cosh(const Traced<Real>& a) {
  using std::cosh, std::sinh;
  return Traced<Real>::of(a, cosh(a.value()), sinh(a.value()));
}
template <class Real>
[[nodiscard]] Traced<Real> tanh(const Traced<Real>& a) {
  using std::tanh;
  const Real value = tanh(a.value());
  return Traced<Real>::of(a, value, (1 - value) * (1 + value));
}
template <class Real>
[[nodiscard]] Traced<Real> abs(const Traced<Real>& a) {
  using std::abs;
  return Traced<Real>::of(a, abs(a.value()), a.value() < 0 ? Real(-1) : Real(a.value() > 0 ? 1 : 0));
}
template <class Real>
[[nodiscard]] Traced<Real> fabs(const Traced<Real>& a) {
  return abs(a);
}
/// a to a constant power; of a whole power of 0 the slope is that of the product.
template <class Real, class Number>
  requires std::is_arithmetic_v<Number> || std::same_as<Number, Real>
[[nodiscard]] Traced<Real> pow(const Traced<Real>& a, Number power) {
  using std::pow;
  const Real b = static_cast<Real>(power);
  return Traced<Real>::of(a, Real(pow(a.value(), b)), b == Real(0) ? Real(0) : Real(b * pow(a.value(), b - 1)));
}
template <class Real>
[[nodiscard]] Traced<Real> pow(const Traced<Real>& a, const Traced<Real>& power) {
  using std::log, std::pow;
  if (power.is_constant()) return pow(a, power.value());
  const Real b = power.value(), value = pow(a.value(), b);
  const Real by_a = b == Real(0) ? Real(0) : Real(b * pow(a.value(), b - 1));
  return Traced<Real>::of(a, power, value, by_a, value == Real(0) ? Real(0) : Real(value * log(a.value())));
}
template <class Real, class Number>
  requires std::is_arithmetic_v<Number> || std::same_as<Number, Real>
[[nodiscard]] Traced<Real> pow(Number a, const Traced<Real>& power) {
  return pow(Traced<Real>(a), power);
}
template <class Real>
[[nodiscard]] bool isfinite(const Traced<Real>& a) {
  using std::isfinite;
  return isfinite(a.value());
}
template <class Real>
[[nodiscard]] bool isnan(const Traced<Real>& a) {
  using std::isnan;
  return isnan(a.value());
}
/// @}

}  // namespace continuo
