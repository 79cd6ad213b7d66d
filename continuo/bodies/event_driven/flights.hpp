// continuo/bodies/event_driven/flights.hpp
// The state of the event-driven motion: bodies on parabolas, each at its own time, and the next predicted event of
// each. A prediction assumes that no other event changes a path before.
//
// Bodies are kept in the order of their cells, so that those that meet lie near in memory: the `place` of a body is its
// index in that order, its `number` its index in the world. Of events at one instant, walls come before bodies and
// lower numbers before higher, whatever the order in memory.
#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <map>
#include <numeric>
#include <utility>
#include <vector>

#include <continuo/bodies/contacts/collision_time.hpp>
#include <continuo/bodies/event_driven/cell_grid.hpp>
#include <continuo/bodies/world.hpp>

namespace continuo {

/// The edge of cells with about one body each, which are wider than all bodies except few large ones.
template <class Real, int Dim>
[[nodiscard]] Real edge_of_cells(const World<Real, Dim>& world) {
  const std::size_t n = world.size();
  if (n == 0) return Real(1);
  std::vector<Real> sorted = world.radius;
  const auto median = sorted.begin() + static_cast<std::ptrdiff_t>(n / 2);
  std::nth_element(sorted.begin(), median, sorted.end());
  const Real usual = 4 * *median;
  Real widest(0);
  for (const Real& radius : sorted)
    if (radius <= usual) widest = std::max(widest, radius);
  Real room(1);  // of nine tenths of the bodies, by axis
  for (std::size_t axis = 0; axis < static_cast<std::size_t>(Dim); ++axis) {
    std::vector<Real> place(n);
    for (std::size_t i = 0; i < n; ++i) place[i] = world.position[i][axis];
    const std::size_t tail = n / 20;
    std::nth_element(place.begin(), place.begin() + static_cast<std::ptrdiff_t>(tail), place.end());
    const Real low = place[tail];
    std::nth_element(place.begin(), place.end() - 1 - static_cast<std::ptrdiff_t>(tail), place.end());
    room *= std::max(Real(place[n - 1 - tail] - low), 2 * widest);
  }
  using std::pow;
  const Real spacing = Real(pow(room / static_cast<Real>(n), Real(1) / Real(Dim)));
  // Proxies of bodies are wider than these by a quarter, see islands.hpp.
  const Real more = world.gravity == Vector<Real, Dim>{} ? Real(1) : Real(1.25);
  return std::max(2 * more * widest, std::min(spacing, 1000 * widest)) * Real(1.0001);
}

// The partner of the next collision: a body below first_wall, a wall from there on, or not known yet (look_again).
inline constexpr std::uint32_t nobody = std::numeric_limits<std::uint32_t>::max(), look_again = nobody - 1,
                               first_wall = std::uint32_t{1} << 31;

// The flight of a body is divided into parts, so that an event reads few cache lines: of neighbours `Path` and `Act`,
// of the partner also the count of its collisions, of bodies that take part also `Plan`, and `Turning` where they have
// friction or rest. The sizes in the comments are those for double in space.

/// The data that is read when other bodies search for their next collision: a cache line.
template <class Real, int Dim>
struct alignas(sizeof(Real) * (Dim == 3 ? 8 : 2)) Path {
  Vector<Real, Dim> x{}, v{};  // at the time t of its own
  Real t{}, radius{};
};

/// How a body is accelerated. is_proxy: another engine moves the body, see sphere_proxy.hpp.
enum class Act : std::uint8_t { falls, rests, is_fixed, is_proxy };

/// The data that every event of a body reads and writes: two cache lines, of which the first has the next event.
template <class Real, int Dim>
struct alignas(sizeof(Real) * 16) Plan {
  static constexpr Real never = std::numeric_limits<Real>::infinity();
  Real collision_time = never, crossing_time = never;
  Real path_end = never;  // when its acceleration changes without a collision, see rolling.hpp
  typename CellGrid<Real, Dim>::Cell cell{};
  std::uint32_t partner = nobody, collisions_of_partner = 0;
  std::int8_t direction = 0;  // of the crossing, along the axis
  std::uint8_t axis = 0;
  bool is_large = false;
  std::uint8_t support_count = 0;
  std::uint8_t strikes_at_once = 0;  // simultaneous strikes at the instant of the last collision
  bool is_tied = false;              // the next collision may be at one instant with another one
  std::uint32_t in_a_row = 0;        // collisions before the last, each soon after the one before
  std::uint32_t number = 0, material = 0;
  std::array<std::uint32_t, static_cast<std::size_t>(Dim)> supports{};  // the walls it rests on
  Vector<Real, Dim> acceleration{};
  Real last_collision = -never, inverse_mass{};
};

/// How a body turns, and since when it rests.
template <class Real, int Dim>
struct Turning {
  Spin<Real, Dim> spin{}, spin_rate{};  // at the time spun_since; the orientation is of spun_to
  Real spun_to{}, spun_since{}, rests_since{}, inverse_inertia{};
};

/// The whole flight of one body.
template <class Real, int Dim>
struct Flight {
  Path<Real, Dim> path{};
  Plan<Real, Dim> plan{};
  Turning<Real, Dim> turning{};
  std::uint32_t collisions = 0;
  Act act = Act::falls;
};

template <class Real, int Dim>
class Flights {
 public:
  using V = Vector<Real, Dim>;
  using Grid = CellGrid<Real, Dim>;
  static constexpr Real never = std::numeric_limits<Real>::infinity();

