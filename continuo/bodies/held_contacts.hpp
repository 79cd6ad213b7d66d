// Contacts that last while forces of any kind press: held closed, with the forces that this takes, until one would have
// to pull. Coulomb's friction is held where it can hold (a ball then rolls), and rubs against the slip where it cannot.
//
// With the relative velocity u = J v of the surfaces in contact, forces f change it by A f, A = J M^-1 J^T; they are
// chosen so that u' = 0 in the directions held, no normal force pulls, and a normal force that vanishes lets go (a
// linear complementarity problem; D. Baraff, "Fast contact force computation for nonpenetrating rigid bodies", SIGGRAPH
// 1994). More contacts than a body needs leave A singular: of all forces that do, the smallest are taken, by a small
// diagonal and refinement (a proximal point method). What gaps and speeds of integration errors come about is damped in
// the time in which a body falls its radius (J. Baumgarte, Comput. Methods Appl. Mech. Eng. 1 (1972) 1-16).
#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include <continuo/bodies/world.hpp>
#include <continuo/numerics/dense_lu.hpp>

namespace continuo {

/// Two that touch or may touch.
struct Touching {
  static constexpr std::uint32_t no_wall = std::numeric_limits<std::uint32_t>::max();
  std::uint32_t a = 0, b = 0, wall = no_wall;
  bool with_wall() const { return wall != no_wall; }
  friend bool operator==(const Touching&, const Touching&) = default;
};

template <class Real, int Dim>
class HeldContacts {
 public:
  using V = Vector<Real, Dim>;
  using S = Spin<Real, Dim>;
  struct Loads {
    std::span<V> force;
    std::span<S> torque;  // empty where nothing rubs
  };

  HeldContacts() = default;
  /// Those of `touching` that are pressed together by forces and slower than `slow`, at the world as it is.
  HeldContacts(const World<Real, Dim>& world, std::span<const Touching> touching, const Real& slow, const Real& rate,
               std::span<const V> force, std::span<const S> torque)
      : world_(&world), slow_(slow), rate_(rate) {
    for (const Touching& one : touching) add(one);
    choose(force, torque);
    std::erase_if(held_, [](const Held& one) { return !one.is_pressed; });
    for (const Held& one : held_) rubs_ = rubs_ || one.friction > Real(0);
  }

  std::size_t size() const { return held_.size(); }
  const Touching& operator[](std::size_t k) const { return held_[k].pair; }
  bool contains(const Touching& pair) const {
    return std::ranges::any_of(held_, [&](const Held& one) { return one.pair == pair; });
  }
  /// Whether spins change.
  bool rub() const { return rubs_; }

  /// Adds to the loads what holds the contacts at x, v, spin under these loads.
  void hold(std::span<const V> x, std::span<const V> v, std::span<const S> spin, const Loads& loads) {
    place(x, v, spin);
    solve(spin, loads.force, loads.torque);
    for (const Held& one : held_) load(one, loads);
  }
  /// Two numbers of each contact that fall through 0 where it lets go, and where it begins or ends to slip. Of the last
  /// call of `hold`.
  Real press(std::size_t k) const { return held_[k].press; }
  Real grip(std::size_t k) const {
    const Held& one = held_[k];
    if (!(one.friction > Real(0))) return Real(1);
    if (one.sticks) return one.friction * one.press - length(one.rub);
    return one.is_fast ? length(one.slip) - slow_ / 2 : dot(one.slip, one.way) + slow_ / 8;
  }

  /// Takes away what speed they have in the directions held, by impulses.
  void settle(std::span<V> velocity, std::span<S> spin) {
    const std::vector<Row> rows = rows_held(true);
    if (rows.empty()) return;
    place(world_->position, velocity, spin);
    std::vector<Real> impulse(rows.size());
    fill(rows, [&](const Row& column) { return column.direction; });
    for (std::size_t r = 0; r < rows.size(); ++r) impulse[r] = -dot(held_[rows[r].held].rate, rows[r].direction);
    if (!make_forces(impulse)) return;
    for (std::size_t r = 0; r < rows.size(); ++r) {
      const Held& one = held_[rows[r].held];
      const V push = rows[r].direction * impulse[r];
      const S twist = moment(one.normal, push);
      for (const auto& [body, sign] : ends(one)) {
        velocity[body] += push * (sign * world_->inverse_mass[body]);
        spin[body] -= twist * (world_->radius[body] * world_->inverse_inertia[body]);
      }
    }
  }

