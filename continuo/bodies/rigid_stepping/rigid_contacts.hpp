// The contacts of a step: those pairs of parts whose surfaces are near, with the impulses of the last step.
#pragma once
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <limits>
#include <ranges>
#include <span>
#include <utility>
#include <vector>

#include <continuo/bodies/meshes/mesh_manifolds.hpp>
#include <continuo/bodies/rigid_stepping/rigid_contact.hpp>
#include <continuo/bodies/rigid_stepping/rigid_pairs.hpp>
#include <continuo/bodies/support/thread_team.hpp>
#include <continuo/bodies/world.hpp>
#include <continuo/shapes/plane_manifold.hpp>

namespace continuo {

/// A contact of the parts of two bodies, or of one and a wall, which is body number `bodies + wall`, or of one and a
/// mesh, of which the body is the world itself. With a mesh, one part can have several contacts.
template <class Real, int Dim>
struct PartContact {
  PartPair parts;
  std::uint32_t a = 0, b = 0;  // bodies
  RigidContact<Real, Dim> contact;
};

template <class Real, int Dim>
class RigidContacts {
 public:
  using V = Vector<Real, Dim>;

  /// Finds the contacts of all pairs, which may be others than before, where `is_active(a, b)` tells whether one of the
  /// bodies is awake; contacts of others stay as they are. The walls are the last of the bodies. `are_others`: whether
  /// the pairs may be others than when this was last called.
  template <class IsActive>
  void find(ThreadTeam& team, const World<Real, Dim>& world, const RigidPairs<Real, Dim>& pairs, bool are_others,
            std::span<const RigidBody<Real, Dim>> bodies, const Real& step, IsActive&& is_active) {
    if (are_others || !is_of_pairs_ || contacts_.size() != without_meshes_ || !world.meshes().empty())
      take_pairs(pairs.pairs(), pairs.first_mesh());
    is_of_pairs_ = true;
    team.for_each(0, contacts_.size(), 32, [&](std::size_t from, std::size_t to) {
      for (std::size_t k = from; k < to; ++k) update(world, pairs, bodies, step, is_active, contacts_[k]);
    });
    without_meshes_ = contacts_.size();
    if (!world.meshes().empty()) find_at_meshes(team, world, pairs, bodies, step, is_active);
  }
  /// One for each pair of parts, or of a part and a wall, in the same order, without points where the two are not near;
  /// then those with meshes.
  [[nodiscard]] std::span<PartContact<Real, Dim>> all() { return contacts_; }
  [[nodiscard]] std::span<const PartContact<Real, Dim>> all() const { return contacts_; }
  /// Those of parts and walls.
  [[nodiscard]] std::span<const PartContact<Real, Dim>> without_meshes() const { return all().first(without_meshes_); }
  /// The shapes of bodies have changed: no points are carried along, see `follow`.
  void find_anew() {
    for (PartContact<Real, Dim>& found : contacts_) found.contact.margin = -std::numeric_limits<Real>::infinity();
  }
  void clear() { contacts_.clear(), without_meshes_ = 0, is_of_pairs_ = false; }
  /// Contacts with their impulses; the bodies are below `bodies`.
  template <class Archive>
  void transfer(Archive& archive, std::size_t bodies) {
    const auto is_near = [](const PartContact<Real, Dim>& found) { return found.contact.size > 0; };
    auto count = static_cast<std::uint64_t>(std::ranges::count_if(contacts_, is_near));
    archive(count);
    if constexpr (Archive::reads) {
      if (count > archive.left()) return archive.fail("a list longer than the bytes that are left");
      is_of_pairs_ = false;
      contacts_.assign(static_cast<std::size_t>(count), {});
    }
    for (PartContact<Real, Dim>& found : contacts_) {
      if (!Archive::reads && !is_near(found)) continue;
      archive(found.parts.a), archive(found.parts.b), archive(found.a), archive(found.b);
      transfer_contact(archive, found.contact);
      if constexpr (Archive::reads)
        archive.expect(found.a < bodies && found.b < bodies && found.contact.size <= found.contact.points.size(),
                       "contacts of other bodies");
      if constexpr (Archive::reads)
        if (!archive.ok()) return;
    }
  }
  [[nodiscard]] std::size_t memory() const { return contacts_.capacity() * sizeof(PartContact<Real, Dim>); }

