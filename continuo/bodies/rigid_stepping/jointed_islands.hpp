// Islands of bodies that joints connect, in a substep: the scheme RATTLE (H. C. Andersen, J. Comp. Phys. 52, 1983; B.
// Leimkuhler, S. Reich, "Simulating Hamiltonian Dynamics", 2004). The impulses of joints act where the bodies are when
// the substep begins, and are those after which the joints hold where it ends, however far the bodies turn in between;
// there the velocities are made to agree with the joints. Linear and angular momentum stay the same to rounding, and
// the energy of a swing of w t = a goes to and fro by a part of the order of a^2. That would add up where substeps
// change their size, so what is left of it is undone as well.
#pragma once
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include <continuo/bodies/rigid_stepping/energy_bounds.hpp>
#include <continuo/bodies/rigid_stepping/free_turning.hpp>
#include <continuo/bodies/rigid_stepping/island_solver.hpp>
#include <continuo/bodies/rigid_stepping/joint_rows.hpp>

namespace continuo {

/// Whether a row gives no energy where its velocity is 0: it holds a joint, and nothing else.
template <class Real, int Dim>
[[nodiscard]] bool holds_rigidly(const ConstraintRow<Real, Dim>& row) {
  return row.softness == Real(0) && row.bias_at_end == Real(0) && row.most == -row.least &&
         row.most == std::numeric_limits<Real>::infinity();
}
[[nodiscard]] constexpr bool is_holding(JointRow kind) {
  return kind <= JointRow::turn_2;
}

/// How fast a joint of a body turns what it holds, in radians per time: an anchor about the centre, by how much of it
/// there is beside the radius of gyration, and the axes. A wheel may turn about its axle at any speed.
template <class Real, int Dim>
[[nodiscard]] Real turn_rate(JointKind kind, const RigidBody<Real, Dim>& body, const Vector<Real, Dim>& anchor,
                             const Matrix<Real, Dim>& joint_axes) {
  if (body.is_fixed()) return Real(0);
  Real greatest(0);
  for (std::size_t i = 0; i < body.inertia.columns.size(); ++i) greatest = std::max(greatest, Real(body.inertia[i][i]));
  const Vector<Real, Dim> arm = body.axes * anchor;
  const Real size2 = std::max(squared(arm), Real(greatest * body.inverse_mass));
  Real square = size2 > Real(0) ? squared(turning(body.spin, arm)) / size2 : Real(0);
  if constexpr (Dim == 3) {
    const bool holds_axes = kind != JointKind::ball && kind != JointKind::distance && kind != JointKind::pull;
    const std::size_t axis = kind == JointKind::wheel || kind == JointKind::universal ? 1 : 0;
    if (holds_axes) square = std::max(square, squared(turning(body.spin, (body.axes * joint_axes)[axis])));
  }
  return std::sqrt(square);
}

/// What must be added to the biases of the rows of a joint so that it holds, or gives way as they mean, where its
/// bodies are after a substep. The rows there, `moved`, ask for all of the errors to be undone, and `meant` are those
/// that are to be left. Returns the greatest.
template <class Real, int Dim>
Real correct_biases(std::span<ConstraintRow<Real, Dim>> rows, std::span<const ConstraintRow<Real, Dim>> moved,
                    std::span<const JointRow> kinds, std::span<const Real> meant) {
  Vector<Real, Dim> apart{};
  Spin<Real, Dim> turned{};
  for (std::size_t r = 0; r < rows.size(); ++r) {
    if (!is_holding(kinds[r]) || !holds_rigidly(rows[r])) continue;
    moved[r].direction == Vector<Real, Dim>{} ? void(turned += moved[r].lever_b * moved[r].bias)
                                              : void(apart += moved[r].direction * moved[r].bias);
  }
  Real greatest(0);
  for (std::size_t r = 0; r < rows.size(); ++r) {
    if (!is_holding(kinds[r]) || !holds_rigidly(rows[r])) continue;
    const bool is_turn = rows[r].direction == Vector<Real, Dim>{};
    const Real error = is_turn ? dot(rows[r].lever_b, turned) : dot(rows[r].direction, apart);
    rows[r].bias += error - meant[r];
    greatest = std::max(greatest, Real(std::abs(error - meant[r])));
  }
  return greatest;
}

/// Twice the kinetic energy of bodies.
template <class Real, int Dim>
[[nodiscard]] Real twice_kinetic_energy(std::span<const std::uint32_t> members,
                                        std::span<const RigidBody<Real, Dim>> bodies) {
  Real sum(0);
  for (const std::uint32_t i : members) {
    const BodyVelocity<Real, Dim> velocity{bodies[i].v, bodies[i].spin};
    sum += kinetic_product(bodies[i], velocity, velocity);
  }
  return sum;
}

template <class Real>
[[nodiscard]] Matrix<Real, 1> inertia_of_point(const Real& mass, const Vector<Real, 2>& arm) {
  return {{{{{mass * squared(arm)}}}}};
}
template <class Real>
[[nodiscard]] Matrix<Real, 3> inertia_of_point(const Real& mass, const Vector<Real, 3>& arm) {
  return identity_matrix<Real, 3>() * (mass * squared(arm)) + outer(arm, arm) * -mass;
}

/// The motion of bodies as one rigid body that has their linear and angular momentum.
template <class Real, int Dim>
struct CommonMotion {
  Vector<Real, Dim> centre{}, v{};
  Spin<Real, Dim> spin{};
};
template <class Real, int Dim>
[[nodiscard]] CommonMotion<Real, Dim> common_motion(std::span<const std::uint32_t> members,
                                                    std::span<const RigidBody<Real, Dim>> bodies) {
  CommonMotion<Real, Dim> common;
  Real mass(0);
  for (const std::uint32_t i : members) {
    const Real own = 1 / bodies[i].inverse_mass;
    mass += own, common.centre += bodies[i].x * own, common.v += bodies[i].v * own;
  }
  common.centre *= 1 / mass, common.v *= 1 / mass;
  Inertia<Real, Dim> inertia{};
  Spin<Real, Dim> momentum{};
  for (const std::uint32_t i : members) {
    const RigidBody<Real, Dim>& body = bodies[i];
    const Vector<Real, Dim> arm = body.x - common.centre;
    const Inertia<Real, Dim> own = turned_inertia(body.axes, body.inertia);
    inertia += own + inertia_of_point(Real(1 / body.inverse_mass), arm);
    momentum += own * body.spin + moment(arm, Vector<Real, Dim>((body.v - common.v) * (1 / body.inverse_mass)));
  }
  common.spin = inverse(inertia) * momentum;
  if (!is_finite(common.spin)) common.spin = {};
  return common;
}

/// Gives bodies the kinetic energy of which `wanted` is the double: their motions against each other (against the
/// world, where they are not free) become faster, by a tenth at most, or slower by one factor, so that joints hold and
/// momenta stay as they are. Where that is not enough, they turn slower about their common centre as well.
template <class Real, int Dim>
void set_energy(const Real& wanted, bool are_free, std::span<const std::uint32_t> members,
                std::span<RigidBody<Real, Dim>> bodies) {
  const auto common = are_free ? common_motion<Real, Dim>(members, bodies) : CommonMotion<Real, Dim>{};
  Real of_way(0), of_turning(0), inner(0);
  const auto parts = [&](const RigidBody<Real, Dim>& body) {
    const BodyVelocity<Real, Dim> turns{turning(common.spin, Vector<Real, Dim>(body.x - common.centre)), common.spin};
    return std::pair(turns, BodyVelocity<Real, Dim>{body.v - common.v - turns.v, body.spin - turns.spin});
  };
  for (const std::uint32_t i : members) {
    const auto [turns, own] = parts(bodies[i]);
    of_way += squared(common.v) / bodies[i].inverse_mass;
    of_turning += kinetic_product(bodies[i], turns, turns), inner += kinetic_product(bodies[i], own, own);
  }
  const auto factor_to = [](const Real& energy, const Real& of) {
    return of > Real(0) ? std::min(std::sqrt(std::max(energy / of, Real(0))), Real(1.1)) : Real(1);
  };
  const Real factor = factor_to(Real(wanted - of_way - of_turning), inner);
  const Real of_turns = wanted - of_way < of_turning ? factor_to(Real(wanted - of_way), of_turning) : Real(1);
  for (const std::uint32_t i : members) {
    const auto [turns, own] = parts(bodies[i]);
    bodies[i].v = common.v + turns.v * of_turns + own.v * factor;
    bodies[i].spin = turns.spin * of_turns + own.spin * factor;
  }
}

/// A joint of an island, with the number of its block.
template <class Real, int Dim>
struct JointOfIsland {
  const Joint<Real, Dim>* joint = nullptr;
  std::uint32_t block = 0;
};

/// Moves an island through a substep, or through several parts of one where joints turn far in it.
template <class Real, int Dim>
class JointedIsland {
 public:
  using V = Vector<Real, Dim>;
  using Body = RigidBody<Real, Dim>;
  using Row = ConstraintRow<Real, Dim>;

