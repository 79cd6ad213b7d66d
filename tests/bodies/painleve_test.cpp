// The rod of P. Painleve ("Sur les lois du frottement de glissement", 1895), which slides with one end on a rough
// floor, against its reduced equations in long double and what is published about them: F. Genot, B. Brogliato, "New
// results on Painleve paradoxes", European Journal of Mechanics A 18, 1999, 653-677.
//
// With the angle q from the floor, its rate w, half the length l, the side (+1 or -1) to which the foot slips with
// velocity v, mass 1 and inertia l^2 / 3, the force N of the floor follows from A N = F with
//
//   A = 1 + 3 cos q (cos q + side f sin q),   F = g - l sin q w^2.
//
// Above a friction f of 4/3 there are angles with A < 0: there F > 0 has no force N, and F < 0 two motions.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <optional>
#include <random>
#include <string>
#include <utility>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <continuo/bodies/exact_motion.hpp>
#include <continuo/status/require.hpp>

namespace continuo::painleve_test {
namespace {

using Wide = long double;
using World2 = World<double, 2>;
constexpr double g = 9.81;
constexpr Wide right_angle = std::numbers::pi_v<Wide> / 2;

/// A box is such a rod to the last digit: its inertia is a third of the square of half its diagonal.
struct Rod {
  double width = 1, height = 0.05, friction = 1;
  int side = -1;
  bool is_mirrored = false;

