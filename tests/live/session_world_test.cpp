// Bodies in a session.
#include <tests/live/spectator.hpp>

#include <continuo/live/world_track.hpp>

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
  stage.session->drag_body(0, down);  // the floor is in the way
  stage.run(0.3);
  EXPECT_NEAR(stage.state("ball.y"), 0.5, 1e-3);
  stage.session->drag_body(0, {std::vector<double>{0, 2}});
  stage.session->drag_body(0, right);  // the stone is
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

TEST(LiveWorld, SlowMotionIsShownBetweenSteps) {
  Stage stage(fast);
  stage.session->set_speed(0.1);
  stage.play(0.5);
  EXPECT_NEAR(stage.session->shown_time(), 0.05, 1e-9);  // three steps: not a multiple of 1/60
  std::set<float> heights;
  for (const auto& slice : stage.audience.slices) heights.insert(slice->bodies->position[2]);
  EXPECT_GT(heights.size(), 20U);
}

}  // namespace
}  // namespace continuo::live
