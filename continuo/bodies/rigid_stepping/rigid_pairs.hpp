// The pairs of convex parts of bodies that may touch within the next steps: those whose bounds, grown by some room,
// overlap. Only parts that have left their room are looked up again.
#pragma once
#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <numeric>
#include <span>
#include <utility>
#include <vector>

#include <continuo/bodies/bounds/bounds_tree.hpp>
#include <continuo/bodies/bounds/convex_bounds.hpp>
#include <continuo/bodies/bounds/sorted_bounds.hpp>
#include <continuo/bodies/meshes/static_mesh.hpp>
#include <continuo/bodies/rigid_stepping/rigid_body.hpp>
#include <continuo/bodies/support/crowd.hpp>
#include <continuo/bodies/support/thread_team.hpp>
#include <continuo/bodies/world.hpp>
#include <continuo/shapes/box_manifold.hpp>

namespace continuo {

/// A part of a body, and a part of another body, a wall or a static mesh, in this order.
struct PartPair {
  std::uint32_t a = 0, b = 0;  // parts, or b = number of parts + wall, or number of parts and walls + mesh
  friend auto operator<=>(const PartPair&, const PartPair&) = default;
};

/// A convex part of a body.
template <class Real, int Dim>
struct RigidPart {
  std::uint32_t body = 0;
  const Convex<Real, Dim>* convex = nullptr;
  Pose<Real, Dim> in_body{};
  Real reach{};  // of the convex body
  Real rounding{};
  Real inner_radius{};       // of a ball around the centre that is within the part
  Vector<Real, Dim> half{};  // the sides, of a box; 0 of others

  [[nodiscard]] bool is_box() const { return half[0] > Real(0); }

  [[nodiscard]] Pose<Real, Dim> pose(const RigidBody<Real, Dim>& of) const {
    return {of.x + of.axes * in_body.centre, of.axes * in_body.axes};
  }
};

/// A part at the beginning of a step: what all its pairs ask for, which is one line of the caches in the plane.
template <class Real, int Dim>
struct PlacedPart {
  Bounds<Real, Dim> bounds{};  // of where it has contacts
  Pose<Real, Dim> pose{};
  Vector<Real, Dim> velocity{};  // of its centre
  Spin<Real, Dim> spin{};
  Real reach{};
  Real margin{};  // of contacts, with whatever else
  std::uint32_t body = 0;
};

template <class Real, int Dim>
class RigidPairs {
 public:
  using V = Vector<Real, Dim>;

