// Random piecewise linear flows of two modes, and their closed orbits in closed form: exponentials of the matrices
// between events, saltation at them.
#pragma once
#include <Eigen/Core>
#include <Eigen/Eigenvalues>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <complex>
#include <cstdlib>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include <fmt/format.h>

namespace continuo::studies {

using Real = long double;
using RealMatrix = Eigen::Matrix<Real, Eigen::Dynamic, Eigen::Dynamic, 0, 4, 4>;  // without the heap
using RealVector = Eigen::Matrix<Real, Eigen::Dynamic, 1, 0, 4, 1>;

/// A larger number than in the suite, on request: CONTINUO_RANDOM_ORBITS=2000.
inline int members(int usual) {
  const char* asked = std::getenv("CONTINUO_RANDOM_ORBITS");
  return asked != nullptr ? std::max(usual, std::atoi(asked)) : usual;
}

inline std::vector<std::complex<double>> sorted_eigenvalues(const RealMatrix& m) {
  std::vector<std::complex<double>> values;
  const auto found = Eigen::EigenSolver<RealMatrix>(m, false).eigenvalues();
  for (Eigen::Index i = 0; i < found.size(); ++i)
    values.emplace_back(static_cast<double>(found[i].real()), static_cast<double>(found[i].imag()));
  return values;
}

/// The logarithm of the condition number of the eigenvectors.
inline double crookedness(const RealMatrix& m) {
  const Eigen::EigenSolver<RealMatrix> solver(m);
  const Eigen::JacobiSVD<Eigen::Matrix<std::complex<Real>, Eigen::Dynamic, Eigen::Dynamic, 0, 4, 4>> svd(
      solver.eigenvectors());
  return static_cast<double>(std::log(svd.singularValues()[0] / svd.singularValues()[m.rows() - 1]));
}

/// exp(h [[A, b], [0, 0]]) by its series, after halving: the flow of x' = A x + b over a time of h.
struct LinearFlow {
  RealMatrix a;
  RealVector b;

  RealVector rates(const RealVector& x) const { return a * x + b; }
  RealMatrix exponential(Real h) const {
    const Eigen::Index n = b.size();
    RealMatrix m = RealMatrix::Zero(n + 1, n + 1);
    m.topLeftCorner(n, n) = a * h;
    m.topRightCorner(n, 1) = b * h;
    int halvings = 0;
    while (m.norm() > 0.5L) m /= 2, ++halvings;
    RealMatrix sum = RealMatrix::Identity(n + 1, n + 1), term = sum;
    for (int k = 1; k < 30 && term.norm() > 1e-22L; ++k) {
      term = (term * m).eval() / static_cast<Real>(k);
      sum += term;
    }
    for (int k = 0; k < halvings; ++k) sum = (sum * sum).eval();
    return sum;
  }
};

/// Two modes: when c x rises through `level` in the first mode or falls through it in the second, x := R x + r and the
/// other mode begins.
struct RandomFlow {
  LinearFlow flow[2];
  RealVector c;
  double level[2] = {0, 0};
  RealMatrix jump[2];
  RealVector shift[2];

  RandomFlow(Eigen::Index n, bool jumps, std::mt19937_64& random) {
    std::uniform_real_distribution<double> entry(-1, 1);
    c = RealVector::Zero(n);
    c[0] = 1;
    for (Eigen::Index i = 1; i < n; ++i) c[i] = 0.5 * entry(random);
    level[0] = 0.3 + 0.2 * entry(random);
    level[1] = -0.3 + 0.2 * entry(random);
    for (int mode = 0; mode < 2; ++mode) {
      flow[mode].a.resize(n, n);
      flow[mode].b.resize(n);
      jump[mode] = RealMatrix::Identity(n, n);
      shift[mode] = RealVector::Zero(n);
      for (Eigen::Index i = 0; i < n; ++i) {
        flow[mode].b[i] = (mode == 0 ? 1 : -1) * (i == 0 ? 1.5 : 0.5) + 0.5 * entry(random);
        for (Eigen::Index k = 0; k < n; ++k) flow[mode].a(i, k) = 1.5 * entry(random) - (i == k ? 1.0 : 0.0);
        if (!jumps) continue;
        shift[mode][i] = 0.1 * entry(random);
        for (Eigen::Index k = 0; k < n; ++k) jump[mode](i, k) += 0.3 * entry(random);
      }
    }
  }

