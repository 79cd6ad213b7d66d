// continuo/bodies/constrained/islands.hpp
// Under gravity most bodies fly on parabolas, or lie on walls, and some lie on each other. Bodies that lie on each
// other form islands. Each island is a world of its own, which the engine of general forces (constrained_motion.hpp)
// moves with steps as long as its own contacts allow, or not at all where nothing in it moves. All other bodies go from
// event to event (event_driven.hpp), where a sphere at rest replaces each body of an island.
//
// An island is moved ahead for a window of time in which none of its bodies leaves its sphere, so that no body outside
// of the spheres can touch it. Where a body reaches a sphere before the window ends, the island returns to the
// beginning of the window, advances to that instant, and merges with this body and with all others whose spheres then
// overlap. At the end of a window the spheres are drawn again: groups of bodies whose spheres overlap become islands of
// their own, and groups in which no body has lain on another for some time fly on. So no two bodies that could have
// touched are ever moved independently of each other.
#pragma once
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <map>
#include <memory>
#include <numeric>
#include <utility>
#include <vector>

#include <continuo/bodies/contacts/contact_time.hpp>
#include <continuo/bodies/event_driven/exact_engine.hpp>

namespace continuo {

namespace detail {

template <class Real, int Dim>
class Islands final : public ExactEngine<Real, Dim> {
 public:
  using V = Vector<Real, Dim>;
  using Numbers = std::vector<std::uint32_t>;

  Islands(World<Real, Dim>& world, const ExactOptions<Real>& options)
      : ExactEngine<Real, Dim>(options),
        world_(world),
        options_(options),
        island_of_(world.size(), nowhere),
        pool_place_(world.size(), nowhere),
        together_(world.size(), -never) {
    const Real usual = usual_contact_time(world);
    if (!options_.contact_time) options_.contact_time = usual;
    stride_ = std::max(*options_.contact_time, Real(100 * usual));
    gas_ = event_driven(world, options_);
  }

  Status advance_to(const Real& t) override {
    if (island_of_.size() != world_.size()) return other_bodies();
    until_ = t;
    gas_->contacts.clear();
    Status status = renew_all();
    for (std::size_t events = 0; status;) {
      if (++events > options_.most_events) status = too_many_events();
      if (options_.is_interrupted()) status = interrupted();
      if (!status) break;
      const auto next = std::ranges::min_element(islands_, {}, [](const auto& one) { return one.second.end; });
      const Real end = next == islands_.end() ? t : std::min(t, next->second.end);
      status = gas_->run_to(end);
      if (!status) break;
      if (gas_->met) {
        status = meet((*gas_->met)[0], (*gas_->met)[1]);
      } else if (end < t) {
        status = regroup({next->first}, {});
      } else {
        break;
      }
    }
    const Real reached = status ? t : gas_->now();
    return finish(reached, std::move(status));
  }

  void save(ByteWriter& writer) override {
    writer(*options_.contact_time), writer(stride_);
    gas_->save(writer);
    writer(static_cast<std::uint64_t>(islands_.size()));
    for (auto& [id, island] : islands_) {
      writer(island.bodies), writer(island.end == never);
      island.engine->save(writer);
    }
  }
  void load(ByteReader& reader) override {
    Real contact_time{};
    reader(contact_time), reader(stride_);
    reader.expect(contact_time >= Real(0) && stride_ >= Real(0), "a contact time below 0");
    options_.contact_time = contact_time;
    gas_->load(reader);
    std::uint64_t count = 0;
    reader(count);
    for (std::uint64_t k = 0; k < count && reader.ok(); ++k) {
      Numbers bodies;
      bool sleeps = false;
      reader(bodies), reader(sleeps);
      reader.expect(is_island(bodies), "an island of no bodies, or of some that are elsewhere");
      if (!reader.ok()) return;
      Island& island = islands_[next_];
      island = found(std::move(bodies), world_.time);
      mark(island, next_++);
      island.engine->load(reader);
      if (sleeps) island.end = never;
      reader.expect(!sleeps || island.engine->is_steady(), "an island at rest that moves");
    }
  }

  using ExactEngine<Real, Dim>::statistics;
  using ExactEngine<Real, Dim>::contacts;

