// Numbers that write down how they were computed, as operations on Taylor series: one call of a right-hand side that
// takes any number type gives the program of which the coefficients of its solution are computed.
//
//   SeriesProgram<double> program;
//   const SeriesNumber<double> x(program, program.add_variable(), 2.0);   // its value is 2
//   const SeriesNumber<double> y = x * sin(x);                            // two operations
//
// Comparisons are those of the values: a branch is expanded as the one that was taken. Functions must be found by their
// argument: sin, not std::sin.
#pragma once
#include <cmath>
#include <compare>
#include <concepts>
#include <cstdint>
#include <type_traits>

#include <continuo/methods/taylor_series/series_program.hpp>

namespace continuo {

template <class Real>
class SeriesNumber {
 public:
  using Program = SeriesProgram<Real>;
  using Register = typename Program::Register;

  /// The constant 0.
  SeriesNumber() = default;
  /// A constant.
  template <class Number>
    requires std::is_arithmetic_v<Number> || std::same_as<Number, Real>
  explicit(false) SeriesNumber(Number value) : value_(static_cast<Real>(value)) {}
  /// The series in this register.
  SeriesNumber(Program& program, Register place, const Real& value)
      : value_(value), program_(&program), place_(place) {}

  /// The coefficient of order 0.
  [[nodiscard]] const Real& value() const { return value_; }
  /// Whether it depends on no variable.
  [[nodiscard]] bool is_constant() const { return program_ == nullptr; }
  /// Its register; a constant gets one.
  [[nodiscard]] Register place_in(Program& program) const {
    return is_constant() ? program.add_number(value_) : place_;
  }

  /// An operation on one number.
  [[nodiscard]] static SeriesNumber of(SeriesCode code, const SeriesNumber& a, const Real& value) {
    if (a.is_constant()) return SeriesNumber(value);
    return SeriesNumber(*a.program_, a.program_->add(code, a.place_), value);
  }
  /// An operation on two numbers, one of which may be a constant.
  [[nodiscard]] static SeriesNumber of(SeriesCode code, const SeriesNumber& a, const SeriesNumber& b,
                                       const Real& value) {
    if (a.is_constant() && b.is_constant()) return SeriesNumber(value);
    Program& program = a.is_constant() ? *b.program_ : *a.program_;
    const Register first = a.place_in(program), second = b.place_in(program);
    return SeriesNumber(program, program.add(code, first, second), value);
  }
  /// The second result of an operation on one number, such as a cosine.
  [[nodiscard]] static SeriesNumber second_of(SeriesCode code, const SeriesNumber& a, const Real& value) {
    if (a.is_constant()) return SeriesNumber(value);
    return SeriesNumber(*a.program_, a.program_->add(code, a.place_) + 1, value);
  }

  /// Arithmetic.
  /// @{
  friend SeriesNumber operator+(const SeriesNumber& a) { return a; }
  friend SeriesNumber operator-(const SeriesNumber& a) { return of(SeriesCode::negate, a, -a.value_); }
  friend SeriesNumber operator+(const SeriesNumber& a, const SeriesNumber& b) {
    const Real value = a.value_ + b.value_;
    if (a.is_constant()) return of(SeriesCode::add_number, b, a, value);
    return of(b.is_constant() ? SeriesCode::add_number : SeriesCode::add, a, b, value);
  }
  friend SeriesNumber operator-(const SeriesNumber& a, const SeriesNumber& b) {
    const Real value = a.value_ - b.value_;
    if (b.is_constant()) return of(SeriesCode::add_number, a, SeriesNumber(-b.value_), value);
    return of(a.is_constant() ? SeriesCode::subtract_from_number : SeriesCode::subtract, a, b, value);
  }
  friend SeriesNumber operator*(const SeriesNumber& a, const SeriesNumber& b) {
    const Real value = a.value_ * b.value_;
    if (a.is_constant()) return of(SeriesCode::scale, a, b, value);
    if (b.is_constant()) return of(SeriesCode::scale, b, a, value);
    if (a.place_ == b.place_) return of(SeriesCode::square, a, value);
    return of(SeriesCode::product, a, b, value);
  }
  friend SeriesNumber operator/(const SeriesNumber& a, const SeriesNumber& b) {
    return of(b.is_constant() ? SeriesCode::divide_by_number : SeriesCode::quotient, a, b, a.value_ / b.value_);
  }
  SeriesNumber& operator+=(const SeriesNumber& b) { return *this = *this + b; }
  SeriesNumber& operator-=(const SeriesNumber& b) { return *this = *this - b; }
  SeriesNumber& operator*=(const SeriesNumber& b) { return *this = *this * b; }
  SeriesNumber& operator/=(const SeriesNumber& b) { return *this = *this / b; }
  /// @}