  /// Takes the parts of all bodies.
  void begin(const World<Real, Dim>& world) {
    parts_.clear(), balls_.clear(), rooms_.clear(), pairs_.clear(), solids_.clear();
    balls_.reserve(world.size());
    for (std::uint32_t i = 0; i < world.size(); ++i) {
      solids_.push_back(world.shared_solid(i));
      if (const Solid<Real, Dim>* const solid = world.solid(i)) {
        for (const SolidPart<Real, Dim>& part : solid->parts)
          parts_.push_back({i, &part.convex, part.in_solid, part.convex.reach, part.convex.rounding,
                            inner_radius(part.convex), half_sides(part.convex)});
        continue;
      }
      Convex<Real, Dim>& ball = balls_.emplace_back();
      ball.core.corners = {V{}};
      ball.rounding = ball.reach = world.radius[i];
      parts_.push_back({i, &ball, {}, ball.reach, ball.rounding, ball.rounding, {}});
    }
    least_inner_radius_ = std::numeric_limits<Real>::infinity();
    for (const RigidPart<Real, Dim>& part : parts_)
      least_inner_radius_ = std::min(least_inner_radius_, part.inner_radius);
    meshes_.clear();
    for (const WorldMesh<Real, Dim>& mesh : world.meshes()) meshes_.push_back(mesh.geometry);
    first_mesh_ = static_cast<std::uint32_t>(parts_.size() + world.walls().size());
    is_new_ = true;
  }
  /// The next update looks for all pairs; those bodies that may collide with no other are not looked up.
  void find_all(std::vector<std::uint8_t> has_partners) {
    has_partners_ = std::move(has_partners);
    is_new_ = true;
  }
  /// Whether the meshes of the world are still these.
  [[nodiscard]] bool has_meshes_of(const World<Real, Dim>& world) const {
    return std::ranges::equal(meshes_, world.meshes(), {}, {}, &WorldMesh<Real, Dim>::geometry);
  }
  /// The number of the first mesh in pairs.
  [[nodiscard]] std::uint32_t first_mesh() const { return first_mesh_; }
  /// Whether the bodies of the world still have these parts: the caller may have exchanged some.
  [[nodiscard]] bool is_of(const World<Real, Dim>& world) const {
    if (solids_.size() != world.size() || !has_meshes_of(world)) return false;
    for (std::size_t i = 0, ball = 0; i < solids_.size(); ++i) {
      if (solids_[i].get() != world.solid(i)) return false;
      if (!solids_[i] && balls_[ball++].rounding != world.radius[i]) return false;
    }
    return true;
  }
  /// All parts, by the numbers of their bodies.
  [[nodiscard]] std::span<const RigidPart<Real, Dim>> parts() const { return parts_; }
  /// Of all parts.
  [[nodiscard]] const Real& least_inner_radius() const { return least_inner_radius_; }
  /// A part as the last update has seen it.
  [[nodiscard]] const PlacedPart<Real, Dim>& placed(std::uint32_t part) const { return placed_[part]; }
  /// Surfaces of two parts that are nearer have a contact: as near as their motion against each other may bring them
  /// within the step, which is that of the smaller one's centre against the other body and its turn against it. Bodies
  /// that move along together, as in a drum, would else have contacts with all that is near. A part of what each may
  /// move alone is added: those ahead may be stopped within the step.
  [[nodiscard]] Real margin_between(const PartPair& pair, const Real& step) const {
    const PlacedPart<Real, Dim>&a = placed_[pair.a], &b = placed_[pair.b];
    const PlacedPart<Real, Dim>&small = a.reach < b.reach ? a : b, &large = a.reach < b.reach ? b : a;
    const V moved = large.velocity + turning(large.spin, V(small.pose.centre - large.pose.centre));
    const Real speed = length(V(small.velocity - moved));
    const Real turn = length(Spin<Real, Dim>(small.spin - large.spin)) * small.reach;
    const Real alone = a.margin + b.margin;
    return std::min(alone, (speed + turn) * step + (small.reach + large.reach) / 100 + alone * part_of_margin);
  }
  /// In increasing order.
  [[nodiscard]] std::span<const PartPair> pairs() const { return pairs_; }
  /// Brings the tree of all parts up to date.
  void update_tree() {
    if (!is_tree_stale_) return;
    tree_.size() == rooms_.size() && !tree_.rebuild_pays() && !is_new_ ? tree_.refit(rooms_) : tree_.build(rooms_);
    is_tree_stale_ = false;
  }
  /// Finds the parts of bodies that do not move.
  void find_still(std::span<const RigidBody<Real, Dim>> bodies) {
    still_before_.swap(still_);
    still_.clear();
    for (std::uint32_t i = 0; i < parts_.size(); ++i)
      if (bodies[parts_[i].body].is_fixed()) still_.push_back(i);
    // Where most parts are still, as those of bodies that sleep, and so others than before, the tree of all serves.
    if (2 * still_.size() > parts_.size()) {
      update_tree();
      return tree_of_still_.build({});
    }
    still_rooms_.clear();
    for (const std::uint32_t i : still_) still_rooms_.push_back(rooms_[i]);
    still_ == still_before_ ? tree_of_still_.refit(still_rooms_) : tree_of_still_.build(still_rooms_);
  }
  /// Those found last, in increasing order.
  [[nodiscard]] std::span<const std::uint32_t> still() const { return still_; }
  /// Calls visit(part) for all parts whose rooms overlap `box`. Each is looked at, unless the tree is up to date.
  template <class Visit>
  void for_each_overlap(const Bounds<Real, Dim>& box, Visit&& visit) const {
    if (!is_tree_stale_) return tree_.for_each_overlap(box, visit);
    for (std::uint32_t i = 0; i < parts_.size(); ++i)
      if (!are_apart(box, rooms_[i])) visit(i);
  }
  /// Calls visit(part) for those that are still and whose rooms overlap `box`, and perhaps for others.
  template <class Visit>
  void for_each_still(const Bounds<Real, Dim>& box, Visit&& visit) const {
    if (tree_of_still_.size() < still_.size()) return tree_.for_each_overlap(box, visit);
    tree_of_still_.for_each_overlap(box, [&](std::uint32_t k) { visit(still_[k]); });
  }
  [[nodiscard]] std::size_t memory() const {
    return parts_.capacity() * sizeof(parts_[0]) + pairs_.capacity() * sizeof(PartPair) + sorted_.memory() +
           tree_.memory() + tree_of_still_.memory() + placed_.capacity() * sizeof(placed_[0]) +
           rooms_.capacity() * sizeof(rooms_[0]) + balls_.capacity() * (sizeof(balls_[0]) + sizeof(V));
  }

