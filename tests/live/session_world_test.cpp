// Sessions with a world of bodies.
#include <tests/live/spectator.hpp>

#include <continuo/live/motion/world_track.hpp>

namespace continuo::live {
namespace {

const std::string exact =
    "param g = 9.81\nworld {\n  gravity (0, -g)\n  material restitution 1 friction 0\n  wall floor (0, 1) at 0\n"
    "  body ball at (0, 2) radius 0.5\n  body stone at (3, 2) radius 0.5 fixed\n  mode exact\n}\nrun 0..10 output "
    "0.1\n";
const std::string fast =
    "param g = 9.81\nworld {\n  dimension 3\n  gravity (0, 0, -g)\n  wall floor (0, 0, 1) at 0\n"
    "  bodies ball grid 3 x 3 x 3 from (0, 0, 1) spacing (1.2, 1.2, 1.2) radius 0.5\n  mode fast step 1/60\n}\n"
    "run 0..10 output 0.1\nplot world.kinetic\n";

TEST(LiveWorld, FallsAndBounces) {
  Stage stage(exact);
  stage.play(0.5);
  // 2 - g*t^2/2 from rest; it meets the floor when its centre is at 0.5, at t = sqrt(2*1.5/g) = 0.553.
  EXPECT_NEAR(stage.state("ball.y"), 2 - 9.81 * 0.125, 1e-9);
  stage.run(0.5);
  const auto& slice = *stage.audience.slices.back();
  ASSERT_TRUE(slice.bodies);
  EXPECT_EQ(slice.bodies->count(), 2U);
  EXPECT_EQ(slice.bodies->orientation.size(), 2U);
  EXPECT_NEAR(slice.bodies->position[1], stage.state("ball.y"), 1e-6);
  std::vector<LiveEvent> events;
  for (const auto& seen : stage.audience.slices) events.insert(events.end(), seen->events.begin(), seen->events.end());
  ASSERT_EQ(events.size(), 1U);
  EXPECT_NEAR(events[0].t, std::sqrt(3 / 9.81), 1e-9);
  EXPECT_EQ(events[0].name, "ball meets floor");
}

TEST(LiveWorld, GoesBackAndOn) {
  Stage stage(exact);
  stage.play(1);
  stage.session->seek(0.3);
  const double then = stage.session->shown_time();
  stage.play(0.2);
  EXPECT_NEAR(stage.state("ball.y"), 2 - 9.81 / 2 * (then + 0.2) * (then + 0.2), 1e-9);
}

TEST(LiveWorld, AParameterCountsFromNowOn) {
  Stage stage(exact);
  stage.session->set_parameter("g", 0);
  stage.play(0.5);
  EXPECT_NEAR(stage.state("ball.y"), 2, 1e-12);
}

TEST(LiveWorld, ABodyStaysInTheHand) {
  Stage stage(exact);
  stage.session->play();
  const std::vector<double> up = {0, 4}, right = {10, 2}, down = {0, -3};
  stage.session->drag_body(0, up);
  stage.run(0.3);
  EXPECT_NEAR(stage.state("ball.y"), 4, 1e-9);
  stage.session->drag_body(0, down);  // the floor blocks the way
  stage.run(0.3);
  EXPECT_NEAR(stage.state("ball.y"), 0.5, 1e-3);
  stage.session->drag_body(0, {std::vector<double>{0, 2}});
  stage.session->drag_body(0, right);  // the stone blocks the way
  stage.run(0.3);
  EXPECT_NEAR(stage.state("ball.x"), 2, 1e-3);
  stage.session->release();
  stage.run(0.2);
  EXPECT_LT(stage.state("ball.y"), 2 - 0.1);
}

TEST(LiveWorld, IsPicked) {
  Stage stage(exact);
  stage.session->pick(1);
  const auto values = stage.audience.said("values").back();
  EXPECT_EQ(values["name"], "stone");
  EXPECT_EQ(values["values"]["x"], 3);
  stage.session->pick(7);
  EXPECT_EQ(stage.audience.said("message").size(), 1U);
}

TEST(LiveWorld, ManyBodiesAreBodiesNotColumns) {
  Stage stage(fast);
  EXPECT_EQ(stage.session->shown().dimension, 3);
  for (const LiveColumn& column : stage.session->shown().columns) EXPECT_FALSE(column.name.starts_with("ball"));
  stage.play(3);
  EXPECT_NEAR(stage.session->shown_time(), 3, 1e-6);
  const auto& bodies = *stage.audience.slices.back()->bodies;
  EXPECT_EQ(bodies.position.size(), 27U * 3);
  EXPECT_EQ(bodies.orientation.size(), 27U * 4);
  for (std::size_t i = 0; i < bodies.count(); ++i) EXPECT_GT(bodies.position[3 * i + 2], 0.45F);
  const auto model = stage.audience.said("model").back();
  EXPECT_EQ(model["bodies"]["count"], 27);
  EXPECT_EQ(model["bodies"]["walls"].size(), 1U);
}

const std::string door =
    "world {\n  mode fast step 1/240\n  body door at (1, 0) box (2, 0.2)\n  body ball at (5, 0) radius 0.5\n"
    "  hinge pin: door at (0, 0)\n}\nrun 0..10\n";

TEST(LiveWorld, TellsTheFormsOfBodiesAndTheirJoints) {
  Stage stage(door);
  const auto bodies = stage.audience.said("model").back()["bodies"];
  EXPECT_EQ(bodies["form"], (nlohmann::json{0, nullptr}));
  EXPECT_EQ(bodies["forms"][0]["corners"].size(), 4U);
  EXPECT_EQ(bodies["forms"][0]["faces"], (nlohmann::json{{0, 1, 2, 3}}));
  ASSERT_EQ(bodies["joints"].size(), 1U);
  EXPECT_EQ(bodies["joints"][0]["on_first"], (nlohmann::json{-1.0, 0.0}));
  EXPECT_EQ(bodies["joints"][0]["second"], nullptr);
}

// The hand pulls the centre of the door upwards; the pin holds its end.
TEST(LiveWorld, AHandPullsWhatAJointHolds) {
  Stage stage(door);
  stage.session->play();
  for (int i = 0; i < 60; ++i) {
    stage.session->drag_body(0, std::vector<double>{0, 1.5});
    stage.run(1.0 / 60);
  }
  EXPECT_NEAR(stage.state("door.angle"), 1.5708, 0.02);
  EXPECT_NEAR(stage.state("door.y"), 1, 1e-4);
  stage.session->release(false);
  const double before = stage.session->shown_time();
  stage.run(0.2);
  EXPECT_GT(stage.session->shown_time(), before);
  EXPECT_TRUE(stage.audience.said("message").empty());
}

TEST(LiveWorld, SlowMotionIsShownBetweenSteps) {
  Stage stage(fast);
  stage.session->set_speed(0.1);
  stage.play(0.5);
  EXPECT_NEAR(stage.session->shown_time(), 0.05, 1e-9);  // three steps: not a multiple of 1/60
  std::set<float> heights;
  for (const auto& slice : stage.audience.slices) heights.insert(slice->bodies->position[2]);
  EXPECT_GT(heights.size(), 20U);
}

// ---- a ghost of bodies, other methods, the past ----

TEST(LiveWorld, HasAGhostByAnotherMethod) {
  Stage stage(exact);
  stage.play(0.3);
  stage.session->take_ghost(MethodChoice{.name = "explicit_euler", .step = 0.04});  // in four substeps each
  stage.run(0.2);
  const auto& slice = *stage.audience.slices.back();
  ASSERT_TRUE(slice.ghost_bodies);
  ASSERT_EQ(slice.ghost_bodies->position.size(), 4U);
  // Euler's positions lag by g*h*t/2, in the t since the ghost began.
  const double since = slice.t - 0.3;
  const double apart = static_cast<double>(slice.ghost_bodies->position[1] - slice.bodies->position[1]);
  EXPECT_NEAR(apart, 9.81 * 0.01 * since / 2, 9.81 * 0.01 * 0.02);  // begun within a picture of 1/60 s
  EXPECT_GT(apart, 0.005);
  EXPECT_NEAR(stage.shown("distance"), apart, 1e-6);
  stage.session->take_ghost(std::nullopt);
  stage.run(0.1);
  EXPECT_FALSE(stage.audience.slices.back()->ghost_bodies);
}

TEST(LiveWorld, GoesOnByAnotherMethodWhereItIs) {
  Stage stage(exact);
  stage.play(0.3);
  const double before = stage.session->shown_time();
  stage.session->take_method({.name = "semi_implicit_euler", .step = 0.001});
  stage.run(0.2);
  const double t = stage.session->shown_time();
  EXPECT_NEAR(t, before + 0.2, 0.02);
  EXPECT_NEAR(stage.state("ball.y"), 2 - 9.81 * t * t / 2, 9.81 * 0.001 * 0.2);  // of order 1: h*g*t/2
  // Seeks a moment before the change of the method, which only the other method could restore.
  stage.session->seek(0.1);
  const double then = stage.session->shown_time();
  stage.play(0.1);
  EXPECT_NEAR(stage.state("ball.y"), 2 - 9.81 * (then + 0.1) * (then + 0.1) / 2, 9.81 * 0.001);
  EXPECT_TRUE(stage.audience.said("message").empty());
}

const std::string rolling =
    "world {\n  dimension 3\n  body ball at (0, 0, 1) spin (0, 0, 1) radius 0.5\n  mode fast step 1/100\n}\nrun "
    "0..10\n";

/// The turn about z, of a quaternion (x, y, z, w).
double turn_of(const Bodies& bodies) {
  return 2 * static_cast<double>(std::atan2(bodies.orientation[2], bodies.orientation[3]));
}

TEST(LiveWorld, ThePastKnowsHowBodiesStood) {
  Stage stage(rolling);
  stage.play(1);
  EXPECT_NEAR(turn_of(*stage.audience.slices.back()->bodies), 1, 1e-3);
  stage.session->seek(0.4);
  stage.run(0.1);
  const auto& slice = *stage.audience.slices.back();
  ASSERT_TRUE(slice.looking_back);
  ASSERT_EQ(slice.bodies->orientation.size(), 4U);
  EXPECT_NEAR(turn_of(*slice.bodies), slice.t, 1e-3);
  stage.session->take_method({.name = "exact"});  // continues from there, with the same orientation
  stage.play(0.2);
  EXPECT_NEAR(turn_of(*stage.audience.slices.back()->bodies), stage.session->shown_time(), 1e-3);
}

// ---- events of the text ----

const std::string watched =
    "world {\n  gravity (0, -10)\n  body ball at (0, 5) radius 0.5\n  mode exact\n}\n"
    "when ball.y falls through 3.75 { ball.y' := 8; mark \"turned\" }\n"
    "when ball.y' falls through 0 { stop \"high enough\" }\nrun 0..10\n";

TEST(LiveWorld, EventsOfTheTextHappen) {
  Stage stage(watched);
  stage.play(2);
  // A fall of 1.25 m from rest takes 0.5 s; thrown up at 8 m/s the ball turns 0.8 s later, 3.2 m higher. The only error
  // is rounding in double.
  std::vector<LiveEvent> events;
  for (const auto& seen : stage.audience.slices) events.insert(events.end(), seen->events.begin(), seen->events.end());
  ASSERT_EQ(events.size(), 2U);
  EXPECT_NE(events[0].name.find("3.75"), std::string::npos);
  EXPECT_EQ(events[0].mark, "turned");
  EXPECT_NEAR(events[0].t, 0.5, 1e-9);
  EXPECT_NE(events[1].name.find("ball.y'"), std::string::npos);
  EXPECT_NEAR(events[1].t, 1.3, 1e-9);
  EXPECT_TRUE(stage.session->has_ended());
  EXPECT_EQ(stage.audience.said("state").back()["ended"], "high enough");
  EXPECT_NEAR(stage.state("ball.y"), 3.75 + 3.2, 1e-9);
  // Back to before: it happens again.
  stage.session->seek(0.4);
  stage.play(0.3);
  EXPECT_NEAR(stage.state("ball.y'"), 8 - 10 * (stage.session->shown_time() - 0.5), 1e-9);
}

TEST(LiveWorld, EventsOfTheTextHappenInSteps) {
  Stage stage(
      "world {\n  gravity (0, -10)\n  body ball at (0, 5) radius 0.5\n  mode fast step 0.01\n}\n"
      "when ball.y falls through 3.75 { ball.y' := 8 }\nat 1 { ball.x' := 2 }\nrun 0..10\n");
  stage.session->until_event();
  stage.run(2);
  EXPECT_NEAR(stage.session->shown_time(), 0.5, 0.02);  // at the end of a step
  stage.session->until_event();
  stage.run(2);
  EXPECT_NEAR(stage.session->shown_time(), 1, 1e-9);
  EXPECT_NEAR(stage.state("ball.x'"), 2, 1e-12);
}

// ---- a hand ----

TEST(LiveWorld, ABodyFliesOnAsFastAsTheHandWent) {
  Stage stage("world {\n  body ball at (0, 0) radius 0.5\n  mode exact\n}\nrun 0..10\n");
  stage.session->play();
  const auto move = [&](double speed, int pictures) {
    static double x = 0;
    for (int i = 0; i < pictures; ++i) {
      x += speed / 60;
      stage.session->drag_body(0, {std::vector<double>{x, 0}});
      stage.run(1.0 / 60);
    }
  };
  move(3, 20);
  stage.session->release();
  stage.run(0.1);
  EXPECT_NEAR(stage.state("ball.x'"), 3, 1e-6);
  move(3, 20);
  move(0, 20);  // a pause before the release means no throw
  stage.session->release();
  stage.run(0.1);
  EXPECT_NEAR(stage.state("ball.x'"), 0, 1e-12);
  move(3, 20);
  stage.session->release(true);
  stage.run(0.1);
  EXPECT_NEAR(stage.state("ball.x'"), 0, 1e-12);
}

}  // namespace
}  // namespace continuo::live
