// The contacts of a step: those listed pairs that may touch in it, coloured and put into batches. No two contacts of a
// colour share a moving body, so that lanes and threads may solve them in any order, to the same bits. The impulses of
// a step are the start of the next one: they are kept by the places of the two bodies.
#pragma once
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include <continuo/bodies/contact_solver/contact_batches.hpp>
#include <continuo/bodies/contact_solver/contact_blocks.hpp>
#include <continuo/bodies/contact_solver/contact_step.hpp>
#include <continuo/bodies/time_stepping/contact_rows.hpp>
#include <continuo/bodies/time_stepping/kept_impulses.hpp>
#include <continuo/bodies/time_stepping/swept_bounds.hpp>
#include <continuo/bodies/world.hpp>

namespace continuo {

/// The partner of a body in a pair that may touch: the place of another body, or of a wall. Rows are sorted, with walls
/// last. A pair of two moving bodies is in the row of the lower place, a pair with a fixed body in the row of the
/// moving one.
struct ContactEntry {
  std::uint32_t other;
  std::uint32_t lane = nowhere;  // the lane in the batches of its kind that solves it
};
using ContactRows = Rows<ContactEntry>;

template <class Real, int Dim>
class ContactList {
 public:
  using V = Vector<Real, Dim>;
  static constexpr std::size_t width = lanes_at_once<Real>;

  ContactRows rows;
  ColouredBatches<Real, Dim> between_movers, with_fixed, with_wall;

  ContactBlocks blocks;

  /// Whether there are contacts that are neither within a block nor across the end of one.
  [[nodiscard]] bool has_rest() const {
    const auto& first = between_movers.groups[blocks.rest()].first;
    return first.front() < first.back();
  }
  /// Calls act(kind, batches, group) for a group of the contacts between moving bodies, see contact_blocks.hpp.
  template <class Act>
  void in_group(std::size_t group, Act&& act) {
    act_on<ContactKind::between_movers>(between_movers, group, act);
  }
  /// The same for the contacts of a block's bodies with fixed bodies and walls. Walls come last, since they yield
  /// least.
  template <class Act>
  void at_border(std::size_t block, Act&& act) {
    act_on<ContactKind::with_fixed>(with_fixed, block, act);
    act_on<ContactKind::with_wall>(with_wall, block, act);
  }

  /// The deepest overlap of two bodies, or of a body and a wall, among the listed pairs.
  [[nodiscard]] Real deepest_overlap(const SolverBodies<Real, Dim>& bodies,
                                     std::span<const Wall<Real, Dim>> walls) const {
    Real deepest(0);
    for (std::size_t k = 0; k < bodies.size(); ++k) {
      for (const ContactEntry& entry : rows.row(k)) {
        if (entry.other < bodies.size()) {
          const Real distance = length(bodies.x(entry.other) - bodies.x(k));
          deepest = std::max(deepest, bodies.radius(k) + bodies.radius(entry.other) - distance);
        } else {
          const Wall<Real, Dim> wall = facing(walls[entry.other - bodies.size()], bodies.x(k));
          deepest = std::max(deepest, bodies.radius(k) + wall.offset - dot(wall.normal, bodies.x(k)));
        }
      }
    }
    return deepest;
  }

  /// Saves the impulses of the batches before the rows change.
  void keep(ThreadTeam& team) {
    make_rows(team, rows.rows(), kept_, [&](std::uint32_t k, KeptImpulses<Real, Dim>& part) {
      for (const ContactEntry& entry : rows.row(k)) {
        if (entry.lane == nowhere) continue;
        const KeptContact contact = impulse_in_lane(entry, entry.lane, false);
        if (!(contact.normal > Real(0))) continue;
        part.entries.push_back({entry.other, contact.normal, contact.friction});
        if (resists_rolling(entry)) part.rolling.push_back(contact.rolling);
      }
    });
    kept_.fit();
    has_kept_ = true;
    for (auto* batches : {&between_movers, &with_fixed, &with_wall}) batches->before = {};
  }