  /// An error where there are too many pairs, of which the last update has not listed all.
  [[nodiscard]] Status check_number() const { return check_crowd(pairs_.size(), parts_.size()); }
  /// Brings the pairs up to date, where `collide(i, j)` tells whether bodies i and j may; it is called at once by
  /// several threads. Returns whether parts had left their rooms.
  template <class Collide>
  bool update(ThreadTeam& team, const World<Real, Dim>& world, std::span<const RigidBody<Real, Dim>> bodies,
              const Real& step, Collide&& collide) {
    find_movers(team, bodies, step);
    if (moved_.empty()) return false;
    is_tree_stale_ = true;
    const auto may_touch = [&](std::uint32_t i, std::uint32_t j) {
      return parts_[i].body != parts_[j].body && collide(parts_[i].body, parts_[j].body);
    };
    const bool may_meet = std::ranges::any_of(moved_, [&](std::uint32_t i) { return may_have_pairs(i); });
    // A search for all pairs has each once, one for those of the parts that have moved some of them twice.
    const bool are_all = may_meet && moved_.size() * 3 > parts_.size();
    if (are_all) pairs_.clear();
    if (!may_meet) {
      found_.assign(1, {});
    } else if (!sweep(team, are_all, may_touch)) {
      update_tree();
      are_all ? find_all_pairs(team, may_touch) : find_pairs_of_moved(team, may_touch);
    }
    is_new_ = false;
    for (const std::uint32_t i : moved_) add_walls(world, i);
    if (are_all)
      for (std::uint32_t i = 0; i < parts_.size(); ++i)
        if (!has_moved_[i]) add_walls(world, i);
    sort_new_pairs();
    if (world.may_collide)
      std::erase_if(new_pairs_, [&](const PartPair& pair) {
        return pair.b < parts_.size() && !world.may_collide(world, parts_[pair.a].body, parts_[pair.b].body);
      });
    take_new_pairs();
    return true;
  }