 private:
  static constexpr Real never = std::numeric_limits<Real>::infinity();
  static constexpr std::uint32_t nowhere = ContactEngine<Real, Dim>::nowhere;
  static constexpr int strides_of_window = 64;  // longer windows would be moved in vain more often
  static constexpr int strides_apart = 32;      // bodies fly that have lain on no other for so long

  struct Island {
    Numbers bodies;  // sorted, with the fixed bodies that they may touch, which may be in several islands
    std::unique_ptr<World<Real, Dim>> world;
    std::unique_ptr<ContactEngine<Real, Dim>> engine;
    World<Real, Dim> begin;  // of the window
    std::unique_ptr<ContactEngine<Real, Dim>> engine_at_begin;
    Real end{};  // of the window; infinity: nothing moves
  };
  /// Bodies that are being regrouped into islands and flying bodies.
  struct Pool {
    Numbers bodies, parent;  // parent: in the disjoint sets of connected bodies
    std::vector<Island> from;
    std::vector<std::pair<std::uint32_t, std::uint32_t>> at_fixed;  // a fixed body and one that may touch it
    Real room{};
  };

  /// Begins new windows with each call. As no window outlasts a call, a motion that is restored from a snapshot
  /// continues to the same bits.
  Status renew_all() {
    Numbers awake;
    for (const auto& [id, island] : islands_) {
      if (!(island.end < never)) continue;
      awake.push_back(id);
      replace_by_proxy(island);
    }
    Status status;
    for (const std::uint32_t id : awake)
      if (status && islands_.contains(id)) status = regroup({id}, {});
    return status;
  }
  Status finish(const Real& t, Status status) {
    for (auto& [id, island] : islands_) {
      Status other = bring_to(island, t);
      status = first_failure(std::move(status), std::move(other));
      put_back(island);
      harvest(island);
    }
    gas_->synchronize(t);
    statistics += std::exchange(gas_->statistics, {});
    harvest_gas();
    return status ? check_motion(world_) : status;
  }
  /// Regroups where two bodies have come to lie on each other, a body is squeezed between others, or a body has reached
  /// an island.
  Status meet(std::uint32_t a, std::uint32_t b) {
    Numbers ids, joining;
    for (const std::uint32_t i : {a, b}) {
      const bool is_in_island = island_of_[i] != nowhere;
      Numbers& to = is_in_island ? ids : joining;
      const std::uint32_t what = is_in_island ? island_of_[i] : i;
      if (!world_.is_fixed(i) && !std::ranges::count(to, what)) to.push_back(what);
    }
    return regroup(ids, joining);
  }

