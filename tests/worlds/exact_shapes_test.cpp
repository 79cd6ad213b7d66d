// Worlds of shapes and joints that a model moves exactly: held against equations of the same motion, closed forms, and
// what the motion itself says when it refuses.
#include <array>
#include <cmath>
#include <numbers>
#include <string>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <tests/worlds/scene.hpp>

namespace continuo::worlds::exact_shapes_test {
namespace {

// A rod on a hinge at its end: phi'' = -(g/2)/I cos phi, with its moment of inertia I about the hinge; the same
// equation beside a ball that does not move.
TEST(ExactShapes, ARodSwingsAsItsEquationSays) {
  const double d = 0.2, g = 9.81, inertia = (1 + d * d) / 12 + 0.25;  // about the hinge, of a mass of 1
  const model::Run rod = run_of(
      fmt::format("world {{ mode exact tolerance 1e-12\n gravity (0, -{})\n body rod at (0.5, 3) box (1, {}) mass 2\n"
                  " hinge pin: rod at (0, 3) }}\nrun 0..3\n",
                  g, d));
  const auto beside = simulate_world(
      program_of("world { body b at (0, 0) }\n" +
                 fmt::format("phi'' = -{}*cos(phi)\nphi(0) = 0\nphi'(0) = 0\n", g / 2 / inertia) + "run 0..3\n"),
      {.rtol = 1e-13});
  ASSERT_TRUE(beside.run);
  EXPECT_NEAR(last(rod, "rod.angle"), last(*beside.run, "phi"), 1e-9);
  EXPECT_NEAR(last(rod, "pin.angle"), last(*beside.run, "phi"), 1e-9);
}

// Forces and torques of the model, and what few bodies have: in closed form.
TEST(ExactShapes, ForcesTorquesAndTraitsActAsInClosedForm) {
  const model::Run run = run_of(
      "world { mode exact tolerance 1e-12\n gravity (0, -10)\n"
      "body a at (1, 0) box (1, 1) mass 2 gravity_scale 0\n"
      "body b at (9, 0) box (1, 1) mass 3 gravity_scale 0 spin 2\n"
      "body c at (19, 0) box (1, 1) gravity_scale 0.25\n"
      "body d at (29, 0) radius 0.5 velocity (3, 0) gravity_scale 0 damping 0.7 spin 2 spin_damping 1.5 }\n"
      "force on a = (-8*a.x, 0)\ntorque on b = -4*b.angle\nrun 0..1.5\n");
  EXPECT_NEAR(last(run, "a.x"), std::cos(2 * 1.5), 1e-9);  // the box has a mass of 2, and 8 N/m draw it
  const double rate = std::sqrt(4 / 0.5);                  // a square of mass 3 has a moment of inertia of 3/6
  EXPECT_NEAR(last(run, "b.angle"), 2 / rate * std::sin(rate * 1.5), 1e-9);
  EXPECT_NEAR(last(run, "c.y"), -0.25 * 10 * 1.5 * 1.5 / 2, 1e-9);
  EXPECT_NEAR(last(run, "d.x'"), 3 * std::exp(-0.7 * 1.5), 1e-9);
  EXPECT_NEAR(last(run, "d.angle'"), 2 * std::exp(-1.5 * 1.5), 1e-9);
}

// A crate slides down without friction: its events are where the closed form has them.
TEST(ExactShapes, EventsAreLocated) {
  const auto program = program_of(
      "param slope = 0.3\nworld { mode exact\n gravity (0, -10)\n material restitution 0 friction 0\n"
      "wall ground (-sin(slope), cos(slope)) at 0\n"
      "body crate at (-0.5*sin(slope), 0.5*cos(slope)) box (1, 1) angle slope }\n"
      "let way = -crate.x*cos(slope) - crate.y*sin(slope)\n"
      "when way rises through 2 { mark \"there\" }\nrun 0..3\n"
      "check time of event 1 of \"way rises\" = sqrt(4/(10*sin(slope))) within 1e-9\n"
      "check way at end = 10*sin(slope)*9/2 within 1e-9\n");
  const auto done = simulate_world(program, {});
  ASSERT_TRUE(done.run);
  EXPECT_EQ(failed_checks(*done.run), "");
}

TEST(ExactShapes, ASnapshotContinuesToTheBit) {
  const std::string text =
      "world { mode exact\n gravity (0, -10)\n material restitution 0.5 friction 0.3\n wall (0, 1) at 0\n"
      "body a at (0, 2) box (1, 1) angle 0.3\n body b at (0.2, 4) capsule 0.5 radius 0.2 angle 1 }\nrun 0..2\n";
  const auto run = started(text), other = started(text);
  ASSERT_TRUE(run->advance_to(0.9));
  const Snapshot saved = run->snapshot();
  ASSERT_TRUE(run->advance_to(1.4));
  ASSERT_TRUE(other->check(saved));
  ASSERT_TRUE(other->restore(saved));
  ASSERT_TRUE(other->advance_to(1.4));
  EXPECT_EQ(run->state(), other->state());
}

// The hand draws by a spring of 5 Hz with a damping ratio of 1: after two seconds exp(-62) is left of the way.
TEST(ExactShapes, AHandDrawsABody) {
  const auto run = started("world { mode exact\n body a at (0, 0) box (1, 1) }\nrun 0..9\n");
  run->pull(std::pair<std::size_t, Point>(0, Point{2, 1, 0}));
  ASSERT_TRUE(run->advance_to(2));
  EXPECT_NEAR(run->position(0)[0], 2, 1e-9);
  EXPECT_NEAR(run->position(0)[1], 1, 1e-9);
  const Snapshot held = run->snapshot();
  run->pull(std::nullopt);
  EXPECT_TRUE(run->check(held));
  ASSERT_TRUE(run->restore(held));
  EXPECT_TRUE(run->springs().empty());
  ASSERT_TRUE(run->advance_to(3));
}

// By time, by a jump in it, and by an input that is set: the angle is the integral of the speed.
TEST(ExactShapes, AMotorFollowsItsSpeed) {
  const model::Run wave = run_of(
      "world { mode exact\n body wheel at (0, 0) box (1, 1)\n"
      "hinge wheel at (0, 0) motor 3*sin(2*t) torque at most 100 }\nrun 0..2\n");
  EXPECT_NEAR(last(wave, "wheel.angle"), 1.5 * (1 - std::cos(4)), 1e-9);
  const std::string text =
      "input pace = 1 in -4..4 key \"w\"\n"
      "world { mode exact\n body wheel at (0, 0) box (1, 1)\n body door at (5, 0) box (1, 1)\n"
      "hinge wheel at (0, 0) motor pace*t torque at most 1e6\n"
      "hinge door at (5, 0) motor if t < 0.3 then 2 else -1 torque at most 1e6 }\nrun 0..9\n";
  const auto run = started(text);
  ASSERT_TRUE(run->advance_to(1));
  const auto angle = [&](std::size_t i) { return run->state()[6 * i + 4]; };
  EXPECT_NEAR(angle(0), 0.5, 1e-9);
  EXPECT_NEAR(angle(1), 0.6 - 0.7, 1e-5);  // a great torque takes a millionth of a second
  ASSERT_TRUE(run->set(program_of(text)->model.inputs[0].variable, 0));
  ASSERT_TRUE(run->advance_to(2));
  EXPECT_NEAR(angle(0), 0.5, 1e-5);
}

// What a model is refused for when it is read, is what the motion says where it is not asked before.
TEST(ExactShapes, RefusalsAreThoseOfTheMotion) {
  constexpr std::array items = {"body c at (5, 0) box (1, 1) sensor", "body c at (5, 0) box (1, 1) rolling 0.1"};
  for (const std::string item : items) {
    const std::string bodies = " gravity (0, -1)\n body b at (0, 0) box (1, 1)\n " + item + "\n}\nrun 0..1\n";
    const model::Source source("scene.sim", "world { mode exact\n" + bodies);
    const model::Checked checked = check(model::parse(source).model, source);
    ASSERT_EQ(checked.diagnostics.size(), 1U) << item;
    EXPECT_EQ(checked.diagnostics[0].code, "E264");
    EXPECT_THAT(item, testing::HasSubstr(std::string(source.slice(checked.diagnostics[0].span))));
    const auto program = program_of("world { mode fast step 1/60\n" + bodies);
    auto motion = start_world(program, {.method = "exact"}, start_values(program->model));
    ASSERT_TRUE(motion);
    const Status said = (*motion)->advance_to(1);
    EXPECT_FALSE(said) << item;
    EXPECT_THAT(said.message, testing::StartsWith(checked.diagnostics[0].message));
    const auto asked = simulate_world(program, {.method = "exact"});
    ASSERT_EQ(asked.diagnostics.size(), 1U) << item;
    EXPECT_EQ(asked.diagnostics[0].code, "E334");
    EXPECT_EQ(asked.diagnostics[0].message, checked.diagnostics[0].message);
  }
}

// A compound of two halves moves as the whole does: same mass, place, inertia and contacts.
TEST(ExactShapes, TwoHalvesAreOneBox) {
  const auto scene = [](const std::string& body) {
    return run_of("world { mode exact\n gravity (0, -10)\n material restitution 0.4 friction 0\n wall (0, 1) at 0\n" +
                  body + " }\nrun 0..0.8\n");
  };
  const model::Run whole = scene("body it at (0, 2) box (2, 1) angle 0.3 spin 1 density 3"),
                   halves = scene(
                       "body it at (0, 2) angle 0.3 spin 1 density 3\n part of it at (-0.5, 0) box (1, 1)\n"
                       "part of it at (0.5, 0) angle 90 [deg] box (1, 1)\n");
  for (const std::string state : {"it.x", "it.y", "it.angle", "it.x'", "it.y'", "it.angle'"})
    EXPECT_NEAR(last(whole, state), last(halves, state), 1e-7) << state;
}

}  // namespace
}  // namespace continuo::worlds::exact_shapes_test
