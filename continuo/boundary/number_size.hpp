// What the solver of two-point problems needs of real and of complex numbers alike.
#pragma once
#include <cmath>

#include <continuo/numerics/complex_number.hpp>

namespace continuo::boundary {

/// |z|^2.
/// @{
[[nodiscard]] inline double squared_size(double x) {
  return x * x;
}
[[nodiscard]] inline double squared_size(const ComplexNumber<double>& z) {
  return z.re * z.re + z.im * z.im;
}
/// @}
/// |z|.
/// @{
[[nodiscard]] inline double size_of(double x) {
  return std::abs(x);
}
[[nodiscard]] inline double size_of(const ComplexNumber<double>& z) {
  return std::hypot(z.re, z.im);
}
/// @}
/// The complex conjugate.
/// @{
[[nodiscard]] inline double conjugate(double x) {
  return x;
}
[[nodiscard]] inline ComplexNumber<double> conjugate(const ComplexNumber<double>& z) {
  return {z.re, -z.im};
}
/// @}
/// Whether it is neither infinite nor not a number.
/// @{
[[nodiscard]] inline bool is_finite(double x) {
  return std::isfinite(x);
}
[[nodiscard]] inline bool is_finite(const ComplexNumber<double>& z) {
  return std::isfinite(z.re) && std::isfinite(z.im);
}
/// @}

}  // namespace continuo::boundary