 private:
  [[nodiscard]] bool may_have_pairs(std::uint32_t part) const {
    return has_partners_.empty() || has_partners_[parts_[part].body] != 0;
  }
  /// Finds the pairs of all parts, or of those that have moved, in their order along an axis. False where that is
  /// slower than to look them up in the tree: there are few, or too many beside each other along the axis.
  template <class MayTouch>
  [[nodiscard]] bool sweep(ThreadTeam& team, bool are_all, MayTouch&& may_touch) {
    if (moved_.size() * 8 < parts_.size() || !sorted_.sort(rooms_, SortedBounds<Real, Dim>::most_compared))
      return false;
    const std::size_t most = most_near_pairs(parts_.size());
    const std::size_t blocks = std::clamp<std::size_t>(parts_.size() / 64, 1, 256);
    found_.resize(blocks + 1);
    std::atomic<bool> is_slow = false;
    team.share(blocks, [&](std::size_t k) {
      auto& found = found_[k];
      found.clear();
      const std::size_t from = parts_.size() * k / blocks, to = parts_.size() * (k + 1) / blocks;
      const auto visit = [&](std::uint32_t i, std::uint32_t j) {
        if ((are_all || has_moved_[i] || has_moved_[j]) && found.size() <= most && may_touch(i, j))
          found.push_back({std::min(i, j), std::max(i, j)});
      };
      if (!sorted_.for_each_pair(from, to, SortedBounds<Real, Dim>::most_of(to - from), visit)) is_slow = true;
    });
    found_.back().clear();
    return !is_slow;
  }
  template <class MayTouch>
  void find_all_pairs(ThreadTeam& team, MayTouch&& may_touch) {
    const std::size_t most = most_near_pairs(parts_.size());
    const auto searches = tree_.pair_searches(team.is_alone() ? 1 : 16 * team.threads());
    found_.resize(searches.size() + 1);
    team.share(searches.size(), [&](std::size_t k) {
      found_[k].clear();
      tree_.for_each_pair_of(searches[k], [&](std::uint32_t i, std::uint32_t j) {
        if (found_[k].size() <= most && may_touch(i, j)) found_[k].push_back({i, j});
      });
    });
    found_.back().clear();
  }
  template <class MayTouch>
  void find_pairs_of_moved(ThreadTeam& team, MayTouch&& may_touch) {
    const std::size_t most = most_near_pairs(parts_.size());
    const std::size_t blocks = std::clamp<std::size_t>(moved_.size() / 32, 1, 256);
    found_.resize(blocks + 1);
    team.share(blocks, [&](std::size_t k) {
      found_[k].clear();
      for (std::size_t n = moved_.size() * k / blocks; n < moved_.size() * (k + 1) / blocks; ++n) {
        const std::uint32_t i = moved_[n];
        tree_.for_each_overlap(rooms_[i], [&](std::uint32_t j) {
          const bool is_new = !has_moved_[j] || i < j;
          if (is_new && found_[k].size() <= most && may_touch(i, j))
            found_[k].push_back({std::min(i, j), std::max(i, j)});
        });
      }
    });
    found_.back().clear();
  }
  /// By counting: first by the second numbers, then, where equal ones keep their order, by the first.
  void sort_new_pairs() {
    unsorted_.clear();
    for (const auto& found : found_) unsorted_.insert(unsorted_.end(), found.begin(), found.end());
    new_pairs_.resize(unsorted_.size());
    distribute(unsorted_, &PartPair::b, first_mesh_ + meshes_.size(), new_pairs_);
    unsorted_.swap(new_pairs_);
    distribute(unsorted_, &PartPair::a, parts_.size(), new_pairs_);
  }
  /// Puts pairs into the order of one of their numbers, which are below `numbers`. Those of the same keep theirs.
  void distribute(std::span<const PartPair> pairs, std::uint32_t PartPair::* number, std::size_t numbers,
                  std::span<PartPair> sorted) {
    first_pair_.assign(numbers + 1, 0);
    for (const PartPair& pair : pairs) ++first_pair_[pair.*number + 1];
    std::partial_sum(first_pair_.begin(), first_pair_.end(), first_pair_.begin());
    for (const PartPair& pair : pairs) sorted[first_pair_[pair.*number]++] = pair;
  }
  /// Puts the new pairs among those of before of which no part has moved.
  void take_new_pairs() {
    if (pairs_.empty()) return pairs_.swap(new_pairs_);
    merged_.clear();
    merged_.reserve(pairs_.size() + new_pairs_.size());
    auto next = new_pairs_.begin();
    for (const PartPair& pair : pairs_) {
      if (has_moved_[pair.a] || (pair.b < parts_.size() && has_moved_[pair.b])) continue;
      while (next != new_pairs_.end() && *next < pair) merged_.push_back(*next++);
      merged_.push_back(pair);
    }
    merged_.insert(merged_.end(), next, new_pairs_.end());
    pairs_.swap(merged_);
  }
  [[nodiscard]] static Real inner_radius(const Convex<Real, Dim>& convex) {
    Real least = convex.core.faces.empty() ? Real(0) : convex.core.faces.front().offset;
    for (const Face<Real, Dim>& face : convex.core.faces) least = std::min(least, face.offset);
    return least + convex.rounding;
  }
  void find_movers(ThreadTeam& team, std::span<const RigidBody<Real, Dim>> bodies, const Real& step) {
    rooms_.resize(parts_.size()), has_moved_.resize(parts_.size()), placed_.resize(parts_.size());
    team.for_each(0, parts_.size(), 64, [&](std::size_t from, std::size_t to) {
      for (std::size_t i = from; i < to; ++i) has_moved_[i] = leaves_room(i, bodies, step);
    });
    moved_.clear();
    for (std::uint32_t i = 0; i < parts_.size(); ++i)
      if (has_moved_[i]) moved_.push_back(i);
  }
  /// Whether a part is not within its room; then it gets another one.
  [[nodiscard]] bool leaves_room(std::size_t i, std::span<const RigidBody<Real, Dim>> bodies, const Real& step) {
    const RigidPart<Real, Dim>& part = parts_[i];
    const RigidBody<Real, Dim>& body = bodies[part.body];
    const Pose<Real, Dim> pose = part.pose(body);
    const Real margin = contact_margin(part, body, step);
    const Bounds<Real, Dim> bounds = grown(bounds_at(part, pose), margin);
    placed_[i] = {bounds, pose, body.velocity_at(pose.centre - body.x), body.spin, part.reach, margin, part.body};
    // What has fallen asleep has moved in the step before.
    if (!is_new_ && united(rooms_[i], bounds) == rooms_[i]) return false;
    rooms_[i] = room(part, body, bounds, step);
    return true;
  }
  /// Room for some steps at the same velocity. What moves far in a step would leave it all the same: it gets little, as
  /// each pair costs in each step.
  [[nodiscard]] static Bounds<Real, Dim> room(const RigidPart<Real, Dim>& part, const RigidBody<Real, Dim>& body,
                                              const Bounds<Real, Dim>& bounds, const Real& step) {
    const Real reach = part.reach, turn = length(body.spin) * reach, speed = length(body.v);
    if ((speed + turn) * step > reach / 8) return grown(bounds, reach / 100);
    const Real duration = 2 * step;
    const Bounds<Real, Dim> around = grown(bounds, Real(0.12) * reach + turn * duration);
    const V way = body.v * duration;
    return united(around, {around.lower + way, around.upper + way});
  }
  [[nodiscard]] static Bounds<Real, Dim> bounds_of_box(const V& half, const Pose<Real, Dim>& pose) {
    V reach;
    for (std::size_t i = 0; i < Dim; ++i)
      for (std::size_t j = 0; j < Dim; ++j) reach[i] += std::abs(pose.axes[j][i]) * half[j];
    return {pose.centre - reach, pose.centre + reach};
  }
  void add_walls(const World<Real, Dim>& world, std::uint32_t i) {
    const auto walls = world.walls();
    if (world.is_fixed(parts_[i].body)) return;
    const V centre = (rooms_[i].lower + rooms_[i].upper) * Real(0.5), half = rooms_[i].upper - centre;
    for (std::uint32_t k = 0; k < walls.size(); ++k) {
      Real reach(0), side = dot(walls[k].normal, centre) - walls[k].offset;
      for (std::size_t axis = 0; axis < Dim; ++axis) reach += std::abs(walls[k].normal[axis]) * half[axis];
      // The side of a thin wall is that of the centre of the body, from which a part of a compound may be beyond it.
      if (walls[k].thin) side = std::abs(side) - length(parts_[i].in_body.centre);
      if (side <= reach) found_.back().push_back({i, static_cast<std::uint32_t>(parts_.size()) + k});
    }
    for (std::uint32_t k = 0; k < meshes_.size(); ++k)
      if (world.meshes()[k].collides(world.traits(parts_[i].body)) && overlap(rooms_[i], meshes_[k]->bounds()))
        found_.back().push_back({i, first_mesh_ + k});
  }

