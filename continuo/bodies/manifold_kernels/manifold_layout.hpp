// Where the numbers of a batch of manifolds are. A batch has as many manifolds as there are lanes; a number of all of
// them is a row of as many values. The number of lanes is known at run time only.
#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

#include <continuo/bodies/contact_solver/contact_step.hpp>
#include <continuo/bodies/manifold_kernels/solver_states.hpp>

namespace continuo {

/// The rows of a batch. Those of point p begin at points + p * of_point.
template <int Dim>
struct ManifoldLayout {
  static constexpr std::size_t most_points = Dim == 2 ? 2 : 4;
  static constexpr std::size_t of_inertia = Dim == 2 ? 1 : 6;  // xx, yy, zz, xy, yz, zx of the inverse
  static constexpr std::size_t normal = 0;                     // from a to b
  static constexpr std::size_t across = Dim;                   // in space: of length 1, across the normal
  static constexpr std::size_t friction = Dim == 2 ? 2 : 6;
  static constexpr std::size_t inertia_a = friction + 1;
  static constexpr std::size_t inertia_b = inertia_a + of_inertia;
  static constexpr std::size_t rounding_a = inertia_b + of_inertia;  // read where one of them is not 0
  static constexpr std::size_t rounding_b = rounding_a + 1;
  static constexpr std::size_t points = rounding_b + 1;
  // Of a point, whose arms are in the frame of the contact once the batch is prepared:
  static constexpr std::size_t arm_a = 0;
  static constexpr std::size_t arm_b = Dim;
  static constexpr std::size_t separation = 2 * Dim;  // when the step began
  static constexpr std::size_t mass = separation + 1;
  static constexpr std::size_t mass_across = mass + 1;  // in each direction across
  static constexpr std::size_t impulse = mass_across + Dim - 1;
  static constexpr std::size_t impulse_across = impulse + 1;
  static constexpr std::size_t greatest_impulse = impulse_across + Dim - 1;
  static constexpr std::size_t of_point = greatest_impulse + 1;

  static constexpr std::size_t rows = points + most_points * of_point;
};

/// A batch apart from its numbers.
struct BatchHead {
  std::uint8_t points = 0;  // of the manifold with the most
  bool is_a_fixed = false;  // whether some of the bodies a never move: they are not written
  bool is_b_fixed = false;  // likewise
  bool is_round = false;    // whether some of the bodies are rounded
  bool is_deep = false;     // whether some of the points are
  bool is_pressed = false;  // likewise
  bool is_meant = true;     // whether the pass of impacts is for some of the manifolds
};

enum class ManifoldPass : std::uint8_t {
  prepare,       // replaces the masses of points, 1 where there is one, by those that impulses there meet
  begin,         // adds the impulses of the last substep
  push,          // corrects positions as well
  push_pressed,  // likewise, at those points alone that were pressed when the step began
  relax,         // removes the velocity that this gave
  relax_deep,    // likewise, at those points alone that were deep when the step began, and along their normals
  rebound        // as relax, but `separation` is the normal velocity to be removed
};

/// Where a pass acts, and how.
template <class Real, int Dim>
struct ManifoldTask {
  SolverState<Real, Dim>* bodies = nullptr;
  Real* values = nullptr;  // rows x lanes of each batch
  const BatchHead* heads = nullptr;
  const std::uint32_t *a = nullptr, *b = nullptr;  // the bodies of each lane of each batch
  Real h{};                                        // of the substep
  Softness<Real> soft{};                           // of contacts and joints
  Softness<Real> soft_at_fixed{};                  // of contacts with bodies that never move
  Real fastest_push{};
  Real deep{}, pressed{};  // an overlap of more is
};

/// Applies a pass to batches from ... to - 1, of which no two share a body that moves.
template <class Real, int Dim>
using ManifoldKernel = void (*)(const ManifoldTask<Real, Dim>& task, ManifoldPass pass, std::size_t from,
                                std::size_t to);

/// Bodies that move at their velocities and spins.
template <class Real, int Dim>
struct MotionTask {
  SolverState<Real, Dim>* bodies = nullptr;
  Real* angles = nullptr;                  // in the plane: since the step began
  const std::uint32_t* numbers = nullptr;  // the bodies of each lane of each batch: none twice, unless it never moves
  Real h{};
};
/// Moves the bodies of batches from ... to - 1.
template <class Real, int Dim>
using MotionKernel = void (*)(const MotionTask<Real, Dim>& task, std::size_t from, std::size_t to);

/// Kernels, and for how many lanes they are.
template <class Real, int Dim>
struct ManifoldKernels {
  std::size_t lanes = 0;
  ManifoldKernel<Real, Dim> apply = nullptr;
  ManifoldKernel<Real, Dim> apply_to_point_joints = nullptr;  // see point_joint_layout.hpp
  MotionKernel<Real, Dim> move = nullptr;
};

/// Those that this machine can run, the widest last. What they compute is the same to the last bit for all.
template <class Real, int Dim>
[[nodiscard]] std::vector<ManifoldKernels<Real, Dim>> manifold_kernels();

/// Those for registers of so many bytes: 16, and where they were compiled 32 and 64.
/// @{
template <class Real, int Dim>
[[nodiscard]] ManifoldKernels<Real, Dim> kernels_of_16_bytes();
template <class Real, int Dim>
[[nodiscard]] ManifoldKernels<Real, Dim> kernels_of_32_bytes();
template <class Real, int Dim>
[[nodiscard]] ManifoldKernels<Real, Dim> kernels_of_64_bytes();
/// @}

}  // namespace continuo
