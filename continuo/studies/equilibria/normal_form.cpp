// continuo/studies/equilibria/normal_form.cpp
// Coefficients of the normal forms of folds and Hopf points, by directional derivatives.
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <continuo/numerics/dense_lu.hpp>
#include <continuo/numerics/eigenvalues.hpp>
#include <continuo/studies/equilibria/normal_form.hpp>

namespace continuo::studies {

namespace {

using Vector = std::vector<double>;
using Complex = std::complex<double>;
using ComplexVector = std::vector<Complex>;

// Where the error of a fourth-order difference, h^4, and that of rounding, eps / h or eps / h^2, are alike.
constexpr double first_increment = 1e-3, second_increment = 3e-3;
constexpr double rounding_of_differences = 1e-9;  // relative

/// How far one step along v goes, each component measured by its size, or by 1 where that is more.
double reach(const Vector& v, const Vector& x) {
  double size = 0;
  for (std::size_t i = 0; i < v.size(); ++i) size = std::max(size, std::abs(v[i]) / std::max(1.0, std::abs(x[i])));
  return size;
}
Vector real_of(const ComplexVector& v) {
  Vector result(v.size());
  std::ranges::transform(v, result.begin(), [](const Complex& value) { return value.real(); });
  return result;
}
Vector imaginary_of(const ComplexVector& v) {
  Vector result(v.size());
  std::ranges::transform(v, result.begin(), [](const Complex& value) { return value.imag(); });
  return result;
}
/// sum_i conj(a_i) b_i
Complex inner(const ComplexVector& a, const ComplexVector& b) {
  Complex sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += std::conj(a[i]) * b[i];
  return sum;
}

double size_of_inner(const ComplexVector& a, const ComplexVector& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += std::abs(a[i]) * std::abs(b[i]);
  return sum;
}

/// (factor - sign A) y = b, row by row; empty where it is singular.
ComplexVector solved(const Vector& a, const Complex& factor, double sign, const ComplexVector& b) {
  const std::size_t n = b.size();
  DenseLU<ComplexNumber<double>, run_time_size> lu(n);
  auto&& matrix = lu.matrix();
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = 0; j < n; ++j) {
      const Complex entry = (i == j ? factor : Complex(0)) - sign * a[i * n + j];
      matrix[i * n + j] = {entry.real(), entry.imag()};
    }
  std::vector<ComplexNumber<double>> y(n);
  for (std::size_t i = 0; i < n; ++i) y[i] = {b[i].real(), b[i].imag()};
  if (!lu.factor()) return {};
  lu.solve(y.data());
  ComplexVector result(n);
  for (std::size_t i = 0; i < n; ++i) result[i] = {y[i].re, y[i].im};
  return result;
}

/// q of A q = value q, the value nearest to `wanted`, and p of A^T p = conj(value) p with conj(p) . q = 1. Empty where
/// there is no such pair.
struct Eigenpair {
  ComplexVector q, p;
};
std::optional<Eigenpair> eigenpair_of(const Vector& a, std::size_t n, const Complex& wanted) {
  Vector transposed(n * n);
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = 0; j < n; ++j) transposed[i * n + j] = a[j * n + i];
  const auto nearest = [&](const Vector& rows, const Complex& value) -> ComplexVector {
    const auto found = eigenvalues(rows, n);
    if (!found.found) return {};
    const auto best =
        std::ranges::min_element(found.values, {}, [&](const Complex& other) { return std::abs(other - value); });
    return found.vectors[static_cast<std::size_t>(best - found.values.begin())];
  };
  Eigenpair pair{nearest(a, wanted), nearest(transposed, std::conj(wanted))};
  if (pair.q.empty() || pair.p.empty()) return std::nullopt;
  const Complex product = inner(pair.p, pair.q);
  if (!(std::abs(product) > 1e-12)) return std::nullopt;
  for (Complex& part : pair.p) part /= std::conj(product);
  return pair;
}

/// B(u, v) of complex directions, by those of their parts.
ComplexVector second(const DirectionalDerivatives& f, const ComplexVector& u, const ComplexVector& v) {
  const Vector a = real_of(u), b = imaginary_of(u), c = real_of(v), d = imaginary_of(v);
  const Vector ac = f.second(a, c), bd = f.second(b, d), ad = f.second(a, d), bc = f.second(b, c);
  ComplexVector result(u.size());
  for (std::size_t i = 0; i < u.size(); ++i) result[i] = {ac[i] - bd[i], ad[i] + bc[i]};
  return result;
}
/// C(q, q, q*) = C(a, a, a) + C(a, b, b) + i (C(b, a, a) + C(b, b, b)).
ComplexVector third(const DirectionalDerivatives& f, const ComplexVector& q) {
  const Vector a = real_of(q), b = imaginary_of(q);
  const Vector aaa = f.third(a, a), abb = f.third(a, b), baa = f.third(b, a), bbb = f.third(b, b);
  ComplexVector result(q.size());
  for (std::size_t i = 0; i < q.size(); ++i) result[i] = {aaa[i] + abb[i], baa[i] + bbb[i]};
  return result;
}

}  // namespace