  JointedIsland(std::span<const std::uint32_t> members, std::span<const std::uint32_t> blocks,
                std::vector<JointOfIsland<Real, Dim>> joints, Constraints<Real, Dim>& rows, std::span<Body> bodies,
                IslandSolver<Real, Dim>& solver, const Real& fastest_push)
      : members_(members),
        blocks_(blocks),
        joints_(std::move(joints)),
        rows_(rows),
        bodies_(bodies),
        solver_(solver),
        fastest_push_(fastest_push) {
    for (const std::uint32_t i : members_) axes_.push_back(principal_axes(bodies_[i].inertia));
  }

  /// Into how many parts a substep is to be cut so that no joint turns by more than `most_turn` in one.
  [[nodiscard]] int parts(const Real& h) {
    Real rate(0);
    for (const auto& [joint, block] : joints_) {
      const Body &a = bodies_[rows_.blocks[block].a], &b = bodies_[rows_.blocks[block].b];
      rate = std::max({rate, turn_rate<Real, Dim>(joint->kind, a, joint->anchor_a, joint->axes_a),
                       turn_rate<Real, Dim>(joint->kind, b, joint->anchor_b, joint->axes_b)});
    }
    stiffen_all(h);
    Real swing(0);
    for (const std::uint32_t i : members_) swing = std::max(swing, swing_of(bodies_[i]));
    is_stiff_ = swing > most_swings;
    for (const std::uint32_t i : members_)
      if (!is_stiff_) bodies_[i].stiffening = {};
    const Real parts = std::max(Real(rate * h / most_turn), std::min(swing, most_swings));
    return static_cast<int>(std::ceil(std::clamp(parts, Real(1), std::min(Real(most_parts), most_parts_of_all()))));
  }

