// The contacts of a step: of the pairs that are listed those that may touch in it, coloured and packed. No two contacts
// of a colour share a body that moves, so lanes and threads may solve them in any order, to the same bits. Impulses
// outlive the step: they are kept by the places of the two bodies, and are the start of the next.
#pragma once
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <continuo/bodies/contact_solver.hpp>
#include <continuo/bodies/world.hpp>

namespace continuo {

inline constexpr std::uint32_t nowhere = std::numeric_limits<std::uint32_t>::max();

/// What the bodies at places 0, 1, ... may touch: entries first[k] ... first[k + 1] - 1 are those of k, in rising
/// order. A pair of two that move stands with the lower place, one with a fixed body with the other.
struct ContactRows {
  struct Entry {
    std::uint32_t other;           // a place, or the number of a wall
    std::uint32_t lane = nowhere;  // in the packs of its kind, where it is solved
  };
  std::vector<std::uint32_t> first{0};
  std::vector<Entry> entries{};

  std::size_t rows() const { return first.size() - 1; }
  std::span<const Entry> row(std::size_t k) const { return {entries.data() + first[k], entries.data() + first[k + 1]}; }
  std::span<Entry> row(std::size_t k) { return {entries.data() + first[k], entries.data() + first[k + 1]}; }
  void clear() {
    first.assign(1, 0);
    entries.clear();
  }
  void end_row() { first.push_back(static_cast<std::uint32_t>(entries.size())); }
};

/// The impulses of a contact between steps.
template <class Real, int Dim>
struct KeptImpulse {
  std::uint32_t other = 0;
  Real normal{};
  Vector<Real, Dim> friction{};  // on `other`

  template <class Archive>
  void transfer(Archive& archive) {
    archive(other), archive(normal), archive(friction);
  }
};
template <class Real, int Dim>
struct KeptImpulses {
  std::vector<std::uint32_t> first{0};
  std::vector<KeptImpulse<Real, Dim>> entries{};
  std::vector<Spin<Real, Dim>> rolling{};  // of the same contacts; empty where nothing resists rolling

  template <class Archive>
  void transfer(Archive& archive) {
    archive(first), archive(entries), archive(rolling);
  }
  /// Of `bodies`, with others below `others`.
  bool fits(std::size_t bodies, std::size_t others) const {
    bool fits = !first.empty() && first.front() == 0 && first.back() == entries.size() && first.size() <= bodies + 1 &&
                std::ranges::is_sorted(first) && (rolling.empty() || rolling.size() == entries.size());
    for (const auto& entry : entries) fits = fits && entry.other < others;
    return fits;
  }
  std::size_t find(std::uint32_t k, std::uint32_t other) const {
    if (k + 1 < first.size())
      for (std::size_t i = first[k]; i < first[k + 1]; ++i)
        if (entries[i].other == other) return i;
    return nowhere;
  }
  void clear() {
    first.assign(1, 0);
    entries.clear();
    rolling.clear();
  }
  void end_row() { first.push_back(static_cast<std::uint32_t>(entries.size())); }
};

/// How near two must be to be solved in a step: as near as they may come.
template <class Real>
struct ActiveReach {
  Real step{};   // of time
  Real extra{};  // beside what their velocities say
};

template <class Real, int Dim>
class ContactList {
 public:
  using V = Vector<Real, Dim>;
  static constexpr std::size_t width = lanes_at_once<Real>;

  ContactRows pairs, walls;
  ColouredPacks<Real, Dim> between_movers, with_fixed, with_wall;

  /// act(kind, packs) for the three kinds, in the order in which they are solved: walls last, they yield least.
  template <class Act>
  void for_each_kind(Act&& act) {
    act(std::integral_constant<ContactKind, ContactKind::between_movers>{}, between_movers);
    act(std::integral_constant<ContactKind, ContactKind::with_fixed>{}, with_fixed);
    act(std::integral_constant<ContactKind, ContactKind::with_wall>{}, with_wall);
  }