  [[nodiscard]] double half() const { return std::hypot(width, height) / 2; }
  /// The angle of the diagonal in the box.
  [[nodiscard]] double diagonal() const { return std::atan2(height, width); }
};
struct State {
  Wide q = 0, w = 0, v = 0, t = 0;
};

// The referee.

Wide parting(const Rod& rod, Wide q) {
  return 1 + 3 * std::cos(q) * (std::cos(q) + rod.side * rod.friction * std::sin(q));
}
Wide load(const Rod& rod, const State& s) {
  return g - rod.half() * std::sin(s.q) * s.w * s.w;
}
/// The angle from where another corner comes near to the floor: the rod lies, or lies on its other side.
Wide room(const Rod& rod, Wide q) {
  constexpr Wide margin = 0.02L;
  return std::min(q - rod.diagonal(), right_angle + rod.diagonal() - q) - margin;
}
/// The derivatives by a time that goes on by dt / A: so they stay smooth where A falls to 0.
State rates(const Rod& rod, const State& s) {
  const Wide c = std::cos(s.q), n = std::sin(s.q), l = rod.half(), rub = rod.side * Wide(rod.friction);
  const Wide a = 1 + 3 * c * (c + rub * n), force = load(rod, s), turning_on = -3 / l * (c + rub * n) * force;
  return {a * s.w, turning_on, -rub * force + l * (n * turning_on + a * c * s.w * s.w), a};
}
State moved(const State& s, const State& by, Wide h) {
  return {s.q + h * by.q, s.w + h * by.w, s.v + h * by.v, s.t + h * by.t};
}
/// A step by the midpoint rule with 2, 4, 6 and 8 parts, whose errors have even powers only, extrapolated to order 8
/// (E. Hairer, S. P. Norsett, G. Wanner, "Solving Ordinary Differential Equations I", II.9).
State after(const Rod& rod, const State& s, Wide h) {
  std::array<State, 4> table{};
  const State first = rates(rod, s);
  for (std::size_t row = 0; row < table.size(); ++row) {
    const std::size_t parts = 2 * row + 2;
    const Wide part = h / static_cast<Wide>(parts);
    State before = s, now = moved(s, first, part);
    for (std::size_t k = 1; k < parts; ++k) before = std::exchange(now, moved(before, rates(rod, now), 2 * part));
    table[row] = now;
    for (std::size_t column = row; column-- > 0;) {
      const auto ratio = static_cast<Wide>(parts) / static_cast<Wide>(2 * column + 2);
      const State &fine = table[column + 1], coarse = table[column];
      table[column] = moved(fine, moved(fine, coarse, -1), 1 / (ratio * ratio - 1));
    }
  }
  return table[0];
}
enum class End { comes_off, stops, jams, slides };
struct Ended {
  End end = End::slides;
  State at{};
};
/// Until the rod comes off, stops, jams (A falls to 0) or nearly lies, or until a time.
Ended followed(const Rod& rod, State s, Wide until) {
  constexpr Wide smallest = 1e-12L;
  const auto guards = [&](const State& at) {
    return std::array{load(rod, at), rod.side * at.v, until - at.t, room(rod, at.q)};
  };
  const Wide step = std::sqrt(Wide(rod.half()) / g) / 120;
  while (parting(rod, s.q) > smallest) {
    const State next = after(rod, s, step);
    Wide first = step;
    std::optional<std::size_t> which;
    const auto now = guards(next);
    for (std::size_t k = 0; k < now.size(); ++k) {
      if (!(now[k] < 0) || !(guards(after(rod, s, first))[k] < 0)) continue;
      Wide low = 0, high = first;
      for (int round = 0; round < 64; ++round)
        (guards(after(rod, s, (low + high) / 2))[k] < 0 ? high : low) = (low + high) / 2;
      first = high, which = k;
    }
    if (which) return {*which == 0 ? End::comes_off : *which == 1 ? End::stops : End::slides, after(rod, s, first)};
    s = next;
  }
  return {End::jams, s};
}
State flown(const State& s, Wide l, Wide duration) {
  State end{s.q + s.w * duration, s.w, 0, s.t + duration};
  const Wide v_of_centre = s.v - l * std::sin(s.q) * s.w;
  end.v = v_of_centre + l * std::sin(end.q) * s.w;
  return end;
}
/// With its foot at rest; nothing where that needs more friction than there is.
std::optional<State> stuck(const Rod& rod, State s, Wide duration) {
  constexpr int steps = 100;
  const Wide l = rod.half(), h = duration / steps;
  const auto turning_on = [&](Wide q) { return -g * std::cos(q) / (l + l / 3); };
  for (int k = 0;; ++k) {
    const Wide a = turning_on(s.q), c = std::cos(s.q), n = std::sin(s.q);
    if (!(room(rod, s.q) > 0)) return {};
    const Wide press = g + l * (c * a - n * s.w * s.w), hold = -l * (n * a + c * s.w * s.w);
    if (!(press > 0) || !(std::abs(hold) < Wide(rod.friction) * press)) return {};
    if (k == steps) return s;
    const Wide k1 = s.w, l1 = a, k2 = s.w + h / 2 * l1, l2 = turning_on(s.q + h / 2 * k1), k3 = s.w + h / 2 * l2;
    const Wide l3 = turning_on(s.q + h / 2 * k2), k4 = s.w + h * l3, l4 = turning_on(s.q + h * k3);
    s = {s.q + h / 6 * (k1 + 2 * k2 + 2 * k3 + k4), s.w + h / 6 * (l1 + 2 * l2 + 2 * l3 + l4), 0, s.t + h};
  }
}
/// A short time after the rod came off or stopped, where it does the same all the while: flies, sticks, or slips back.
std::optional<State> continued(const Rod& rod, const Ended& from, Wide duration) {
  if (from.end == End::comes_off) {
    const State end = flown(from.at, rod.half(), duration);
    return end.q < right_angle ? std::optional(end) : std::nullopt;  // beyond, it falls back at once
  }
  if (const auto held = stuck(rod, from.at, duration)) return held;
  Rod back = rod;
  back.side = -rod.side;
  State start = from.at;
  start.v = 0;
  const State change = rates(back, start);
  if (!(change.t > 0) || !(change.v * back.side > 0) || !(load(back, start) > 0)) return {};
  const Ended end = followed(back, start, start.t + duration);
  if (end.end != End::slides || end.at.t < start.t + duration - 1e-15L) return {};
  return end.at;
}

// The exact motion.

World2 world_of(const Rod& rod, const State& start) {
  const auto q = static_cast<double>(start.q), w = static_cast<double>(start.w), v = static_cast<double>(start.v);
  const double l = rod.half(), mirror = rod.is_mirrored ? -1 : 1;
  const Material<double> material{.restitution = 0, .friction = rod.friction};
  World2 world;
  world.gravity = {{0, -g}};
  require(world.add_wall({.material = material}));
  require(world.add({.shape = Box<double, 2>{{{rod.width, rod.height}}},
                     .position = {{mirror * l * std::cos(q), l * std::sin(q)}},
                     .velocity = {{mirror * (v - l * std::sin(q) * w), l * std::cos(q) * w}},
                     .orientation = {{mirror * (q - rod.diagonal())}},
                     .spin = {{mirror * w}},
                     .mass = 1,
                     .material = material}));
  return world;
}
State state_of(const Rod& rod, const World2& world) {
  const double mirror = rod.is_mirrored ? -1 : 1;
  const double q = mirror * world.orientation[0][0] + rod.diagonal(), w = mirror * world.spin[0][0];
  return {q, w, mirror * world.velocity[0][0] + rod.half() * std::sin(q) * w, world.time};
}
struct Moved {
  Status status{};
  State at{};
  std::optional<double> left{};  // the floor
};
Moved moved_to(const Rod& rod, const State& start, Wide t) {
  World2 world = world_of(rod, start);
  ExactMotion motion(world, {.tolerance = 1e-13, .contact_events = 10});
  Moved made{.status = motion.advance_to(static_cast<double>(t))};
  made.at = state_of(rod, world);
  for (const auto& event : motion.contact_events())
    if (event.change == ContactChange::end && !made.left) made.left = event.time;
  return made;
}
void expect_near(const State& one, const State& other) {
  constexpr double most = 1e-8;
  EXPECT_NEAR(static_cast<double>(one.q - other.q), 0, most);
  EXPECT_NEAR(static_cast<double>(one.w - other.w), 0, most);
  EXPECT_NEAR(static_cast<double>(one.v - other.v), 0, most);
}

class Starts {
 public:
  explicit Starts(unsigned seed) : random_(seed) {}
  double between(double low, double high) { return std::uniform_real_distribution(low, high)(random_); }
  Rod rod(double least_friction, double most_friction) {
    Rod rod{.width = between(0.5, 3)};
    rod.height = rod.width * between(0.01, 0.1);
    rod.friction = between(least_friction, most_friction);
    rod.is_mirrored = between(0, 1) < 0.5;
    return rod;
  }
  /// Any at which the floor presses the rod.
  State sliding(const Rod& rod) {
    for (;;) {
      const double q = between(rod.diagonal() + 0.1, 1.45), spin = std::sqrt(g / (rod.half() * std::sin(q)));
      const State s{q, between(-0.95, 0.95) * spin, rod.side * std::exp(between(-1, 4)), 0};
      if (parting(rod, s.q) > 0.02) return s;
    }
  }
  /// One at which A is below 0.
  State paradoxical(const Rod& rod) {
    for (;;) {
      const State s{between(rod.diagonal() + 0.1, 1.45), between(-3, 3) * std::sqrt(g / rod.half()),
                    rod.side * between(1, 20), 0};
      if (parting(rod, s.q) < -0.02 && std::abs(load(rod, s)) > 0.1) return s;
    }
  }