  /// The bodies have been accelerated, but have not turned. `aim(h)` makes the rows of contacts ask for what they are
  /// to ask for; `given()` is the energy that motors and springs have given since the velocities were `free`.
  template <class Aim, class Note, class Given>
  void advance(const Real& h, std::span<const V> acceleration, std::span<BodyVelocity<Real, Dim>> free, Aim&& aim,
               Note&& note, Given&& given) {
    Real part = h / static_cast<Real>(parts(h)), left = h;
    const Real least = std::max(Real(part / more_parts), Real(h / most_parts_of_all()));
    accelerate(acceleration, -h);
    scale_impulses(part / h);
    while (left > part / 2) {
      begin_.clear(), begin_impulses_.clear();
      for (const std::uint32_t i : members_) begin_.push_back(bodies_[i]);
      for_each_row([this](Row& row) { begin_impulses_.push_back(row.impulse); });
      const bool is_good = advance_part(part, acceleration, free, aim, given);
      if (!is_good && part > least && solver_.is_direct()) {
        for (std::size_t n = 0; n < members_.size(); ++n) bodies_[members_[n]] = begin_[n];
        std::size_t r = 0;
        for_each_row([&](Row& row) { row.impulse = begin_impulses_[r++]; });
        part /= 2, rows_are_of_ = Real(0);
        scale_impulses(Real(0.5));
        continue;
      }
      note();
      left -= part;
    }
    scale_impulses(h / part);
  }

