// continuo/bodies/flights.hpp
// Bodies on parabolas, each at a time of its own, and whom each meets next, were nobody else to change its path: what
// the event-driven motion moves from one event to the next.
//
// Bodies are kept in the order of their cells, so that those that meet lie near in memory: a `place` is where one is in
// that order, its `number` where it is in the world. Of events at one instant, walls come before bodies and lower
// numbers before higher, whatever the order in memory.
#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include <continuo/bodies/cell_grid.hpp>
#include <continuo/bodies/collision_time.hpp>
#include <continuo/bodies/world.hpp>

namespace continuo {

/// Of cells that hold about one body and are wider than any but the few large ones.
template <class Real, int Dim>
Real edge_of_cells(const World<Real, Dim>& world) {
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
  return std::max(Real(2) * widest, std::min(spacing, 1000 * widest)) * Real(1.0001);
}

// Who the next collision is with: a body below first_wall, a wall from there on, nobody known yet.
inline constexpr std::uint32_t nobody = std::numeric_limits<std::uint32_t>::max(), look_again = nobody - 1,
                               first_wall = std::uint32_t{1} << 31;

/// What others look at who seek their next collision: with doubles a cache line in space.
template <class Real, int Dim>
struct alignas(sizeof(Real) * (Dim == 3 ? 8 : 2)) Path {
  Vector<Real, Dim> x{}, v{};  // at the time t of its own
  Real t{}, radius{};
};

/// How a body is accelerated.
enum class Act : std::uint8_t { falls, rests, is_fixed };

/// What else a look at another needs.
struct Mark {
  std::uint32_t collisions : 30 = 0;  // so many changes of its path; a prediction holds for one of them
  Act act : 2 = Act::falls;
};

template <class Real, int Dim>
struct Plan {
  static constexpr Real never = std::numeric_limits<Real>::infinity();
  Real collision_time = never, crossing_time = never, last_collision = -never, spun_to{}, spun_since{}, rests_since{};
  Real path_end = never;  // when it is accelerated otherwise, though nothing hits it: see rolling.hpp
  Real inverse_mass{}, inverse_inertia{};
  Vector<Real, Dim> acceleration{};
  Spin<Real, Dim> spin{}, spin_rate{};  // at the time spun_since; the orientation is of spun_to
  Material<Real> material{};
  typename CellGrid<Real, Dim>::Cell cell{};
  std::uint32_t number = 0, partner = nobody, collisions_of_partner = 0;
  std::array<std::uint32_t, static_cast<std::size_t>(Dim)> supports{};  // the walls it rests on
  std::uint8_t support_count = 0;
  std::uint8_t at_once = 0;  // so many collisions before the last, at the same instant; no more than 255
  bool is_large = false;
  std::int8_t direction = 0;  // of the crossing, along the axis
  std::uint8_t axis = 0;
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
    paths.resize(n);
    plans.resize(n);
    marks.resize(n);
    for (std::uint32_t i = 0; i < n; ++i) take_from_world(i);
  }

  const World<Real, Dim>& world;
  Real now;
  std::vector<Path<Real, Dim>> paths;
  std::vector<Plan<Real, Dim>> plans;
  std::vector<Mark> marks;
  std::vector<std::uint32_t> large;  // too wide for the cells, or too far out: everybody's neighbours
  Grid grid;

  static void advance(Path<Real, Dim>& path, const V& acceleration, const Real& t) {
    const Real dt = t - path.t;
    path.x += path.v * dt + acceleration * (dt * dt / 2);
    path.v += acceleration * dt;
    path.t = t;
  }
  void move_to_now(std::uint32_t i) { advance(paths[i], plans[i].acceleration, now); }

  static bool is_support(const Plan<Real, Dim>& plan, std::uint32_t w) {
    const auto end = plan.supports.begin() + plan.support_count;
    return std::find(plan.supports.begin(), end, w) != end;
  }