DirectionalDerivatives::DirectionalDerivatives(const ParametricSystem& system, Vector x, Vector p, double t)
    : system_(system), x_(std::move(x)), p_(std::move(p)), t_(t) {}

Vector DirectionalDerivatives::along(const Vector& u, const Vector& v, double s) const {
  const std::size_t n = x_.size();
  Vector moved(x_), result(n);
  for (std::size_t i = 0; i < n; ++i) moved[i] += s * v[i];
  const Vector rows = jacobian_of(system_, t_, moved, p_);
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = 0; j < n; ++j) result[i] += rows[i * n + j] * u[j];
  return result;
}

Vector DirectionalDerivatives::second(const Vector& u, const Vector& v) const {
  const double size = reach(v, x_);
  Vector result(x_.size());
  if (size == 0) return result;
  const double h = first_increment / size;
  const Vector a = along(u, v, -2 * h), b = along(u, v, -h), c = along(u, v, h), d = along(u, v, 2 * h);
  for (std::size_t i = 0; i < result.size(); ++i) result[i] = (a[i] - 8 * b[i] + 8 * c[i] - d[i]) / (12 * h);
  return result;
}

Vector DirectionalDerivatives::third(const Vector& u, const Vector& v) const {
  const double size = reach(v, x_);
  Vector result(x_.size());
  if (size == 0) return result;
  const double h = second_increment / size;
  const Vector a = along(u, v, -2 * h), b = along(u, v, -h), o = along(u, v, 0), c = along(u, v, h),
               d = along(u, v, 2 * h);
  for (std::size_t i = 0; i < result.size(); ++i)
    result[i] = (-a[i] + 16 * b[i] - 30 * o[i] + 16 * c[i] - d[i]) / (12 * h * h);
  return result;
}

std::optional<LyapunovCoefficient> first_lyapunov_coefficient(const ParametricSystem& system, const Vector& x,
                                                              std::span<const double> p, double angular_frequency,
                                                              double t) {
  if (system.algebraic > 0) return std::nullopt;
  const std::size_t n = system.size;
  const Vector a = jacobian_of(system, t, x, p);
  const auto pair = eigenpair_of(a, n, {0, angular_frequency});
  if (!pair) return std::nullopt;
  const DirectionalDerivatives f(system, x, Vector(p.begin(), p.end()), t);
  ComplexVector conjugate(pair->q);
  for (Complex& part : conjugate) part = std::conj(part);
  const ComplexVector mean = solved(a, 0, -1, second(f, pair->q, conjugate));
  const ComplexVector twice = solved(a, {0, 2 * angular_frequency}, 1, second(f, pair->q, pair->q));
  if (mean.empty() || twice.empty()) return std::nullopt;
  const ComplexVector cubic = third(f, pair->q), with_mean = second(f, pair->q, mean),
                      with_twice = second(f, conjugate, twice);
  const Complex sum = inner(pair->p, cubic) - 2.0 * inner(pair->p, with_mean) + inner(pair->p, with_twice);
  const double size =
      size_of_inner(pair->p, cubic) + 2 * size_of_inner(pair->p, with_mean) + size_of_inner(pair->p, with_twice);
  const double slope = std::abs(*std::ranges::max_element(a, {}, [](double entry) { return std::abs(entry); }));
  const LyapunovCoefficient coefficient{
      .value = sum.real() / (2 * angular_frequency),
      .rounding = (rounding_of_differences * size +
                   std::numeric_limits<double>::epsilon() * slope / (second_increment * second_increment)) /
                  (2 * angular_frequency)};
  return std::isfinite(coefficient.value) ? std::optional(coefficient) : std::nullopt;
}

std::optional<double> fold_coefficient(const ParametricSystem& system, const Vector& x, std::span<const double> p,
                                       double t) {
  if (system.algebraic > 0) return std::nullopt;
  const auto pair = eigenpair_of(jacobian_of(system, t, x, p), system.size, 0);
  if (!pair) return std::nullopt;
  const DirectionalDerivatives f(system, x, Vector(p.begin(), p.end()), t);
  // The eigenvectors are real, each up to a factor on the unit circle, which p . q = 1 leaves out.
  const auto as_real = [](const ComplexVector& v) {
    const auto greatest = std::ranges::max_element(v, {}, [](const Complex& part) { return std::abs(part); });
    const Complex turn = *greatest / std::abs(*greatest);
    ComplexVector result(v);
    for (Complex& part : result) part /= turn;
    return real_of(result);
  };
  const Vector q = as_real(pair->q);
  Vector left = as_real(pair->p);
  double product = 0, length = 0;
  for (std::size_t i = 0; i < q.size(); ++i) product += left[i] * q[i], length += q[i] * q[i];
  const Vector bent = f.second(q, q);
  double sum = 0;
  for (std::size_t i = 0; i < q.size(); ++i) sum += left[i] * bent[i];
  const double coefficient = sum / (2 * product * std::sqrt(length));
  return std::isfinite(coefficient) ? std::optional(coefficient) : std::nullopt;
}

}  // namespace continuo::studies
