// The forces of springs of joints, and of joints that pull.
//
// A spring of frequency f and damping ratio d pushes its coordinate q by -m (w^2 (q - rest) + 2 d w q'), with w = 2 pi
// f and the mass m that the row of the coordinate meets, 1 / (J M^-1 J^T): that of its two bodies alone, as if nothing
// else held them. The fast motion takes implicit steps of the same law.
#pragma once
#include <array>
#include <cstddef>
#include <limits>
#include <numbers>

#include <continuo/bodies/exact_rigid/joint_constraints.hpp>

namespace continuo {

/// The force along a row whose error is how far the spring is from its rest.
template <class Real, int Dim>
[[nodiscard]] Real spring_force(const JointSpring<Real>& spring, const MotionRow<Real, Dim>& row,
                                const ExactBody<Real, Dim>* bodies) {
  const Real compliance = response(row, row, bodies);
  if (!(compliance > Real(0))) return Real(0);
  const Real w = 2 * std::numbers::pi_v<Real> * spring.hertz;
  return -w * (w * row.error + 2 * spring.damping * row.rate_of(bodies[row.a], bodies[row.b])) / compliance;
}

/// Calls `push(row, force)` for the spring of a joint, and for each direction in which a joint pulls.
template <class Real, int Dim, class Push>
void push_by_springs(const ActingJoint<Real, Dim>& acting, const ExactBody<Real, Dim>* bodies, Push&& push) {
  using Row = MotionRow<Real, Dim>;
  const Joint<Real, Dim>& joint = acting.joint;
  const ExactBody<Real, Dim>&a = bodies[acting.a], &b = bodies[acting.b];
  if (joint.kind == JointKind::pull) {
    const JointSpring<Real> spring = spring_of_pull(joint);
    const Moving<Real, Dim> end = moving_point(b, joint.anchor_b);
    std::array<Row, Dim> rows;
    Vector<Real, Dim> force{};
    for (std::size_t i = 0; i < Dim; ++i) {
      Vector<Real, Dim> direction{};
      direction[i] = Real(1);
      rows[i] = row_along(a, b, Moving<Real, Dim>{direction, {}}, end);
      rows[i].a = acting.a, rows[i].b = acting.b;
      rows[i].error = end.value[i] - joint.target[i];
      force[i] = spring_force(spring, rows[i], bodies);
    }
    const Real size = length(force);
    for (std::size_t i = 0; i < Dim; ++i)
      push(rows[i], size > joint.breaks_at ? joint.breaks_at * (force[i] / size) : force[i]);
  } else if (has_spring(joint)) {
    std::vector<Row> none;
    Row row = JointConstraints<Real, Dim>(acting, a, b, none).coordinate();
    row.error -= joint.spring->rest + (joint.kind == JointKind::distance ? joint.length : Real(0));
    push(row, spring_force(*joint.spring, row, bodies));
  }
}

}  // namespace continuo