 private:
  struct End {
    std::uint32_t body;
    Real sign;
  };
  struct Held {
    Touching pair{};
    std::array<End, 2> ends{};
    Real friction{};
    bool is_pressed = true, sticks = false, is_fast = false;  // fast: it slipped at the start
    int changes = 0;
    V way{};  // in which it slips, or would
    // At the instant of the last call:
    V normal{}, rate{}, slip{}, bend{};  // of a to b; of the surfaces, all and across the normal; rate of the normal
    Real gap{}, press{};
    V rub{};  // the force of friction on b
  };
  /// A direction in which a contact is held: its normal, or one across it.
  struct Row {
    std::size_t held;
    V direction;
    bool is_normal;
  };

  /// One or two bodies: of a wall the first alone.
  static std::span<const End> ends(const Held& one) { return std::span(one.ends).first(one.pair.with_wall() ? 1 : 2); }

  void add(const Touching& pair) {
    Held one;
    one.pair = pair;
    one.ends = {End{pair.a, Real(-1)}, End{pair.b, Real(1)}};
    one.friction = combined(world_->meeting, world_->material[pair.a],
                            pair.with_wall() ? world_->walls()[pair.wall].material : world_->material[pair.b])
                       .friction;
    held_.push_back(one);
  }

  void place(std::span<const V> x, std::span<const V> v, std::span<const S> spin) {
    for (Held& one : held_) {
      const auto [a, b, w] = one.pair;
      V rate = -v[a];
      if (one.pair.with_wall()) {
        const Wall<Real, Dim> wall = facing(world_->walls()[w], world_->position[a]);
        one.normal = -wall.normal;
        one.gap = dot(wall.normal, x[a]) - wall.offset - world_->radius[a];
        one.bend = {};
      } else {
        const V apart = x[b] - x[a];
        const Real distance = length(apart);
        one.normal = apart * (1 / distance);
        one.gap = distance - world_->radius[a] - world_->radius[b];
        rate += v[b];
        one.bend = (rate - one.normal * dot(rate, one.normal)) * (1 / distance);
      }
      one.rate = rate;
      if (one.friction > Real(0)) {
        one.rate -= turning(spin[a], V(one.normal * world_->radius[a]));
        if (!one.pair.with_wall()) one.rate -= turning(spin[b], V(one.normal * world_->radius[b]));
      }
      one.slip = one.rate - one.normal * dot(one.rate, one.normal);
    }
  }

  /// The direction of the slip; as slow as one that begins to slip it is the way that it will.
  V direction_of(const Held& one) const {
    const Real speed = length(one.slip);
    if (speed > slow_) return one.slip * (1 / speed);
    return (one.slip + one.way * (slow_ - speed)) * (1 / slow_);
  }

  /// With the slow ones also those across that begin to slip.
  std::vector<Row> rows_held(bool with_slow = false) const {
    std::vector<Row> rows;
    for (std::size_t k = 0; k < held_.size(); ++k) {
      const Held& one = held_[k];
      if (!one.is_pressed) continue;
      rows.push_back({k, one.normal, true});
      if (!one.sticks && !(with_slow && one.friction > Real(0) && !one.is_fast)) continue;
      for (const V& across : across_of(one.normal)) rows.push_back({k, across, false});
    }
    return rows;
  }
  static std::vector<V> across_of(const V& normal) {
    if constexpr (Dim == 2) {
      return {V{{-normal[1], normal[0]}}};
    } else {
      V least{};  // the axis that is least along the normal
      std::size_t axis = 0;
      for (std::size_t k = 1; k < 3; ++k)
        if (std::abs(normal[k]) < std::abs(normal[axis])) axis = k;
      least[axis] = Real(1);
      V first = turning(normal, least);
      first *= 1 / length(first);
      return {first, turning(normal, first)};
    }
  }

