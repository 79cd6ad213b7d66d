// The numbers of collocation methods, derived from nothing but the definition of their nodes, to the 46 digits of
// Coefficient. E. Hairer, G. Wanner, "Solving Ordinary Differential Equations II", IV.5 and IV.8.
//
// Let N be the monic polynomial of degree s whose zeros are the nodes c_i, and l_i the Lagrange polynomials on them.
// (A v)_i is the integral over 0..c_i of the polynomial p with p(c_j) = v_j. So A v = v / gamma means, for P = that
// integral: P = P' / gamma + const N with P(0) = 0, solved by P = sum_k gamma^-k N^(k), whence
//
//   gamma is an eigenvalue of A^-1:  sum_k gamma^(s-k) N^(k)(0) = 0
//   its vector:                      v_i = sum_(k>0) gamma^(s-k) N^(k)(c_i)
//   its vector on the left:          the functional L(p) = u . p(c) has L(x^(k+1)) = (k + 1) / gamma L(x^k), so
//                                    L(x^k) = k! / gamma^k and u_i = L(l_i).
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>

#include <continuo/numerics/coefficient.hpp>
#include <continuo/numerics/complex_number.hpp>

namespace continuo::collocation {

/// The zeros of d^m/dx^m x^m (x - 1)^s: m = s for Gauss, m = s - 1 for Radau IIA, whose last node is 1.
enum class Nodes { gauss, radau };

using Complex = ComplexNumber<Coefficient>;
template <std::size_t s>
using Row = std::array<Coefficient, s>;
template <std::size_t s>
using Matrix = std::array<Row<s>, s>;

/// p(x) and p'(x) of the polynomial with these powers.
template <class Number, class Powers>
[[nodiscard]] constexpr std::array<Number, 2> value_and_slope(const Powers& powers, const Number& x) {
  Number value(powers.back()), slope{};
  for (std::size_t k = powers.size() - 1; k-- > 0;) {
    slope = slope * x + value;
    value = value * x + Number(powers[k]);
  }
  return {value, slope};
}

template <class Real>
[[nodiscard]] constexpr ComplexNumber<Real> inverse(const ComplexNumber<Real>& z) {
  const Real square = z.re * z.re + z.im * z.im;
  return {z.re / square, -z.im / square};
}

/// N by its powers.
template <Nodes nodes, std::size_t s>
[[nodiscard]] constexpr std::array<Coefficient, s + 1> node_polynomial() {
  constexpr std::size_t m = nodes == Nodes::gauss ? s : s - 1;
  std::array<std::int64_t, s + 1> whole{};
  std::int64_t binomial = s % 2 == 0 ? 1 : -1;  // of (x - 1)^s
  for (std::size_t k = 0; k <= s; ++k) {
    whole[k] = binomial;
    for (std::size_t i = k + 1; i <= k + m; ++i) whole[k] *= static_cast<std::int64_t>(i);
    binomial = -binomial * static_cast<std::int64_t>(s - k) / static_cast<std::int64_t>(k + 1);
  }
  std::array<Coefficient, s + 1> powers{};
  for (std::size_t k = 0; k <= s; ++k) powers[k] = Coefficient(whole[k]) / Coefficient(whole[s]);
  return powers;
}

/// The zeros of N, ascending. Newton's iteration from the left of all of them goes monotonically to the least that is
/// not divided out yet (H. J. Maehly, ZAMP 5 (1954)); in double first, then to all digits.
template <Nodes nodes, std::size_t s>
[[nodiscard]] constexpr Row<s> find_nodes() {
  constexpr auto powers = node_polynomial<nodes, s>();
  std::array<double, s + 1> rounded{};
  for (std::size_t k = 0; k <= s; ++k) rounded[k] = powers[k].template as<double>();
  std::array<double, s> near{};
  Row<s> found{};
  for (std::size_t i = 0; i < s; ++i) {
    double x = 0;
    for (int iteration = 0; iteration < 40; ++iteration) {
      const auto [value, slope] = value_and_slope(rounded, x);
      double known = 0;
      for (std::size_t j = 0; j < i; ++j) known += value / (x - near[j]);
      x -= value / (slope - known);
    }
    near[i] = x;
    Coefficient exact = Coefficient(static_cast<std::int64_t>(x * 1e15)) / 1000000000000000;
    for (int iteration = 0; iteration < 3; ++iteration) {
      const auto [value, slope] = value_and_slope(powers, exact);
      exact = exact - value / slope;
    }
    found[i] = exact;
  }
  if (nodes == Nodes::radau) found[s - 1] = 1;
  return found;
}

/// N^(k)(c_i) for k = 0..s, in row i.
template <std::size_t s>
[[nodiscard]] constexpr std::array<std::array<Coefficient, s + 1>, s> find_derivatives(
    const std::array<Coefficient, s + 1>& powers, const Row<s>& c) {
  std::array<std::array<Coefficient, s + 1>, s> derivatives{};
  for (std::size_t i = 0; i < s; ++i) {
    std::array<Coefficient, s + 1> row = powers;  // to be the powers of x - c_i
    for (std::size_t k = 0; k < s; ++k)
      for (std::size_t j = s; j-- > k;) row[j] = row[j] + c[i] * row[j + 1];
    Coefficient factorial = 1;
    for (std::size_t k = 1; k <= s; ++k) {
      factorial = factorial * k;
      row[k] = row[k] * factorial;
    }
    row[0] = 0;
    derivatives[i] = row;
  }
  return derivatives;
}

/// The powers of l_i, in row i.
template <std::size_t s>
[[nodiscard]] constexpr Matrix<s> find_lagrange(const std::array<Coefficient, s + 1>& powers, const Row<s>& c) {
  Matrix<s> lagrange{};
  for (std::size_t i = 0; i < s; ++i) {
    lagrange[i][s - 1] = powers[s];
    for (std::size_t k = s - 1; k-- > 0;) lagrange[i][k] = powers[k + 1] + c[i] * lagrange[i][k + 1];
    const Coefficient scale = 1 / value_and_slope(lagrange[i], c[i])[0];
    for (Coefficient& power : lagrange[i]) power = power * scale;
  }
  return lagrange;
}

/// The eigenvalues of A^-1 in the closed upper half plane, by their imaginary parts: s + 1 over 2 of them. All zeros at
/// once in double (E. Durand (1960), I. Kerner, Numer. Math. 8 (1966)), then each to all digits.
template <std::size_t s>
constexpr std::array<Complex, (s + 1) / 2> find_eigenvalues(const std::array<Coefficient, s + 1>& powers) {
  std::array<Coefficient, s + 1> characteristic{};
  Coefficient factorial = 1;
  for (std::size_t k = 0; k <= s; ++k) {
    characteristic[s - k] = factorial * powers[k] / powers[0];
    factorial = factorial * (k + 1);
  }
  using Near = ComplexNumber<double>;
  std::array<double, s + 1> rounded{};
  for (std::size_t k = 0; k <= s; ++k) rounded[k] = characteristic[k].template as<double>();
  std::array<Near, s> near{};
  Near start(static_cast<double>(2 * s));
  for (Near& zero : near) zero = start = start * Near(0.4, 0.9);
  for (int iteration = 0; iteration < 60; ++iteration) {
    for (std::size_t i = 0; i < s; ++i) {
      Near others(1);
      for (std::size_t j = 0; j < s; ++j)
        if (j != i) others = others * (near[i] - near[j]);
      near[i] -= value_and_slope(rounded, near[i])[0] * inverse(others);
    }
  }
  std::array<Complex, (s + 1) / 2> found{};
  double below = -1e-6;
  for (Complex& zero : found) {
    Near next(0, 1e300);
    for (const Near& candidate : near)
      if (candidate.im > below && candidate.im < next.im) next = candidate;
    below = next.im + 1e-6;
    const auto lift = [](double x) { return Coefficient(static_cast<std::int64_t>(x * 1e15)) / 1000000000000000; };
    zero = {lift(next.re), next.im < 1e-6 ? Coefficient(0) : lift(next.im)};
    for (int iteration = 0; iteration < 4; ++iteration) {
      const auto [value, slope] = value_and_slope(characteristic, zero);
      zero -= value * inverse(slope);
    }
  }
  return found;
}

/// The vectors to one eigenvalue: A^-1 right = value right, left A^-1 = value left, left . right = 1, right_s = 1.
template <std::size_t s>
struct Eigenvectors {
  std::array<Complex, s> right, left;
};

template <std::size_t s>
[[nodiscard]] constexpr Eigenvectors<s> find_vectors(const Complex& value, const Matrix<s>& lagrange,
                                                     const std::array<std::array<Coefficient, s + 1>, s>& derivatives) {
  Eigenvectors<s> vectors{};
  const Complex one_over_value = inverse(value);
  for (std::size_t i = 0; i < s; ++i) {
    Complex right(derivatives[i][1]), left{};
    for (std::size_t k = 2; k <= s; ++k) right = right * value + Complex(derivatives[i][k]);
    for (std::size_t k = s; k-- > 0;) left = Complex(lagrange[i][k]) + left * one_over_value * Complex(k + 1);
    vectors.right[i] = right;
    vectors.left[i] = left;
  }
  const Complex scale = inverse(vectors.right[s - 1]);
  Complex product{};
  for (std::size_t i = 0; i < s; ++i) {
    vectors.right[i] *= scale;
    product += vectors.left[i] * vectors.right[i];
  }
  const Complex scale_left = inverse(product);
  for (std::size_t i = 0; i < s; ++i) vectors.left[i] *= scale_left;
  return vectors;
}

// One constant for each part of the work: compilers bound what one of them may take.
template <Nodes nodes, std::size_t s>
inline constexpr auto polynomial = node_polynomial<nodes, s>();
template <Nodes nodes, std::size_t s>
inline constexpr Row<s> c = find_nodes<nodes, s>();
template <Nodes nodes, std::size_t s>
inline constexpr Matrix<s> lagrange = find_lagrange(polynomial<nodes, s>, c<nodes, s>);
template <Nodes nodes, std::size_t s>
inline constexpr auto derivatives = find_derivatives<s>(polynomial<nodes, s>, c<nodes, s>);
template <Nodes nodes, std::size_t s>
inline constexpr auto eigenvalues = find_eigenvalues<s>(polynomial<nodes, s>);
template <Nodes nodes, std::size_t s, std::size_t k>
inline constexpr Eigenvectors<s> eigenvectors =
    find_vectors<s>(eigenvalues<nodes, s>[k], lagrange<nodes, s>, derivatives<nodes, s>);

/// The tableau.
template <Nodes nodes, std::size_t s>
[[nodiscard]] constexpr Matrix<s> find_a() {
  Matrix<s> a{};
  for (std::size_t i = 0; i < s; ++i)
    for (std::size_t j = 0; j < s; ++j) {
      Coefficient sum = 0;
      for (std::size_t k = s; k-- > 0;) sum = (sum + lagrange<nodes, s>[j][k] / (k + 1)) * c<nodes, s>[i];
      a[i][j] = sum;
    }
  return a;
}
template <Nodes nodes, std::size_t s>
[[nodiscard]] constexpr Row<s> find_b() {
  Row<s> b{};
  for (std::size_t j = 0; j < s; ++j)
    for (std::size_t k = 0; k < s; ++k) b[j] = b[j] + lagrange<nodes, s>[j][k] / (k + 1);
  return b;
}

}  // namespace continuo::collocation
