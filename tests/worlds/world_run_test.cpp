// A world that is advanced step by step: the interface of the live view and of co-simulation.
#include <cmath>

#include <gmock/gmock.h>
#include <tests/worlds/scene.hpp>

#include <continuo/language/load.hpp>

namespace continuo::worlds::world_run_test {
namespace {

constexpr const char* bouncing = R"(
param g = 10, e = 1
world {
  gravity (0, -g)
  wall ground (0, 1) at 0
  material restitution e friction 0
  body ball at (0, 5.5) radius 0.5 mass 2
  body post at (9, 0) radius 1 fixed
  spring ball to (0, 5.5) stiffness 0
}
run 0..10
)";

TEST(WorldRun, ShowsWhatIsThere) {
  const auto run = started(bouncing);
  EXPECT_EQ(run->dimension(), 2);
  ASSERT_EQ(run->bodies().size(), 2u);
  EXPECT_EQ(run->bodies()[0].name, "ball");
  EXPECT_EQ(run->bodies()[0].radius, 0.5);
  EXPECT_EQ(run->bodies()[0].mass, 2);
  EXPECT_TRUE(run->bodies()[1].fixed);
  ASSERT_EQ(run->walls().size(), 1u);
  EXPECT_EQ(run->walls()[0].name, "ground");
  EXPECT_EQ(run->walls()[0].normal, (Point{0, 1, 0}));
  ASSERT_EQ(run->springs().size(), 1u);
  EXPECT_EQ(run->springs()[0].point, (Point{0, 5.5, 0}));
  EXPECT_EQ(run->position(0), (Point{0, 5.5, 0}));
  EXPECT_EQ(run->orientation(0), (std::array<double, 4>{1, 0, 0, 0}));
}

TEST(WorldRun, TakesWallsWithNormalsOfAnyLength) {
  const auto run = started("world { wall slope (3, 4) at 25; container (0, 0) to (9, 8); body ball at (5, 5) }");
  ASSERT_EQ(run->walls().size(), 5u);
  EXPECT_NEAR(run->walls()[0].offset, 5, 1e-15);  // 3 x + 4 y = 25 is 5 away from the origin
  EXPECT_NEAR(run->walls()[0].normal[1], 0.8, 1e-15);
  EXPECT_EQ(run->walls()[1].name, "wall 2");
  EXPECT_EQ(run->walls()[4].normal, (Point{0, -1, 0}));
  EXPECT_EQ(run->walls()[4].offset, -8);
}

TEST(WorldRun, LeavesItsWordsToModelsWithoutAWorld) {
  const model::Loaded loaded =
      model::load(model::Source("names.sim",
                                "param body = 2, wall = 3, mode_ = 1\nforce' = -force\nforce(0) = 1\n"
                                "world' = force*body\nworld(0) = 0\nlet spring = wall\nrun 0..1\n"));
  EXPECT_TRUE(loaded) << loaded.text();
}

TEST(WorldRun, ReportsContactsOfTheLastAdvance) {
  const auto run = started(R"(
world {
  gravity (0, -10)
  wall ground (0, 1) at 0
  material restitution 1 friction 0
  body ball at (0, 5.5) mass 2
})",
                           {.most_contacts = 10});
  ASSERT_TRUE(run->advance_to(0.5));
  EXPECT_THAT(run->contacts(), testing::IsEmpty());
  ASSERT_TRUE(run->advance_to(1.5));
  ASSERT_THAT(run->contacts(), testing::SizeIs(1));
  const Contact& contact = run->contacts()[0];
  EXPECT_EQ(run->name_of(contact), "ball meets ground");
  EXPECT_NEAR(contact.time, 1, 1e-12);      // from a height of 5 m at 10 m/s^2
  EXPECT_NEAR(contact.impulse, 40, 1e-10);  // 2 kg turned from -10 to 10 m/s
  EXPECT_NEAR(run->position(0)[1], 0.5 + 10 * 0.5 - 5 * 0.25, 1e-12);
  EXPECT_NEAR(run->kinetic_energy(), 25, 1e-10);
}

TEST(WorldRun, GoesOnToTheSameBitsFromASnapshot) {
  for (const char* method : {"exact", "fast"}) {
    const auto run = started(bouncing, {.method = method, .step = 0.01});
    ASSERT_TRUE(run->advance_to(1.23));
    const Snapshot saved = run->snapshot();
    ASSERT_TRUE(run->advance_to(4));
    const std::vector<double> once = run->state();
    ASSERT_TRUE(run->restore(saved));
    EXPECT_EQ(run->time(), saved.time);
    ASSERT_TRUE(run->advance_to(4));
    EXPECT_EQ(run->state(), once) << method;
  }
}

TEST(WorldRun, CanBePushed) {
  const auto run = started(bouncing);
  ASSERT_TRUE(run->advance_to(0.25));
  run->set_body(0, {1, 20, 0}, {3, 0, 0});
  ASSERT_TRUE(run->advance_to(1.25));
  EXPECT_NEAR(run->position(0)[0], 4, 1e-10);
  EXPECT_NEAR(run->position(0)[1], 15, 1e-10);
}

TEST(WorldRun, FollowsItsParameters) {
  const auto program = program_of(bouncing);
  auto world = start_world(program, {}, start_values(program->model));
  ASSERT_TRUE(world);
  WorldRun& run = **world;
  const auto parameter = [&](const char* name) {
    return program->model.parameters[find_parameter(program->model, name)].variable;
  };
  ASSERT_TRUE(run.set(parameter("g"), 0));
  ASSERT_TRUE(run.advance_to(3));
  EXPECT_EQ(run.position(0)[1], 5.5);
  EXPECT_THAT(run.set(parameter("e"), 2).message, testing::HasSubstr("restitution"));  // refused
  ASSERT_TRUE(run.set(parameter("g"), 10));
  ASSERT_TRUE(run.advance_to(5));
  EXPECT_NEAR(run.position(0)[1], 5.5, 1e-9);  // down and up again in 2 s with e = 1
}

TEST(WorldRun, StopsAtTheEndOfAStepInTheFastMode) {
  const auto run = started(bouncing, {.method = "fast", .step = 1.0 / 60});
  ASSERT_TRUE(run->advance_to(1));
  EXPECT_EQ(run->time(), 1);  // 60 steps, counted and not added up
  ASSERT_TRUE(run->advance_to(1.001));
  EXPECT_EQ(run->time(), 61.0 / 60);
}

}  // namespace
}  // namespace continuo::worlds::world_run_test
