// Solves the point joints of large islands by sweeps, as ManifoldSolver does their contacts: in lanes, colour by
// colour, with the same results for all widths of registers and numbers of threads.
#pragma once
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <continuo/bodies/contact_solver/contact_step.hpp>
#include <continuo/bodies/joint.hpp>
#include <continuo/bodies/manifold_kernels/contact_colours.hpp>
#include <continuo/bodies/manifold_kernels/point_joint_layout.hpp>
#include <continuo/bodies/rigid_stepping/rigid_body.hpp>
#include <continuo/bodies/support/large_array.hpp>
#include <continuo/bodies/support/thread_team.hpp>

namespace continuo {

/// Whether a joint keeps two points together and does nothing else.
template <class Real, int Dim>
[[nodiscard]] bool is_point_joint(const Joint<Real, Dim>& joint) {
  if (joint.kind == JointKind::ball) return true;
  return Dim == 2 && joint.kind == JointKind::hinge && !joint.limits && !joint.spring && !joint.motor;
}

/// A point joint at the beginning of a step.
template <class Real, int Dim>
struct PointJoint {
  std::uint32_t a = 0, b = 0;          // bodies
  Vector<Real, Dim> arm_a{}, arm_b{};  // from their centres, in the world
  Vector<Real, Dim> impulse{};         // on b, in the last substep
};

template <class Real, int Dim>
class PointJointSolver {
 public:
  using V = Vector<Real, Dim>;
  using At = PointJointLayout<Dim>;
  using Bodies = std::span<const RigidBody<Real, Dim>>;

  explicit PointJointSolver(ThreadTeam& team,
                            const ManifoldKernels<Real, Dim>& kernels = manifold_kernels<Real, Dim>().back())
      : team_(team), kernels_(kernels) {}

  /// Takes joints of bodies with these states at the beginning of a step.
  void begin(Bodies bodies, SolverState<Real, Dim>* states, std::span<const PointJoint<Real, Dim>> joints) {
    size_ = joints.size();
    if (joints.empty()) return;
    colour(bodies, joints);
    team_.for_each(0, heads_.size(), 8, [&](std::size_t from, std::size_t to) {
      for (std::size_t batch = from; batch < to; ++batch) fill(batch, bodies, joints);
    });
    task_ = {.bodies = states, .values = value(0, 0, 0), .heads = heads_.data(), .a = a_.data(), .b = b_.data()};
    sweep(ManifoldPass::prepare);
  }
  /// How joints are held in the substeps of the step.
  void set_hardness(const Real& h, const Softness<Real>& soft, const Real& fastest_push) {
    task_.h = h;
    task_.soft = soft;
    task_.fastest_push = fastest_push;
  }
  [[nodiscard]] bool empty() const { return size_ == 0; }
  void sweep(ManifoldPass pass) {
    if (empty()) return;
    for (const BatchRun& run : lanes_.runs(0))
      team_.for_each(run.first, run.last, run.is_shared ? run.last - run.first : 8,
                     [&](std::size_t from, std::size_t to) { kernels_.apply_to_point_joints(task_, pass, from, to); });
  }
  /// Of the last substep.
  [[nodiscard]] V impulse(std::size_t joint) const {
    const std::size_t lane = lane_[joint];
    V sum;
    for (std::size_t i = 0; i < Dim; ++i)
      sum[i] = *value(lane / kernels_.lanes, lane % kernels_.lanes, At::impulse + i);
    return sum;
  }
  void clear_impulses() {
    for (std::size_t batch = 0; !empty() && batch < heads_.size(); ++batch)
      std::fill_n(value(batch, 0, At::impulse), Dim * kernels_.lanes, Real(0));
  }
  [[nodiscard]] std::size_t memory() const {
    return values_.capacity() * sizeof(Line) + (a_.capacity() + b_.capacity() + lane_.capacity()) * sizeof(a_[0]) +
           heads_.capacity() * sizeof(heads_[0]);
  }