  /// Of each row the change of speed that the force of each column makes.
  template <class DirectionOf>
  void fill(const std::vector<Row>& rows, const DirectionOf& direction_of_column) {
    const std::size_t n = rows.size();
    matrix_.assign(n * n, Real(0));
    for (std::size_t c = 0; c < n; ++c) {
      const Held& from = held_[rows[c].held];
      const V push = direction_of_column(rows[c]);
      const S twist = moment(from.normal, push);
      for (std::size_t r = 0; r < n; ++r) {
        const Held& to = held_[rows[r].held];
        const S lever = moment(to.normal, rows[r].direction);
        Real sum(0);
        for (const End& e : ends(to))
          for (const End& f : ends(from)) {
            if (e.body != f.body) continue;
            const Real radius = world_->radius[e.body];
            sum += e.sign * f.sign * world_->inverse_mass[e.body] * dot(rows[r].direction, push);
            sum += world_->inverse_inertia[e.body] * radius * radius * dot(lever, twist);
          }
        matrix_[r * n + c] = sum;
      }
    }
  }
  /// From the changes of speed that are wanted to the forces that make them. What a diagonal of 1e-5 of the size leaves
  /// wrong two more rounds take away: 1e-15, and no force is more than 3e5 times what it should be for what cannot be.
  bool make_forces(std::vector<Real>& wanted) const {
    const std::size_t n = wanted.size();
    Real greatest(0);
    for (std::size_t r = 0; r < n; ++r) greatest = std::max(greatest, std::abs(matrix_[r * n + r]));
    DenseLU<Real, run_time_size> lu(n);
    std::ranges::copy(matrix_, lu.matrix().begin());
    for (std::size_t r = 0; r < n; ++r) lu.matrix()[r * n + r] += Real(1e-5) * greatest;
    if (!lu.factor()) return false;
    std::vector<Real> force(n), rest;
    for (int round = 0; round < 3; ++round) {
      rest = wanted;
      for (std::size_t r = 0; r < n; ++r)
        for (std::size_t c = 0; c < n; ++c) rest[r] -= matrix_[r * n + c] * force[c];
      lu.solve(rest.data());
      for (std::size_t r = 0; r < n; ++r) force[r] += rest[r];
    }
    wanted = std::move(force);
    return true;
  }

  /// The rate of change, in the direction of a row, of the speed of its contact: by loads, by what bends, and against
  /// what has come about by errors.
  Real free_rate(const Row& row, std::span<const S> spin, std::span<const V> force, std::span<const S> torque) const {
    const Held& one = held_[row.held];
    const S lever = moment(one.normal, row.direction);
    Real sum(0);
    for (const End& e : ends(one)) {
      sum += e.sign * world_->inverse_mass[e.body] * dot(row.direction, force[e.body]);
      if (row.is_normal) continue;
      const Real radius = world_->radius[e.body];
      if (!torque.empty()) sum -= radius * world_->inverse_inertia[e.body] * dot(lever, torque[e.body]);
      sum -= dot(row.direction, turning(spin[e.body], V(one.bend * radius)));
    }
    if (!row.is_normal) return sum + rate_ * dot(one.rate, row.direction);
    V centres = one.rate;  // along the normal the surfaces move as the centres do
    centres -= one.slip;
    const Real distance = one.pair.with_wall() ? Real(0) : world_->radius[one.pair.a] + world_->radius[one.pair.b];
    const Real deepest = -Real(1e-6) * world_->radius[one.pair.a];
    return sum + squared(one.bend) * distance + 2 * rate_ * dot(centres, row.direction) +
           rate_ * rate_ * std::max(one.gap, deepest);
  }