 private:
  /// Of a large island fewer: where joints contradict each other even the least parts are not good, and a step through
  /// thousands of them would take minutes.
  [[nodiscard]] Real most_parts_of_all() const {
    return std::clamp(Real(5000) / static_cast<Real>(blocks_.size()), Real(2), Real(most_parts_of_substep));
  }
  static constexpr Real most_turn = Real(0.2), most_error = Real(0.05);
  static constexpr Real most_gain = Real(1.05);  // where it is only nearly known what motors and springs give
  static constexpr Real accuracy = Real(2e-4), most_swings = Real(32);
  static constexpr int most_parts = 64, more_parts = 32, most_parts_of_substep = 100, most_corrections = 8;

  /// By how many radians the pull of joints swings a body at its anchors in the time of which the rows are, at most
  /// (add_stiffening): the square is the trace of what it stiffens over the inertia.
  [[nodiscard]] static Real swing_of(const Body& body) {
    Real square(0);
    for (std::size_t i = 0; i < body.stiffening.columns.size(); ++i)
      square += (body.inverse_inertia_now * body.stiffening[i])[i];
    return std::sqrt(std::max(square, Real(0)));
  }
  /// Returns whether that is as good as it can be: whether joints hold and the energy is nearly what it should be.
  template <class Aim, class Given>
  [[nodiscard]] bool advance_part(const Real& h, std::span<const V> acceleration,
                                  std::span<BodyVelocity<Real, Dim>> free, Aim&& aim, Given&& given) {
    const JointHardness<Real> hardness = hardness_of(h);
    if (h != rows_are_of_) renew_rows(hardness);
    rows_are_of_ = h;
    aim(h);
    const bool do_joints_agree = agree();
    Real before = twice_kinetic_energy<Real, Dim>(members_, bodies_);
    accelerate(acceleration, h / 2);
    start_.clear();
    for (const std::uint32_t i : members_) {
      start_.push_back(bodies_[i]);
      free[i] = {bodies_[i].v + acceleration[i] * (h / 2), bodies_[i].spin};
    }
    const Real error = push(h);
    const bool do_joints_hold = error <= 50 * accuracy * fastest();
    for (std::size_t k = 0; k < members_.size(); ++k)
      before += 2 * dot(acceleration[members_[k]], bodies_[members_[k]].x - start_[k].x) / start_[k].inverse_mass;
    accelerate(acceleration, h / 2);
    renew_rows(hardness);
    aim(h);
    solver_.relax(rows_, bodies_);
    const bool is_near = balance(before, do_joints_agree, free, given);
    return !do_joints_agree || (is_near && do_joints_hold) || rounding_of_speed(h) > accuracy * fastest();
  }
  /// How well the speed is known with which joints part in h: their places are rounded. Where bodies are slow, smaller
  /// parts know it even less.
  [[nodiscard]] Real rounding_of_speed(const Real& h) const {
    Real farthest(0);
    for (const std::uint32_t i : members_)
      for (const Real& part : bodies_[i].x.components) farthest = std::max(farthest, Real(std::abs(part)));
    return 4 * std::numeric_limits<Real>::epsilon() * farthest / h;
  }
  template <class Act>
  void for_each_row(Act&& act) {
    for (const std::uint32_t k : blocks_)
      for (auto& row : rows_.of(rows_.blocks[k])) act(row);
  }
  [[nodiscard]] JointHardness<Real> hardness_of(const Real& h) const {
    return {.h = h, .rate = 1 / h, .softness = Real(0), .fastest_push = fastest_push_};
  }
  void accelerate(std::span<const V> acceleration, const Real& h) {
    for (const std::uint32_t i : members_) bodies_[i].v += acceleration[i] * h;
  }
  void scale_impulses(const Real& factor) {
    for_each_row([&](Row& row) { row.impulse *= factor; });
  }
  /// The rows of joints where the bodies are now, with the impulses that they have.
  void renew_rows(const JointHardness<Real>& hardness) {
    for (const auto& [joint, block] : joints_) {
      const auto rows = rows_.of(rows_.blocks[block]);
      build(*joint, rows_.blocks[block], hardness);
      for (std::size_t r = 0; r < rows.size(); ++r) {
        built_.rows[r].impulse = rows[r].impulse;
        rows[r] = built_.rows[r];
      }
    }
    if (is_stiff_) stiffen_all(hardness.h);
  }
  /// What the impulses that joints had in h stiffen.
  void stiffen_all(const Real& h) {
    for (const std::uint32_t i : members_) bodies_[i].stiffening = {};
    for (const auto& [joint, block] : joints_) {
      const RowBlock& of = rows_.blocks[block];
      V force{};
      for (const Row& row : rows_.of(of)) force += row.direction * row.impulse;
      stiffen(bodies_[of.a], joint->anchor_a, V(-force), h);
      stiffen(bodies_[of.b], joint->anchor_b, force, h);
    }
  }
  static void stiffen(Body& body, const V& anchor, const V& force, const Real& h) {
    if (!body.is_fixed()) add_stiffening(V(body.axes * anchor), force, h, body.stiffening);
  }
  void build(const Joint<Real, Dim>& joint, const RowBlock& block, const JointHardness<Real>& hardness) {
    built_.rows.clear(), built_.blocks.clear(), kinds_.clear();
    add_rows(joint, JointImpulses<Real>{}, block.a, block.b, bodies_[block.a], bodies_[block.b], hardness, built_,
             kinds_);
  }
  /// Whether the velocities agree with the joints: else something else has changed them, and their energy is not kept.
  [[nodiscard]] bool agree() {
    Real error(0), speed(0);
    for (const std::uint32_t k : blocks_) {
      const RowBlock& block = rows_.blocks[k];
      if (block.points > 0) continue;
      const Body &a = bodies_[block.a], &b = bodies_[block.b];
      for (const auto& row : rows_.of(block)) {
        speed = std::max({speed, length(a.v), length(b.v), length(row.lever_a) * length(a.spin),
                          length(row.lever_b) * length(b.spin)});
        if (holds_rigidly(row)) error = std::max(error, Real(std::abs(row.velocity(a, b))));
      }
    }
    return error <= Real(1e-3) * speed;
  }