  /// Takes the impulses out of the packs.
  void keep() {
    keep(pairs, kept_pairs_, [&](std::uint32_t lane) { return lane & fixed_bit ? &with_fixed : &between_movers; });
    keep(walls, kept_walls_, [&](std::uint32_t) { return &with_wall; });
  }

  /// Packs what may touch; place_before[k] is where the body at k was when impulses were kept (empty: at k).
  template <class MaterialOf>
  void activate(const SolverBodies<Real, Dim>& bodies, std::span<const Wall<Real, Dim>> world_walls,
                const MaterialOf& material_of, bool has_rare, const ActiveReach<Real>& reach,
                std::span<const std::uint32_t> place_before) {
    taken_.assign(bodies.size(), 0);
    between_movers.count.fill(0), with_fixed.count.fill(0), with_wall.count.fill(0);
    colour_pairs(bodies, reach);
    colour_walls(bodies, world_walls, reach);
    for_each_kind([&](auto, auto& packs) { packs.make_room(bodies, has_rare); });
    const auto before = [&](std::uint32_t k) { return place_before.empty() ? k : place_before[k]; };
    fill_pairs(bodies, material_of, before);
    fill_walls(bodies, world_walls, material_of, before);
  }

  /// What `keep` takes, to and fro.
  template <class Archive>
  void transfer_kept(Archive& archive) {
    archive(kept_pairs_), archive(kept_walls_);
  }
  bool kept_fits(std::size_t bodies, std::size_t world_walls) const {
    return kept_pairs_.fits(bodies, bodies) && kept_walls_.fits(bodies, world_walls);
  }

  /// visit(k, other, is_wall, impulse) for the contacts that pressed in the last substep.
  template <class Visit>
  void for_each_touching(Visit&& visit) const {
    const auto impulse = [](const ColouredPacks<Real, Dim>& packs, std::uint32_t lane) {
      return packs.packs[(lane & ~fixed_bit) / width].normal_impulse.lane[lane % width];
    };
    const auto visit_rows = [&](const ContactRows& rows, bool is_wall) {
      for (std::uint32_t k = 0; k < rows.rows(); ++k)
        for (const ContactRows::Entry& entry : rows.row(k)) {
          if (entry.lane == nowhere) continue;
          const auto& packs = is_wall ? with_wall : entry.lane & fixed_bit ? with_fixed : between_movers;
          if (const Real pressed = impulse(packs, entry.lane); pressed > Real(0))
            visit(k, entry.other, is_wall, pressed);
        }
    };
    visit_rows(pairs, false);
    visit_rows(walls, true);
  }

  std::size_t active() const {
    std::size_t sum = 0;
    for (const auto* packs : {&between_movers, &with_fixed, &with_wall})
      for (const std::uint32_t count : packs->count) sum += count;
    return sum;
  }

 private:
  static constexpr std::uint32_t fixed_bit = 1u << 31;  // of an entry's lane: its packs are those with fixed bodies

  template <class PacksOf>
  void keep(const ContactRows& rows, KeptImpulses<Real, Dim>& kept, const PacksOf& packs_of) {
    kept.clear();
    if (const std::size_t most = active(); kept.entries.capacity() < most) kept.entries.reserve(most + most / 16);
    for (std::size_t k = 0; k < rows.rows(); ++k) {
      for (const ContactRows::Entry& entry : rows.row(k)) {
        if (entry.lane == nowhere) continue;
        auto& packs = *packs_of(entry.lane);
        const std::size_t p = (entry.lane & ~fixed_bit) / width, lane = entry.lane % width;
        const ContactPack<Real, Dim>& pack = packs.packs[p];
        if (!(pack.normal_impulse.lane[lane] > Real(0))) continue;
        kept.entries.push_back({entry.other, pack.normal_impulse.lane[lane], in_lane(pack.friction_impulse, lane)});
        if (const auto* rare = packs.rare_of(p)) kept.rolling.push_back(in_lane(rare->rolling_impulse, lane));
      }
      kept.end_row();
    }
  }
  template <int Size>
  static Vector<Real, Size> in_lane(const Vector<StoredLanes<Real>, Size>& stored, std::size_t lane) {
    Vector<Real, Size> v;
    for (std::size_t axis = 0; axis < v.size(); ++axis) v[axis] = stored[axis].lane[lane];
    return v;
  }
  template <int Size>
  static void put_in_lane(const Vector<Real, Size>& v, Vector<StoredLanes<Real>, Size>& stored, std::size_t lane) {
    for (std::size_t axis = 0; axis < v.size(); ++axis) stored[axis].lane[lane] = v[axis];
  }