  /// After `keep`: sets aside the impulses of contacts without a moving body, and takes back those of bodies that move
  /// again. number_at[k] is the number in the world of the body that was at place k when impulses were kept;
  /// moves(number) is its present state.
  template <class Moves>
  void exchange_with_resting(std::span<const std::uint32_t> number_at, const Moves& moves) {
    exchange_resting(number_at, moves, kept_, resting_);
  }
  [[nodiscard]] bool has_resting() const { return !resting_.empty(); }

  /// Puts the contacts that may touch into batches. combine_rule_of(a, b) gives the combined material of the bodies or
  /// walls at two places; it is called only where materials are special. place_before[k] is the place that the body at
  /// k had when impulses were kept; if it is empty, places are the same. reach_of[block] says how near the pairs of a
  /// block must be.
  template <class CombineRuleOf>
  void activate(ThreadTeam& team, const SolverBodies<Real, Dim>& bodies, std::span<const Wall<Real, Dim>> walls,
                const CombineRuleOf& combine_rule_of, bool has_special_material,
                std::span<const BlockSweptBounds<Real>> reach_of, std::span<const std::uint32_t> place_before) {
    between_movers.clear(blocks.groups()), with_fixed.clear(blocks.count), with_wall.clear(blocks.count);
    std::vector<std::uint8_t> has_rest(blocks.count, 0);
    const auto lane_before = std::make_unique_for_overwrite<std::uint32_t[]>(rows.entries.size());
    const auto lane_before_of = [&](const ContactEntry& entry) -> std::uint32_t& {
      return lane_before[static_cast<std::size_t>(&entry - rows.entries.data())];
    };
    team.share(blocks.count, [&](std::size_t block) {
      for (std::uint32_t k = blocks.first(block); k < blocks.last(block, rows.rows()); ++k)
        choose(k, bodies, walls, reach_of[block], lane_before_of);
      has_rest[block] = colour(block, bodies);
    });
    colour_rest(has_rest, bodies);
    for (auto* batches : {&between_movers, &with_fixed, &with_wall})
      batches->make_room(blocks, bodies, has_special_material);
    const auto before = [&](std::uint32_t k) { return k < place_before.size() ? place_before[k] : k; };
    const auto impulse_of = [&](std::uint32_t k, const ContactEntry& entry) {
      if (has_kept_) return impulse_kept(before(k), before(entry.other), !place_before.empty());
      const std::uint32_t lane = lane_before_of(entry);
      return lane == nowhere ? KeptContact{} : impulse_in_lane(entry, lane, true);
    };
    team.share(blocks.count, [&](std::size_t block) {
      for (std::uint32_t k = blocks.first(block); k < blocks.last(block, rows.rows()); ++k)
        fill_row(block, k, bodies, walls, combine_rule_of, impulse_of);
    });
    kept_ = {};
    has_kept_ = false;
  }

  /// Writes or reads the impulses that `keep` has saved.
  template <class Archive>
  void transfer_kept(Archive& archive) {
    archive(kept_);
    has_kept_ = true;
  }
  [[nodiscard]] bool kept_fits(std::size_t bodies, std::size_t world_walls) const {
    return kept_.fits(bodies, bodies + world_walls);
  }

  /// Calls visit(k, other, is_wall, impulse) for the contacts with a normal impulse in the last substep.
  template <class Visit>
  void for_each_touching(Visit&& visit) const {
    for (std::uint32_t k = 0; k < rows.rows(); ++k)
      for (const ContactEntry& entry : rows.row(k)) {
        if (entry.lane == nowhere) continue;
        const std::uint32_t lane = entry.lane & ~fixed_bit;
        const Real pressed = batches_of(entry, entry.lane).impulses[lane / width].normal.lane[lane % width];
        const auto bodies = static_cast<std::uint32_t>(rows.rows());
        const bool is_wall = entry.other >= bodies;
        if (pressed > Real(0)) visit(k, is_wall ? entry.other - bodies : entry.other, is_wall, pressed);
      }
  }

