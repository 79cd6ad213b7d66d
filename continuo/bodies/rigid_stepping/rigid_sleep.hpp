// Which bodies sleep. The bodies of an island fall asleep together, once all have been slow for a while, and wake
// together: when one of them has been changed, or when a body that is faster than bodies at rest touches them.
#pragma once
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <continuo/bodies/rigid_stepping/rigid_contacts.hpp>
#include <continuo/bodies/rigid_stepping/rigid_islands.hpp>
#include <continuo/bodies/world.hpp>

namespace continuo {

template <class Real, int Dim>
class RigidSleep {
 public:
  using V = Vector<Real, Dim>;
  [[nodiscard]] bool is_asleep(std::size_t body) const { return body < group_.size() && group_[body] != 0; }
  [[nodiscard]] std::size_t asleep() const { return asleep_; }

  /// Before a step: wakes the groups of bodies whose place, velocity or force the caller has changed.
  void wake_changed(const World<Real, Dim>& world, std::span<const RigidBody<Real, Dim>> bodies) {
    if (asleep_ == 0) return;
    std::vector<std::uint32_t> waking;
    const bool is_other_gravity = world.gravity != gravity_;
    for (std::size_t i = 0; i < group_.size(); ++i) {
      if (group_[i] == 0) continue;
      const bool is_moved = world.position[i] != bodies[i].x || world.orientation[i] != bodies[i].orientation ||
                            world.velocity[i] != V{} || world.spin[i] != Spin<Real, Dim>{};
      if (is_moved || is_other_gravity || world.constant_force[i] != force_[i]) waking.push_back(group_[i]);
    }
    wake(waking);
  }
  /// Wakes the groups that awake bodies faster than `speed` touch. Returns whether there are any.
  bool wake_touched(std::span<const PartContact<Real, Dim>> contacts, std::span<const RigidBody<Real, Dim>> bodies,
                    std::span<const Real> reach, const Real& speed) {
    if (asleep_ == 0) return false;
    std::vector<std::uint32_t> waking;
    const auto is_fast = [&](std::uint32_t i) {
      const Real of_rim = length(bodies[i].spin) * (i < reach.size() ? reach[i] : Real(0));
      return length(bodies[i].v) + of_rim > speed;
    };
    for (const PartContact<Real, Dim>& contact : contacts) {
      if (contact.contact.size == 0) continue;
      if (is_asleep(contact.a) && !is_asleep(contact.b) && is_fast(contact.b)) waking.push_back(group_[contact.a]);
      if (is_asleep(contact.b) && !is_asleep(contact.a) && is_fast(contact.a)) waking.push_back(group_[contact.b]);
    }
    wake(waking);
    return !waking.empty();
  }
  /// After a step of dt: islands of which all bodies, `alone` bodies among them, have been slow for `duration` fall
  /// asleep. Their velocities are set to 0.
  void settle(World<Real, Dim>& world, const RigidIslands& islands, std::span<const std::uint32_t> alone,
              const Real& dt, const Real& duration, const Real& speed) {
    group_.resize(world.size(), 0), rested_.resize(world.size(), Real(0)), force_.resize(world.size());
    gravity_ = world.gravity;
    const auto is_rested = [&](std::uint32_t i) {
      const Real rim = length(world.spin[i]) * world.radius[i];
      rested_[i] = length(world.velocity[i]) + rim < speed ? rested_[i] + dt : Real(0);
      return rested_[i] >= duration;
    };
    const auto fall_asleep = [&](std::span<const std::uint32_t> bodies) {
      ++last_group_;
      for (const std::uint32_t i : bodies) {
        group_[i] = last_group_;
        world.velocity[i] = {}, world.spin[i] = {};
        force_[i] = world.constant_force[i];
      }
      asleep_ += bodies.size();
    };
    for (std::size_t k = 0; k < islands.size(); ++k) {
      bool are_rested = true;
      for (const std::uint32_t i : islands.bodies(k)) are_rested &= is_rested(i);
      if (are_rested) fall_asleep(islands.bodies(k));
    }
    for (const std::uint32_t& i : alone)
      if (is_rested(i) && world.gravity == V{}) fall_asleep(std::span(&i, 1));
  }
  template <class Archive>
  void transfer(Archive& archive) {
    archive(group_), archive(rested_), archive(force_), archive(gravity_), archive(last_group_);
    asleep_ = group_.size() - static_cast<std::size_t>(std::ranges::count(group_, 0u));
  }
  [[nodiscard]] bool fits(std::size_t bodies) const {
    return (group_.empty() || group_.size() == bodies) && rested_.size() == group_.size() &&
           force_.size() == group_.size();
  }

 private:
  void wake(std::vector<std::uint32_t>& groups) {
    if (groups.empty()) return;
    std::ranges::sort(groups);
    for (std::size_t i = 0; i < group_.size(); ++i) {
      if (group_[i] == 0 || !std::ranges::binary_search(groups, group_[i])) continue;
      group_[i] = 0, rested_[i] = Real(0);
      --asleep_;
    }
  }

  std::vector<std::uint32_t> group_;  // 0: awake
  std::vector<Real> rested_;          // for how long
  std::vector<V> force_;              // constant force when it fell asleep
  V gravity_{};
  std::uint32_t last_group_ = 0;
  std::size_t asleep_ = 0;
};

}  // namespace continuo
