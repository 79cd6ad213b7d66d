// bench/reference/collocation.hpp
// Reference states of stiff problems x' = f(x) from a code that shares nothing with the library: collocation at the
// right Radau points of any number of stages, order 2 * stages - 1. O. Axelsson, "A class of A-stable methods", BIT 9
// (1969); E. Hairer, G. Wanner, "Solving Ordinary Differential Equations II", IV.5.
//
// The polynomial of a step goes through x at 0 and through the stages Y_i at c_i. Its derivatives there are D Y, with
// the differentiation matrix of the nodes 0, c_1, ..., c_s = 1, and have to be h f(Y_i); the last stage is the new x.
// Residuals are computed in Real; the corrections of Newton's method need not be exact and come from a factorization in
// long double.
#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

#include <bench/reference/band_matrix.hpp>

namespace continuo::bench {

/// 0 and the zeros of P_s - P_(s-1), shifted to 0..1 (ascending; the last is 1). P are the Legendre polynomials.
template <class Real>
std::vector<Real> radau_nodes(std::size_t stages) {
  const auto value = [&](const Real& x) {  // P_s - P_(s-1) over x - 1
    Real before(1), here = x;
    for (std::size_t k = 1; k < stages; ++k) {
      const Real next =
          (static_cast<Real>(2 * k + 1) * x * here - static_cast<Real>(k) * before) / static_cast<Real>(k + 1);
      before = here;
      here = next;
    }
    return Real((here - before) / (x - 1));
  };
  std::vector<Real> nodes{Real(0)};
  constexpr int grid = 4000, halvings = 130;
  for (int i = 0; i < grid; ++i) {
    Real left = Real(2 * i) / grid - 1, right = Real(2 * i + 2) / grid - 1;
    if (i + 1 == grid) right -= Real(1) / grid;
    const bool rises = value(left) < 0;
    if (rises == (value(right) < 0)) continue;
    for (int k = 0; k < halvings; ++k) {
      const Real middle = (left + right) / 2;
      ((value(middle) < 0) == rises ? left : right) = middle;
    }
    nodes.push_back((1 + left) / 2);
  }
  nodes.push_back(Real(1));
  return nodes;
}

template <class Problem, class Real>
class Collocation {
 public:
  using State = std::vector<Real>;

  /// Steps are chosen so that the last term of the polynomial stays below `tolerance`, relative to each component. The
  /// end of a step is about twice as many digits exact.
  Collocation(const Problem& problem, std::size_t stages, double tolerance)
      : problem_(problem), stages_(stages), tolerance_(tolerance), node_(radau_nodes<Real>(stages)) {
    const auto start = problem.start();
    x_.assign(start.begin(), start.end());
    largest_.resize(x_.size());
    for (std::size_t c = 0; c < x_.size(); ++c) largest_[c] = abs_of(x_[c]);
    stage_.assign(stages + 1, x_);
    matrix_ = BandMatrix<long double>(stages * x_.size(), (unknown_band() + 1) * stages - 1);
    if (unknown_band() < x_.size() - 1) matrix_ = BandMatrix<long double>(stages * x_.size(), unknown_band() * stages);
    differentiate();
  }

  const State& x() const { return x_; }
  std::size_t steps() const { return steps_; }

  /// Goes on to t = end exactly.
  void advance(const Real& end) {
    while (t_ < end) {
      const bool cut = t_ + h_ >= end;
      const Real h = cut ? Real(end - t_) : h_;
      auto predicted = predict(h);
      if (!newton(h, predicted)) {
        h_ = h / 4;
        continue;
      }
      const double error = last_term(predicted);
      const Real next =
          h *
          Real(std::clamp(0.8 * std::pow(error / tolerance_ + 1e-30, -1.0 / static_cast<double>(stages_)), 0.2, 3.0));
      if (error > tolerance_) {
        h_ = next;
        continue;
      }
      stage_ = std::move(predicted);
      x_ = stage_.back();
      for (std::size_t c = 0; c < x_.size(); ++c) largest_[c] = std::max<Real>(largest_[c], abs_of(x_[c]));
      t_ = cut ? end : Real(t_ + h);
      last_h_ = h;
      ++steps_;
      if (!cut || next > h_) h_ = next;  // a step that was cut says nothing against longer ones
    }
  }

 private:
  /// Below this share of its largest value so far a component need not be known relative to itself.
  static constexpr double negligible = 1e-10;
  static constexpr int most_iterations = 14;

  Problem problem_;
  std::size_t stages_;
  double tolerance_;
  std::vector<Real> node_, weight_, derivative_;
  Real t_{0}, h_{1e-6}, last_h_{1};
  std::size_t steps_ = 0;
  State x_, largest_;
  std::vector<State> stage_;  // of the last step, with its beginning
  BandMatrix<long double> matrix_{1, 0};

  static Real abs_of(const Real& value) { return value < 0 ? Real(-value) : value; }
  std::size_t unknown_band() const {
    if constexpr (requires { Problem::bands; }) {
      return Problem::bands;
    } else {
      return x_.size() - 1;
    }
  }
  /// Component by component, stage by stage: so the matrix of a banded problem is banded.
  std::size_t unknown(std::size_t stage, std::size_t component) const { return component * stages_ + stage - 1; }

