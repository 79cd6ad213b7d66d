// bench/problems/n_body.hpp
// Point masses that attract each other, shared by Pleiades and the outer solar system.
#pragma once
#include <array>
#include <cmath>
#include <cstddef>

namespace continuo::bench {

/// x holds the positions, axis by axis (all first coordinates, then all second ones, ...), then the velocities in the
/// same order. The force between two bodies is computed once and acts on both.
template <std::size_t Axes, std::size_t Bodies, class Real>
void attract(const std::array<double, Bodies>& mass, const std::array<Real, 2 * Axes * Bodies>& x,
             std::array<Real, 2 * Axes * Bodies>& dxdt) {
  using std::sqrt;
  constexpr std::size_t half = Axes * Bodies;
  for (std::size_t k = 0; k < half; ++k) {
    dxdt[k] = x[half + k];
    dxdt[half + k] = Real(0);
  }
  for (std::size_t i = 1; i < Bodies; ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      std::array<Real, Axes> apart;
      Real square(0);
      for (std::size_t axis = 0; axis < Axes; ++axis) {
        apart[axis] = x[axis * Bodies + j] - x[axis * Bodies + i];
        square += apart[axis] * apart[axis];
      }
      const Real inverse_cube = Real(1) / (square * sqrt(square));
      const Real to_i = Real(mass[j]) * inverse_cube, to_j = Real(mass[i]) * inverse_cube;
      for (std::size_t axis = 0; axis < Axes; ++axis) {
        dxdt[half + axis * Bodies + i] += to_i * apart[axis];
        dxdt[half + axis * Bodies + j] -= to_j * apart[axis];
      }
    }
  }
}

}  // namespace continuo::bench
