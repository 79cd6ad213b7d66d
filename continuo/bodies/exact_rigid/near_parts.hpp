// The pairs of convex parts, and of parts and walls, that may meet before a body leaves the room that it had when the
// pairs were listed.
#pragma once
#include <algorithm>
#include <cmath>
#include <compare>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include <continuo/bodies/bounds/bounds_tree.hpp>
#include <continuo/bodies/exact_rigid/joint_constraints.hpp>
#include <continuo/bodies/exact_rigid/separation.hpp>
#include <continuo/bodies/rigid_stepping/rigid_pairs.hpp>
#include <continuo/bodies/support/crowd.hpp>

namespace continuo {

/// Two parts by their numbers, or wall a and part b.
struct NearPair {
  bool is_wall = false;
  std::uint32_t a = 0, b = 0;
  friend auto operator<=>(const NearPair&, const NearPair&) = default;
  template <class Archive>
  void transfer(Archive& archive) {
    archive(is_wall), archive(a), archive(b);
  }
};

template <class Real, int Dim>
class NearParts {
 public:
  using V = Vector<Real, Dim>;
  using Body = ExactBody<Real, Dim>;

  using Joints = std::span<const ActingJoint<Real, Dim>>;

  /// Takes the parts of all bodies, and the pairs of bodies that joints, among them `broken` ones, keep from colliding.
  void begin(const World<Real, Dim>& world, Joints joints, Joints broken) {
    parts_.clear(), balls_.clear(), apart_.clear(), pairs_.clear();
    balls_.resize(world.size());
    for (std::uint32_t i = 0; i < world.size(); ++i) {
      if (const Solid<Real, Dim>* const solid = world.solid(i)) {
        for (const SolidPart<Real, Dim>& part : solid->parts)
          parts_.push_back({.convex = &part.convex, .in_body = part.in_solid, .body = i});
        continue;
      }
      balls_[i].core.corners = {V{}};
      balls_[i].rounding = balls_[i].reach = world.radius[i];
      parts_.push_back({.convex = &balls_[i], .body = i});
    }
    for (const Joints all : {joints, broken})
      for (const auto& joint : all)
        if (!joint.joint.collide) apart_.emplace_back(std::min(joint.a, joint.b), std::max(joint.a, joint.b));
    std::ranges::sort(apart_);
  }
  /// Two bodies may collide though a joint, by now broken, connected them; for the next list.
  void let_meet(std::uint32_t a, std::uint32_t b) {
    const auto at = std::ranges::lower_bound(apart_, std::pair(std::min(a, b), std::max(a, b)));
    if (at != apart_.end() && *at == std::pair(std::min(a, b), std::max(a, b))) apart_.erase(at);
  }
  [[nodiscard]] std::span<const ExactPart<Real, Dim>> parts() const { return parts_; }
  /// In increasing order.
  [[nodiscard]] std::span<const NearPair> pairs() const { return pairs_; }
  /// The numbers of the pairs of a body.
  [[nodiscard]] std::span<const std::uint32_t> pairs_of(std::uint32_t body) const { return pairs_of_[body]; }

  /// An error where there are too many pairs, of which the list has one more than there may be.
  [[nodiscard]] Status check_number() const { return check_crowd(pairs_.size(), parts_.size()); }

  /// Lists the pairs anew. Rooms let the bodies move by about half of their size.
  void list(const World<Real, Dim>& world, std::span<const Body> bodies, const Real& now) {
    const std::size_t n = bodies.size();
    way_.assign(n, Real(0)), since_.assign(n, now), speed_.assign(n, Real(0)), room_.resize(n);
    Real speeds(0), sizes(0);
    for (std::size_t i = 0; i < n; ++i) {
      speed_[i] = length(bodies[i].v) + length(bodies[i].spin) * world.radius[i];
      if (!bodies[i].is_fixed()) speeds += speed_[i], sizes += world.radius[i];
    }
    const Real duration = speeds > Real(0) ? sizes / (2 * speeds) : Real(0);
    for (std::size_t i = 0; i < n; ++i) room_[i] = world.radius[i] / 8 + speed_[i] * duration;
    rooms_.clear(), pairs_.clear();
    for (const auto& part : parts_)
      rooms_.push_back(grown(bounds_of(*part.convex, part.pose(bodies[part.body])), room_[part.body]));
    tree_.build(rooms_);
    const std::size_t most = most_near_pairs(parts_.size());
    tree_.for_each_pair([&](std::uint32_t i, std::uint32_t j) {
      const std::uint32_t a = parts_[i].body, b = parts_[j].body;
      if (pairs_.size() <= most && a != b && world.collide(a, b) &&
          !std::ranges::binary_search(apart_, std::pair(std::min(a, b), std::max(a, b))))
        pairs_.push_back({.a = i, .b = j});
    });
    for (std::uint32_t i = 0; i < parts_.size(); ++i)
      if (!bodies[parts_[i].body].is_fixed()) add_walls(world, i);
    std::ranges::sort(pairs_);
    pairs_of_.assign(n, {});
    for (std::uint32_t p = 0; p < pairs_.size(); ++p) {
      if (!pairs_[p].is_wall) pairs_of_[parts_[pairs_[p].a].body].push_back(p);
      pairs_of_[parts_[pairs_[p].b].body].push_back(p);
    }
  }
  /// The time until which a body surely stays in its room, if from now on no point of it is faster than `speed`.
  [[nodiscard]] Real leaves_at(std::uint32_t body, const Real& now, const Real& speed) {
    way_[body] += speed_[body] * (now - since_[body]);
    since_[body] = now, speed_[body] = speed;
    const Real left = std::max(Real(room_[body] - way_[body]), Real(0));
    return speed > Real(0) ? now + left / speed : std::numeric_limits<Real>::infinity();
  }

 private:
  void add_walls(const World<Real, Dim>& world, std::uint32_t part) {
    const auto walls = world.walls();
    const V centre = (rooms_[part].lower + rooms_[part].upper) * Real(0.5), half = rooms_[part].upper - centre;
    for (std::uint32_t k = 0; k < walls.size(); ++k) {
      Real reach(0), side = dot(walls[k].normal, centre) - walls[k].offset;
      for (std::size_t axis = 0; axis < Dim; ++axis) reach += std::abs(walls[k].normal[axis]) * half[axis];
      if (walls[k].thin) side = std::abs(side);
      if (side <= reach) pairs_.push_back({.is_wall = true, .a = k, .b = part});
    }
  }

  std::vector<ExactPart<Real, Dim>> parts_;
  std::vector<Convex<Real, Dim>> balls_;  // by bodies
  std::vector<std::pair<std::uint32_t, std::uint32_t>> apart_;
  std::vector<Bounds<Real, Dim>> rooms_;
  std::vector<NearPair> pairs_;
  std::vector<std::vector<std::uint32_t>> pairs_of_;
  std::vector<Real> way_, since_, speed_, room_;  // of bodies: the way since the list, at most
  BoundsTree<Real, Dim> tree_;
};

}  // namespace continuo