  /// When body i crosses into another cell and whom it meets first. Brings it to the present.
  void predict(std::uint32_t i) {
    Plan<Real, Dim>& plan = plans[i];
    plan.crossing_time = never;
    plan.collision_time = plan.path_end;
    plan.partner = plan.path_end < never ? look_again : nobody;
    if (marks[i].act == Act::is_fixed) return;
    move_to_now(i);
    predict_crossing(i);
    for (std::uint32_t w = 0; w < world.walls().size(); ++w)
      if (marks[i].act != Act::rests || !is_support(plan, w)) predict_wall(i, w);
    std::size_t count = 0;
    if (plan.is_large) {
      candidates_.resize(std::max(candidates_.size(), paths.size()));
      for (std::uint32_t j = 0; j < paths.size(); ++j) candidates_[count++] = j;
    } else {
      auto lower = plan.cell, upper = plan.cell;
      for (std::size_t axis = 0; axis < lower.size(); ++axis) --lower[axis], ++upper[axis];
      count = grid.gather(lower, upper, candidates_, 0);
      if (candidates_.size() < count + large.size()) candidates_.resize(count + large.size());
      for (const std::uint32_t j : large) candidates_[count++] = j;
    }
    predict_pairs(i, count);
  }

  /// It has come to another cell: only the bodies of those that have come into sight are new.
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
    predict_pairs(i, grid.gather(lower, upper, candidates_, 0));
  }

 private:
  void take_from_world(std::uint32_t i) {
    Path<Real, Dim>& path = paths[i];
    Plan<Real, Dim>& plan = plans[i];
    path = {world.position[i], world.velocity[i], now, world.radius[i]};
    marks[i].act = world.is_fixed(i) ? Act::is_fixed : Act::falls;
    plan.number = i;
    plan.spun_to = plan.spun_since = now;
    plan.inverse_mass = world.inverse_mass[i];
    plan.inverse_inertia = world.inverse_inertia[i];
    plan.acceleration = world.is_fixed(i) ? V{} : world.gravity;
    plan.spin = world.spin[i];
    plan.material = world.material[i];
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
    const Wall<Real, Dim> wall = facing(world.walls()[w], path.x);
    const Real gap = dot(wall.normal, path.x) - wall.offset - path.radius;
    const Real wait = time_to_close(gap, dot(wall.normal, path.v), dot(wall.normal, plan.acceleration));
    if (now + wait < plan.collision_time) {
      plan.collision_time = now + wait;
      plan.partner = first_wall + w;
    }
  }

  /// Of the first `count` candidates, those that body i meets before all others.
  void predict_pairs(std::uint32_t i, std::size_t count) {
    const Path<Real, Dim> me = paths[i];
    curved_.resize(count);
    std::size_t straight = 0, curved = 0;
    for (std::size_t k = 0; k < count; ++k) {
      const std::uint32_t j = candidates_[k];
      const auto falls =
          static_cast<unsigned>(marks[i].act == Act::falls) & static_cast<unsigned>(marks[j].act == Act::falls);
      candidates_[straight] = j;
      curved_[curved] = j;
      straight += falls & may_touch(me, paths[j]);
      curved += 1 - falls;
    }
    for (std::size_t k = 0; k < straight; ++k) {
      const Path<Real, Dim>& other = paths[candidates_[k]];
      const Real dt = now - other.t;
      meet(i, candidates_[k],
           time_to_touch(V(other.x + other.v * dt + world.gravity * (dt * dt / 2) - me.x),
                         V(other.v + world.gravity * dt - me.v), Real(me.radius + other.radius)));
    }
    // How far ahead a meeting on a curved path is looked for depends on what was found before: always in one order.
    curved_.resize(curved);
    std::ranges::sort(curved_, {}, [&](std::uint32_t j) { return plans[j].number; });
    for (const std::uint32_t j : curved_) predict_pair(i, j);
  }
  /// Whether two that fall alike approach on lines that come within reach: most neighbours do not, in no order that a
  /// processor could foresee, so that there is no branch here.
  unsigned may_touch(const Path<Real, Dim>& me, const Path<Real, Dim>& other) const {
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
  /// How far ahead a meeting on curved paths is looked for: until one of the two does something else, or for a time in
  /// which they could have met.
  Real horizon(const Plan<Real, Dim>& plan, const Plan<Real, Dim>& other, const V& apart, const V& rate,
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
    if (!(t < plan.collision_time) && !(t == plan.collision_time && t < never && gives_way(plan.partner, j))) return;
    if (some_pass_ && !world.collide(plan.number, plans[j].number)) return;
    plan.collision_time = t;
    plan.partner = j;
    plan.collisions_of_partner = marks[j].collisions;
  }
  /// Of two partners at one instant the lower number comes first, walls before both.
  bool gives_way(std::uint32_t partner, std::uint32_t j) const {
    return partner >= look_again || (partner < first_wall && plans[j].number < plans[partner].number);
  }

  bool some_pass_ = false;  // through each other: groups are to be asked
  std::vector<std::uint32_t> candidates_, curved_;
};

}  // namespace continuo
