// Where the numbers of a batch of point joints are: joints that keep two points of two bodies together and nothing
// else. As in manifold_layout.hpp, a number of all joints of a batch is a row of as many values as there are lanes.
#pragma once
#include <cstddef>

#include <continuo/bodies/manifold_kernels/manifold_layout.hpp>

namespace continuo {

template <int Dim>
struct PointJointLayout {
  static constexpr std::size_t of_inertia = ManifoldLayout<Dim>::of_inertia;
  // When the step began: the arms from the centres to the points, and the way from that of a to that of b.
  static constexpr std::size_t first_arm_a = 0, first_arm_b = Dim, first_apart = 2 * Dim;
  // Where the bodies are now: both arms to the point of b, at which the impulse acts, and that way.
  static constexpr std::size_t arm_a = 3 * Dim, arm_b = 4 * Dim, apart = 5 * Dim;
  static constexpr std::size_t impulse = 6 * Dim;  // on b
  static constexpr std::size_t inertia_a = 7 * Dim, inertia_b = inertia_a + of_inertia;
  // The change of velocity by an impulse is a matrix L D L^T: the inverse of D, then L below its diagonal.
  static constexpr std::size_t factor = inertia_b + of_inertia;

  static constexpr std::size_t rows = factor + Dim * (Dim + 1) / 2;
};

}  // namespace continuo