  /// Finds the impulses after which the joints hold where the bodies are at the end of h, and moves them there. Returns
  /// by how fast they still part.
  [[nodiscard]] Real push(const Real& h) {
    note_meant(h);
    solver_.push(rows_, bodies_);
    move(h);
    Real least = std::numeric_limits<Real>::infinity();
    for (int k = 0; k < most_corrections && solver_.is_direct(); ++k) {
      const Real error = correct(h);
      if (!(error < least / 2)) break;
      least = error;
      if (error <= accuracy * fastest()) break;
      for (std::size_t n = 0; n < members_.size(); ++n) bodies_[members_[n]] = start_[n];
      if (!solver_.push_again(rows_, bodies_)) break;
      move(h);
    }
    return least < std::numeric_limits<Real>::infinity() ? least : Real(0);
  }
  void move(const Real& h) {
    for (std::size_t n = 0; n < members_.size(); ++n) move_freely(bodies_[members_[n]], axes_[n], h);
  }
  [[nodiscard]] Real fastest() const {
    Real square(0);
    for (const std::uint32_t i : members_)
      square = std::max({square, squared(bodies_[i].v), twice_spin_energy(i) * bodies_[i].inverse_mass});
    return std::sqrt(square);
  }
  [[nodiscard]] Real twice_spin_energy(std::uint32_t i) const { return 2 * spin_energy(bodies_[i]); }
  /// What errors the rows mean to leave: all but what they undo in h, at the fastest push.
  void note_meant(const Real& h) {
    meant_.clear();
    for (const auto& [joint, block] : joints_) {
      const auto rows = rows_.of(rows_.blocks[block]);
      const bool is_slow =
          std::ranges::any_of(rows, [this](const Row& row) { return std::abs(row.bias) >= fastest_push_; });
      if (is_slow) build(*joint, rows_.blocks[block], whole(h));
      for (std::size_t r = 0; r < rows.size(); ++r)
        meant_.push_back(is_slow ? built_.rows[r].bias - rows[r].bias : Real(0));
    }
  }
  /// All of an error at once.
  [[nodiscard]] static JointHardness<Real> whole(const Real& h) {
    return {.h = h, .rate = 1 / h, .softness = Real(0), .fastest_push = std::numeric_limits<Real>::infinity()};
  }
  [[nodiscard]] Real correct(const Real& h) {
    Real greatest(0);
    std::size_t first = 0;
    for (const auto& [joint, block] : joints_) {
      build(*joint, rows_.blocks[block], whole(h));
      const auto rows = rows_.of(rows_.blocks[block]);
      const auto meant = std::span<const Real>(meant_).subspan(first, rows.size());
      first += rows.size();
      if (joint->kind == JointKind::pull) continue;
      greatest = std::max(greatest, correct_biases<Real, Dim>(rows, built_.rows, kinds_, meant));
    }
    return greatest;
  }

