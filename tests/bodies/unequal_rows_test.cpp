// Rows of two to seven balls whose masses differ by up to eight powers of ten, between walls or without them: thousands
// of collisions, which the exact motions are to answer as the referee does, collision by collision in long double.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include <continuo/bodies/exact_motion.hpp>

namespace continuo::unequal_rows_test {
namespace {

using Real = long double;

/// Points on a line, between walls at 0 and `length`, or without them.
struct Row {
  std::vector<Real> x, v, m;
  Real restitution = 1, length = 0;
  bool has_walls = false;

  [[nodiscard]] std::size_t size() const { return x.size(); }
  [[nodiscard]] Real fastest() const {
    Real most = 0;
    for (const Real one : v) most = std::max(most, std::abs(one));
    return most;
  }
};

struct Next {
  Real after = 1e30L;
  std::size_t place = 0;  // of the left one of two; size() and size() + 1 are the walls
};
Next next_of(const Row& row) {
  Next next;
  const auto take = [&next](Real after, std::size_t place) {
    if (after < next.after) next = {after, place};
  };
  const std::size_t n = row.size();
  for (std::size_t i = 0; i + 1 < n; ++i)
    if (const Real closing = row.v[i] - row.v[i + 1]; closing > 1e-18L)
      take(std::max<Real>(row.x[i + 1] - row.x[i], 0) / closing, i);
  if (!row.has_walls) return next;
  if (row.v[0] < 0) take(row.x[0] / -row.v[0], n);
  if (row.v[n - 1] > 0) take((row.length - row.x[n - 1]) / row.v[n - 1], n + 1);
  return next;
}
void collide(Row& row, std::size_t at) {
  const std::size_t n = row.size();
  if (at >= n) {
    row.v[at == n ? 0 : n - 1] *= -row.restitution;
    return;
  }
  const Real impulse = (1 + row.restitution) * (row.v[at] - row.v[at + 1]) / (1 / row.m[at] + 1 / row.m[at + 1]);
  row.v[at] -= impulse / row.m[at], row.v[at + 1] += impulse / row.m[at + 1];
}
/// Moves the row, and returns the number of collisions; nothing where they do not end.
std::optional<std::size_t> advance(Row& row, Real duration) {
  constexpr std::size_t most = 200'000;
  for (std::size_t collisions = 0; collisions < most; ++collisions) {
    const Next next = next_of(row);
    const Real step = std::min(next.after, duration);
    for (std::size_t i = 0; i < row.size(); ++i) row.x[i] += row.v[i] * step;
    duration -= step;
    if (!(duration > 0)) return collisions;
    collide(row, next.place);
  }
  return {};
}

Row random_row(std::mt19937& engine) {
  const auto between = [&](double low, double high) { return std::uniform_real_distribution(low, high)(engine); };
  Row row;
  const double losses[] = {0, 0, 0, 1e-6, 1e-3, 1e-2};
  row.restitution = 1 - losses[engine() % 6];
  row.has_walls = engine() % 2 == 0;
  const double power = between(0, 4);
  const std::size_t count = 2 + engine() % 6;
  Real x = 0.1L;
  for (std::size_t i = 0; i < count; ++i, x += between(0.05, 1)) {
    row.x.push_back(x), row.v.push_back(between(-1, 1));
    row.m.push_back(std::pow(10, between(-power, power)));
  }
  row.length = x;
  return row;
}
/// Balls of diameter 1 with the gaps of the row.
template <int Dim>
World<double, Dim> world_of(const Row& row, double friction) {
  World<double, Dim> world;
  const Material<double> material{.restitution = static_cast<double>(row.restitution), .friction = friction};
  for (const bool is_right : {false, true}) {
    if (!row.has_walls) break;
    Wall<double, Dim> wall{.material = material};
    wall.normal = {}, wall.normal[0] = is_right ? -1 : 1;
    if (is_right) wall.offset = -(static_cast<double>(row.length) + static_cast<double>(row.size()));
    EXPECT_TRUE(world.add_wall(wall));
  }
  for (std::size_t i = 0; i < row.size(); ++i) {
    BodyDefinition<double, Dim> ball{.mass = static_cast<double>(row.m[i]), .material = material};
    ball.position[0] = static_cast<double>(row.x[i]) + static_cast<double>(i) + 0.5;
    ball.velocity[0] = static_cast<double>(row.v[i]);
    EXPECT_TRUE(world.add(ball));
  }
  return world;
}

/// Moves `count` rows by the motion that `prepare` makes the world ask for. How much rounding matters is asked of the
/// referee: positions that differ by 1e-13 change its velocities by so much, which a motion whose positions differ by
/// the rounding of double, some hundred times less, times its many collisions, is not to exceed by far.
template <int Dim, class Prepare>
void expect_as_the_referee(unsigned seed, int count, double friction, Prepare&& prepare) {
  std::mt19937 engine(seed);
  int compared = 0;
  for (int k = 0; k < count; ++k) {
    const Row begin = random_row(engine);
    const Real duration = std::uniform_real_distribution(0.5, 4.0)(engine);
    Row row = begin, other = begin;
    for (Real& x : other.x) x *= 1 + 1e-13L * std::uniform_real_distribution(-1.0, 1.0)(engine);
    const auto collisions = advance(row, duration);
    if (!collisions || !advance(other, duration)) continue;
    Real change = 0;
    for (std::size_t i = 0; i < row.size(); ++i) change = std::max(change, std::abs(row.v[i] - other.v[i]));
    if (!(change < 1e-7L * row.fastest())) continue;  // another order of collisions
    ++compared;
    World<double, Dim> world = world_of<Dim>(begin, friction);
    prepare(world, begin);
    ExactMotion<double, Dim> motion(world);
    const Status status = motion.advance_to(static_cast<double>(duration));
    ASSERT_TRUE(status) << status.message << " row " << k;
    const Real tolerance = 1e4L * change + row.fastest() * (1e-9L + 1e-11L * static_cast<Real>(*collisions));
    for (std::size_t i = 0; i < row.size(); ++i)
      EXPECT_NEAR(world.velocity[i][0], static_cast<double>(row.v[i]), static_cast<double>(tolerance))
          << "row " << k << " of " << row.size() << ", " << *collisions << " collisions";
  }
  EXPECT_GT(compared, count * 9 / 10);
}

const auto as_it_is = [](auto&, const Row&) {};

TEST(UnequalRows, OfDiscsAsTheReferee) {
  expect_as_the_referee<2>(1, 300, 0, as_it_is);
}
TEST(UnequalRows, OfBallsThatRubAsTheReferee) {
  expect_as_the_referee<3>(2, 300, 0.5, as_it_is);
}
// A force law makes the paths those of an integration.
TEST(UnequalRows, UnderForcesAsTheReferee) {
  const auto forced = [](auto& world, const Row&) {
    world.force_laws.emplace_back([](const auto&, double, auto, auto, auto) {});
  };
  expect_as_the_referee<2>(3, 50, 0, forced);
  expect_as_the_referee<3>(4, 50, 0, forced);
}
// A box far away makes the motion that of bodies of any shape.
TEST(UnequalRows, BesideABoxAsTheReferee) {
  const auto beside = [](World<double, 2>& world, const Row& row) {
    const double middle = static_cast<double>(row.length) / 2 + static_cast<double>(row.size()) / 2;
    EXPECT_TRUE(world.add({.shape = Box<double, 2>{}, .position = {{middle, 1000}}}));
  };
  expect_as_the_referee<2>(5, 100, 0, beside);
}

}  // namespace
}  // namespace continuo::unequal_rows_test