  explicit Flights(const World<Real, Dim>& of) : world(of), now(of.time) {
    const std::size_t n = world.size();
    grid = Grid(edge_of_cells(world), n);
    some_pass_ = world.has_ignored_groups();
    for_each_array([&](auto& array) { array.resize(n); });
    std::map<std::array<Real, 3>, std::uint32_t> kinds;
    for (std::uint32_t i = 0; i < n; ++i) {
      take_from_world(i);
      const Material<Real>& of_body = world.material[i];
      const auto [kind, is_new] = kinds.try_emplace({of_body.restitution, of_body.friction, of_body.rolling_resistance},
                                                    static_cast<std::uint32_t>(materials_.size()));
      if (is_new) materials_.push_back(of_body);
      plans[i].material = kind->second;
    }
  }

  const World<Real, Dim>& world;
  Real now;
  Real slow{};         // approaches within the rounding of this speed do not count as collisions
  Real at_one_time{};  // collisions that are apart by no more, or by the rounding of time, may be at one instant
  std::vector<Path<Real, Dim>> paths;
  std::vector<Plan<Real, Dim>> plans;
  std::vector<Turning<Real, Dim>> turnings;
  std::vector<std::uint32_t> collisions;  // changes of the path, by which a prediction is known to be outdated
  std::vector<Act> acts;
  std::vector<std::uint32_t> large;  // too wide for the cells, or too far out: neighbours of all bodies
  Grid grid;

  template <class Action>
  void for_each_array(Action&& action) {
    action(paths), action(plans), action(turnings), action(collisions), action(acts);
  }
  [[nodiscard]] Flight<Real, Dim> flight(std::uint32_t i) const {
    return {paths[i], plans[i], turnings[i], collisions[i], acts[i]};
  }
  void set_flight(std::uint32_t i, const Flight<Real, Dim>& to) {
    paths[i] = to.path, plans[i] = to.plan, turnings[i] = to.turning, collisions[i] = to.collisions, acts[i] = to.act;
  }
  /// The bytes of memory that events access.
  [[nodiscard]] std::size_t memory() const {
    return paths.size() * (sizeof(Path<Real, Dim>) + sizeof(Plan<Real, Dim>));
  }
  /// Where the body of each number is.
  [[nodiscard]] std::vector<std::uint32_t> places() const {
    std::vector<std::uint32_t> place(plans.size());
    for (std::uint32_t k = 0; k < place.size(); ++k) place[plans[k].number] = k;
    return place;
  }
  [[nodiscard]] const Material<Real>& material(std::uint32_t i) const { return materials_[plans[i].material]; }

  static void advance(Path<Real, Dim>& path, const V& acceleration, const Real& t) {
    const Real dt = t - path.t;
    path.x += path.v * dt + acceleration * (dt * dt / 2);
    path.v += acceleration * dt;
    path.t = t;
  }
  [[nodiscard]] V place_now(std::uint32_t i) const {
    Path<Real, Dim> path = paths[i];
    advance(path, plans[i].acceleration, now);
    return path.x;
  }
  [[nodiscard]] V velocity_now(std::uint32_t i) const {
    return paths[i].v + plans[i].acceleration * (now - paths[i].t);
  }
  void move_to_now(std::uint32_t i) { advance(paths[i], plans[i].acceleration, now); }

