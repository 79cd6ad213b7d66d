// The contacts of a step: those pairs of parts whose surfaces are near, with the impulses of the last step.
#pragma once
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
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

/// What is asked of all contacts most often, in few bytes.
struct ContactHead {
  std::uint32_t a = 0, b = 0;  // bodies
  std::uint8_t points = 0;
  bool has_restitution = false;
  friend bool operator==(const ContactHead&, const ContactHead&) = default;
};
template <class Real, int Dim>
[[nodiscard]] ContactHead head_of(const PartContact<Real, Dim>& found) {
  return {found.a, found.b, static_cast<std::uint8_t>(found.contact.size), found.contact.restitution > Real(0)};
}

template <class Real, int Dim>
class RigidContacts {
 public:
  using V = Vector<Real, Dim>;

  /// Finds the contacts of all pairs, where `is_active(a, b)` tells whether one of the bodies is awake; contacts of
  /// others stay as they are. The walls are the last of the bodies. The impulses of contacts may be elsewhere:
  /// impulses.take_impulses(number, contact) gives one its own before it changes, several at once, and
  /// impulses.take_all_impulses(contacts) all of them before they become others.
  template <class IsActive, class Impulses>
  void find(ThreadTeam& team, const World<Real, Dim>& world, const RigidPairs<Real, Dim>& pairs,
            std::span<const RigidBody<Real, Dim>> bodies, const Real& step, IsActive&& is_active, Impulses& impulses) {
    if (!world.meshes().empty() || !are_apart_ || pairs.first_mesh() != first_mesh_)
      impulses.take_all_impulses(contacts_);
    set_mesh_contacts_apart(pairs.first_mesh());
    have_other_heads_ |= heads_.size() != contacts_.size();
    heads_.resize(contacts_.size()), separations_.resize(contacts_.size());
    take_materials(world);
    blocks_.resize(std::clamp<std::size_t>(pairs.pairs().size() / 256, 1, 1024));
    team.share(blocks_.size(), [&](std::size_t k) {
      begin_block(k, pairs.pairs());
      find_in_block(world, pairs, bodies, step, is_active, impulses, k);
    });
    take_blocks(team, impulses);
    without_meshes_ = contacts_.size();
    if (!world.meshes().empty()) find_at_meshes(team, world, pairs, bodies, step, is_active);
  }
  /// One for each pair of parts, or of a part and a wall, that are near, in the order of the pairs; then those with
  /// meshes.
  [[nodiscard]] std::span<PartContact<Real, Dim>> all() { return contacts_; }
  [[nodiscard]] std::span<const PartContact<Real, Dim>> all() const { return contacts_; }
  /// The same, since the contacts were found.
  [[nodiscard]] std::span<const ContactHead> heads() const { return heads_; }
  /// The separations of the points of those that are active, unless a head has changed.
  using Separations = std::array<Real, RigidContact<Real, Dim>::most_points>;
  [[nodiscard]] std::span<const Separations> separations() const { return separations_; }
  /// Whether a head has changed since this was last asked, as it rarely does in a heap at rest.
  [[nodiscard]] bool take_change_of_heads() { return std::exchange(have_other_heads_, false); }
  /// Those of parts and walls.
  [[nodiscard]] std::span<const PartContact<Real, Dim>> without_meshes() const { return all().first(without_meshes_); }
  /// The shapes of bodies have changed: no points are carried along, see `follow`.
  void find_anew() {
    for (PartContact<Real, Dim>& found : contacts_) found.contact.margin = -std::numeric_limits<Real>::infinity();
  }
  void clear() { contacts_.clear(), without_meshes_ = 0, are_apart_ = false; }
  /// Contacts with their impulses; the bodies are below `bodies`.
  template <class Archive>
  void transfer(Archive& archive, std::size_t bodies) {
    const auto is_near = [](const PartContact<Real, Dim>& found) { return found.contact.size > 0; };
    auto count = static_cast<std::uint64_t>(std::ranges::count_if(contacts_, is_near));
    archive(count);
    if constexpr (Archive::reads) {
      if (count > archive.left()) return archive.fail("a list longer than the bytes that are left");
      are_apart_ = false;
      materials_ = {};
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
  [[nodiscard]] std::size_t memory() const {
    return (contacts_.capacity() + merged_.capacity()) * sizeof(PartContact<Real, Dim>) +
           heads_.capacity() * sizeof(ContactHead) + separations_.capacity() * sizeof(Separations);
  }

 private:
  template <class Archive>
  static void transfer_contact(Archive& archive, RigidContact<Real, Dim>& contact) {
    auto size = static_cast<std::uint8_t>(contact.size);
    archive(size), archive(contact.normal), archive(contact.friction), archive(contact.restitution);
    archive(contact.normal_in_a), archive(contact.margin), archive(contact.found_at.centre);
    for (auto& axis : contact.found_at.axes.columns) archive(axis);
    for (auto& axis : contact.held_axes.columns) archive(axis);
    if constexpr (Archive::reads) contact.size = size;
    if (contact.size > contact.points.size()) return;
    for (auto& point : contact.all()) {
      archive(point.arm_a), archive(point.arm_b), archive(point.local_a), archive(point.local_b);
      archive(point.separation), archive(point.approach), archive(point.impulse), archive(point.friction);
      archive(point.separation_when_found), archive(point.local_apart);
      archive(point.greatest_impulse), archive(point.feature);
    }
  }
  /// The contacts of a part of the list of pairs.
  struct Block {
    std::size_t first_pair = 0, last_pair = 0;  // up to the one before the last
    std::size_t first = 0, last = 0;            // contacts of before, likewise; those that are lost have no points
    std::size_t lost = 0, place = 0;            // how many are; where the contacts of now begin
    bool has_other_heads = false;               // among those of before that are left
    std::vector<PartContact<Real, Dim>> born;

    [[nodiscard]] std::size_t size() const { return last - first - lost + born.size(); }
  };
  /// Those with meshes, of which a pair can have several, are found anew in each step.
  void set_mesh_contacts_apart(std::uint32_t first_mesh) {
    mesh_before_.clear();
    if (are_apart_ && first_mesh == first_mesh_ && contacts_.size() == without_meshes_) return;
    are_apart_ = true, first_mesh_ = first_mesh;
    const auto is_at_mesh = [&](const PartContact<Real, Dim>& found) { return found.parts.b >= first_mesh; };
    std::ranges::copy_if(contacts_, std::back_inserter(mesh_before_), is_at_mesh);
    std::erase_if(contacts_, is_at_mesh);
    // Walls that have been added have numbers that were those of meshes.
    if (!std::ranges::is_sorted(contacts_, {}, &PartContact<Real, Dim>::parts))
      std::ranges::sort(contacts_, {}, &PartContact<Real, Dim>::parts);
  }
  /// All contacts of before are in one block, whether their pairs are still there or not.
  void begin_block(std::size_t k, std::span<const PartPair> pairs) {
    Block& block = blocks_[k];
    const auto first_pair = [&](std::size_t of) { return pairs.size() * of / blocks_.size(); };
    const auto first_contact = [&](std::size_t of) -> std::size_t {
      if (of == 0) return 0;
      if (of == blocks_.size()) return contacts_.size();
      const auto at = std::ranges::lower_bound(contacts_, pairs[first_pair(of)], {}, &PartContact<Real, Dim>::parts);
      return static_cast<std::size_t>(at - contacts_.begin());
    };
    block.first_pair = first_pair(k), block.last_pair = first_pair(k + 1);
    block.first = first_contact(k), block.last = first_contact(k + 1);
    block.lost = 0, block.has_other_heads = false;
    block.born.clear();
  }
  template <class IsActive, class Impulses>
  void find_in_block(const World<Real, Dim>& world, const RigidPairs<Real, Dim>& pairs,
                     std::span<const RigidBody<Real, Dim>> bodies, const Real& step, IsActive&& is_active,
                     Impulses& impulses, std::size_t k) {
    Block& block = blocks_[k];
    std::size_t old = block.first;
    const auto take = [&](PartContact<Real, Dim>& contact) {
      const auto number = static_cast<std::size_t>(&contact - contacts_.data());
      if (number < contacts_.size()) impulses.take_impulses(number, contact.contact);  // it is none of the new ones
    };
    const auto lose = [&](PartContact<Real, Dim>& contact) { contact.contact.size = 0, ++block.lost; };
    for (const PartPair& pair : pairs.pairs().subspan(block.first_pair, block.last_pair - block.first_pair)) {
      if (pair.b >= first_mesh_) continue;
      while (old < block.last && contacts_[old].parts < pair) lose(contacts_[old++]);
      const bool is_old = old < block.last && contacts_[old].parts == pair;
      PartContact<Real, Dim>* const before = is_old ? &contacts_[old++] : nullptr;
      const auto [a, b] = bodies_of(pair, world, pairs);
      if (before) {
        before->a = a, before->b = b;
        if (have_other_materials_) take(*before), combine_materials(world, *before);
      }
      if (!is_active(a, b)) {
        if (before) note_head(*before, block);
        continue;
      }
      // Most of those that are not near are apart by both margins, which are known.
      const bool may_have_any = may_be_near(pair, pairs);
      const Real margin = may_have_any ? margin_of(pair, pairs, step) : Real(0);
      if (!may_have_any || !may_be_near(pair, pairs, margin)) {
        if (before) lose(*before);
        continue;
      }
      if (before) {
        update(world, pairs, bodies, margin, *before, take);
        note_head(*before, block);
        if (before->contact.size == 0) ++block.lost;
        continue;
      }
      const Manifold<Real, Dim> touching = ordered_manifold(world, pairs, bodies, pair, margin);
      if (touching.size == 0) continue;
      PartContact<Real, Dim>& born =
          block.born.emplace_back(PartContact<Real, Dim>{.parts = pair, .a = a, .b = b, .contact = {}});
      renew(born.contact, touching, pairs.placed(pair.a).pose, margin, bodies[a], bodies[b]);
      take_rounding(pairs, born);
      combine_materials(world, born);
    }
    while (old < block.last) lose(contacts_[old++]);
  }
  void note_head(const PartContact<Real, Dim>& of, Block& block) {
    ContactHead& head = heads_[static_cast<std::size_t>(&of - contacts_.data())];
    const ContactHead now = head_of(of);
    block.has_other_heads |= head != now;
    head = now;
    const std::size_t number = static_cast<std::size_t>(&of - contacts_.data());
    for (std::size_t i = 0; i < of.contact.size; ++i) separations_[number][i] = of.contact.points[i].separation;
  }
  /// What frictions and restitutions are combined from is most often what it was in the last step.
  void take_materials(const World<Real, Dim>& world) {
    std::vector<Material<Real>> of_walls;
    for (const Wall<Real, Dim>& wall : world.walls()) of_walls.push_back(wall.material);
    have_other_materials_ = world.combine_rule != materials_.rule || of_walls != materials_.of_walls ||
                            !std::ranges::equal(world.material, materials_.of_bodies);
    if (have_other_materials_)
      materials_ = {world.combine_rule, {world.material.begin(), world.material.end()}, std::move(of_walls)};
  }
  static void combine_materials(const World<Real, Dim>& world, PartContact<Real, Dim>& found) {
    const Material<Real>&of_a = world.material[found.a],
          &of_b = found.b < world.size() ? world.material[found.b] : world.walls()[found.b - world.size()].material;
    found.contact.friction = combined(world.combine_rule.friction, of_a.friction, of_b.friction);
    found.contact.restitution = combined(world.combine_rule.restitution, of_a.restitution, of_b.restitution);
  }
  [[nodiscard]] static std::pair<std::uint32_t, std::uint32_t> bodies_of(const PartPair& pair,
                                                                         const World<Real, Dim>& world,
                                                                         const RigidPairs<Real, Dim>& pairs) {
    const auto size = static_cast<std::uint32_t>(pairs.parts().size());
    return {pairs.placed(pair.a).body,
            pair.b < size ? pairs.placed(pair.b).body : static_cast<std::uint32_t>(world.size()) + (pair.b - size)};
  }
  [[nodiscard]] static Real margin_of(const PartPair& pair, const RigidPairs<Real, Dim>& pairs, const Real& step) {
    if (pair.b >= pairs.parts().size()) return pairs.placed(pair.a).margin;
    return pairs.margin_between(pair, step);
  }
  /// False where two parts are farther apart than where they may have a contact.
  /// @{
  [[nodiscard]] static bool may_be_near(const PartPair& pair, const RigidPairs<Real, Dim>& pairs) {
    if (pair.b >= pairs.parts().size()) return true;
    return !are_apart(pairs.placed(pair.a).bounds, pairs.placed(pair.b).bounds);
  }
  [[nodiscard]] static bool may_be_near(const PartPair& pair, const RigidPairs<Real, Dim>& pairs, const Real& margin) {
    if (pair.b >= pairs.parts().size()) return true;
    const PlacedPart<Real, Dim>&a = pairs.placed(pair.a), &b = pairs.placed(pair.b);
    return !are_apart(a.bounds, b.bounds, a.margin + b.margin - margin);
  }
  /// @}
  /// Puts the contacts of before that are still there and the new ones into one list.
  template <class Impulses>
  void take_blocks(ThreadTeam& team, Impulses& impulses) {
    std::size_t size = 0;
    bool are_same = true;
    for (Block& block : blocks_) {
      block.place = size, size += block.size();
      are_same = are_same && block.lost == 0 && block.born.empty();
      have_other_heads_ |= block.has_other_heads;
    }
    have_other_heads_ |= !are_same;
    if (are_same) return;
    impulses.take_all_impulses(contacts_);
    // Contacts are most of the memory of a heap: what they are put into has hardly more room than they need.
    if (merged_.capacity() < size) {
      merged_ = {};
      merged_.reserve(size + size / 16);
    }
    merged_.resize(size), heads_.resize(size), separations_.resize(size);
    team.share(blocks_.size(), [this](std::size_t k) {
      Block& block = blocks_[k];
      auto next = block.born.begin();
      auto out = merged_.begin() + static_cast<std::ptrdiff_t>(block.place);
      for (const auto& before : std::span(contacts_).subspan(block.first, block.last - block.first)) {
        while (next != block.born.end() && next->parts < before.parts) *out++ = *next++;
        if (before.contact.size > 0) *out++ = before;
      }
      std::copy(next, block.born.end(), out);
      for (std::size_t at = block.place; at < block.place + block.size(); ++at) heads_[at] = head_of(merged_[at]);
      if (block.born.capacity() > 32) block.born = {};  // as where a heap begins
    });
    contacts_.swap(merged_);
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
    for (std::size_t k = heads_.size(); k < contacts_.size(); ++k) heads_.push_back(head_of(contacts_[k]));
    have_other_heads_ |= !mesh_before_.empty() || contacts_.size() > without_meshes_;
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
      PartContact<Real, Dim>& made =
          found.emplace_back(PartContact<Real, Dim>{pair, a, ground, old ? *old : RigidContact<Real, Dim>{}});
      renew(made.contact, touching, pose, margin, bodies[a], bodies[ground]);
      made.contact.rounding_a = part.rounding;
      made.contact.friction = both.friction, made.contact.restitution = both.restitution;
    });
  }
  /// Where a part touches another one, or a wall, in the frame of the part.
  [[nodiscard]] static Manifold<Real, Dim> manifold_of_pair(const World<Real, Dim>& world,
                                                            const RigidPairs<Real, Dim>& pairs,
                                                            std::span<const RigidBody<Real, Dim>> bodies,
                                                            const PartPair& pair, const Real& margin) {
    const auto parts = pairs.parts();
    const RigidPart<Real, Dim>& a = parts[pair.a];
    const PlacedPart<Real, Dim>& placed_a = pairs.placed(pair.a);
    const Pose<Real, Dim>& pose = placed_a.pose;
    if (pair.b >= parts.size()) {
      const Wall<Real, Dim> turned = facing(world.walls()[pair.b - parts.size()], bodies[a.body].x);
      const Plane<Real, Dim> plane{pose.local_direction(turned.normal),
                                   turned.offset - dot(turned.normal, pose.centre)};
      return manifold(*a.convex, plane, margin);
    }
    const RigidPart<Real, Dim>& b = parts[pair.b];
    const PlacedPart<Real, Dim>& placed_b = pairs.placed(pair.b);
    const Pose<Real, Dim> b_in_a = relative(pose, placed_b.pose);
    if (!a.is_box() || !b.is_box()) return manifold(*a.convex, *b.convex, b_in_a, margin);
    const Real size = std::min(placed_a.reach, placed_b.reach);
    return manifold_of_boxes(*a.convex, *b.convex, {a.half, b.half, b_in_a, size}, margin);
  }
  /// With its points in one order for all contacts of two bodies of space, that along a direction of body a to which
  /// few faces are square. Sweeps push the points one after the other: where neighbours go round their corners in
  /// different orders, a wall of boxes leans more, and overlaps by a fifth more while it settles.
  [[nodiscard]] static Manifold<Real, Dim> ordered_manifold(const World<Real, Dim>& world,
                                                            const RigidPairs<Real, Dim>& pairs,
                                                            std::span<const RigidBody<Real, Dim>> bodies,
                                                            const PartPair& pair, const Real& margin) {
    Manifold<Real, Dim> found = manifold_of_pair(world, pairs, bodies, pair, margin);
    if constexpr (Dim == 3) {
      const auto place = [](const ManifoldPoint<Real, Dim>& point) {
        return 9 * point.position[0] + 3 * point.position[1] + point.position[2];
      };
      if (pair.b < pairs.parts().size())
        std::ranges::sort(std::span(found.points).first(found.size), std::greater<>{}, place);
    }
    return found;
  }
  /// Calls take(found) before its points or its frame change.
  template <class Take>
  static void update(const World<Real, Dim>& world, const RigidPairs<Real, Dim>& pairs,
                     std::span<const RigidBody<Real, Dim>> bodies, const Real& margin, PartContact<Real, Dim>& found,
                     Take&& take) {
    const RigidBody<Real, Dim>&a = bodies[found.a], &b = bodies[found.b];
    RigidContact<Real, Dim>& contact = found.contact;
    if (may_follow(pairs, found)) {
      if (has_turned_far(contact, a)) take(found), turn_held_frame(contact, a);
      const Real reach_a = pairs.placed(found.parts.a).reach, reach_b = pairs.placed(found.parts.b).reach;
      if (follow(contact, margin, std::min(reach_a, reach_b), reach_a < reach_b, a, b)) return;
    }
    take(found);
    renew(contact, ordered_manifold(world, pairs, bodies, found.parts, margin), pairs.placed(found.parts.a).pose,
          margin, a, b);
    take_rounding(pairs, found);
  }
  /// Those with walls and of rounded parts are found anew in each step.
  [[nodiscard]] static bool may_follow(const RigidPairs<Real, Dim>& pairs, const PartContact<Real, Dim>& found) {
    const auto parts = pairs.parts();
    return found.contact.size > 0 && found.parts.b < parts.size() && parts[found.parts.a].rounding == Real(0) &&
           parts[found.parts.b].rounding == Real(0);
  }
  static void take_rounding(const RigidPairs<Real, Dim>& pairs, PartContact<Real, Dim>& found) {
    const auto parts = pairs.parts();
    found.contact.rounding_a = parts[found.parts.a].rounding;
    found.contact.rounding_b = found.parts.b < parts.size() ? parts[found.parts.b].rounding : Real(0);
  }
  /// What the materials of contacts with parts and walls were combined from.
  struct Materials {
    CombineRule rule{};
    std::vector<Material<Real>> of_bodies{}, of_walls{};
  };
  std::vector<PartContact<Real, Dim>> contacts_, merged_, mesh_before_;
  std::vector<ContactHead> heads_;        // of the contacts
  std::vector<Separations> separations_;  // likewise
  bool have_other_heads_ = true;          // see take_change_of_heads
  Materials materials_;
  bool have_other_materials_ = true;  // since the last step
  std::size_t without_meshes_ = 0;
  bool are_apart_ = false;        // whether those with meshes are known
  std::uint32_t first_mesh_ = 0;  // in pairs, then
  std::vector<Block> blocks_;
  std::vector<PartPair> at_mesh_;
  std::vector<std::vector<PartContact<Real, Dim>>> found_;  // at meshes
};

}  // namespace continuo
