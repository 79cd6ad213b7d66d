// The size of the largest eigenvalue of df/dx from values of f alone, by a power method on the differences of f.
// B. P. Sommeijer, L. F. Shampine, J. G. Verwer, "RKC: an explicit solver for parabolic PDEs", J. Comp. Appl. Math. 88
// (1997), section 4.
#pragma once
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>

#include <continuo/system/system.hpp>

namespace continuo {

/// The last direction found: an eigenvector changes little from step to step, and the search goes on from there.
template <State X>
struct SpectralRadius {
  X direction, moved, slope;
  bool known = false;

  explicit SpectralRadius(const X& x) : direction(x), moved(x), slope(x) {}

  /// For checkpoints: what the next estimate depends on.
  template <class Archive>
  void transfer(Archive& archive) {
    archive(direction, known);
  }

  /// Somewhat more than the spectral radius at (t, x), where f is fx; not a number where f is not finite nearby.
  template <class F>
  [[nodiscard]] Scalar<X> estimate(F& f, const Scalar<X>& t, const X& x, const X& fx, int& evaluations) {
    using Real = Scalar<X>;
    using std::abs, std::max, std::sqrt;
    const std::size_t n = dimension(x);
    if (n == 0) return Real(0);
    const Real root = sqrt(std::numeric_limits<Real>::epsilon());
    const Real size = euclidean_norm(x);
    const Real distance = size > 0 ? root * size : root;
    // A smooth state is often made of a few eigenvectors, not of the one looked for: noise has a part of each.
    if (!known) {
      for (std::size_t i = 0; i < n; ++i) direction.data()[i] = noise<Real>(i);
    }
    known = true;
    Real radius(0);
    for (int k = 1; k <= most_iterations; ++k) {
      const Real factor = distance / euclidean_norm(direction);
      for (std::size_t i = 0; i < n; ++i) moved.data()[i] = x.data()[i] + factor * direction.data()[i];
      evaluate(f, t, moved, slope);
      ++evaluations;
      for (std::size_t i = 0; i < n; ++i) slope.data()[i] -= fx.data()[i];
      const Real stretch = euclidean_norm(slope), last = radius;
      radius = stretch / distance;
      if (!(radius < std::numeric_limits<Real>::infinity())) {
        known = false;
        break;
      }
      if (stretch > 0) {
        direction = slope;
      } else {  // it was mapped to nothing: turn one component round
        const std::size_t i = static_cast<std::size_t>(k) % n;
        direction.data()[i] = direction.data()[i] != Real(0) ? -direction.data()[i] : Real(1);
      }
      if (k >= 2 && stretch > 0 && abs(radius - last) <= Real(accuracy) * radius) break;
    }
    return Real(margin) * radius;
  }

 private:
  // The iteration comes from below: 1 % between two of them is far less than the margin.
  static constexpr int most_iterations = 50;
  static constexpr double accuracy = 0.01, margin = 1.2;

  /// Between -1 and 1, never 0: the bits of i, mixed as in the finalizer of A. Appleby's MurmurHash3.
  template <class Real>
  [[nodiscard]] static Real noise(std::size_t i) {
    std::uint32_t bits = static_cast<std::uint32_t>(i) + 1;
    for (const std::uint32_t factor : {0x85ebca6bU, 0xc2b2ae35U}) bits = (bits ^ (bits >> 15)) * factor;
    return Real(static_cast<std::int32_t>(bits | 1U)) / Real(2147483648.0);
  }
};

}  // namespace continuo