  Status regroup(const Numbers& ids, const Numbers& joining, const Real& least_room = Real(0)) {
    Pool pool;
    Status status;
    for (const std::uint32_t id : ids) take_in(pool, id, status);
    for (const std::uint32_t i : joining) {
      draw_in(pool, i);
      if (ids.empty()) together_[i] = gas_->now();
    }
    while (true) {
      const Real room = std::max(least_room, room_for(pool));
      if (!(room > pool.room)) break;
      pool.room = room;
      for (std::size_t k = 0; k < pool.bodies.size(); ++k) look_round(pool, k, status);
    }
    for (const std::uint32_t i : pool.bodies) pool_place_[i] = nowhere;
    Numbers founded;
    for (Numbers& group : share_out(pool)) founded.push_back(settle(pool, std::move(group)));
    for (const std::uint32_t id : founded)  // if its window is too small, one may take in another
      if (status && islands_.contains(id)) status = open(islands_.at(id), id, pool.room);
    return status;
  }
  void take_in(Pool& pool, std::uint32_t id, Status& status) {
    Island island = std::move(islands_.at(id));
    islands_.erase(id);
    Status other = bring_to(island, gas_->now());
    status = first_failure(std::move(status), std::move(other));
    put_back(island);
    for (std::size_t k = 0; k < island.bodies.size(); ++k) {
      if (world_.is_fixed(island.bodies[k])) continue;
      together_[island.bodies[k]] = island.engine->together[k];
      add(pool, island.bodies[k]);
    }
    pool.from.push_back(std::move(island));
  }
  void draw_in(Pool& pool, std::uint32_t i) {
    gas_->bring_out(i);
    together_[i] = -never;
    add(pool, i);
  }
  void add(Pool& pool, std::uint32_t i) {
    pool_place_[i] = static_cast<std::uint32_t>(pool.bodies.size());
    pool.parent.push_back(pool_place_[i]);
    pool.bodies.push_back(i);
  }
  /// The distance from the surface of a body to that of its sphere: at least some steps at the present speeds, as for
  /// the listing of pairs.
  Real room_for(const Pool& pool) const {
    using std::sqrt;
    Real fastest(0), smallest = never;
    for (const std::uint32_t i : pool.bodies) {
      fastest = std::max(fastest, squared(world_.velocity[i]));
      smallest = std::min(smallest, world_.radius[i]);
    }
    return std::max(Real(smallest / 4), Real(32 * stride_ * (sqrt(fastest) + 2 * length(world_.gravity) * stride_)));
  }
  /// Draws the sphere of a body, and adds the bodies and islands that it overlaps to the pool.
  void look_round(Pool& pool, std::size_t k, Status& status) {
    const std::uint32_t i = pool.bodies[k];
    gas_->replace_by_proxy(i, world_.position[i], world_.radius[i] + pool.room);
    gas_->find_overlapping(i, near_);
    for (const std::uint32_t j : near_) {
      if (world_.is_fixed(j)) {
        pool.at_fixed.emplace_back(j, i);
        continue;
      }
      if (pool_place_[j] == nowhere) island_of_[j] == nowhere ? draw_in(pool, j) : take_in(pool, island_of_[j], status);
      pool.parent[root(pool, pool_place_[j])] = root(pool, pool_place_[i]);
    }
  }
  static std::uint32_t root(Pool& pool, std::uint32_t k) {
    while (pool.parent[k] != k) k = pool.parent[k] = pool.parent[pool.parent[k]];
    return k;
  }
  /// Returns the groups that form islands; all other bodies fly from here on.
  std::vector<Numbers> share_out(Pool& pool) {
    std::map<std::uint32_t, Numbers> by_root;
    for (std::uint32_t k = 0; k < pool.bodies.size(); ++k) by_root[root(pool, k)].push_back(pool.bodies[k]);
    std::vector<Numbers> groups;
    for (auto& [of, group] : by_root) {
      std::ranges::sort(group);
      const auto lay = [&](std::uint32_t i) { return gas_->now() - together_[i] <= strides_apart * stride_; };
      const bool is_island = std::ranges::any_of(group, lay);
      for (const std::uint32_t i : group) island_of_[i] = is_island ? next_ : nowhere;
      if (is_island) groups.push_back(std::move(group));
    }
    std::ranges::sort(groups);
    harvest_gas();  // the log first ends contacts with walls that go on in an island
    for (Island& island : pool.from) {
      std::vector<bool> leaves;
      for (const std::uint32_t i : island.bodies) leaves.push_back(!world_.is_fixed(i) && island_of_[i] == nowhere);
      if (std::ranges::count(leaves, true)) island.engine->let_go(leaves);
      harvest(island);
    }
    for (const std::uint32_t i : pool.bodies)
      if (island_of_[i] == nowhere) gas_->take_back(i);
    return groups;
  }
  std::uint32_t settle(Pool& pool, Numbers group) {
    Numbers bodies = group;
    for (const auto& [fixed, i] : pool.at_fixed)
      if (std::ranges::binary_search(group, i)) bodies.push_back(fixed);
    std::ranges::sort(bodies);
    bodies.erase(std::ranges::unique(bodies).begin(), bodies.end());
    const std::uint32_t id = next_++;
    Island& island = islands_[id];
    if (pool.from.size() == 1 && pool.from[0].bodies == bodies) {
      island = std::move(pool.from[0]);
    } else {
      island = found(std::move(bodies), gas_->now());
      for (const Island& one : pool.from) {
        if (!one.engine) continue;  // it goes on, unchanged, as another island
        Numbers to;
        for (const std::uint32_t i : one.bodies) to.push_back(place_in(island.bodies, i));
        island.engine->take_over(*one.engine, to);
      }
    }
    mark(island, id);
    return id;
  }
  Island found(Numbers bodies, const Real& now) const {
    Island island;
    island.world = std::make_unique<World<Real, Dim>>(world_.part(bodies));
    island.world->time = now;
    ExactOptions<Real> options = options_;
    options.interrupt = nullptr;  // it is tested between windows
    island.engine = constrained_motion<Real, Dim>(*island.world, options, nullptr);
    island.bodies = std::move(bodies);
    island.engine->set_numbers(island.bodies);
    return island;
  }
  void mark(const Island& island, std::uint32_t id) {
    for (const std::uint32_t i : island.bodies)
      if (!world_.is_fixed(i)) island_of_[i] = id;
  }
  static std::uint32_t place_in(const Numbers& bodies, std::uint32_t i) {
    const auto at = std::ranges::lower_bound(bodies, i);
    return at != bodies.end() && *at == i ? static_cast<std::uint32_t>(at - bodies.begin()) : nowhere;
  }
  bool is_island(const Numbers& bodies) const {
    const auto is_right = [&](std::uint32_t i) {
      return i < world_.size() && (world_.is_fixed(i) || island_of_[i] == nowhere);
    };
    return !bodies.empty() && std::ranges::adjacent_find(bodies, std::ranges::greater_equal{}) == bodies.end() &&
           std::ranges::all_of(bodies, is_right);
  }

