// Constraints of the velocities of two bodies, row by row: J v = direction . (v_b - v_a) + lever_b . spin_b - lever_a .
// spin_a. A contact has a row along the normal and one or two across it for each of its points, a joint has one for
// each direction in which it holds. All solvers see only these rows.
//
// A row asks for J v + bias + softness impulse = 0, where its impulse stays between `least` and `most`; of the friction
// of a contact, the size of the impulse across the normal stays below friction times that along it, and the impulse of
// a pull, which has a row for each axis, stays below the greatest one in length.
#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include <continuo/bodies/rigid_stepping/rigid_body.hpp>

namespace continuo {

template <class Real, int Dim>
struct ConstraintRow {
  Vector<Real, Dim> direction{};         // of the impulse on b; 0 for a torque
  Spin<Real, Dim> lever_a{}, lever_b{};  // arms x direction, or the axis of a torque
  Real mass{};                           // 1 / (J M^-1 J^T)
  Real bias{};                           // velocity that is to be removed beyond J v, while positions are corrected
  Real bias_at_end{};                    // the same, afterwards
  Real softness{};                       // velocity per impulse; 0 is rigid
  Real least = -std::numeric_limits<Real>::infinity(), most = std::numeric_limits<Real>::infinity();  // impulses
  Real impulse{};                                                                                     // of a substep

  [[nodiscard]] Real velocity(const RigidBody<Real, Dim>& a, const RigidBody<Real, Dim>& b) const {
    return dot(direction, b.v - a.v) + dot(lever_b, b.spin) - dot(lever_a, a.spin);
  }
  /// A fixed body is not written to: islands that are solved at once may share it.
  void apply(const Real& change, RigidBody<Real, Dim>& a, RigidBody<Real, Dim>& b) const {
    if (!a.is_fixed()) {
      a.v -= direction * (change * a.inverse_mass);
      a.spin -= a.inverse_inertia_now * lever_a * change;
    }
    if (!b.is_fixed()) {
      b.v += direction * (change * b.inverse_mass);
      b.spin += b.inverse_inertia_now * lever_b * change;
    }
  }
};

/// Sets the mass that a row meets.
template <class Real, int Dim>
void set_mass(ConstraintRow<Real, Dim>& row, const RigidBody<Real, Dim>& a, const RigidBody<Real, Dim>& b) {
  const Real compliance = squared(row.direction) * (a.inverse_mass + b.inverse_mass) +
                          dot(row.lever_a, a.inverse_inertia_now * row.lever_a) +
                          dot(row.lever_b, b.inverse_inertia_now * row.lever_b);
  row.mass = compliance > Real(0) ? 1 / compliance : Real(0);
}

/// The rows of a contact or of a joint. Those of a contact of p points: p along the normal, then Dim - 1 across it for
/// each point.
struct RowBlock {
  std::uint32_t a = 0, b = 0;  // bodies
  std::uint32_t first = 0;     // of its rows
  std::uint16_t rows = 0;      // their number
  std::uint16_t points = 0;    // of a contact; 0: a joint
  float friction = 0;          // of a contact
  bool is_bounded = false;     // whether the length of all impulses together is `most` of its first row, at most
};

/// What is to be solved in a step: rows in blocks.
template <class Real, int Dim>
struct Constraints {
  std::vector<ConstraintRow<Real, Dim>> rows;
  std::vector<RowBlock> blocks;

  [[nodiscard]] std::span<ConstraintRow<Real, Dim>> of(const RowBlock& block) {
    return std::span(rows).subspan(block.first, block.rows);
  }
};

/// Which velocity a solver asks for: push corrects positions as well, relax removes the velocity that this gave.
enum class RowPass : std::uint8_t { push, relax };

/// Shortens the impulses across the normal to what friction allows, or those of a pull to its greatest one.
template <class Real, std::size_t Size>
void limit_length(std::array<Real, Size>& impulse, const Real& most) {
  Real square(0);
  for (const Real& part : impulse) square += part * part;
  if (square <= most * most) return;
  const Real factor = most > Real(0) ? most / std::sqrt(square) : Real(0);
  for (Real& part : impulse) part *= factor;
}

/// Shortens the impulses of a pull to its greatest one.
template <class Real, int Dim>
void limit_pull(std::span<ConstraintRow<Real, Dim>> rows, RigidBody<Real, Dim>& a, RigidBody<Real, Dim>& b) {
  std::array<Real, Dim> limited;
  for (std::size_t i = 0; i < Dim; ++i) limited[i] = rows[i].impulse;
  limit_length(limited, rows[0].most);
  for (std::size_t i = 0; i < Dim; ++i) {
    rows[i].apply(limited[i] - rows[i].impulse, a, b);
    rows[i].impulse = limited[i];
  }
}

/// One sweep over the rows of a block (projected Gauss-Seidel): friction first, so that normal velocities, which matter
/// more, are solved last.
template <class Real, int Dim>
void sweep(std::span<ConstraintRow<Real, Dim>> rows, const RowBlock& block, RowPass pass, RigidBody<Real, Dim>& a,
           RigidBody<Real, Dim>& b) {
  constexpr std::size_t across = Dim - 1;
  for (std::size_t point = 0; point < block.points; ++point) {
    auto* const tangents = &rows[block.points + point * across];
    std::array<Real, across> wanted;
    for (std::size_t k = 0; k < across; ++k)
      wanted[k] = tangents[k].impulse - tangents[k].mass * tangents[k].velocity(a, b);
    limit_length(wanted, Real(block.friction) * rows[point].impulse);
    for (std::size_t k = 0; k < across; ++k) {
      tangents[k].apply(wanted[k] - tangents[k].impulse, a, b);
      tangents[k].impulse = wanted[k];
    }
  }
  const std::size_t count = block.points > 0 ? block.points : block.rows;
  for (ConstraintRow<Real, Dim>& row : rows.first(count)) {
    const bool is_pushing = pass == RowPass::push;
    // (1 / mass + softness) change = -(J v + bias + softness impulse)
    const Real softness = is_pushing || block.points == 0 ? row.softness : Real(0);
    const Real residual = row.velocity(a, b) + (is_pushing ? row.bias : row.bias_at_end) + softness * row.impulse;
    const Real change = -row.mass * residual / (1 + row.mass * softness);
    const Real impulse =
        block.is_bounded ? row.impulse + change : std::clamp(row.impulse + change, row.least, row.most);
    row.apply(impulse - row.impulse, a, b);
    row.impulse = impulse;
  }
  if (block.is_bounded) limit_pull<Real, Dim>(rows, a, b);
}

}  // namespace continuo