  [[nodiscard]] std::size_t memory() const {
    std::size_t sum = rows.memory() + kept_.memory() + resting_.capacity() * sizeof(resting_[0]);
    for (const auto* batches : {&between_movers, &with_fixed, &with_wall}) sum += batches->memory();
    return sum;
  }
  [[nodiscard]] std::size_t active() const {
    std::size_t sum = 0;
    for (const auto* batches : {&between_movers, &with_fixed, &with_wall}) sum += batches->contacts;
    return sum;
  }

 private:
  static constexpr std::uint32_t fixed_bit = 1u << 31;  // of an entry's lane: its batches are those with fixed bodies

  template <ContactKind kind, class Act>
  static void act_on(ColouredBatches<Real, Dim>& batches, std::size_t group, Act&& act) {
    const auto& first = batches.groups[group].first;
    if (first.front() < first.back()) act(std::integral_constant<ContactKind, kind>{}, batches, group);
  }

  [[nodiscard]] const ColouredBatches<Real, Dim>& batches_of(const ContactEntry& entry, std::uint32_t lane) const {
    if (entry.other >= rows.rows()) return with_wall;
    return lane & fixed_bit ? with_fixed : between_movers;
  }
  [[nodiscard]] ColouredBatches<Real, Dim>& batches_of(const ContactEntry& entry, std::uint32_t lane) {
    return const_cast<ColouredBatches<Real, Dim>&>(std::as_const(*this).batches_of(entry, lane));
  }
  template <int Size>
  [[nodiscard]] static Vector<Real, Size> in_lane(const Vector<StoredLanes<Real>, Size>& stored, std::size_t lane) {
    Vector<Real, Size> v;
    for (std::size_t axis = 0; axis < v.size(); ++axis) v[axis] = stored[axis].lane[lane];
    return v;
  }
  template <int Size>
  static void put_in_lane(const Vector<Real, Size>& v, Vector<StoredLanes<Real>, Size>& stored, std::size_t lane) {
    for (std::size_t axis = 0; axis < v.size(); ++axis) stored[axis].lane[lane] = v[axis];
  }

  [[nodiscard]] static Real come_closer(const V& rate, const BlockSweptBounds<Real>& reach) {
    using std::abs;
    Real sum(0);
    for (std::size_t axis = 0; axis < V::size(); ++axis) sum += abs(rate[axis]);
    return sum * reach.step + reach.extra;
  }

  // Until the batches are allocated, the lane of an entry encodes its colour and its number among the contacts of this
  // colour in its group.
  static constexpr std::uint32_t colour_shift = 25;
  static constexpr std::uint32_t last_colour = ColouredBatches<Real, Dim>::most_colours - 1;
  static constexpr std::uint32_t chosen = nowhere - 1;  // but without a colour yet