 private:
  template <class Archive>
  static void transfer_contact(Archive& archive, RigidContact<Real, Dim>& contact) {
    auto size = static_cast<std::uint8_t>(contact.size);
    archive(size), archive(contact.normal), archive(contact.friction), archive(contact.restitution);
    archive(contact.normal_in_a), archive(contact.margin), archive(contact.found_at.centre);
    for (auto& axis : contact.found_at.axes.columns) archive(axis);
    if constexpr (Archive::reads) contact.size = size;
    if (contact.size > contact.points.size()) return;
    for (auto& point : contact.all()) {
      archive(point.arm_a), archive(point.arm_b), archive(point.local_a), archive(point.local_b);
      archive(point.separation), archive(point.approach), archive(point.impulse), archive(point.friction);
      archive(point.separation_when_found);
      archive(point.greatest_impulse), archive(point.feature);
    }
  }
  /// Contacts of pairs that are there no more are dropped; those with meshes, of which a pair can have several, are
  /// kept apart.
  void take_pairs(std::span<const PartPair> pairs, std::uint32_t first_mesh) {
    const auto is_at_mesh = [&](const PartContact<Real, Dim>& found) { return found.parts.b >= first_mesh; };
    mesh_before_.clear();
    std::ranges::copy_if(contacts_, std::back_inserter(mesh_before_), is_at_mesh);
    std::erase_if(contacts_, is_at_mesh);
    auto solid = pairs | std::views::filter([&](const PartPair& pair) { return pair.b < first_mesh; });
    if (std::ranges::equal(contacts_, solid, {}, &PartContact<Real, Dim>::parts)) return;
    // Contacts are most of the memory of a heap: no more is kept than there are.
    const auto before = std::exchange(contacts_, {});
    contacts_.reserve(pairs.size());
    std::size_t old = 0;
    for (const PartPair& pair : solid) {
      while (old < before.size() && before[old].parts < pair) ++old;
      const bool is_kept = old < before.size() && before[old].parts == pair;
      contacts_.push_back(is_kept ? before[old] : PartContact<Real, Dim>{.parts = pair, .contact = {}});
    }
  }
  template <class IsActive>
  void find_at_meshes(ThreadTeam& team, const World<Real, Dim>& world, const RigidPairs<Real, Dim>& pairs,
                      std::span<const RigidBody<Real, Dim>> bodies, const Real& step, IsActive&& is_active) {
    at_mesh_.clear();
    for (const PartPair& pair : pairs.pairs())
      if (pair.b >= pairs.first_mesh()) at_mesh_.push_back(pair);
    found_.resize(std::clamp<std::size_t>(at_mesh_.size() / 16, 1, 1024));
    team.share(found_.size(), [&](std::size_t block) {
      found_[block].clear();
      for (std::size_t k = at_mesh_.size() * block / found_.size(); k < at_mesh_.size() * (block + 1) / found_.size();
           ++k)
        find_at_mesh(world, pairs, bodies, step, at_mesh_[k], is_active, found_[block]);
    });
    for (const auto& found : found_) contacts_.insert(contacts_.end(), found.begin(), found.end());
  }
  template <class IsActive>
  void find_at_mesh(const World<Real, Dim>& world, const RigidPairs<Real, Dim>& pairs,
                    std::span<const RigidBody<Real, Dim>> bodies, const Real& step, const PartPair& pair,
                    IsActive&& is_active, std::vector<PartContact<Real, Dim>>& found) const {
    const RigidPart<Real, Dim>& part = pairs.parts()[pair.a];
    const std::uint32_t a = part.body, ground = static_cast<std::uint32_t>(world.size() + world.walls().size());
    const auto before = std::ranges::equal_range(mesh_before_, pair, {}, &PartContact<Real, Dim>::parts);
    if (!is_active(a, ground)) return void(found.insert(found.end(), before.begin(), before.end()));
    const WorldMesh<Real, Dim>& mesh = world.meshes()[pair.b - pairs.first_mesh()];
    const Material<Real> both = combined(world.combine_rule, world.material[a], mesh.material);
    const Pose<Real, Dim> pose = part.pose(bodies[a]);
    const Real margin = RigidPairs<Real, Dim>::contact_margin(part, bodies[a], step);
    for_each_manifold(*part.convex, pose, *mesh.geometry, margin, [&](const Manifold<Real, Dim>& touching) {
      // The one before is that with nearly the same normal.
      const V normal = pose.axes * touching.normal;
      Real greatest = Real(0.9);
      const RigidContact<Real, Dim>* old = nullptr;
      for (const PartContact<Real, Dim>& one : before)
        if (const Real cosine = dot(one.contact.normal, normal); cosine > greatest)
          greatest = cosine, old = &one.contact;
      PartContact<Real, Dim>& made = found.emplace_back(PartContact<Real, Dim>{pair, a, ground, {}});
      made.contact = contact_of(touching, pose, margin, bodies[a], bodies[ground], old);
      made.contact.friction = both.friction, made.contact.restitution = both.restitution;
    });
  }
  template <class IsActive>
  static void update(const World<Real, Dim>& world, const RigidPairs<Real, Dim>& pairs,
                     std::span<const RigidBody<Real, Dim>> bodies, const Real& step, IsActive&& is_active,
                     PartContact<Real, Dim>& found) {
    const auto parts = pairs.parts();
    const RigidPart<Real, Dim>& part_a = parts[found.parts.a];
    const bool is_wall = found.parts.b >= parts.size();
    const std::uint32_t wall = is_wall ? found.parts.b - static_cast<std::uint32_t>(parts.size()) : 0;
    const std::uint32_t a = part_a.body;
    const std::uint32_t b = is_wall ? static_cast<std::uint32_t>(world.size()) + wall : parts[found.parts.b].body;
    found.a = a, found.b = b;
    if (!is_active(a, b)) return;
    const Pose<Real, Dim> pose = part_a.pose(bodies[a]);
    Real margin = RigidPairs<Real, Dim>::contact_margin(part_a, bodies[a], step);
    if (is_wall) {
      const Wall<Real, Dim> turned = facing(world.walls()[wall], bodies[a].x);
      const Plane<Real, Dim> plane{pose.local_direction(turned.normal),
                                   turned.offset - dot(turned.normal, pose.centre)};
      const Manifold<Real, Dim> touching = manifold(*part_a.convex, plane, margin);
      found.contact = contact_of(touching, pose, margin, bodies[a], bodies[b], &found.contact);
    } else {
      const RigidPart<Real, Dim>& part_b = parts[found.parts.b];
      margin += RigidPairs<Real, Dim>::contact_margin(part_b, bodies[b], step);
      const Pose<Real, Dim> pose_b = part_b.pose(bodies[b]);
      const Real reach = part_a.convex->reach + part_b.convex->reach + margin;
      if (squared(pose_b.centre - pose.centre) > reach * reach) {
        found.contact.size = 0;
        return;
      }
      const Real size = std::min(part_a.convex->reach, part_b.convex->reach);
      if (!follow(found.contact, margin, size, bodies[a], bodies[b])) {
        const Pose<Real, Dim> b_in_a = relative(pose, pose_b);
        const Manifold<Real, Dim> touching =
            part_a.is_box() && part_b.is_box()
                ? manifold_of_boxes(*part_a.convex, *part_b.convex, {part_a.half, part_b.half, b_in_a}, margin)
                : manifold(*part_a.convex, *part_b.convex, b_in_a, margin);
        found.contact = contact_of(touching, pose, margin, bodies[a], bodies[b], &found.contact);
      }
    }
    if (found.contact.size == 0) return;
    const Material<Real>& of_b = is_wall ? world.walls()[wall].material : world.material[b];
    const Material<Real> both = combined(world.combine_rule, world.material[a], of_b);
    found.contact.friction = both.friction, found.contact.restitution = both.restitution;
  }
  std::vector<PartContact<Real, Dim>> contacts_, mesh_before_;
  std::size_t without_meshes_ = 0;
  bool is_of_pairs_ = false;  // whether there is one for each pair
  std::vector<PartPair> at_mesh_;
  std::vector<std::vector<PartContact<Real, Dim>>> found_;  // at meshes
};

}  // namespace continuo
