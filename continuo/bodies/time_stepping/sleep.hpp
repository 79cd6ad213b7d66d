// Sleeping bodies. Bodies that touch each other, or are connected by springs, form an island. The bodies of an island
// fall asleep together once all have been slow for a while; sleeping islands that they touch become part of theirs. A
// sleeping body is not moved and costs next to nothing.
//
// An island wakes, as a whole, when an awake body that is faster than bodies at rest is about to touch it, when one of
// its velocities, positions or forces has changed, or when an awake body presses on it by more than a body at rest
// would. What is slow wakes nothing: in a pile that settles, some bodies always fall asleep later than their
// neighbours, and would wake them again and again.
#pragma once
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <utility>
#include <variant>
#include <vector>

#include <continuo/bodies/forces.hpp>
#include <continuo/bodies/time_stepping/contact_list.hpp>

namespace continuo {

template <class Real, int Dim>
class Sleep {
 public:
  using V = Vector<Real, Dim>;

  /// Body i of the world.
  [[nodiscard]] bool is_asleep(std::size_t i) const { return i < island_.size() && island_[i] != 0; }
  [[nodiscard]] std::size_t asleep() const { return asleep_; }
  void wake_all() {
    std::ranges::fill(island_, 0);
    std::ranges::fill(rested_, Real(0));
    asleep_ = 0;
  }

  /// Whether the last step has left no body awake that could move.
  [[nodiscard]] bool is_all_asleep() const { return asleep_ > 0 && awake_ == 0; }

  /// Wakes the islands of bodies that have been changed since. Returns whether there are any.
  [[nodiscard]] bool wake_changed(const World<Real, Dim>& world) {
    if (asleep_ == 0) return false;
    const std::size_t before = asleep_;
    if (world.gravity != gravity_ || world.size() != island_.size()) wake_all();
    const bool has_forces = !only_gravity(world);
    if (has_forces) {
      force_now_.resize(world.size());
      forces<Real, Dim>(world, world.time, world.position, world.velocity, force_now_);
    }
    for (std::size_t i = 0; asleep_ > 0 && i < island_.size(); ++i) {
      const V pull = has_forces ? force_now_[i] : V(world.mass[i] * world.gravity);
      // No branch before the end: a sleeping body costs nothing else.
      const bool is_pulled = squared(pull - force_[i]) > Real(1e-4) * squared(force_[i]);  // by more than a hundredth
      const bool is_moved =
          squared(world.position[i] - x_[i]) + squared(world.velocity[i]) + squared(world.spin[i]) != Real(0);
      if ((is_pulled | is_moved) & (island_[i] != 0)) waking_.push_back(island_[i]);
    }
    wake(true);
    return asleep_ != before;
  }

  /// Wakes the islands that an awake body faster than `speed` may touch in a step of dt. Returns whether there are any.
  /// order[k] is the number in the world of the body at place k.
  [[nodiscard]] bool wake_near(const SolverBodies<Real, Dim>& bodies, const ContactRows& rows,
                               const std::vector<std::uint32_t>& order, const Real& dt, const Real& speed) {
    if (asleep_ == 0) return false;
    for (std::uint32_t k = 0; k < rows.rows(); ++k) {
      const Real rim = squared(vector_of<Spin<Real, Dim>::size()>(bodies.motion[k].rim));
      if (!(squared(bodies.v(k)) + rim > speed * speed)) continue;
      for (const ContactEntry& entry : rows.row(k)) {
        const std::uint32_t j = entry.other;
        if (j >= order.size() || !is_asleep(order[j]) || is_asleep(order[k])) continue;
        const V apart = bodies.x(j) - bodies.x(k);
        const Real way = (length(bodies.v(k)) + length(bodies.acceleration(k)) * dt) * dt;
        if (length(apart) < bodies.radius(k) + bodies.radius(j) + way) waking_.push_back(island_[order[j]]);
      }
    }
    return wake(true);
  }

  /// After a step of dt, in substeps of h: islands whose bodies have been slower than `speed` for `duration` fall
  /// asleep, and islands wake on which others press. Returns whether there are any.
  [[nodiscard]] bool settle(World<Real, Dim>& world, const SolverBodies<Real, Dim>& bodies,
                            const ContactList<Real, Dim>& contacts, const std::vector<std::uint32_t>& order,
                            const Real& dt, const Real& h, const Real& duration, const Real& speed) {
    resize(world.size());
    for (std::size_t i = 0; i < world.size(); ++i) {
      const Real rim = world.radius[i] * world.radius[i] * squared(world.spin[i]);
      rested_[i] = squared(world.velocity[i]) + rim < speed * speed ? rested_[i] + dt : Real(0);
    }
    const bool has_woken = wake_pressed(world, contacts, order, h);
    join_islands(world, bodies, contacts, order);
    return fall_asleep(world, duration) || has_woken;
  }

  template <class Archive>
  void transfer(Archive& archive) {
    archive(island_), archive(rested_), archive(x_), archive(force_), archive(gravity_), archive(awake_);
    asleep_ =
        static_cast<std::size_t>(std::ranges::count_if(island_, [](std::uint32_t island) { return island != 0; }));
  }
  [[nodiscard]] bool fits(std::size_t bodies) const {
    const auto fits = [&](const auto& array) { return array.size() == island_.size(); };
    return (island_.empty() || island_.size() == bodies) && fits(rested_) && fits(x_) && fits(force_);
  }

  [[nodiscard]] std::size_t memory() const {
    return (island_.capacity() + leader_.capacity() + waking_.capacity()) * sizeof(std::uint32_t) +
           rested_.capacity() * sizeof(Real) + (x_.capacity() + force_.capacity() + force_now_.capacity()) * sizeof(V);
  }