  [[nodiscard]] static bool is_support(const Plan<Real, Dim>& plan, std::uint32_t w) {
    const auto end = plan.supports.begin() + plan.support_count;
    return std::find(plan.supports.begin(), end, w) != end;
  }

  /// Brings the bodies into the order of their cells.
  void sort() {
    const std::size_t n = plans.size();
    std::vector<std::uint32_t> order(n), place(n);
    std::iota(order.begin(), order.end(), 0u);
    std::vector<std::size_t> key(n);
    for (std::size_t i = 0; i < n; ++i)
      key[i] = plans[i].is_large ? std::numeric_limits<std::size_t>::max() : grid.list_of(plans[i].cell);
    std::ranges::sort(order, {}, [&](std::uint32_t i) { return std::pair(key[i], plans[i].number); });
    for (std::uint32_t k = 0; k < n; ++k) place[order[k]] = k;
    for_each_array([&](auto& values) {
      auto old = values;
      for (std::size_t k = 0; k < n; ++k) values[k] = old[order[k]];
    });
    large.clear();
    grid = Grid(grid.edge(), n);
    for (std::uint32_t k = 0; k < n; ++k) {
      if (plans[k].partner < first_wall) plans[k].partner = place[plans[k].partner];
      plans[k].is_large ? large.push_back(k) : grid.insert(k, plans[k].cell);
    }
  }

  /// Predicts the next crossing of body i into another cell and its next collision. Brings the body to the present.
  void predict(std::uint32_t i) {
    Plan<Real, Dim>& plan = plans[i];
    plan.crossing_time = never;
    plan.collision_time = plan.path_end;
    plan.partner = plan.path_end < never ? look_again : nobody;
    plan.is_tied = false;
    if (acts[i] == Act::is_fixed) return;
    move_to_now(i);
    predict_crossing(i);
    for (std::uint32_t w = 0; w < world.walls().size(); ++w)
      if (acts[i] != Act::rests || !is_support(plan, w)) predict_wall(i, w);
    const std::size_t count = gather_near(i, candidates_);
    predict_pairs(i, count);
  }

  /// Calls `action` for each body that may touch body i, in the order of memory, perhaps for body i too.
  template <class Action>
  void for_each_near(std::uint32_t i, std::vector<std::uint32_t>& near, Action&& action) const {
    const std::size_t count = gather_near(i, near);
    for (std::size_t k = 0; k < count; ++k) action(near[k]);
  }

  /// Predicts the events of body i after it has crossed into another cell. New candidates are only the bodies in cells
  /// that have become neighbours.
  void look_ahead(std::uint32_t i) {
    Plan<Real, Dim>& plan = plans[i];
    auto lower = plan.cell, upper = plan.cell;
    for (std::size_t axis = 0; axis < lower.size(); ++axis) {
      if (axis == plan.axis) {
        lower[axis] = upper[axis] = plan.cell[axis] + plan.direction;
      } else {
        --lower[axis], ++upper[axis];
      }
    }
    plan.crossing_time = never;
    predict_crossing(i);
    predict_pairs(i, grid.gather(lower, upper, candidates_));
  }

  /// Whether the approach of two bodies in contact is within the rounding of their velocities, or as good as rest, as
  /// after a simultaneous strike. Such bodies sink into each other by no more than the rounding of positions on the
  /// way.
  [[nodiscard]] bool is_rounding(const Real& approach, const Real& speeds) const {
    return approach <= 8 * std::numeric_limits<Real>::epsilon() * std::max(speeds, slow);
  }

