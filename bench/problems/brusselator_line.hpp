// bench/problems/brusselator_line.hpp
#pragma once
#include <array>
#include <cmath>
#include <cstddef>
#include <span>
#include <string_view>
#include <vector>

#include <bench/problems/problem.hpp>

#include <continuo/numerics/state.hpp>

namespace continuo::bench {

/// The Brusselator with diffusion along a line: u' = 1 + u^2 v - 4 u + u_xx / 50, v' = 3 u - u^2 v + v_xx / 50 on
/// 0 < x < 1 with u = 1, v = 3 at both ends, by central differences on `points` inner points. State u0, v0, u1, v1,
/// ...; the Jacobian has two bands on each side. E. Hairer, G. Wanner, "Solving Ordinary Differential Equations II",
/// IV.10, started from u = 1 + sin(2 pi x) / 2, v = 3 as in the authors' programs.
template <class Real = double>
struct BrusselatorLine {
  static constexpr std::string_view name = "brusselator_line",
                                    title = "Brusselator in one dimension, N = 500, to t = 10";
  static constexpr double duration = 10;
  static constexpr bool autonomous = true;
  static constexpr std::size_t bands = 2;
  using State = std::vector<Real>;

  std::size_t points = 500;

  /// 1 / (50 dx^2)
  Real diffusion = Real(static_cast<double>((points + 1) * (points + 1))) / Real(50);

  State start() const {
    using std::sin;
    State x(2 * points);
    const Real two_pi = in<Real>(6.28318530717958647692528676655900576839433879875_c);
    for (std::size_t i = 0; i < points; ++i) {
      const Real place = Real(static_cast<double>(i + 1)) / Real(static_cast<double>(points + 1));
      x[2 * i] = Real(1) + sin(Real(two_pi * place)) / Real(2);
      x[2 * i + 1] = Real(3);
    }
    return x;
  }

  template <class X>
  void operator()(const auto&, const X& x, X& dxdt) const {
    using S = Scalar<X>;
    S u_before(1), v_before(3);
    for (std::size_t i = 0; i < points; ++i) {
      const bool last = i + 1 == points;
      const S u = x[2 * i], v = x[2 * i + 1], meet = u * u * v;
      const S u_after = last ? S(1) : x[2 * i + 2], v_after = last ? S(3) : x[2 * i + 3];
      dxdt[2 * i] = Real(1) + meet - Real(4) * u + diffusion * (u_before - Real(2) * u + u_after);
      dxdt[2 * i + 1] = Real(3) * u - meet + diffusion * (v_before - Real(2) * v + v_after);
      u_before = u;
      v_before = v;
    }
  }

  /// Calls visit(row, column, value) for every entry that is not always zero, row by row, columns ascending.
  template <class X, class Visit>
  void jacobian_entries(const X& x, Visit&& visit) const {
    using S = Scalar<X>;
    const S spread(diffusion);
    for (std::size_t i = 0; i < points; ++i) {
      const std::size_t row = 2 * i;
      const S by_u = Real(2) * x[row] * x[row + 1], by_v = x[row] * x[row];
      for (std::size_t k = 0; k < 2; ++k) {
        if (i > 0) visit(row + k, row + k - 2, spread);
        visit(row + k, row, k == 0 ? S(by_u - Real(4) - Real(2) * diffusion) : S(Real(3) - by_u));
        visit(row + k, row + 1, k == 0 ? by_v : S(-by_v - Real(2) * diffusion));
        if (i + 1 < points) visit(row + k, row + k + 2, spread);
      }
    }
  }

  template <class X>
  void jacobian(const auto&, const X& x, std::span<Scalar<X>> rows) const {
    for (Scalar<X>& entry : rows) entry = Scalar<X>(0);
    jacobian_entries(x, [&](std::size_t row, std::size_t column, const Scalar<X>& value) {
      rows[row * 2 * points + column] = value;
    });
  }
};

}  // namespace continuo::bench
