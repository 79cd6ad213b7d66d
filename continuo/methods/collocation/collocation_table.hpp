// The numbers of a collocation method in the scalar of the state, arranged for the stepper. The increments Z_i = X_i -
// x of the stages and their transforms W are related by Z = back W, W = forward Z, where the rows of `forward` are the
// vectors on the left of A^-1: of its real eigenvalue first (s odd), then the real and the imaginary part of each pair.
#pragma once
#include <array>
#include <concepts>
#include <cstddef>
#include <utility>

#include <continuo/methods/collocation/collocation_coefficients.hpp>
#include <continuo/methods/implicit/constant_mass.hpp>

namespace continuo::collocation {

template <class Real, Nodes nodes, std::size_t s>
struct Table {
  using Square = std::array<std::array<Real, s>, s>;

  std::array<Real, s> c{};
  std::array<Real, s> eigenvalue{};  // of A^-1: the real one, then real and imaginary parts
  Square forward{}, back{};
  /// The collocation polynomial: q(theta) = x + sum_k theta^(k+1) sum_i powers[k][i] Z_i, and about its end:
  /// q(1 + sigma) = q(1) + sum_k sigma^(k+1) sum_i ahead[k][i] Z_i.
  Square powers{}, ahead{};
  std::array<Real, s> end{};  // x_new = x + sum_i end[i] Z_i
  Real greatest_inside{};     // of |theta N(theta)| for theta in 0..1
};

template <class Real, Nodes nodes, std::size_t s>
[[nodiscard]] constexpr Table<Real, nodes, s> make_table() {
  Table<Real, nodes, s> table{};
  const auto real = [](const Coefficient& x) { return x.template as<Real>(); };
  for (std::size_t i = 0; i < s; ++i) {
    table.c[i] = real(c<nodes, s>[i]);
    const Coefficient scale = 1 / c<nodes, s>[i];
    Row<s + 1> power{};  // of l_i(theta) theta / c_i, then of the same in sigma
    for (std::size_t k = 0; k < s; ++k) power[k + 1] = lagrange<nodes, s>[i][k] * scale;
    for (std::size_t k = 0; k < s; ++k) table.powers[k][i] = real(power[k + 1]);
    for (std::size_t k = 0; k < s; ++k)
      for (std::size_t j = s; j-- > k;) power[j] += power[j + 1];
    for (std::size_t k = 0; k < s; ++k) table.ahead[k][i] = real(power[k + 1]);
    table.end[i] = nodes == Nodes::radau ? Real(i + 1 == s ? 1 : 0) : real(power[0]);
  }
  const auto set_vectors = [&]<std::size_t k>() {
    constexpr std::size_t reals = s % 2;
    const Complex value = eigenvalues<nodes, s>[k];
    const Eigenvectors<s>& vectors = eigenvectors<nodes, s, k>;
    const std::size_t m = k < reals ? 0 : reals + 2 * (k - reals);
    table.eigenvalue[m] = real(value.re);
    if (k >= reals) table.eigenvalue[m + 1] = real(value.im);
    for (std::size_t i = 0; i < s; ++i) {
      table.forward[m][i] = real(vectors.left[i].re);
      table.back[i][m] = real(k < reals ? vectors.right[i].re : 2 * vectors.right[i].re);
      if (k < reals) continue;
      table.forward[m + 1][i] = real(vectors.left[i].im);
      table.back[i][m + 1] = real(-2 * vectors.right[i].im);
    }
  };
  [&]<std::size_t... k>(std::index_sequence<k...>) {
    (set_vectors.template operator()<k>(), ...);
  }(std::make_index_sequence<(s + 1) / 2>{});
  // Where x(t + theta h) - q(theta) = K theta N(theta) with K of the order s + 1 in h; three digits will do.
  std::array<double, s + 1> powers{};
  for (std::size_t k = 0; k <= s; ++k) powers[k] = polynomial<nodes, s>[k].template as<double>();
  double greatest = 0;
  for (int i = 1; i < 200; ++i) {
    const double theta = i / 200.0, size = theta * value_and_slope(powers, theta)[0];
    greatest = size > greatest ? size : -size > greatest ? -size : greatest;
  }
  table.greatest_inside = Real(greatest);
  return table;
}

/// Made at compile time where the scalar is built in, else at the first use.
template <class Real, Nodes nodes, std::size_t s>
[[nodiscard]] const Table<Real, nodes, s>& table() {
  if constexpr (std::floating_point<Real>) {
    static constexpr auto numbers = make_table<Real, nodes, s>();
    return numbers;
  } else {
    static const auto numbers = make_table<Real, nodes, s>();
    return numbers;
  }
}

// Compilers take seconds to derive the numbers of the methods that have names: they are in collocation_table.cpp.
extern template const Table<float, Nodes::gauss, 2>& table();
extern template const Table<float, Nodes::radau, 3>& table();
extern template const Table<float, Nodes::radau, 5>& table();
extern template const Table<float, Nodes::radau, 7>& table();
extern template const Table<double, Nodes::gauss, 2>& table();
extern template const Table<double, Nodes::radau, 3>& table();
extern template const Table<double, Nodes::radau, 5>& table();
extern template const Table<double, Nodes::radau, 7>& table();
extern template const Table<long double, Nodes::gauss, 2>& table();
extern template const Table<long double, Nodes::radau, 3>& table();
extern template const Table<long double, Nodes::radau, 5>& table();
extern template const Table<long double, Nodes::radau, 7>& table();

/// For the steps of a state. Those of fixed size have the numbers in their code, which then has a tenth fewer
/// instructions (Radau on HIRES, Robertson, van der Pol).
template <State X, Nodes nodes, std::size_t s>
[[nodiscard]] const Table<Scalar<X>, nodes, s>& table_for() {
  if constexpr (std::floating_point<Scalar<X>> && fixed_size<X>() != run_time_size) {
    static constexpr auto numbers = make_table<Scalar<X>, nodes, s>();
    return numbers;
  } else {
    return table<Scalar<X>, nodes, s>();
  }
}

}  // namespace continuo::collocation