  /// The energy is what it was and what forces have given; where something else acts than joints that only hold, it is
  /// at most that and what motors and springs may have given.
  template <class Given>
  [[nodiscard]] bool balance(const Real& before, bool do_joints_agree, std::span<const BodyVelocity<Real, Dim>> free,
                             Given&& given) {
    bool are_free = true, only_hold = true;
    for (const std::uint32_t k : blocks_) {
      const RowBlock& block = rows_.blocks[k];
      bool acts = block.points == 0;
      for (const auto& row : rows_.of(block)) {
        acts |= row.impulse != Real(0);
        only_hold &= row.impulse == Real(0) || holds_rigidly(row);
      }
      are_free &= !acts || (!bodies_[block.a].is_fixed() && !bodies_[block.b].is_fixed());
    }
    const Real now = twice_kinetic_energy<Real, Dim>(members_, bodies_);
    Real wanted = before, of_free(0);
    for (const std::uint32_t i : members_) of_free += kinetic_product(bodies_[i], free[i], free[i]);
    const bool is_bound = !only_hold || !do_joints_agree;
    if (is_bound) {
      wanted = std::max(before, of_free) + 2 * given();
      if (now <= wanted * most_gain) return true;
    }
    const bool is_near = is_bound || std::abs(now - wanted) <= most_error * std::max(now, of_free);
    set_energy<Real, Dim>(wanted, are_free, members_, bodies_);
    return is_near;
  }

  std::span<const std::uint32_t> members_, blocks_;
  std::vector<JointOfIsland<Real, Dim>> joints_;
  Constraints<Real, Dim>& rows_;
  std::span<Body> bodies_;
  IslandSolver<Real, Dim>& solver_;
  Real fastest_push_;
  bool is_stiff_ = false;             // whether joints swing too fast for the parts
  Real rows_are_of_{};                // the part for which rows have been renewed where the bodies are
  std::vector<Body> begin_, start_;   // the members when a part begins, and when forces have acted
  std::vector<Real> begin_impulses_;  // of all rows
  std::vector<Real> meant_;
  std::vector<PrincipalAxes<Real, Dim>> axes_;  // of the members
  Constraints<Real, Dim> built_;
  std::vector<JointRow> kinds_;
};

}  // namespace continuo
