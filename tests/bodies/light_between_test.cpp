// A light body between a wall and a heavy one, of any ratio of masses, restitution and gap: the two strike each other
// up to 30,000 times within a time in which nothing falls. The referee follows the two along their line in long double,
// by the closed form of every collision. Earlier versions took so many collisions in so short a time for an inelastic
// collapse, and said success where all the energy was gone.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <random>
#include <string>

#include <gtest/gtest.h>

#include <continuo/bodies/exact_motion.hpp>

namespace continuo::light_between_test {
namespace {

struct Squeezed {
  double ratio = 1, restitution = 1, pull = 0;  // pull: gravity towards the wall
  double light_gap = 0.1, heavy_gap = 0.1;      // of the light body to the wall, of the heavy one to the light one
  double until = 0.5;
};

/// The two along their line, as gaps and velocities: the wall is at 0, and bodies have no size.
class Referee {
 public:
  explicit Referee(const Squeezed& of)
      : e_(of.restitution), ratio_(of.ratio), pull_(of.pull), light_(of.light_gap), heavy_(light_ + of.heavy_gap) {
    while (step(static_cast<long double>(of.until))) ++collisions;
  }
  long double light_velocity = 0, heavy_velocity = -1;
  std::size_t collisions = 0;
  long double least_gap = std::numeric_limits<long double>::infinity();  // of the heavy body to the wall, at collisions
  [[nodiscard]] long double light() const { return light_; }
  [[nodiscard]] long double heavy() const { return heavy_; }

 private:
  static constexpr long double never = std::numeric_limits<long double>::infinity();

  /// When what is at a distance x above a place, with velocity v and falling by `pull`, is there: the later root of
  /// x + v t - pull t^2 / 2, written so that nothing cancels.
  [[nodiscard]] static long double time_to_fall(long double x, long double v, long double pull) {
    const long double root = std::sqrt(v * v + 2 * pull * x);
    if (v < 0) return 2 * x / (root - v);
    return pull > 0 ? (root + v) / pull : never;
  }
  /// To the next collision. False where there is none until then, or the two lie at the wall.
  [[nodiscard]] bool step(long double until) {
    constexpr long double rounding = 1e-17L;
    const bool light_rests = light_ == 0 && light_velocity <= 1e-12L * pull_;
    if (light_rests) light_velocity = 0;
    const long double closing = light_velocity - heavy_velocity, between = heavy_ - light_;
    const long double at_wall = light_rests ? never : time_to_fall(light_, light_velocity, pull_),
                      at_heavy = light_rests          ? time_to_fall(between, heavy_velocity, pull_)
                                 : closing > rounding ? between / closing
                                                      : never;
    const long double next = std::min(at_wall, at_heavy), left = until - time_, dt = std::min(next, left);
    if (!light_rests) light_ += dt * (light_velocity - pull_ * dt / 2), light_velocity -= pull_ * dt;
    heavy_ += dt * (heavy_velocity - pull_ * dt / 2), heavy_velocity -= pull_ * dt;
    time_ += dt;
    if (!(next <= left)) return false;
    if (at_wall <= at_heavy) {
      light_ = 0, light_velocity = -e_ * light_velocity;
    } else {
      light_ = heavy_;
      const long double change = (1 + e_) * (light_velocity - heavy_velocity) / (1 + ratio_);
      light_velocity -= ratio_ * change, heavy_velocity += change;
    }
    least_gap = std::min(least_gap, heavy_);
    if (heavy_ > 1e-15L) return true;
    heavy_ = light_ = heavy_velocity = light_velocity = 0;
    return false;
  }