 private:
  /// Numbers that begin where a register may be loaded.
  struct alignas(64) Line {
    std::array<Real, 64 / sizeof(Real)> numbers;
  };
  [[nodiscard]] std::size_t place(std::size_t batch, std::size_t lane, std::size_t row) const {
    return (batch * At::rows + row) * kernels_.lanes + lane;
  }
  [[nodiscard]] Real* value(std::size_t batch, std::size_t lane, std::size_t row) {
    return values_.data()->numbers.data() + place(batch, lane, row);
  }
  [[nodiscard]] const Real* value(std::size_t batch, std::size_t lane, std::size_t row) const {
    return values_.data()->numbers.data() + place(batch, lane, row);
  }

  void colour(Bodies bodies, std::span<const PointJoint<Real, Dim>> joints) {
    coloured_.resize(joints.size());
    const auto mover = [&](std::uint32_t i) { return bodies[i].is_fixed() ? ColouredContact::none : i; };
    for (std::size_t k = 0; k < joints.size(); ++k) coloured_[k] = {mover(joints[k].a), mover(joints[k].b), 1};
    const std::size_t lanes = kernels_.lanes;
    const bool are_others = colours_.find(coloured_, bodies.size());
    if (are_others) lanes_.find(colours_, lanes);
    const std::size_t batches = lanes_.batches();
    heads_.assign(batches, {});
    const auto spare = static_cast<std::uint32_t>(bodies.size());  // a body that never moves
    a_.assign(batches * lanes, spare), b_.assign(batches * lanes, spare);
    if (!are_others) return;
    lane_.resize(joints.size());
    for (std::uint32_t k = 0; k < batches * lanes; ++k)
      if (const std::uint32_t joint = lanes_.members()[k]; joint != LanesOfColours::none) lane_[joint] = k;
    values_.resize((batches * lanes * At::rows * sizeof(Real) + sizeof(Line) - 1) / sizeof(Line));
  }
  void fill(std::size_t batch, Bodies bodies, std::span<const PointJoint<Real, Dim>> joints) {
    std::fill_n(value(batch, 0, 0), At::rows * kernels_.lanes, Real(0));
    BatchHead& head = heads_[batch];
    for (std::size_t lane = 0; lane < kernels_.lanes; ++lane) {
      const std::uint32_t member = lanes_.members()[batch * kernels_.lanes + lane];
      if (member == LanesOfColours::none) {
        head.is_a_fixed = head.is_b_fixed = true;
        continue;
      }
      const PointJoint<Real, Dim>& joint = joints[member];
      const RigidBody<Real, Dim>&a = bodies[joint.a], &b = bodies[joint.b];
      head.is_a_fixed |= a.is_fixed(), head.is_b_fixed |= b.is_fixed();
      a_[batch * kernels_.lanes + lane] = joint.a, b_[batch * kernels_.lanes + lane] = joint.b;
      Real* const rows = value(batch, lane, 0);
      const auto put = [&](std::size_t at, const auto& vector) {
        for (std::size_t i = 0; i < vector.size(); ++i) rows[(at + i) * kernels_.lanes] = vector[i];
      };
      put(At::first_arm_a, joint.arm_a), put(At::first_arm_b, joint.arm_b);
      put(At::first_apart, V((b.x + joint.arm_b) - (a.x + joint.arm_a)));
      put(At::impulse, joint.impulse);
      put(At::inertia_a, lane_numbers(a.inverse_inertia_now)), put(At::inertia_b, lane_numbers(b.inverse_inertia_now));
    }
  }

  ThreadTeam& team_;
  ManifoldKernels<Real, Dim> kernels_;
  ManifoldTask<Real, Dim> task_;
  std::size_t size_ = 0;
  std::vector<ColouredContact> coloured_;
  ContactColours colours_;
  LanesOfColours lanes_;
  LargeArray<Line> values_;  // see point_joint_layout.hpp
  std::vector<BatchHead> heads_;
  std::vector<std::uint32_t> a_, b_;  // bodies of each lane
  std::vector<std::uint32_t> lane_;   // of each joint
};

}  // namespace continuo