  /// Comparisons of the values.
  /// @{
  friend bool operator==(const SeriesNumber& a, const SeriesNumber& b) { return a.value_ == b.value_; }
  friend auto operator<=>(const SeriesNumber& a, const SeriesNumber& b) { return a.value_ <=> b.value_; }
  /// @}

  /// Functions of two numbers.
  /// @{
  [[nodiscard]] friend SeriesNumber min(const SeriesNumber& a, const SeriesNumber& b) {
    return of(SeriesCode::minimum, a, b, b.value_ < a.value_ ? b.value_ : a.value_);
  }
  [[nodiscard]] friend SeriesNumber max(const SeriesNumber& a, const SeriesNumber& b) {
    return of(SeriesCode::maximum, a, b, a.value_ < b.value_ ? b.value_ : a.value_);
  }
  [[nodiscard]] friend SeriesNumber hypot(const SeriesNumber& a, const SeriesNumber& b) { return sqrt(a * a + b * b); }
  [[nodiscard]] friend SeriesNumber atan2(const SeriesNumber& y, const SeriesNumber& x) {
    using std::atan2;
    const SeriesNumber square = x * x + y * y;
    const Real value = atan2(y.value_, x.value_);
    if (square.is_constant()) return SeriesNumber(value);
    Program& program = *square.program_;
    const Register first = y.place_in(program), second = x.place_in(program);
    return SeriesNumber(program, program.add(SeriesCode::arc_tangent2, first, second, square.place_), value);
  }
  [[nodiscard]] friend SeriesNumber pow(const SeriesNumber& a, const SeriesNumber& b) {
    using std::pow;
    if (!b.is_constant()) return exp(b * log(a));
    // Small whole exponents are products, exact near zero, where the recurrence divides by a.
    if (b.value_ == Real(2)) return a * a;
    if (b.value_ == Real(3)) return a * (a * a);
    if (b.value_ == Real(4)) return (a * a) * (a * a);
    if (b.value_ == Real(-1)) return SeriesNumber(1) / a;
    if (b.value_ == Real(-2)) return SeriesNumber(1) / (a * a);
    return of(SeriesCode::power, a, b, pow(a.value_, b.value_));
  }
  /// @}

  /// Functions of one number.
  /// @{
  [[nodiscard]] friend SeriesNumber abs(const SeriesNumber& a) {
    return of(SeriesCode::absolute, a, a.value_ < Real(0) ? -a.value_ : a.value_);
  }
  [[nodiscard]] friend SeriesNumber sqrt(const SeriesNumber& a) {
    using std::sqrt;
    return of(SeriesCode::square_root, a, sqrt(a.value_));
  }
  [[nodiscard]] friend SeriesNumber exp(const SeriesNumber& a) {
    using std::exp;
    return of(SeriesCode::exponential, a, exp(a.value_));
  }
  [[nodiscard]] friend SeriesNumber log(const SeriesNumber& a) {
    using std::log;
    return of(SeriesCode::logarithm, a, log(a.value_));
  }
  [[nodiscard]] friend SeriesNumber sin(const SeriesNumber& a) {
    using std::sin;
    return of(SeriesCode::sine_cosine, a, sin(a.value_));
  }
  [[nodiscard]] friend SeriesNumber cos(const SeriesNumber& a) {
    using std::cos;
    return second_of(SeriesCode::sine_cosine, a, cos(a.value_));
  }
  [[nodiscard]] friend SeriesNumber tan(const SeriesNumber& a) {
    using std::tan;
    return of(SeriesCode::tangent, a, tan(a.value_));
  }
  [[nodiscard]] friend SeriesNumber sinh(const SeriesNumber& a) {
    using std::sinh;
    return of(SeriesCode::hyperbolic_sine_cosine, a, sinh(a.value_));
  }
  [[nodiscard]] friend SeriesNumber cosh(const SeriesNumber& a) {
    using std::cosh;
    return second_of(SeriesCode::hyperbolic_sine_cosine, a, cosh(a.value_));
  }
  [[nodiscard]] friend SeriesNumber tanh(const SeriesNumber& a) {
    using std::tanh;
    return of(SeriesCode::hyperbolic_tangent, a, tanh(a.value_));
  }
  [[nodiscard]] friend SeriesNumber atan(const SeriesNumber& a) {
    using std::atan;
    return of(SeriesCode::arc_tangent, a, 1 + a * a, atan(a.value_));
  }
  [[nodiscard]] friend SeriesNumber asin(const SeriesNumber& a) {
    using std::asin;
    return of(SeriesCode::arc_sine, a, sqrt((1 - a) * (1 + a)), asin(a.value_));
  }
  [[nodiscard]] friend SeriesNumber acos(const SeriesNumber& a) {
    using std::acos;
    return of(SeriesCode::arc_cosine, a, sqrt((1 - a) * (1 + a)), acos(a.value_));
  }
  /// @}

 private:
  Real value_{};
  Program* program_ = nullptr;
  Register place_ = 0;
};

}  // namespace continuo