  long double e_, ratio_, pull_, light_, heavy_, time_ = 0;
};

/// The same as balls, or as boxes where the rigid motion is asked for.
World<double, 2> world_of(const Squeezed& of, bool with_boxes) {
  World<double, 2> world;
  world.gravity = {{-of.pull, 0}};
  const Material<double> material{.restitution = of.restitution};
  EXPECT_TRUE(world.add_wall({.normal = {{1, 0}}, .material = material}));
  for (const auto& [x, v, mass] :
       {std::array{0.5 + of.light_gap, 0.0, 1.0}, std::array{1.5 + of.light_gap + of.heavy_gap, -1.0, of.ratio}}) {
    BodyDefinition<double, 2> body{.position = {{x, 0}}, .velocity = {{v, 0}}, .mass = mass, .material = material};
    if (with_boxes) body.shape = Box<double, 2>{};
    EXPECT_TRUE(world.add(body));
  }
  return world;
}

/// What rounding may change: a collision is located to some roundings of a position of size 2, which is a share of the
/// gap in which the light body flies; each of them changes by that share when, and how often, the next ones are.
/// What has come to rest at the wall is there.
double tolerance_of(const Referee& referee, double tolerance_of_path) {
  if (referee.heavy() == 0) return 1e-6;
  const double rounding = 64 * std::numeric_limits<double>::epsilon() + tolerance_of_path;
  return static_cast<double>(referee.collisions + 4) * rounding / static_cast<double>(referee.least_gap);
}

template <class Prepare>
void expect_as_the_referee(const Squeezed& of, bool with_boxes, double tolerance_of_path, Prepare&& prepare) {
  SCOPED_TRACE(testing::Message() << "ratio " << of.ratio << " restitution " << of.restitution << " pull " << of.pull
                                  << " gaps " << of.light_gap << " " << of.heavy_gap);
  const Referee referee(of);
  auto world = world_of(of, with_boxes);
  prepare(world);
  ExactMotion motion(world);
  const Status status = motion.advance_to(of.until);
  if (!status && of.ratio > 3e6) {  // more than sweeps with friction can tell apart
    EXPECT_NE(status.message.find("were not found"), std::string::npos) << status.message;
    return;
  }
  ASSERT_TRUE(status) << status.message << " after " << referee.collisions;
  const double tolerance = tolerance_of(referee, tolerance_of_path);
  if (!(tolerance < 1e-3)) return;  // rounding decides
  EXPECT_NEAR(world.velocity[1][0], static_cast<double>(referee.heavy_velocity), tolerance) << referee.collisions;
  EXPECT_NEAR(world.position[1][0], static_cast<double>(referee.heavy()) + 1.5, tolerance) << referee.collisions;
  const double energy = of.ratio * std::pow(static_cast<double>(referee.heavy_velocity), 2) +
                        std::pow(static_cast<double>(referee.light_velocity), 2);
  EXPECT_NEAR((of.ratio * squared(world.velocity[1]) + squared(world.velocity[0])) / of.ratio, energy / of.ratio,
              4 * tolerance)
      << referee.collisions;
}

Squeezed random(std::mt19937& engine, double greatest_power, double greatest_pull) {
  const auto between = [&](double low, double high) { return std::uniform_real_distribution(low, high)(engine); };
  Squeezed of;
  of.ratio = std::pow(10, between(0, greatest_power));
  // A collapse needs 1 - e above about pi / sqrt(ratio): restitutions on both sides of it.
  const double losses[] = {0, 1e-9, 1e-6, 1e-4, 1e-3, 0.01, 0.1, 0.5, 0.9};
  of.restitution = 1 - losses[std::uniform_int_distribution<std::size_t>(0, 8)(engine)];
  of.pull = greatest_pull * between(0, 1);
  of.light_gap = std::pow(10, between(-3, -0.5));
  of.heavy_gap = std::pow(10, between(-3, -0.5));
  of.until = of.light_gap + of.heavy_gap + between(0, 0.3);
  return of;
}

TEST(LightBetween, BallsWithoutForcesAsTheReferee) {
  std::mt19937 engine(1);
  for (int k = 0; k < 300; ++k) expect_as_the_referee(random(engine, 8, 0), false, 0, [](auto&) {});
}
TEST(LightBetween, BallsThatFallAsTheReferee) {
  std::mt19937 engine(2);
  for (int k = 0; k < 300; ++k) expect_as_the_referee(random(engine, 8, 1), false, 0, [](auto&) {});
}
// A force law makes the paths those of an integration.
TEST(LightBetween, BallsUnderForcesAsTheReferee) {
  std::mt19937 engine(3);
  for (int k = 0; k < 100; ++k)
    expect_as_the_referee(random(engine, 6, k % 2), false, 1e-10, [](World<double, 2>& world) {
      world.force_laws.emplace_back([](const auto&, double, auto, auto, auto) {});
    });
}
TEST(LightBetween, BoxesAsTheReferee) {
  std::mt19937 engine(4);
  for (int k = 0; k < 100; ++k) expect_as_the_referee(random(engine, 6, k % 2), true, 1e-10, [](auto&) {});
}

}  // namespace
}  // namespace continuo::light_between_test
