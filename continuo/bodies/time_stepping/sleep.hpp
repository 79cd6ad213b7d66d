// Sleeping bodies. Bodies that touch each other, or are connected by springs, form an island. The bodies of an island
// fall asleep together once all have been slow for a while. They wake together when an awake body is about to touch one
// of them, or when one of their velocities, positions or forces has changed. A sleeping body is not moved and costs
// next to nothing.
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
      if (island_[i] == 0) continue;
      const V pull = has_forces ? force_now_[i] : V(world.mass[i] * world.gravity);
      const bool is_pulled = squared(pull - force_[i]) > Real(1e-4) * squared(force_[i]);  // by more than a hundredth
      if (is_pulled || world.position[i] != x_[i] || world.velocity[i] != V{} || world.spin[i] != Spin<Real, Dim>{})
        wake(island_[i]);
    }
    return asleep_ != before;
  }

  /// Wakes the islands that an awake body may touch in a step of dt. Returns whether there are any. order[k] is the
  /// number in the world of the body at place k.
  [[nodiscard]] bool wake_near(const SolverBodies<Real, Dim>& bodies, const ContactRows& rows,
                               const std::vector<std::uint32_t>& order, const Real& dt) {
    const std::size_t before = asleep_;
    for (std::uint32_t k = 0; asleep_ > 0 && k < rows.rows(); ++k)
      for (const ContactEntry& entry : rows.row(k)) {
        const std::uint32_t j = entry.other;
        if (j >= order.size() || !is_asleep(order[j]) || is_asleep(order[k])) continue;
        const V apart = bodies.x(j) - bodies.x(k);
        const Real way = (length(bodies.v(k)) + length(bodies.acceleration(k)) * dt) * dt;
        if (length(apart) < bodies.radius(k) + bodies.radius(j) + way) wake(island_[order[j]]);
      }
    return asleep_ != before;
  }

  /// After a step of dt: islands whose bodies have been slower than `speed` for `duration` fall asleep. Returns whether
  /// there are any.
  [[nodiscard]] bool settle(World<Real, Dim>& world, const ContactList<Real, Dim>& contacts,
                            const std::vector<std::uint32_t>& order, const Real& dt, const Real& duration,
                            const Real& speed) {
    const std::size_t bodies = world.size();
    island_.resize(bodies, 0), rested_.resize(bodies, Real(0)), x_.resize(bodies), force_.resize(bodies);
    leader_.resize(bodies);
    std::iota(leader_.begin(), leader_.end(), 0u);
    for (std::size_t i = 0; i < bodies; ++i) {
      const Real rim = world.radius[i] * world.radius[i] * squared(world.spin[i]);
      rested_[i] = squared(world.velocity[i]) + rim < speed * speed ? rested_[i] + dt : Real(0);
    }
    contacts.for_each_touching([&](std::uint32_t k, std::uint32_t other, bool is_wall, const Real&) {
      if (!is_wall) join(world, order[k], order[other]);
    });
    for (const Spring<Real, Dim>& spring : world.springs) {
      const auto* b = std::get_if<BodyHandle>(&spring.b);
      if (b && world.contains(spring.a) && world.contains(*b)) join(world, world.index(spring.a), world.index(*b));
    }
    // The leader of an island keeps the shortest time at rest of its bodies.
    for (std::size_t i = 0; i < bodies; ++i) {
      const std::size_t leader = leader_of(i);
      rested_[leader] = std::min(rested_[leader], rested_[i]);
    }
    const std::size_t before = asleep_;
    const bool has_forces = !only_gravity(world);
    for (std::size_t i = 0; i < bodies; ++i) {
      if (world.is_fixed(i) || island_[i] != 0 || !(rested_[leader_of(i)] >= duration)) continue;
      island_[i] = first_free_ + static_cast<std::uint32_t>(leader_of(i));
      world.velocity[i] = {};
      world.spin[i] = {};
      x_[i] = world.position[i];
      ++asleep_;
    }
    if (asleep_ == before) return false;
    first_free_ += static_cast<std::uint32_t>(bodies);
    if (first_free_ > nowhere / 2) wake_all(), first_free_ = 1;  // numbers begin anew, once in a very long time
    remember_forces(world, has_forces);
    return true;
  }

  template <class Archive>
  void transfer(Archive& archive) {
    archive(island_), archive(rested_), archive(x_), archive(force_), archive(gravity_), archive(first_free_);
    asleep_ =
        static_cast<std::size_t>(std::ranges::count_if(island_, [](std::uint32_t island) { return island != 0; }));
  }
  [[nodiscard]] bool fits(std::size_t bodies) const {
    const auto fits = [&](const auto& array) { return array.size() == island_.size(); };
    return (island_.empty() || island_.size() == bodies) && fits(rested_) && fits(x_) && fits(force_);
  }

  [[nodiscard]] std::size_t memory() const {
    return (island_.capacity() + leader_.capacity()) * sizeof(std::uint32_t) + rested_.capacity() * sizeof(Real) +
           (x_.capacity() + force_.capacity() + force_now_.capacity()) * sizeof(V);
  }

 private:
  void wake(std::uint32_t island) {
    for (std::size_t i = 0; i < island_.size(); ++i) {
      if (island_[i] != island) continue;
      island_[i] = 0;
      rested_[i] = Real(0);
      --asleep_;
    }
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

  std::vector<std::uint32_t> island_, leader_;  // island: 0 of those awake
  std::vector<Real> rested_;
  std::vector<V> x_, force_, force_now_;  // of those asleep
  V gravity_{};
  std::uint32_t first_free_ = 1;
  std::size_t asleep_ = 0;
};

}  // namespace continuo