  /// Barycentric weights and the differentiation matrix; the rows of the latter add up to zero.
  void differentiate() {
    const std::size_t count = stages_ + 1;
    weight_.assign(count, Real(1));
    for (std::size_t i = 0; i < count; ++i) {
      for (std::size_t j = 0; j < count; ++j) {
        if (i != j) weight_[i] /= node_[i] - node_[j];
      }
    }
    derivative_.assign(count * count, Real(0));
    for (std::size_t i = 0; i < count; ++i) {
      for (std::size_t j = 0; j < count; ++j) {
        if (i == j) continue;
        derivative_[i * count + j] = weight_[j] / weight_[i] / (node_[i] - node_[j]);
        derivative_[i * count + i] -= derivative_[i * count + j];
      }
    }
  }

  /// The stages of a step by h: the cubic through four points of the last step, carried on.
  std::vector<State> predict(const Real& h) const {
    const std::array<std::size_t, 4> through{0, stages_ / 3, 2 * stages_ / 3, stages_};
    std::vector<State> stages(stages_ + 1, x_);
    if (steps_ == 0) return stages;
    for (std::size_t i = 1; i <= stages_; ++i) {
      const Real at = 1 + node_[i] * h / last_h_;
      std::fill(stages[i].begin(), stages[i].end(), Real(0));
      for (const std::size_t j : through) {
        Real factor(1);
        for (const std::size_t k : through) {
          if (k != j) factor *= (at - node_[k]) / (node_[j] - node_[k]);
        }
        for (std::size_t c = 0; c < x_.size(); ++c) stages[i][c] += factor * stage_[j][c];
      }
    }
    return stages;
  }

  /// The size of the last term of the polynomial, relative to the component, where it is largest.
  double last_term(const std::vector<State>& stages) const {
    double worst = 0;
    for (std::size_t c = 0; c < x_.size(); ++c) {
      Real leading(0);
      for (std::size_t i = 0; i <= stages_; ++i) leading += weight_[i] * stages[i][c];
      // The polynomial with leading coefficient 1 that is least on 0..1 is 2 / 4^s.
      const double size =
          std::ldexp(static_cast<double>(Real(abs_of(leading) / scale(stages, c))), 1 - 2 * static_cast<int>(stages_));
      worst = std::max(worst, size);
    }
    return worst;
  }
  Real scale(const std::vector<State>& stages, std::size_t c) const {
    Real size = std::max<Real>(abs_of(x_[c]), largest_[c] * Real(negligible));
    for (std::size_t i = 1; i <= stages_; ++i) size = std::max<Real>(size, abs_of(stages[i][c]));
    return size;
  }

  /// Solves for the stages from what is in them. False where that fails.
  bool newton(const Real& h, std::vector<State>& stages) {
    std::vector<long double> residual(stages_ * x_.size());
    double before = 1e30, slowest_good = 0.5;
    for (int iteration = 0; iteration < most_iterations; ++iteration) {
      find_residual(h, stages, residual);
      find_matrix(static_cast<long double>(h), stages);
      matrix_.solve(residual);
      double change = 0;
      for (std::size_t c = 0; c < x_.size(); ++c) {
        Real largest(0);
        for (std::size_t i = 1; i <= stages_; ++i) {
          const Real correction(residual[unknown(i, c)]);
          stages[i][c] -= correction;
          largest = std::max<Real>(largest, abs_of(correction));
        }
        const Real size = scale(stages, c);
        if (size > 0) change = std::max(change, static_cast<double>(Real(largest / size)));
        if (!(largest < Real(1e30))) return false;
      }
      const double ratio = change / before;
      if (change < 1e-18 && (ratio > slowest_good || change * ratio < 1e-32)) return true;
      if (iteration > 6 && ratio > slowest_good) return false;
      before = change;
    }
    return false;
  }

  /// D Y - h f(Y).
  void find_residual(const Real& h, const std::vector<State>& stages, std::vector<long double>& residual) {
    State slope(x_.size());
    for (std::size_t i = 1; i <= stages_; ++i) {
      problem_(t_, stages[i], slope);
      for (std::size_t c = 0; c < x_.size(); ++c) {
        Real sum = -h * slope[c];
        for (std::size_t j = 0; j <= stages_; ++j) sum += derivative_[i * (stages_ + 1) + j] * (stages[j][c] - x_[c]);
        residual[unknown(i, c)] = static_cast<long double>(sum);
      }
    }
  }

  /// D - h df/dx(Y), factored.
  void find_matrix(long double h, const std::vector<State>& stages) {
    matrix_.clear();
    const std::size_t n = x_.size();
    for (std::size_t i = 1; i <= stages_; ++i) {
      for (std::size_t j = 1; j <= stages_; ++j) {
        const auto d = static_cast<long double>(derivative_[i * (stages_ + 1) + j]);
        for (std::size_t c = 0; c < n; ++c) matrix_(unknown(i, c), unknown(j, c)) = d;
      }
    }
    for (std::size_t i = 1; i <= stages_; ++i) {
      const auto enter = [&](std::size_t row, std::size_t column, const Real& value) {
        matrix_(unknown(i, row), unknown(i, column)) -= h * static_cast<long double>(value);
      };
      if constexpr (requires { Problem::bands; }) {
        problem_.jacobian_entries(stages[i], enter);
      } else {
        State rows(n * n);
        problem_.jacobian(t_, stages[i], std::span<Real>(rows));
        for (std::size_t k = 0; k < n * n; ++k) enter(k / n, k % n, rows[k]);
      }
    }
    matrix_.factor();
  }
};

}  // namespace continuo::bench