 private:
  std::mt19937_64 random_;
};

void check_change(const Rod& rod, const State& start, const Ended& end, int& continuations) {
  const Wide later = std::sqrt(Wide(rod.half()) / g) / 20;
  const Moved then = moved_to(rod, start, end.at.t + later);
  ASSERT_TRUE(then.status) << describe(then.status);
  if (end.end == End::comes_off) {
    ASSERT_TRUE(then.left);
    EXPECT_NEAR(*then.left, static_cast<double>(end.at.t), 1e-8);
  } else {
    // It still slips shortly before, and no more shortly after.
    EXPECT_GT(rod.side * moved_to(rod, start, end.at.t - 1e-8L).at.v, 0);
    EXPECT_LT(rod.side * moved_to(rod, start, end.at.t + 1e-8L).at.v, 1e-12);
  }
  const auto expected = continued(rod, end, later);
  if (!expected) return;
  ++continuations;
  expect_near(then.at, *expected);
}
/// Where the rod comes off or stops with A nearly 0, it turns ever faster in a time and by an angle below rounding: it
/// may as well jam there.
void check_beside_a_jam(const Rod& rod, const State& start, const State& end) {
  const Moved made = moved_to(rod, start, end.t);
  EXPECT_TRUE(made.status || made.status.message.find("Painleve") != std::string::npos) << describe(made.status);
  EXPECT_NEAR(static_cast<double>(made.at.t - end.t), 0, 1e-8);
  EXPECT_NEAR(static_cast<double>(made.at.q - end.q), 0, 1e-8);
}
/// The forces grow beyond all bounds, and no motion goes on from there; angle and time have a limit.
void check_jam(const Rod& rod, const State& start, const State& end) {
  const Moved ended = moved_to(rod, start, end.t + 0.1L);
  EXPECT_EQ(ended.status.ending, Ending::cannot_continue);
  EXPECT_THAT(ended.status.message, testing::HasSubstr("Painleve"));
  EXPECT_NEAR(static_cast<double>(ended.at.t - end.t), 0, 1e-8);
  EXPECT_NEAR(static_cast<double>(ended.at.q - end.q), 0, 1e-8);
}

TEST(Painleve, SlidesUntilItComesOffStopsOrJams) {
  constexpr int starts = 300;
  const double jam = 8 / (3 * std::sqrt(3.0));
  Starts any(1895);
  std::array<int, 4> below{}, between{}, above{};
  int continuations = 0;
  for (int k = 0; k < starts; ++k) {
    SCOPED_TRACE(k);
    const int kind = k % 3;
    Rod rod = kind == 0 ? any.rod(0.2, 4.0 / 3) : kind == 1 ? any.rod(4.0 / 3, jam - 0.05) : any.rod(jam + 0.05, 3);
    if (k % 4 == 0) rod.side = 1;
    const State start = any.sliding(rod);
    const Ended end = followed(rod, start, 1);
    (kind == 0 ? below : kind == 1 ? between : above)[static_cast<std::size_t>(end.end)]++;
    if (end.end == End::jams) {
      const Wide before = end.at.t * 0.9L;
      expect_near(moved_to(rod, start, before).at, followed(rod, start, before).at);
      check_jam(rod, start, end.at);
      continue;
    }
    if (parting(rod, end.at.q) < 1e-5) {
      check_beside_a_jam(rod, start, end.at);
      continue;
    }
    const Moved made = moved_to(rod, start, end.at.t);
    ASSERT_TRUE(made.status) << describe(made.status);
    expect_near(made.at, end.at);
    if (end.end != End::slides) check_change(rod, start, end, continuations);
  }
  for (const auto& counts : {below, between, above})
    for (const End end : {End::comes_off, End::stops, End::slides}) EXPECT_GE(counts[static_cast<std::size_t>(end)], 3);
  // Below 4/3 A is above 0, and up to 8 / 3^(3/2) the rod comes off before A is 0.
  EXPECT_EQ(below[static_cast<std::size_t>(End::jams)], 0);
  EXPECT_EQ(between[static_cast<std::size_t>(End::jams)], 0);
  EXPECT_GE(above[static_cast<std::size_t>(End::jams)], 5);
  EXPECT_GE(continuations, 30);
}

// Where two motions satisfy Coulomb's law, one slides by forces that the least give of the floor would drive away from
// their values: the rod comes off. Where none does, it does not move.
TEST(Painleve, ComesOffOrJamsAtOnceInsideTheParadox) {
  Starts any(1999);
  int off = 0, jams = 0;
  for (int k = 0; k < 60; ++k) {
    SCOPED_TRACE(k);
    const Rod rod = any.rod(1.5, 4);
    const State start = any.paradoxical(rod);
    const Wide soon = 1e-3L;
    const Moved made = moved_to(rod, start, soon);
    if (load(rod, start) > 0) {
      ++jams;
      EXPECT_EQ(made.status.ending, Ending::cannot_continue);
      EXPECT_THAT(made.status.message, testing::HasSubstr("Painleve"));
      EXPECT_EQ(made.at.t, 0);
    } else {
      ++off;
      ASSERT_TRUE(made.status) << describe(made.status);
      expect_near(made.at, flown(start, rod.half(), soon));
    }
  }
  EXPECT_GE(off, 15);
  EXPECT_GE(jams, 15);
}

}  // namespace
}  // namespace continuo::painleve_test