  static Real come_closer(const V& rate, const ActiveReach<Real>& reach) {
    using std::abs;
    Real sum(0);
    for (std::size_t axis = 0; axis < V::size(); ++axis) sum += abs(rate[axis]);
    return sum * reach.step + reach.extra;
  }

  /// The lowest colour that neither has, for now in the place of the lane.
  std::uint32_t colour(std::uint64_t used, ColouredPacks<Real, Dim>& packs) {
    const auto c = static_cast<std::uint32_t>(
        std::min<std::size_t>(static_cast<std::size_t>(std::countr_one(used)), packs.most_colours - 1));
    ++packs.count[c];
    return c;
  }
  void colour_pairs(const SolverBodies<Real, Dim>& bodies, const ActiveReach<Real>& reach) {
    for (std::uint32_t k = 0; k < pairs.rows(); ++k) {
      const V x = bodies.x(k), v = bodies.v(k);
      const Real radius = bodies.radius(k);
      for (ContactRows::Entry& entry : pairs.row(k)) {
        const std::uint32_t j = entry.other;
        const Real near = radius + bodies.radius(j) + come_closer(bodies.v(j) - v, reach);
        entry.lane = nowhere;
        if (!(squared(bodies.x(j) - x) < near * near)) continue;
        if (bodies.moves(j)) {
          entry.lane = colour(taken_[k] | taken_[j], between_movers);
          taken_[j] |= std::uint64_t{1} << entry.lane;
          taken_[k] |= std::uint64_t{1} << entry.lane;
        } else {
          entry.lane = colour_alone(k, with_fixed) | fixed_bit;
        }
      }
    }
  }
  // Contacts with what does not move share colours with no other kind: counting how many a body has is enough.
  std::uint32_t colour_alone(std::uint32_t k, ColouredPacks<Real, Dim>& packs) {
    if (alone_of_ != k) alone_of_ = k, alone_ = 0;
    return colour((std::uint64_t{1} << std::min<std::uint32_t>(alone_++, 63)) - 1, packs);
  }
  void colour_walls(const SolverBodies<Real, Dim>& bodies, std::span<const Wall<Real, Dim>> world_walls,
                    const ActiveReach<Real>& reach) {
    alone_of_ = nowhere;
    for (std::uint32_t k = 0; k < walls.rows(); ++k)
      for (ContactRows::Entry& entry : walls.row(k)) {
        const Wall<Real, Dim>& wall = world_walls[entry.other];
        const Real gap = dot(wall.normal, bodies.x(k)) - wall.offset - bodies.radius(k);
        entry.lane = gap < come_closer(bodies.v(k), reach) ? colour_alone(k, with_wall) : nowhere;
      }
    alone_of_ = nowhere;
  }

