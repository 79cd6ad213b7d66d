// The contacts of a step: those pairs of parts whose surfaces are near, with the impulses of the last step.
#pragma once
#include <algorithm>
#include <cstddef>
#include <cstdint>
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

  /// Finds the contacts of all pairs, where `is_active(a, b)` tells whether one of the bodies is awake; contacts of
  /// others stay as they are. The walls are the last of the bodies.
  template <class IsActive>
  void find(ThreadTeam& team, const World<Real, Dim>& world, const RigidPairs<Real, Dim>& pairs,
            std::span<const RigidBody<Real, Dim>> bodies, const Real& step, IsActive&& is_active) {
    before_.swap(contacts_);
    const auto all = pairs.pairs();
    const std::size_t blocks = std::clamp<std::size_t>(all.size() / 64, 1, 1024);
    found_.resize(blocks);
    team.share(blocks, [&](std::size_t block) {
      auto& found = found_[block];
      found.clear();
      for (std::size_t k = all.size() * block / blocks; k < all.size() * (block + 1) / blocks; ++k)
        find(world, pairs, bodies, step, all[k], is_active, found);
    });
    contacts_.clear();
    for (auto& found : found_) contacts_.insert(contacts_.end(), found.begin(), found.end());
  }
  [[nodiscard]] std::span<PartContact<Real, Dim>> all() { return contacts_; }
  [[nodiscard]] std::span<const PartContact<Real, Dim>> all() const { return contacts_; }
  void clear() { contacts_.clear(), before_.clear(); }
  /// Contacts with their impulses; the bodies are below `bodies`.
  template <class Archive>
  void transfer(Archive& archive, std::size_t bodies) {
    auto count = static_cast<std::uint64_t>(contacts_.size());
    archive(count);
    if constexpr (Archive::reads) {
      if (count > archive.left()) return archive.fail("a list longer than the bytes that are left");
      contacts_.assign(static_cast<std::size_t>(count), {});
    }
    for (PartContact<Real, Dim>& found : contacts_) {
      archive(found.parts.a), archive(found.parts.b), archive(found.a), archive(found.b);
      transfer_contact(archive, found.contact);
      if constexpr (Archive::reads)
        archive.expect(found.a < bodies && found.b < bodies && found.contact.size <= found.contact.points.size(),
                       "contacts of other bodies");
      if constexpr (Archive::reads)
        if (!archive.ok()) return;
    }
    if constexpr (Archive::reads)
      archive.expect(std::ranges::is_sorted(contacts_, {}, &PartContact<Real, Dim>::parts), "contacts out of order");
  }
  [[nodiscard]] std::size_t memory() const {
    return (contacts_.capacity() + before_.capacity()) * sizeof(PartContact<Real, Dim>);
  }

 private:
  template <class Archive>
  static void transfer_contact(Archive& archive, RigidContact<Real, Dim>& contact) {
    auto size = static_cast<std::uint8_t>(contact.size);
    archive(size), archive(contact.normal), archive(contact.friction), archive(contact.restitution);
    if constexpr (Archive::reads) contact.size = size;
    if (contact.size > contact.points.size()) return;
    for (auto& point : contact.all()) {
      archive(point.arm_a), archive(point.arm_b), archive(point.local_a), archive(point.local_b);
      archive(point.separation), archive(point.approach), archive(point.impulse), archive(point.friction);
      archive(point.greatest_impulse), archive(point.feature);
    }
  }
  template <class IsActive>
  void find(const World<Real, Dim>& world, const RigidPairs<Real, Dim>& pairs,
            std::span<const RigidBody<Real, Dim>> bodies, const Real& step, const PartPair& pair, IsActive&& is_active,
            std::vector<PartContact<Real, Dim>>& found) const {
    if (pair.b >= pairs.first_mesh()) return find_at_mesh(world, pairs, bodies, step, pair, is_active, found);
    const auto parts = pairs.parts();
    const RigidPart<Real, Dim>& part_a = parts[pair.a];
    const bool is_wall = pair.b >= parts.size();
    const std::uint32_t wall = is_wall ? pair.b - static_cast<std::uint32_t>(parts.size()) : 0;
    const std::uint32_t a = part_a.body;
    const std::uint32_t b = is_wall ? static_cast<std::uint32_t>(world.size()) + wall : parts[pair.b].body;
    const auto* const before = find_before(pair);
    if (!is_active(a, b)) {
      if (before) found.push_back(*before);
      return;
    }
    const Pose<Real, Dim> pose = part_a.pose(bodies[a]);
    Real margin = RigidPairs<Real, Dim>::contact_margin(part_a, bodies[a], step);
    Manifold<Real, Dim> touching;
    if (is_wall) {
      const Wall<Real, Dim> turned = facing(world.walls()[wall], bodies[a].x);
      touching = manifold(
          *part_a.convex,
          Plane<Real, Dim>{pose.local_direction(turned.normal), turned.offset - dot(turned.normal, pose.centre)},
          margin);
    } else {
      const RigidPart<Real, Dim>& part_b = parts[pair.b];
      margin += RigidPairs<Real, Dim>::contact_margin(part_b, bodies[b], step);
      const Pose<Real, Dim> pose_b = part_b.pose(bodies[b]);
      const Real reach = part_a.convex->reach + part_b.convex->reach + margin;
      if (squared(pose_b.centre - pose.centre) > reach * reach) return;
      touching = manifold(*part_a.convex, *part_b.convex, relative(pose, pose_b), margin);
    }
    if (touching.size == 0) return;
    PartContact<Real, Dim>& made = found.emplace_back(PartContact<Real, Dim>{pair, a, b, {}});
    made.contact = contact_of(touching, pose, bodies[a], bodies[b], before ? &before->contact : nullptr);
    const Material<Real>& of_b = is_wall ? world.walls()[wall].material : world.material[b];
    const Material<Real> both = combined(world.combine_rule, world.material[a], of_b);
    made.contact.friction = both.friction, made.contact.restitution = both.restitution;
  }
  template <class IsActive>
  void find_at_mesh(const World<Real, Dim>& world, const RigidPairs<Real, Dim>& pairs,
                    std::span<const RigidBody<Real, Dim>> bodies, const Real& step, const PartPair& pair,
                    IsActive&& is_active, std::vector<PartContact<Real, Dim>>& found) const {
    const RigidPart<Real, Dim>& part = pairs.parts()[pair.a];
    const std::uint32_t a = part.body, ground = static_cast<std::uint32_t>(world.size() + world.walls().size());
    const auto before = std::ranges::equal_range(before_, pair, {}, &PartContact<Real, Dim>::parts);
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
      made.contact = contact_of(touching, pose, bodies[a], bodies[ground], old);
      made.contact.friction = both.friction, made.contact.restitution = both.restitution;
    });
  }
  [[nodiscard]] const PartContact<Real, Dim>* find_before(const PartPair& pair) const {
    const auto at = std::ranges::lower_bound(before_, pair, {}, &PartContact<Real, Dim>::parts);
    return at != before_.end() && at->parts == pair ? &*at : nullptr;
  }

  std::vector<PartContact<Real, Dim>> contacts_, before_;
  std::vector<std::vector<PartContact<Real, Dim>>> found_;
};

}  // namespace continuo