  /// The lowest colour that neither body of a contact has.
  [[nodiscard]] static std::uint32_t lowest_free(std::uint64_t used) {
    return std::min(static_cast<std::uint32_t>(std::countr_one(used)), last_colour);
  }
  [[nodiscard]] static std::uint32_t number(ColouredBatches<Real, Dim>& batches, std::size_t group,
                                            std::uint32_t colour) {
    return colour << colour_shift | batches.count[group][colour]++;
  }
  /// taken_by_a and taken_by_b are the colours of the contacts that each of the two moving bodies already has in this
  /// group.
  [[nodiscard]] std::uint32_t number(std::size_t group, std::uint64_t& taken_by_a, std::uint64_t& taken_by_b) {
    const std::uint32_t free = lowest_free(taken_by_a | taken_by_b);
    taken_by_a |= std::uint64_t{1} << free;
    taken_by_b |= std::uint64_t{1} << free;
    return number(between_movers, group, free);
  }
  /// Marks the entries of row k that may touch: their lane is no longer `nowhere`.
  template <class LaneBeforeOf>
  void choose(std::uint32_t k, const SolverBodies<Real, Dim>& bodies, std::span<const Wall<Real, Dim>> walls,
              const BlockSweptBounds<Real>& reach, const LaneBeforeOf& lane_before_of) {
    const V x = bodies.x(k), v = bodies.v(k);
    const Real radius = bodies.radius(k);
    for (ContactEntry& entry : rows.row(k)) {
      const std::uint32_t j = entry.other;
      bool may_touch = false;
      if (j >= bodies.size()) {
        const Wall<Real, Dim> wall = facing(walls[j - bodies.size()], x);
        may_touch = dot(wall.normal, x) - wall.offset - radius < come_closer(v, reach);
      } else {
        const Real near = radius + bodies.radius(j) + come_closer(bodies.v(j) - v, reach);
        may_touch = squared(bodies.x(j) - x) < near * near;
      }
      lane_before_of(entry) = entry.lane;
      entry.lane = may_touch ? chosen : nowhere;
    }
  }
  /// Colours the contacts in the rows of a block. Returns whether there are others, neither within the block nor across
  /// its end.
  [[nodiscard]] bool colour(std::size_t block, const SolverBodies<Real, Dim>& bodies) {
    const std::uint32_t begin = blocks.first(block), end = blocks.last(block, rows.rows());
    std::vector<std::uint64_t> within(2 * blocks.half, 0), across(2 * blocks.half, 0);
    bool has_rest = false;
    for (std::uint32_t k = begin; k < end; ++k) {
      std::uint32_t fixed = 0, at_walls = 0;  // each of these has a colour of its own
      for (ContactEntry& entry : rows.row(k)) {
        if (entry.lane == nowhere) continue;
        const std::uint32_t j = entry.other;
        if (j >= bodies.size()) {
          entry.lane = number(with_wall, block, std::min(at_walls++, last_colour));
        } else if (!bodies.moves(j)) {
          entry.lane = number(with_fixed, block, std::min(fixed++, last_colour)) | fixed_bit;
        } else if (const std::size_t group = blocks.group_of(block, k - begin, j - begin); group == block) {
          entry.lane = number(group, within[k - begin], within[j - begin]);
        } else if (group != blocks.rest()) {
          entry.lane = number(group, across[k - begin - blocks.half], across[j - begin - blocks.half]);
        } else {
          has_rest = true;
        }
      }
    }
    return has_rest;
  }
  void colour_rest(std::span<const std::uint8_t> has_rest, const SolverBodies<Real, Dim>& bodies) {
    if (std::ranges::find(has_rest, 1) == has_rest.end()) return;
    std::vector<std::uint64_t> taken(bodies.size(), 0);
    for (std::size_t block = 0; block < blocks.count; ++block)
      for (std::uint32_t k = blocks.first(block); has_rest[block] && k < blocks.last(block, rows.rows()); ++k)
        for (ContactEntry& entry : rows.row(k))
          if (entry.lane == chosen) entry.lane = number(blocks.rest(), taken[k], taken[entry.other]);
  }