 public:
  [[nodiscard]] static Bounds<Real, Dim> bounds_at(const RigidPart<Real, Dim>& part, const Pose<Real, Dim>& pose) {
    return part.is_box() ? bounds_of_box(part.half, pose) : bounds_of(*part.convex, pose);
  }
  /// Bounds of where a part has contacts in a step that begins so. They are within its room.
  [[nodiscard]] static Bounds<Real, Dim> bounds_of_contacts(const RigidPart<Real, Dim>& part,
                                                            const RigidBody<Real, Dim>& body, const Real& step) {
    return grown(bounds_at(part, part.pose(body)), contact_margin(part, body, step));
  }
  /// Surfaces that are nearer than the sum of these of both parts have a contact.
  [[nodiscard]] static Real contact_margin(const RigidPart<Real, Dim>& part, const RigidBody<Real, Dim>& body,
                                           const Real& step) {
    const Real way = (length(body.v) + length(body.spin) * part.reach) * step;
    return std::min(way, part.reach / 2) + part.reach / 100;
  }

 private:
  static constexpr Real part_of_margin = Real(0.125);

  std::vector<RigidPart<Real, Dim>> parts_;
  std::vector<std::shared_ptr<const Solid<Real, Dim>>> solids_;       // of each body; the parts refer to them
  std::vector<std::shared_ptr<const StaticMesh<Real, Dim>>> meshes_;  // of the world
  std::uint32_t first_mesh_ = 0;
  std::vector<Convex<Real, Dim>> balls_;
  Real least_inner_radius_{};
  std::vector<Bounds<Real, Dim>> rooms_;
  std::vector<PlacedPart<Real, Dim>> placed_;
  std::vector<std::uint32_t> moved_;
  std::vector<std::uint8_t> has_moved_;     // each part
  std::vector<std::uint8_t> has_partners_;  // each body
  std::vector<PartPair> pairs_, new_pairs_, unsorted_, merged_;
  std::vector<std::vector<PartPair>> found_;  // the new ones, of each part of a search, and those with walls and meshes
  std::vector<std::size_t> first_pair_;       // of each number, while they are sorted
  std::vector<std::uint32_t> still_, still_before_;
  std::vector<Bounds<Real, Dim>> still_rooms_;
  SortedBounds<Real, Dim> sorted_;
  BoundsTree<Real, Dim> tree_, tree_of_still_;
  bool is_new_ = true, is_tree_stale_ = true;
};

}  // namespace continuo
