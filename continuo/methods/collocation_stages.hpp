// The stages of a collocation method: their first guess, the matrices and one correction of Newton's iteration.
#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include <continuo/methods/collocation_table.hpp>
#include <continuo/methods/collocation_workspace.hpp>
#include <continuo/numerics/complex_number.hpp>
#include <continuo/system/system.hpp>

namespace continuo::collocation {

/// gamma / h M - J for all eigenvalues. False where one is singular: work.status says so.
template <Nodes nodes, std::size_t s, State X, std::size_t most>
bool decompose(const Scalar<X>& h, Workspace<X, most>& work) {
  using Real = Scalar<X>;
  const auto& numbers = table<Real, nodes, s>();
  if (work.decomposed_for == h && work.decomposed_stages == s) return true;
  constexpr std::size_t reals = s % 2, pairs = s / 2;
  bool done = true;
  if constexpr (reals == 1) done = work.lu.factor(work.linear, numbers.eigenvalue[0] / h);
  for (std::size_t p = 0; p < pairs && done; ++p) {
    const std::size_t m = reals + 2 * p;
    done = work.pair_lu[p].factor(work.linear,
                                  ComplexNumber<Real>(numbers.eigenvalue[m] / h, numbers.eigenvalue[m + 1] / h));
  }
  work.costs.decompositions += reals + pairs;
  work.decomposed_for = done ? h : Real(0);
  work.decomposed_stages = s;
  if (!done) work.status = work.linear.is_finite() ? StepStatus::singular_matrix : StepStatus::not_finite;
  return done;
}

/// Z and W from the polynomial of the last step, beyond its end.
template <Nodes nodes, std::size_t s, State X, std::size_t most>
void guess(const Scalar<X>& h, Workspace<X, most>& work) {
  using Real = Scalar<X>;
  const auto& numbers = table<Real, nodes, s>();
  const std::size_t degree = work.ahead_degree;
  const Real ratio = degree == 0 ? Real(0) : h / work.ahead_h;
  for (std::size_t i = 0; i < dimension(work.f); ++i) {
    std::array<Real, s> z{};
    for (std::size_t j = 0; j < s; ++j) {
      const Real sigma = ratio * numbers.c[j];
      for (std::size_t k = degree; k-- > 0;) z[j] = (z[j] + work.ahead[k].data()[i]) * sigma;
      work.Z[j].data()[i] = z[j];
    }
    for (std::size_t m = 0; m < s; ++m) {
      Real sum(0);
      for (std::size_t j = 0; j < s; ++j) sum += numbers.forward[m][j] * z[j];
      work.W[m].data()[i] = sum;
    }
    work.guess.data()[i] = z[s - 1];
  }
}

/// Without a last step: the powers of q fall off like a geometric series, and K is the first one that q has not.
template <Nodes nodes, std::size_t s, State X, std::size_t most>
void estimate_dense_of_first(Workspace<X, most>& work) {
  using Real = Scalar<X>;
  using std::abs, std::max;
  const auto& numbers = table<Real, nodes, s>();
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
  const auto& numbers = table<Real, nodes, s>();
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
  const auto& numbers = table<Scalar<X>, nodes, s>();
  for (std::size_t j = 0; j < s; ++j) {
    for (std::size_t i = 0; i < dimension(x); ++i) work.point.data()[i] = x.data()[i] + work.Z[j].data()[i];
    evaluate(system, Scalar<X>(t + numbers.c[j] * h), work.point, work.F[j]);
  }
}

/// One correction of Z and W from the slopes F; its norm over all stages.
template <Nodes nodes, std::size_t s, State X, std::size_t most>
Scalar<X> correct(const Scalar<X>& h, Workspace<X, most>& work) {
  using Real = Scalar<X>;
  using std::sqrt;
  const auto& numbers = table<Real, nodes, s>();
  constexpr std::size_t reals = s % 2, pairs = s / 2;
  const std::size_t n = dimension(work.f);
  const Real one_over_h = Real(1) / h;
  if (work.linear.has_mass())
    for (std::size_t m = 0; m < s; ++m) work.linear.multiply_mass(work.W[m], work.MW[m]);
  const auto& MW = work.linear.has_mass() ? work.MW : work.W;
  for (std::size_t i = 0; i < n; ++i) {
    std::array<Real, s> right{};
    for (std::size_t m = 0; m < s; ++m)
      for (std::size_t j = 0; j < s; ++j) right[m] += numbers.forward[m][j] * work.F[j].data()[i];
    if constexpr (reals == 1) work.right.data()[i] = right[0] - numbers.eigenvalue[0] * one_over_h * MW[0].data()[i];
    for (std::size_t p = 0; p < pairs; ++p) {
      const std::size_t m = reals + 2 * p;
      const Real re = numbers.eigenvalue[m] * one_over_h, im = numbers.eigenvalue[m + 1] * one_over_h;
      work.pair_right[p][i] = {right[m] - re * MW[m].data()[i] + im * MW[m + 1].data()[i],
                               right[m + 1] - re * MW[m + 1].data()[i] - im * MW[m].data()[i]};
    }
  }
  if constexpr (reals == 1) work.lu.solve(work.right.data());
  for (std::size_t p = 0; p < pairs; ++p) work.pair_lu[p].solve(work.pair_right[p].data());
  work.costs.solutions += reals + pairs;
  Real sum(0);
  for (std::size_t i = 0; i < n; ++i) {
    std::array<Real, s> change{};
    if constexpr (reals == 1) change[0] = work.right.data()[i];
    for (std::size_t p = 0; p < pairs; ++p) {
      change[reals + 2 * p] = work.pair_right[p][i].re;
      change[reals + 2 * p + 1] = work.pair_right[p][i].im;
    }
    for (std::size_t j = 0; j < s; ++j) {
      work.W[j].data()[i] += change[j];
      Real moved(0);
      for (std::size_t m = 0; m < s; ++m) moved += numbers.back[j][m] * change[m];
      work.Z[j].data()[i] += moved;
      const Real part = moved * work.weight.data()[i];
      sum += part * part;
    }
  }
  return n == 0 ? Real(0) : Real(sqrt(sum / Real(static_cast<double>(n * s))));
}

}  // namespace continuo::collocation
