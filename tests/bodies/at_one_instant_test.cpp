// Several collisions at one instant under gravity lose the same energy as if they happened one after the other.
#include <cstddef>

#include <gtest/gtest.h>

#include <continuo/bodies/exact_motion.hpp>

namespace continuo::at_one_instant_test {
namespace {

// A column without restitution stays where it lands: each ball stops the one above it. After so many halvings the
// remaining speed is below rounding, and persistent contacts bring it to zero.
template <int Dim>
void lands_and_stays(std::size_t count, double friction) {
  World<double, Dim> world;
  constexpr std::size_t up = Dim - 1;
  world.gravity[up] = -9.81;
  const Material<double> material{.restitution = 0, .friction = friction};
  Wall<double, Dim> floor{.material = material};
  ASSERT_TRUE(world.add_wall(floor));
  for (std::size_t i = 0; i < count; ++i) {
    BodyDefinition<double, Dim> ball{.material = material};
    ball.position[up] = 1.5 + static_cast<double>(i);
    ASSERT_TRUE(world.add(ball));
  }
  ExactMotion motion(world);
  for (const double t : {0.46, 0.6, 2.0}) {  // it lands at sqrt(2 / 9.81) = 0.4515
    ASSERT_TRUE(motion.advance_to(t));
    for (std::size_t i = 0; i < count; ++i)
      EXPECT_NEAR(world.position[i][up], 0.5 + static_cast<double>(i), 1e-6) << Dim << " " << friction << " " << i;
  }
  EXPECT_NEAR(kinetic_energy(world), 0, 1e-9);
}
TEST(AtOneInstant, AColumnThatFallsStaysWhereItLands) {
  for (const double friction : {0.0, 0.5})
    for (const std::size_t count : {2u, 3u, 5u}) {
      lands_and_stays<2>(count, friction);
      lands_and_stays<3>(count, friction);
    }
}

}  // namespace
}  // namespace continuo::at_one_instant_test
