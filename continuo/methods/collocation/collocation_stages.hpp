// The stages of a collocation method: their first guess, the matrices and one correction of Newton's iteration.
#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include <continuo/methods/collocation/collocation_sums.hpp>
#include <continuo/methods/collocation/collocation_table.hpp>
#include <continuo/methods/collocation/collocation_workspace.hpp>
#include <continuo/numerics/complex_number.hpp>
#include <continuo/system/system.hpp>

namespace continuo::collocation {

/// gamma / h M - J for all eigenvalues. False where one is singular: work.status says so.
template <Nodes nodes, std::size_t s, State X, std::size_t most>
[[nodiscard]] bool decompose(const Scalar<X>& h, Workspace<X, most>& work) {
  using Real = Scalar<X>;
  const auto& numbers = table_for<X, nodes, s>();
  if (work.decomposed_for == h && work.decomposed_stages == s) return true;
  constexpr std::size_t reals = s % 2, pairs = s / 2;
  bool done = true;
  if constexpr (reals == 1) done = work.lu.factor(work.linear, numbers.eigenvalue[0] / h);
  for (std::size_t p = 0; p < pairs && done; ++p) {
    const std::size_t m = reals + 2 * p;
    done = work.pair_lu[p].factor(work.linear,
                                  ComplexNumber<Real>(numbers.eigenvalue[m] / h, numbers.eigenvalue[m + 1] / h));
  }
  work.costs.factorizations += reals + pairs;
  work.decomposed_for = done ? h : Real(0);
  work.decomposed_stages = s;
  if (!done) work.status = work.linear.status_of_failure();
  return done;
}

/// Z and W from the polynomial of the last step, beyond its end; it has at most `degree` powers.
template <Nodes nodes, std::size_t s, std::size_t degree, State X, std::size_t most>
void extend(const Scalar<X>& h, Workspace<X, most>& work) {
  using Real = Scalar<X>;
  const auto& numbers = table_for<X, nodes, s>();
  std::array<std::array<Real, degree>, s> power{};  // of the places of the stages, seen from that end
  if (work.ahead_degree != 0) {
    const Real ratio = h / work.ahead_h;
    for (std::size_t j = 0; j < s; ++j) {
      const Real sigma = ratio * numbers.c[j];
      Real product = sigma;
      for (std::size_t k = 0; k < degree && k < work.ahead_degree; ++k, product *= sigma) power[j][k] = product;
    }
  }
  for_each_sums(power, work.ahead, [&](std::size_t i, const auto& z) __attribute__((always_inline)) {
    const std::array<Real, s> w = product(numbers.forward, z);
    detail::unrolled<0, s>([&](auto j) __attribute__((always_inline)) {
      work.Z[j].data()[i] = z[j];
      work.W[j].data()[i] = w[j];
    });
    work.guess.data()[i] = z[s - 1];
  });
}
template <Nodes nodes, std::size_t s, State X, std::size_t most>
void guess(const Scalar<X>& h, Workspace<X, most>& work) {
  if (work.ahead_degree <= s) return extend<nodes, s, s>(h, work);
  extend<nodes, s, most>(h, work);
}

/// Without a last step: the powers of q fall off like a geometric series, and K is the first one that q has not.
template <Nodes nodes, std::size_t s, State X, std::size_t most>
void estimate_dense_of_first(Workspace<X, most>& work) {
  using Real = Scalar<X>;
  using std::abs, std::max;
  const auto& numbers = table_for<X, nodes, s>();
  Real last_size(0), size_before(0);
  for (std::size_t i = 0; i < dimension(work.f); ++i) {
    Real last(0), before(0);
    for (std::size_t j = 0; j < s; ++j) {
      last += numbers.powers[s - 1][j] * work.Z[j].data()[i];
      before += numbers.powers[s - 2][j] * work.Z[j].data()[i];
    }
    last_size = max(last_size, Real(abs(last) * work.weight.data()[i]));
    size_before = max(size_before, Real(abs(before) * work.weight.data()[i]));
    work.dense_error.data()[i] = last * numbers.greatest_inside;
  }
  if (last_size < size_before)
    for (std::size_t i = 0; i < dimension(work.f); ++i) work.dense_error.data()[i] *= last_size / size_before;
}

/// x(t + theta h) = q(theta) + K theta N(theta), and beyond the end of the last step the same with its K: that was the
/// error of the guess. The estimate in estimate_radau is blind to it in stiff components, where x_new stays exact
/// while the polynomial between the nodes is not.
template <Nodes nodes, std::size_t s, State X, std::size_t most>
void estimate_dense(const Scalar<X>& h, Workspace<X, most>& work) {
  using Real = Scalar<X>;
  const auto& numbers = table_for<X, nodes, s>();
  if (work.ahead_degree == 0) return estimate_dense_of_first<nodes, s>(work);
  Real part(0);
  if (work.ahead_degree == s) {
    const Real ratio = h / work.ahead_h, theta = Real(1) + ratio;
    part = ratio * numbers.greatest_inside / theta;
    for (std::size_t j = 0; j < s; ++j) part *= ratio / (theta - numbers.c[j]);
  }
  for (std::size_t i = 0; i < dimension(work.f); ++i)
    work.dense_error.data()[i] = part * (work.Z[s - 1].data()[i] - work.guess.data()[i]);
}

template <Nodes nodes, std::size_t s, class System, State X, std::size_t most>
void stage_slopes(System& system, const Scalar<X>& t, const X& x, const Scalar<X>& h, Workspace<X, most>& work) {
  const auto& numbers = table_for<X, nodes, s>();
  for (std::size_t j = 0; j < s; ++j) {
    for (std::size_t i = 0; i < dimension(x); ++i) work.point.data()[i] = x.data()[i] + work.Z[j].data()[i];
    evaluate(system, Scalar<X>(t + numbers.c[j] * h), work.point, work.F[j]);
  }
}

/// The right-hand sides of the systems for a correction.
template <Nodes nodes, std::size_t s, State X, std::size_t most>
[[gnu::always_inline]] inline void set_right(const Scalar<X>& h, Workspace<X, most>& work) {
  using Real = Scalar<X>;
  const auto& numbers = table_for<X, nodes, s>();
  constexpr std::size_t reals = s % 2, pairs = s / 2;
  if (work.linear.has_mass())
    for (std::size_t m = 0; m < s; ++m) work.linear.multiply_mass(work.W[m], work.MW[m]);
  const auto& MW = work.linear.has_mass() ? work.MW : work.W;
  const Real one_over_h = Real(1) / h;
  std::array<Real, s> shift{};
  for (std::size_t m = 0; m < s; ++m) shift[m] = numbers.eigenvalue[m] * one_over_h;
  for_each_sums(numbers.forward, work.F, [&](std::size_t i, const auto& right) __attribute__((always_inline)) {
    if constexpr (reals == 1) work.right.data()[i] = right[0] - shift[0] * MW[0].data()[i];
    detail::unrolled<0, pairs>([&](auto p) __attribute__((always_inline)) {
      constexpr std::size_t m = reals + 2 * p;
      const Real re = MW[m].data()[i], im = MW[m + 1].data()[i];
      work.pair_right[p].data()[i] = {right[m] - shift[m] * re + shift[m + 1] * im,
                                      right[m + 1] - shift[m] * im - shift[m + 1] * re};
    });
  });
}

/// One correction of Z and W from the slopes F; its norm over all stages.
template <Nodes nodes, std::size_t s, State X, std::size_t most>
[[nodiscard]] [[gnu::always_inline]] inline Scalar<X> correct(const Scalar<X>& h, Workspace<X, most>& work) {
  using Real = Scalar<X>;
  using std::sqrt;
  const auto& numbers = table_for<X, nodes, s>();
  constexpr std::size_t reals = s % 2, pairs = s / 2;
  set_right<nodes, s>(h, work);
  if constexpr (reals == 1) work.lu.solve(work.linear, work.right.data());
  for (std::size_t p = 0; p < pairs; ++p) work.pair_lu[p].solve(work.linear, work.pair_right[p].data());
  work.costs.linear_solves += reals + pairs;
  const std::size_t n = dimension(work.f);
  for_each_component(work.f, [&](std::size_t i) __attribute__((always_inline)) {
    std::array<Real, s> change;
    if constexpr (reals == 1) change[0] = work.right.data()[i];
    detail::unrolled<0, pairs>([&](auto p) __attribute__((always_inline)) {
      constexpr std::size_t m = reals + 2 * p;
      change[m] = work.pair_right[p].data()[i].re;
      change[m + 1] = work.pair_right[p].data()[i].im;
    });
    const std::array<Real, s> moved = product(numbers.back, change);
    Real squares(0);
    detail::unrolled<0, s>([&](auto j) __attribute__((always_inline)) {
      work.W[j].data()[i] += change[j];
      work.Z[j].data()[i] += moved[j];
      const Real part = moved[j] * work.weight.data()[i];
      squares += part * part;
    });
    work.point.data()[i] = squares;
  });
  return n == 0 ? Real(0) : Real(sqrt(total(work.point) / Real(static_cast<double>(n * s))));
}

}  // namespace continuo::collocation