  /// Fills the lane of a numbered contact, except for the impulses and the normal, and returns it.
  template <class CombineRuleOf>
  [[nodiscard]] std::uint32_t fill(ColouredBatches<Real, Dim>& batches, std::size_t group, std::uint32_t numbered,
                                   std::uint32_t a, std::uint32_t b, const CombineRuleOf& combine_rule_of) {
    const std::uint32_t colour = numbered >> colour_shift, number = numbered & ((1u << colour_shift) - 1);
    const std::uint32_t lanes = static_cast<std::uint32_t>(width);
    const std::uint32_t p = batches.groups[group].first[colour] + (batches.is_shared(colour) ? number : number / lanes);
    const std::uint32_t lane = batches.is_shared(colour) ? 0 : number % lanes;
    batches.batches[p].a[lane] = a;
    batches.batches[p].b[lane] = b;
    if (SpecialMaterialBatch<Real, Dim>* special = batches.special_material_of(p)) {
      const Material<Real> both = combine_rule_of(a, b);
      special->friction.lane[lane] = both.friction;
      special->restitution.lane[lane] = both.restitution;
      special->rolling_resistance.lane[lane] = both.rolling_resistance;
    }
    return p * lanes + lane;
  }
  /// The impulses of a contact that has a normal impulse.
  struct KeptContact {
    Real normal{};
    V friction{};
    Spin<Real, Dim> rolling{};
  };
  [[nodiscard]] bool resists_rolling(const ContactEntry& entry) const {
    return !batches_of(entry, entry.lane).special.empty();
  }
  [[nodiscard]] KeptContact impulse_in_lane(const ContactEntry& entry, std::uint32_t lane_number,
                                            bool is_before) const {
    const ColouredBatches<Real, Dim>& batches = batches_of(entry, lane_number);
    const StoredImpulses<Real, Dim>& of_batches = is_before ? batches.before : batches;
    const std::size_t p = (lane_number & ~fixed_bit) / width, lane = lane_number % width;
    const BatchImpulses<Real, Dim>& impulses = of_batches.impulses[p];
    if (!(impulses.normal.lane[lane] > Real(0))) return {};
    KeptContact contact{impulses.normal.lane[lane], in_lane(impulses.friction, lane)};
    if (!of_batches.special.empty()) contact.rolling = in_lane(of_batches.special[p].rolling_impulse, lane);
    return contact;
  }
  [[nodiscard]] KeptContact impulse_kept(std::uint32_t a, std::uint32_t b, bool was_sorted) const {
    Real direction(1);
    std::size_t found = kept_.find(a, b);
    if (found == nowhere && was_sorted) {
      direction = Real(-1);  // the contact had the other direction then
      found = kept_.find(b, a);
    }
    if (found == nowhere) return {};
    KeptContact contact{kept_.entries[found].normal, kept_.entries[found].friction * direction};
    if (!kept_.rolling.empty()) contact.rolling = kept_.rolling[found] * direction;
    return contact;
  }
  void put_in(ColouredBatches<Real, Dim>& batches, std::uint32_t lane_number, const KeptContact& contact) {
    const std::size_t p = lane_number / width, lane = lane_number % width;
    batches.impulses[p].normal.lane[lane] = contact.normal;
    put_in_lane(contact.friction, batches.impulses[p].friction, lane);
    if (SpecialMaterialBatch<Real, Dim>* special = batches.special_material_of(p))
      put_in_lane(contact.rolling, special->rolling_impulse, lane);
  }

  template <class CombineRuleOf, class ImpulseOf>
  void fill_row(std::size_t block, std::uint32_t k, const SolverBodies<Real, Dim>& bodies,
                std::span<const Wall<Real, Dim>> walls, const CombineRuleOf& combine_rule_of,
                const ImpulseOf& impulse_of) {
    const std::uint32_t begin = blocks.first(block);
    for (ContactEntry& entry : rows.row(k)) {
      if (entry.lane == nowhere) continue;
      auto& batches = batches_of(entry, entry.lane);
      const std::uint32_t bit = &batches == &with_fixed ? fixed_bit : 0, j = entry.other;
      const std::size_t group = &batches == &between_movers ? blocks.group_of(block, k - begin, j - begin) : block;
      const std::uint32_t lane = fill(batches, group, entry.lane & ~bit, k, j, combine_rule_of);
      batches.bins[lane / width] |= blocks.bit_of(group, k - begin);
      if (&batches == &between_movers) batches.bins[lane / width] |= blocks.bit_of(group, j - begin);
      if (j >= bodies.size())
        put_in_lane(V(-facing(walls[j - bodies.size()], bodies.x(k)).normal), batches.batches[lane / width].normal,
                    lane % width);
      put_in(batches, lane, impulse_of(k, entry));
      entry.lane = lane | bit;
    }
  }

  KeptImpulses<Real, Dim> kept_;
  std::vector<RestingImpulse<Real, Dim>> resting_;
  bool has_kept_ = false;  // false: the impulses are in the batches of the step before
};

}  // namespace continuo