 private:
  void resize(std::size_t bodies) {
    island_.resize(bodies, 0), rested_.resize(bodies, Real(0)), x_.resize(bodies), force_.resize(bodies);
    leader_.resize(bodies);
  }

  /// Wakes the islands in `waking_`, which may repeat. Returns whether there are any. If `anew`, their bodies have to
  /// rest again for the full time before they sleep.
  bool wake(bool anew) {
    if (waking_.empty()) return false;
    std::ranges::sort(waking_);
    for (std::size_t i = 0; i < island_.size(); ++i) {
      if (island_[i] == 0 || !std::ranges::binary_search(waking_, island_[i])) continue;
      island_[i] = 0;
      if (anew) rested_[i] = Real(0);
      --asleep_;
      ++awake_;
    }
    waking_.clear();
    return true;
  }

  /// A slow body wakes nothing by its weight, but by a greater force it does, and by any force where there are others
  /// than gravity: otherwise it could press against bodies that sleep, and never move them. It rests as they did, so
  /// that they need not rest anew.
  [[nodiscard]] bool wake_pressed(const World<Real, Dim>& world, const ContactList<Real, Dim>& contacts,
                                  const std::vector<std::uint32_t>& order, const Real& h) {
    if (asleep_ == 0) return false;
    const Real most = only_gravity(world) ? 2 * length(world.gravity) * h : Real(0);  // per mass
    contacts.for_each_touching([&](std::uint32_t k, std::uint32_t other, bool is_wall, const Real& impulse) {
      if (is_wall || !is_asleep(order[other]) || is_asleep(order[k])) return;
      if (impulse > most * world.mass[order[k]]) waking_.push_back(island_[order[other]]);
    });
    return wake(false);
  }

  /// Bodies touch where they press each other, or their gap is below a hundredth of the smaller radius: in a pile at
  /// rest, many contacts bear nothing for some of the time.
  void join_islands(const World<Real, Dim>& world, const SolverBodies<Real, Dim>& bodies,
                    const ContactList<Real, Dim>& contacts, const std::vector<std::uint32_t>& order) {
    std::iota(leader_.begin(), leader_.end(), 0u);
    for (std::size_t i = 0; i < leader_.size(); ++i)
      if (island_[i] != 0) join(world, i, (island_[i] - 1) % leader_.size());
    for (std::uint32_t k = 0; k < contacts.rows.rows(); ++k)
      for (const ContactEntry& entry : contacts.rows.row(k)) {
        if (entry.other >= bodies.size()) break;  // walls are last
        const Real smaller = std::min(bodies.radius(k), bodies.radius(entry.other));
        const Real near = bodies.radius(k) + bodies.radius(entry.other) + Real(0.01) * smaller;
        if (squared(bodies.x(entry.other) - bodies.x(k)) < near * near) join(world, order[k], order[entry.other]);
      }
    for (const Spring<Real, Dim>& spring : world.springs) {
      const auto* b = std::get_if<BodyHandle>(&spring.b);
      if (b && world.contains(spring.a) && world.contains(*b)) join(world, world.index(spring.a), world.index(*b));
    }
  }

  [[nodiscard]] bool fall_asleep(World<Real, Dim>& world, const Real& duration) {
    const std::size_t bodies = world.size(), before = asleep_;
    std::vector<Real> shortest = rested_;  // of the bodies of an island, at its leader
    std::vector<std::size_t> awake;
    for (std::size_t i = 0; i < bodies; ++i) {
      if (world.is_fixed(i) || island_[i] != 0) continue;
      awake.push_back(i);
      shortest[leader_of(i)] = std::min(shortest[leader_of(i)], rested_[i]);
    }
    std::vector<std::uint8_t> falls(bodies, 0);  // of an island, at its leader
    for (const std::size_t i : awake) {
      if (!(shortest[leader_of(i)] >= duration)) continue;
      falls[leader_of(i)] = 1;
      world.velocity[i] = {};
      world.spin[i] = {};
      x_[i] = world.position[i];
      ++asleep_;
    }
    awake_ = static_cast<std::uint32_t>(awake.size() - (asleep_ - before));
    if (asleep_ == before) return false;
    for (std::size_t i = 0; i < bodies; ++i)
      if (falls[leader_of(i)]) island_[i] = 1 + static_cast<std::uint32_t>(leader_of(i));
    remember_forces(world, !only_gravity(world));
    return true;
  }
  void remember_forces(const World<Real, Dim>& world, bool has_forces) {
    gravity_ = world.gravity;
    if (has_forces) {
      forces<Real, Dim>(world, world.time, world.position, world.velocity, force_);
    } else {
      for (std::size_t i = 0; i < world.size(); ++i) force_[i] = world.mass[i] * world.gravity;
    }
  }

  // Disjoint sets, with paths halved on the way up.
  [[nodiscard]] std::size_t leader_of(std::size_t i) {
    while (leader_[i] != i) {
      leader_[i] = leader_[leader_[i]];
      i = leader_[i];
    }
    return i;
  }
  void join(const World<Real, Dim>& world, std::size_t i, std::size_t j) {
    if (world.is_fixed(i) || world.is_fixed(j)) return;
    const std::size_t a = leader_of(i), b = leader_of(j);
    leader_[std::max(a, b)] = static_cast<std::uint32_t>(std::min(a, b));
  }

  // The number of an island is 1 and that of one of its bodies, and 0 of those awake.
  std::vector<std::uint32_t> island_, leader_;
  std::vector<Real> rested_;
  std::vector<V> x_, force_, force_now_;  // of those asleep
  V gravity_{};
  std::vector<std::uint32_t> waking_;  // islands
  std::uint32_t awake_ = 0;            // bodies that can move, after the last step
  std::size_t asleep_ = 0;
};

}  // namespace continuo