  /// Moves an island ahead through its next window.
  Status open(Island& island, std::uint32_t id, const Real& room) {
    if (island.engine->is_steady()) {
      replace_by_proxy(island);
      island.end = never;
      return {};
    }
    island.begin = *island.world;
    island.engine_at_begin = island.engine->clone();
    island.engine->keep_within(room);
    Status status = island.engine->advance_to(std::min(until_, Real(gas_->now() + strides_of_window * stride_)));
    island.end = island.world->time;
    Real farthest(0);
    for (std::size_t k = 0; k < island.bodies.size(); ++k)
      farthest = std::max(farthest, squared(V(island.world->position[k] - island.begin.position[k])));
    if (status && farthest > room * room) return regroup({id}, {}, Real(4 * room));
    return status;
  }
  /// Replaces the bodies by spheres of their own size, at their positions in the world.
  void replace_by_proxy(const Island& island) {
    for (const std::uint32_t i : island.bodies)
      if (!world_.is_fixed(i)) gas_->replace_by_proxy(i, world_.position[i], world_.radius[i]);
  }
  /// Brings an island to a time in its window, or to any later time where it is at rest.
  Status bring_to(Island& island, const Real& t) {
    if (island.world->time > t) {
      *island.world = std::move(island.begin);
      island.engine = std::move(island.engine_at_begin);
    }
    if (!(island.world->time < t)) return {};
    island.engine->keep_within(never);
    return island.engine->advance_to(t);
  }
  void put_back(const Island& island) {
    for (std::size_t k = 0; k < island.bodies.size(); ++k) {
      const std::uint32_t i = island.bodies[k];
      world_.position[i] = island.world->position[k], world_.velocity[i] = island.world->velocity[k];
      world_.orientation[i] = island.world->orientation[k], world_.spin[i] = island.world->spin[k];
    }
  }
  void harvest_gas() {
    if (contacts.is_kept()) contacts.take_over(gas_->contacts, [](const BodyHandle& body) { return body; });
  }
  /// Collects the statistics and contact events of an island once they are final.
  void harvest(Island& island) {
    statistics += std::exchange(island.engine->statistics, {});
    if (contacts.is_kept())
      contacts.take_over(island.engine->contacts,
                         [&](const BodyHandle& body) { return world_.handle(island.bodies[body.slot]); });
  }

  World<Real, Dim>& world_;  // bodies of islands are up to date at the end of a call, or when regrouped
  ExactOptions<Real> options_;
  Real stride_{}, until_{};
  std::unique_ptr<ParabolicEngine<Real, Dim>> gas_;
  std::map<std::uint32_t, Island> islands_;
  std::uint32_t next_ = 0;
  Numbers island_of_, pool_place_, near_;  // by number; near_: found by a search
  std::vector<Real> together_;             // for a pool: the last time at which each lay on another
};

}  // namespace detail

template <class Real, int Dim>
std::unique_ptr<ExactEngine<Real, Dim>> islands(World<Real, Dim>& world, const ExactOptions<Real>& options) {
  return std::make_unique<detail::Islands<Real, Dim>>(world, options);
}

}  // namespace continuo