  static std::string linear(const RealMatrix& m, const RealVector& v, Eigen::Index i) {
    std::string text = fmt::format("{:.17g}", static_cast<double>(v[i]));
    for (Eigen::Index k = 0; k < v.size(); ++k) text += fmt::format(" + {:.17g}*x{}", static_cast<double>(m(i, k)), k);
    return text;
  }
  std::string text() const {
    std::string all;
    const Eigen::Index n = c.size();
    for (int mode = 0; mode < 2; ++mode) {
      all += mode == 0 ? "mode up {" : "mode down {";
      for (Eigen::Index i = 0; i < n; ++i)
        all += fmt::format("{}x{}' = {}", i == 0 ? " " : "; ", i, linear(flow[mode].a, flow[mode].b, i));
      all += " }\n";
    }
    all += "start in up\n";
    for (Eigen::Index i = 0; i < n; ++i) all += fmt::format("x{}(0) = 0\n", i);
    std::string guard;
    for (Eigen::Index i = 0; i < n; ++i)
      guard += fmt::format("{}{:.17g}*x{}", i == 0 ? "" : " + ", static_cast<double>(c[i]), i);
    for (int mode = 0; mode < 2; ++mode) {
      all += fmt::format("when {} {} through {:.17g} in {} {{ go {}", guard, mode == 0 ? "rises" : "falls", level[mode],
                         mode == 0 ? "up" : "down", mode == 0 ? "down" : "up");
      for (Eigen::Index i = 0; i < n; ++i) all += fmt::format("; x{} := {}", i, linear(jump[mode], shift[mode], i));
      all += " }\n";
    }
    return all + "run 0..200\n";
  }
};

struct Turn {
  Real time = 0;
  RealVector x;
  RealMatrix product;
};

inline constexpr Real short_time = 0.01L;

/// From just after the jump into `mode` to just after the next one; empty if there is none within a time of 50. `step`
/// is the exponential of a short time. The product is computed only if derivatives are needed.
inline std::optional<Turn> half_turn(const RandomFlow& system, int mode, const RealMatrix& step,
                                     const RealVector& begin, bool differentiated) {
  const LinearFlow& flow = system.flow[mode];
  const Eigen::Index n = begin.size();
  const Real h = short_time;
  const auto state = [&](const RealVector& x, Real time) {
    const RealMatrix e = flow.exponential(time);
    return RealVector(e.topLeftCorner(n, n) * x + e.topRightCorner(n, 1));
  };
  const Real sign = mode == 0 ? 1 : -1;
  const auto height = [&](const RealVector& x) { return sign * (system.c.dot(x) - system.level[mode]); };
  RealVector x = begin;
  for (int k = 0; k < 5000; ++k) {
    const RealVector next = step.topLeftCorner(n, n) * x + step.topRightCorner(n, 1);
    if (height(x) < 0 && height(next) >= 0) {
      // Newton's method from where the chord crosses: h is short, so that a few steps are exact.
      Real at = h * height(x) / (height(x) - height(next));
      Real move = h;
      for (int newton = 0; newton < 6 && std::abs(move) > 1e-18L; ++newton) {
        const RealVector there = state(x, at);
        move = height(there) / (sign * system.c.dot(flow.rates(there)));
        at -= move;
      }
      const RealVector hit = state(x, at);
      const RealVector before = flow.rates(hit);
      Turn turn{k * h + at, system.jump[mode] * hit + system.shift[mode], {}};
      const RealVector after = system.flow[1 - mode].rates(turn.x);
      const Real speed = system.c.dot(before);
      if (std::abs(speed) < 1e-4L) return std::nullopt;  // as good as touched only
      if (!differentiated) return turn;
      const RealMatrix saltation =
          system.jump[mode] + (after - system.jump[mode] * before) * system.c.transpose() / speed;
      turn.product = saltation * flow.exponential(turn.time).topLeftCorner(n, n);
      return turn;
    }
    x = next;
  }
  return std::nullopt;
}

struct FlowCycle {
  Real period = 0;
  RealMatrix product;
};

/// The cycle after many turns, if they repeat within `most`. `bounded`: whether the motion remains near the levels,
/// where it began; far from them it switches ever faster.
inline std::optional<FlowCycle> cycle_of(const RandomFlow& system, std::size_t most, bool& bounded) {
  const Eigen::Index n = system.c.size();
  RealVector x = RealVector::Zero(n);
  const RealMatrix step[2] = {system.flow[0].exponential(short_time), system.flow[1].exponential(short_time)};
  const auto whole_turn = [&](bool differentiated) -> std::optional<Turn> {
    const auto first = half_turn(system, 0, step[0], x, differentiated);
    if (!first) return std::nullopt;
    const auto second = half_turn(system, 1, step[1], first->x, differentiated);
    bounded = bounded && first->x.norm() < 30 && (!second || second->x.norm() < 30);
    if (!second || !bounded) return std::nullopt;
    Turn turn{first->time + second->time, second->x, {}};
    if (differentiated) turn.product = second->product * first->product;
    return turn;
  };
  for (int k = 0; k < 100; ++k) {
    const auto turn = whole_turn(false);
    if (!turn) return std::nullopt;
    x = turn->x;
  }
  const RealVector begin = x;
  FlowCycle cycle{0, RealMatrix::Identity(n, n)};
  for (std::size_t k = 0; k < most; ++k) {
    const auto turn = whole_turn(true);
    if (!turn) return std::nullopt;
    cycle.period += turn->time;
    cycle.product = turn->product * cycle.product;
    x = turn->x;
    if ((x - begin).norm() < 1e-11L) return cycle;
  }
  return std::nullopt;
}

}  // namespace continuo::studies