  /// The next lane of that colour; it is filled but for the impulses and the normal.
  template <class Next>
  static std::uint32_t next_lane(ColouredPacks<Real, Dim>& packs, Next& next, std::uint32_t colour, std::uint32_t a,
                                 std::uint32_t b, const Material<Real>& both) {
    const std::uint32_t number = next[colour]++, lanes = static_cast<std::uint32_t>(width);
    const std::uint32_t p = packs.first[colour] + (packs.is_shared(colour) ? number : number / lanes);
    const std::uint32_t lane = packs.is_shared(colour) ? 0 : number % lanes;
    packs.packs[p].a[lane] = a;
    packs.packs[p].b[lane] = b;
    packs.packs[p].friction.lane[lane] = both.friction;
    if (RarePack<Real, Dim>* rare = packs.rare_of(p)) {
      rare->restitution.lane[lane] = both.restitution;
      rare->rolling_resistance.lane[lane] = both.rolling_resistance;
    }
    return p * lanes + lane;
  }
  void recall(ColouredPacks<Real, Dim>& packs, std::uint32_t lane_number, const KeptImpulses<Real, Dim>& kept,
              std::size_t found, const Real& direction) {
    const std::size_t p = lane_number / width, lane = lane_number % width;
    const bool is_new = found == nowhere;
    packs.packs[p].normal_impulse.lane[lane] = is_new ? Real(0) : kept.entries[found].normal;
    put_in_lane(is_new ? V{} : V(kept.entries[found].friction * direction), packs.packs[p].friction_impulse, lane);
    if (RarePack<Real, Dim>* rare = packs.rare_of(p))
      put_in_lane(is_new || kept.rolling.empty() ? Spin<Real, Dim>{} : Spin<Real, Dim>(kept.rolling[found] * direction),
                  rare->rolling_impulse, lane);
  }

  template <class MaterialOf, class Before>
  void fill_pairs(const SolverBodies<Real, Dim>& bodies, const MaterialOf& material_of, const Before& before) {
    (void)bodies;
    std::array<std::uint32_t, ColouredPacks<Real, Dim>::most_colours> next{}, next_fixed{};
    for (std::uint32_t k = 0; k < pairs.rows(); ++k) {
      const std::uint32_t k_before = before(k);
      for (ContactRows::Entry& entry : pairs.row(k)) {
        if (entry.lane == nowhere) continue;
        const bool is_fixed = (entry.lane & fixed_bit) != 0;
        auto& packs = is_fixed ? with_fixed : between_movers;
        const Material<Real> both = combined<Real>(material_of(k), material_of(entry.other));
        const std::uint32_t lane =
            next_lane(packs, is_fixed ? next_fixed : next, entry.lane & ~fixed_bit, k, entry.other, both);
        const std::uint32_t other_before = before(entry.other);
        Real direction(1);
        std::size_t found = kept_pairs_.find(k_before, other_before);
        if (found == nowhere) {
          direction = Real(-1);  // the other way round then
          found = kept_pairs_.find(other_before, k_before);
        }
        recall(packs, lane, kept_pairs_, found, direction);
        entry.lane = lane | (is_fixed ? fixed_bit : 0u);
      }
    }
  }
  template <class MaterialOf, class Before>
  void fill_walls(const SolverBodies<Real, Dim>& bodies, std::span<const Wall<Real, Dim>> world_walls,
                  const MaterialOf& material_of, const Before& before) {
    std::array<std::uint32_t, ColouredPacks<Real, Dim>::most_colours> next{};
    for (std::uint32_t k = 0; k < walls.rows(); ++k)
      for (ContactRows::Entry& entry : walls.row(k)) {
        if (entry.lane == nowhere) continue;
        const Wall<Real, Dim>& wall = world_walls[entry.other];
        const Material<Real> both = combined<Real>(material_of(k), wall.material);
        const std::uint32_t lane = next_lane(with_wall, next, entry.lane, k, bodies.wall(entry.other), both);
        put_in_lane(V(-wall.normal), with_wall.packs[lane / width].normal, lane % width);
        recall(with_wall, lane, kept_walls_, kept_walls_.find(before(k), entry.other), Real(1));
        entry.lane = lane;
      }
  }

  KeptImpulses<Real, Dim> kept_pairs_, kept_walls_;
  std::vector<std::uint64_t> taken_;
  std::uint32_t alone_of_ = nowhere, alone_ = 0;
};

}  // namespace continuo