 private:
  [[nodiscard]] std::size_t gather_near(std::uint32_t i, std::vector<std::uint32_t>& near) const {
    std::size_t count = 0;
    if (plans[i].is_large) {
      near.resize(std::max(near.size(), paths.size()));
      for (std::uint32_t j = 0; j < paths.size(); ++j) near[count++] = j;
    } else {
      count = grid.gather_around(plans[i].cell, near);
      if (near.size() < count + large.size()) near.resize(count + large.size());
      for (const std::uint32_t j : large) near[count++] = j;
    }
    return count;
  }
  void take_from_world(std::uint32_t i) {
    Path<Real, Dim>& path = paths[i];
    Plan<Real, Dim>& plan = plans[i];
    path = {world.position[i], world.velocity[i], now, world.radius[i]};
    acts[i] = world.is_fixed(i) ? Act::is_fixed : Act::falls;
    plan.number = i;
    plan.inverse_mass = world.inverse_mass[i];
    plan.acceleration = world.is_fixed(i) ? V{} : world.gravity;
    Turning<Real, Dim>& turning = turnings[i];
    turning.spun_to = turning.spun_since = now;
    turning.inverse_inertia = world.inverse_inertia[i];
    turning.spin = world.spin[i];
    plan.is_large = 2 * path.radius > grid.edge() || !grid.has_cell(path.x);
    if (!plan.is_large) plan.cell = grid.cell_of(path.x);
  }

  void predict_crossing(std::uint32_t i) {
    const Path<Real, Dim>& path = paths[i];
    Plan<Real, Dim>& plan = plans[i];
    if (plan.is_large) return;
    for (std::size_t axis = 0; axis < V::size(); ++axis) {
      const Real lower = grid.edge() * static_cast<Real>(plan.cell[axis]), upper = lower + grid.edge();
      const Real a = plan.acceleration[axis];
      take_crossing(plan, time_to_close(Real(path.x[axis] - lower), path.v[axis], a), axis, -1);
      take_crossing(plan, time_to_close(Real(upper - path.x[axis]), Real(-path.v[axis]), Real(-a)), axis, 1);
    }
  }
  void take_crossing(Plan<Real, Dim>& plan, const Real& wait, std::size_t axis, int direction) {
    if (!(now + wait < plan.crossing_time)) return;
    plan.crossing_time = now + wait;
    plan.axis = static_cast<std::uint8_t>(axis);
    plan.direction = static_cast<std::int8_t>(direction);
  }

  void predict_wall(std::uint32_t i, std::uint32_t w) {
    const Path<Real, Dim>& path = paths[i];
    Plan<Real, Dim>& plan = plans[i];
    const Wall<Real, Dim>& wall = world.walls()[w];
    Real along = dot(wall.normal, path.x) - wall.offset, speed = dot(wall.normal, path.v);
    Real pull = dot(wall.normal, plan.acceleration);
    if (wall.thin && along < Real(0)) along = -along, speed = -speed, pull = -pull;
    if (speed >= Real(0) && pull >= Real(0)) return;
    if (along <= path.radius && pull == Real(0) && is_rounding(Real(-speed), length(path.v))) return;
    const Real wait = time_to_close(Real(along - path.radius), speed, pull);
    note_tie(plan, now + wait);
    if (now + wait < plan.collision_time) {
      plan.collision_time = now + wait;
      plan.partner = first_wall + w;
    }
  }
  /// Before a collision at time t is taken, or is not.
  void note_tie(Plan<Real, Dim>& plan, const Real& t) const {
    const Real near = at_one_time + 16 * std::numeric_limits<Real>::epsilon() * std::abs(t);
    const bool is_near = plan.collision_time <= t + near && t <= plan.collision_time + near;
    plan.is_tied = is_near || (plan.is_tied && t > plan.collision_time);
  }