  void solve(std::span<const S> spin, std::span<const V> force, std::span<const S> torque) {
    for (Held& one : held_) one.press = Real(0), one.rub = {};
    const std::vector<Row> rows = rows_held();
    if (rows.empty()) return;
    fill(rows, [&](const Row& column) {
      const Held& one = held_[column.held];
      return column.is_normal && !one.sticks ? V(one.normal - direction_of(one) * one.friction) : column.direction;
    });
    std::vector<Real> size(rows.size());
    for (std::size_t r = 0; r < rows.size(); ++r) size[r] = -free_rate(rows[r], spin, force, torque);
    if (!make_forces(size)) return;
    for (std::size_t r = 0; r < rows.size(); ++r) {
      Held& one = held_[rows[r].held];
      if (!rows[r].is_normal) {
        one.rub += rows[r].direction * size[r];
      } else {
        one.press = size[r];
        if (!one.sticks) one.rub = direction_of(one) * (-one.friction * size[r]);
      }
    }
  }
  void load(const Held& one, const Loads& loads) const {
    const V push = one.normal * one.press + one.rub;
    const S twist = moment(one.normal, one.rub);
    for (const End& e : ends(one)) {
      loads.force[e.body] += push * e.sign;
      if (!loads.torque.empty()) loads.torque[e.body] -= twist * world_->radius[e.body];
    }
  }

  /// Which are pressed, and which of those stick.
  void choose(std::span<const V> force, std::span<const S> torque) {
    const World<Real, Dim>& world = *world_;
    place(world.position, world.velocity, world.spin);
    for (Held& one : held_) {
      const Real speed = length(one.slip);
      one.is_fast = one.friction > Real(0) && speed > slow_;
      one.sticks = one.friction > Real(0) && !one.is_fast;
      if (one.is_fast) one.way = one.slip * (1 / speed);
    }
    std::vector<V> all;
    std::vector<S> twist;
    for (int round = 0; round < 50; ++round) {
      all.assign(force.begin(), force.end());
      twist.assign(world.size(), S{});
      std::ranges::copy(torque, twist.begin());
      hold(world.position, world.velocity, world.spin, {all, twist});
      if (!change(all, twist)) return;
    }
  }
  /// Lets go what pulls, takes back what would sink in, lets slip what friction cannot hold. False where all is right.
  bool change(std::span<const V> force, std::span<const S> torque) {
    bool is_other = false;
    Real greatest(0);
    for (const Held& one : held_) greatest = std::max(greatest, one.press);
    for (std::size_t k = 0; k < held_.size(); ++k) {
      Held& one = held_[k];
      if (one.changes > 8) {  // undecided: as it is, but that it sticks
        one.sticks = one.friction > Real(0) && !one.is_fast;
        continue;
      }
      const Row row{k, one.normal, true};
      if (one.is_pressed && one.press < Real(0)) {
        one.is_pressed = false;
        is_other = true, ++one.changes;
      } else if (!one.is_pressed &&
                 free_rate(row, world_->spin, force, torque) * mass_of(one) < -Real(1e-9) * greatest) {
        one.is_pressed = true;
        is_other = true, ++one.changes;
      } else if (one.is_pressed && one.sticks && !(length(one.rub) < one.friction * one.press * Real(1 - 1e-9))) {
        one.sticks = false;
        one.way = length(one.rub) > Real(0) ? one.rub * (-1 / length(one.rub)) : V{};
        is_other = true, ++one.changes;
      } else if (one.is_pressed && one.friction > Real(0) && !one.sticks && !one.is_fast &&
                 free_rate({k, one.way, false}, world_->spin, force, torque) * mass_of(one) < -Real(1e-6) * greatest) {
        one.sticks = true;  // once others slip it can
        is_other = true, ++one.changes;
      }
    }
    return is_other;
  }
  Real mass_of(const Held& one) const {
    Real sum(0);
    for (const End& e : ends(one)) sum += world_->inverse_mass[e.body];
    return 1 / sum;
  }

  const World<Real, Dim>* world_ = nullptr;
  Real slow_{}, rate_{};
  bool rubs_ = false;
  std::vector<Held> held_;
  std::vector<Real> matrix_;  // A, row by row
};

}  // namespace continuo