  /// Predicts the collisions of body i with the first `count` candidates.
  void predict_pairs(std::uint32_t i, std::size_t count) {
    const Path<Real, Dim> me = paths[i];
    curved_.resize(count);
    std::size_t straight = 0, curved = 0;
    for (std::size_t k = 0; k < count; ++k) {
      const std::uint32_t j = candidates_[k];
      const auto falls = static_cast<unsigned>(acts[i] == Act::falls) & static_cast<unsigned>(acts[j] == Act::falls);
      candidates_[straight] = j;
      curved_[curved] = j;
      straight += falls & may_touch(me, paths[j]);
      curved += 1 - falls;
    }
    for (std::size_t k = 0; k < straight; ++k) {
      const Path<Real, Dim>& other = paths[candidates_[k]];
      const Real dt = now - other.t;
      const V apart = other.x + other.v * dt + world.gravity * (dt * dt / 2) - me.x;
      const V rate = other.v + world.gravity * dt - me.v;
      const Real wait = time_to_touch(apart, rate, Real(me.radius + other.radius));
      if (wait > Real(0) || !is_rounding(Real(-dot(apart, rate) / length(apart)), Real(length(me.v) + length(other.v))))
        meet(i, candidates_[k], wait);
    }
    // The time up to which a collision on a curved path is searched depends on the results before: so the order is
    // fixed.
    curved_.resize(curved);
    std::ranges::sort(curved_, {}, [&](std::uint32_t j) { return plans[j].number; });
    for (const std::uint32_t j : curved_) predict_pair(i, j);
  }
  /// Whether two falling bodies approach each other on lines that come within reach. Most neighbours do not, in an
  /// unpredictable order, so that there is no branch here.
  [[nodiscard]] unsigned may_touch(const Path<Real, Dim>& me, const Path<Real, Dim>& other) const {
    const Real dt = now - other.t;
    const V apart = other.x + other.v * dt + world.gravity * (dt * dt / 2) - me.x;
    const V rate = other.v + world.gravity * dt - me.v;
    const Real reach = me.radius + other.radius, b = dot(apart, rate), c = squared(apart) - reach * reach;
    const auto overlap = static_cast<unsigned>(c <= Real(0)), hit = static_cast<unsigned>(b * b >= squared(rate) * c);
    return static_cast<unsigned>(b < Real(0)) & (overlap | hit);
  }

  void predict_pair(std::uint32_t i, std::uint32_t j) {
    if (i == j) return;
    const Path<Real, Dim>&me = paths[i], &other = paths[j];
    const V& a = plans[j].acceleration;
    const Real dt = now - other.t;
    const V apart = other.x + other.v * dt + a * (dt * dt / 2) - me.x;
    const V rate = other.v + a * dt - me.v, pull = a - plans[i].acceleration;
    const Real reach = me.radius + other.radius;
    if (pull == V{}) return meet(i, j, time_to_touch(apart, rate, reach));
    if (some_pass_ && !world.collide(plans[i].number, plans[j].number)) return;
    Plan<Real, Dim>& plan = plans[i];
    const Real end = horizon(plan, plans[j], apart, rate, pull);
    const Real wait = time_to_touch(apart, rate, pull, reach, Real(end - now));
    if (wait < never) {
      meet(i, j, wait);
    } else if (end < plan.collision_time) {
      plan.collision_time = end;
      plan.partner = look_again;
    }
  }
  /// The time up to which a collision on curved paths is searched: the next event of one of the two, or the end of a
  /// time in which they could have collided.
  [[nodiscard]] Real horizon(const Plan<Real, Dim>& plan, const Plan<Real, Dim>& other, const V& apart, const V& rate,
                             const V& pull) const {
    Real end = std::min(plan.collision_time, plan.crossing_time);
    if (other.crossing_time > now) end = std::min(end, other.crossing_time);
    if (end < never) return end;
    using std::sqrt;
    const Real way = length(apart), square = squared(rate) + 2 * length(pull) * way;
    return now + way / sqrt(square);
  }

  void meet(std::uint32_t i, std::uint32_t j, const Real& wait) {
    Plan<Real, Dim>& plan = plans[i];
    const Real t = now + wait;
    note_tie(plan, t);
    if (!(t < plan.collision_time) && !(t == plan.collision_time && t < never && gives_way(plan.partner, j))) return;
    if (some_pass_ && !world.collide(plan.number, plans[j].number)) return;
    plan.collision_time = t;
    plan.partner = j;
    plan.collisions_of_partner = collisions[j];
  }
  /// Whether `partner` comes after j at the same instant: lower numbers come first, and walls before bodies.
  [[nodiscard]] bool gives_way(std::uint32_t partner, std::uint32_t j) const {
    return partner >= look_again || (partner < first_wall && plans[j].number < plans[partner].number);
  }

  bool some_pass_ = false;                 // some groups do not collide with each other
  std::vector<Material<Real>> materials_;  // each but once
  std::vector<std::uint32_t> candidates_, curved_;
};

}  // namespace continuo
