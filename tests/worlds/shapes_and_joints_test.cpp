// Bodies of every shape and joints in the language: held against closed forms, and against the solids of shapes/.
#include <cmath>
#include <numbers>
#include <random>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <tests/worlds/scene.hpp>

#include <continuo/shapes/solid.hpp>

namespace continuo::worlds::shapes_and_joints_test {
namespace {

const WorldOptions fast{.method = "fast", .step = 1.0 / 240};

double value_of(const model::Model& model, model::NodeId node) {
  return evaluate(model, node, start_values(model));
}

/// The mass of a body of density 3 and its radius are those of the solid that shapes/ makes of it.
template <int Dim>
void expect_solid(const std::string& text, const Shape<double, Dim>& shape) {
  const std::string zeros = Dim == 2 ? "(0, 0)" : "(0, 0, 0)";
  const auto program =
      program_of(fmt::format("world {{ dimension {}\n body it at {} density 3 {} }}\nrun 0..1\n", Dim, zeros, text));
  const auto made = solid<double, Dim>(shape);
  ASSERT_TRUE(made) << made.status().message;
  const model::BodyDescription& body = program->model.world->bodies[0];
  EXPECT_NEAR(value_of(program->model, body.mass), 3 * made->volume, 1e-12 * made->volume) << text;
  EXPECT_NEAR(value_of(program->model, body.radius), made->reach, 1e-12 * made->reach) << text;
  const model::State& x = program->model.states[body.first_state];
  EXPECT_NEAR(value_of(program->model, x.initial), made->centre[0], 1e-12 * made->reach) << text;
}

TEST(ShapesAndJoints, MassAndRadiusAreThoseOfTheSolid) {
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> size(0.5, 3), part(0, 0.24);
  for (int k = 0; k < 5; ++k) {
    const double a = size(random), b = size(random), c = size(random), r = part(random);
    expect_solid<2>(fmt::format("box ({}, {}) rounding {}", a, b, r), Box<double, 2>{{{a, b}}, r});
    expect_solid<3>(fmt::format("box ({}, {}, {}) rounding {}", a, b, c, r), Box<double, 3>{{{a, b, c}}, r});
    expect_solid<2>(fmt::format("capsule {} radius {}", a, b), Capsule<double>{a, b});
    expect_solid<3>(fmt::format("capsule {} radius {}", a, b), Capsule<double>{a, b});
    expect_solid<2>(fmt::format("hull (0, 0) ({}, 0) ({}, {}) (0, {}) rounding {}", a, a, b, c, r),
                    Hull<double, 2>{{{{0, 0}}, {{a, 0}}, {{a, b}}, {{0, c}}}, r});
    expect_solid<3>(fmt::format("hull (0, 0, 0) ({}, 0, 0) (0, {}, 0) (0, 0, {})", a, b, c),
                    Hull<double, 3>{{{{0, 0, 0}}, {{a, 0, 0}}, {{0, b, 0}}, {{0, 0, c}}}, 0});
  }
}

// The corners of a hull are in a frame with its origin at `at`; its place is that of the centre of mass, here (1, 1)
// from the origin, turned by a right angle.
TEST(ShapesAndJoints, HullsStandWhereTheirCornersAre) {
  const auto run = started(
      "world { mode fast step 1/60\n body a at (5, 0) hull (0, 0) (3, 0) (0, 3) angle 90 [deg]\n"
      "body b hull (7, 0) (10, 0) (7, 3) }\nrun 0..1\n",
      fast);
  EXPECT_NEAR(run->position(0)[0], 4, 1e-14);
  EXPECT_NEAR(run->position(0)[1], 1, 1e-14);
  EXPECT_NEAR(run->position(1)[0], 8, 1e-14);
  EXPECT_NEAR(run->position(1)[1], 1, 1e-14);
  ASSERT_EQ(run->bodies()[0].form, 0U);
  ASSERT_EQ(run->forms()[0].corners.size(), 3U);
  EXPECT_NEAR(run->forms()[0].corners[0][0], -1, 1e-14);  // in the frame of the body
}

// A bar of 2 m and 3 kg whose end is held by a motor at rest: m g on the pin, m g l/2 about it.
TEST(ShapesAndJoints, AHingeTellsWhatItBears) {
  const model::Run run = run_of(R"(
world {
  gravity (0, -10) [m/s^2]
  mode fast step 1/240
  body bar at (1, 0) [m] box (2, 0.1) mass 3
  hinge pin: bar at (0, 0) motor 0 torque at most 100 [N m]
}
output load = pin.force_y, moment = pin.torque, brake = pin.motor_torque, turned = pin.angle
run 0..1 [s]
check load at end = 30 [N] within 1e-6
check moment at end = 30 [N m] within 1e-6
check brake at end = 30 [N m] within 1e-6
check abs(turned) at end < 1e-6
check bar.spin at end = 0 within 1e-6
)");
  EXPECT_EQ(failed_checks(run), "");
}

// Without a name, what a joint bears is asked of its first body. A weld holds the weight m g = 20 at half a metre.
TEST(ShapesAndJoints, AJointWithoutANameSpeaksThroughItsBody) {
  const model::Run run = run_of(R"(
world {
  gravity (0, -10)
  mode fast step 1/240
  body board at (0.5, 0) box (1, 1) mass 2
  weld board at (0, 0)
}
run 0..1
check board.force_y at end = 20 within 1e-6
check board.torque at end = 10 within 1e-6
check board.x at end = 0.5 within 1e-9
)");
  EXPECT_EQ(failed_checks(run), "");
}

// The speed of a motor is an expression: its angle is the integral, to the order of the step. Limits stop another one.
TEST(ShapesAndJoints, MotorsFollowExpressionsAndLimitsStopThem) {
  const model::Run run = run_of(R"(
param w = 2
world {
  mode fast step 1/240
  body wheel at (0, 0) box (1, 1)
  body door at (5.5, 0) box (1, 0.1)
  body drawer at (10, 0) box (1, 1)
  hinge axle: wheel at (0, 0) motor w*sin(w*t) torque at most 1000
  hinge door at (5, 0) limits -30..30 [deg] motor 3 torque at most 10
  slider rail: drawer axis (1, 0) limits 0..0.5 motor 1 force at most 10
}
run 0..2
check axle.angle at end = 1 - cos(4) within 2/240*2
check door.angle at end = pi/6 within 1e-6
check rail.length at end = 0.5 within 1e-6
check rail.motor_force at end = 10 within 1e-6
)");
  EXPECT_EQ(failed_checks(run), "");
}

// A ball of 1 kg hangs on a rope of 1 m: m g. One that falls beside it on a longer rope is caught below.
TEST(ShapesAndJoints, RopesPullAndDoNotPush) {
  const model::Run run = run_of(R"(
world {
  gravity (0, 0, -10)
  dimension 3
  mode fast step 1/240
  body bob at (0, 0, 1) radius 0.1 mass 1
  rope line: bob to (0, 0, 2)
  body low at (3, 0, 1.5) radius 0.1 mass 1
  rope low to (3, 0, 2) length 1
}
run 0..2
check line.force_z at end = 10 within 1e-6
check line.length at end = 1 within 1e-6
check low.z at 0.1 = 1.5 - 10*0.1^2/2 within 10*0.1/2/960*1.01     # a substep of semi-implicit Euler
check low.z at end = 1 within 1e-3
)");
  EXPECT_EQ(failed_checks(run), "");
}

// Gears keep the first angle plus twice the second one; a spring draws the distance to half a length beyond its start.
TEST(ShapesAndJoints, GearsTurnAndSpringsRest) {
  const model::Run run = run_of(R"(
world {
  mode fast step 1/240
  body small at (0, 0) radius 1 mass 1
  body large at (3, 0) radius 2 mass 1
  hinge small at (0, 0) motor 1 torque at most 100
  hinge large at (3, 0)
  gear small to large ratio 2
  body bob at (20, 1) radius 0.1 mass 2
  distance elastic: bob to (20, 5) spring 1 rest 0.5
}
output both = small.angle + 2*large.angle
run 0..3
check always abs(both) < 1e-6
check small.spin at end = 1 within 1e-6
check elastic.length at end = 4.5 within 1e-4      # critically damped at 1 per unit of time: e^(-6 pi)*6 pi is left
)");
  EXPECT_EQ(failed_checks(run), "");
}

// A universal joint between shafts in line turns both alike. A wheel turns about its axle and keeps to its car.
TEST(ShapesAndJoints, ShaftsAndWheelsTurnInSpace) {
  const model::Run run = run_of(R"(
world {
  dimension 3
  gravity (0, 0, -10)
  mode fast step 1/240
  body frame at (0, 0, 0) box (1, 1, 1) fixed
  body lower at (0, 0, 2) box (0.2, 0.2, 2) mass 1
  body upper at (0, 0, 4) box (0.2, 0.2, 2) mass 1
  hinge shaft: lower to frame at (0, 0, 1) axis (0, 0, 1) motor 2 torque at most 100
  universal upper to lower at (0, 0, 3) axis (1, 0, 0) axle (0, 1, 0)
  hinge upper at (0, 0, 5) axis (0, 0, 1)
  body arm at (6, 0, 0) capsule 1 radius 0.1 axis (0, 1, 0) angle 90 [deg] mass 3
  ball arm at (5.5, 0, 0)
  body car at (20, 0, 2) box (2, 1, 0.5) mass 10
  body rim at (20, 1, 1) radius 0.5 mass 1
  wheel rim to car at (20, 1, 1) axis (0, 0, 1) axle (0, 1, 0) spring 3 motor 4 torque at most 50
  weld car at (20, 0, 2)
}
output reach = hypot(hypot(arm.x - 5.5, arm.y), arm.z)
run 0..1
check shaft.angle at end = 2 within 0.01           # a step of its start
check upper.spin_z at end = 2 within 1e-3
check rim.spin_y at end = 4 within 1e-3
check rim.x at end = 20 within 1e-4
check always abs(reach - 0.5) < 1e-4
)");
  EXPECT_EQ(failed_checks(run), "");
}

// A driven belt carries a crate with it, and stays what moves it: fixed.
TEST(ShapesAndJoints, DrivenBodiesCarryOthers) {
  const model::Run run = run_of(R"(
world {
  gravity (0, -10)
  mode fast step 1/240
  body belt at (0, 0) box (10, 1) velocity (1, 0) driven
  body crate at (-3, 1) box (1, 1)
}
run 0..2
check belt.x at end = 2 within 1e-9
check crate.x' at end = 1 within 1e-6
)");
  EXPECT_EQ(failed_checks(run), "");
}

const std::string pendulum = R"(
param strength = 100, mass_of_bob = 1
world {
  gravity (0, -10)
  mode fast step 1/240
  body arm at (1, 0) box (2, 0.1) mass mass_of_bob
  hinge pivot: arm at (0, 0) motor 0 torque at most strength/1000
}
run 0..2
)";

// What a parameter changes is built anew; the joint still holds the arm where it did, not where it is now.
TEST(ShapesAndJoints, ParametersAreSetWhileTheJointHolds) {
  const auto run = started(pendulum, fast);
  ASSERT_TRUE(run->advance_to(0.5));
  const auto program = program_of(pendulum);
  ASSERT_TRUE(run->set(program->model.parameters[0].variable, 200));
  ASSERT_TRUE(run->advance_to(1));
  const double angle = run->state()[4];
  EXPECT_LT(angle, -1);
  EXPECT_NEAR(run->position(0)[0], std::cos(angle), 1e-5);
  EXPECT_NEAR(run->position(0)[1], std::sin(angle), 1e-5);
}

TEST(ShapesAndJoints, SnapshotsGoOnToTheSameBits) {
  const auto run = started(pendulum, fast), again = started(pendulum, fast);
  ASSERT_TRUE(run->advance_to(0.5));
  const Snapshot saved = run->snapshot();
  ASSERT_TRUE(again->check(saved));
  ASSERT_TRUE(again->restore(saved));
  ASSERT_TRUE(run->advance_to(1));
  ASSERT_TRUE(again->advance_to(1));
  EXPECT_EQ(run->state(), again->state());
}

// A hand pulls; what it lets go of flies on as it moved, and a snapshot from then has no hand in it.
TEST(ShapesAndJoints, AHandPullsABodyToItsPlace) {
  const auto run = started("world { mode fast step 1/240\n body crate at (0, 0) box (1, 1) }\nrun 0..1\n", fast);
  ASSERT_TRUE(run->is_rigid());
  run->pull(std::pair<std::size_t, Point>(0, Point{2, 1, 0}));
  ASSERT_TRUE(run->advance_to(2));
  EXPECT_NEAR(run->position(0)[0], 2, 1e-3);
  EXPECT_NEAR(run->position(0)[1], 1, 1e-3);
  const Snapshot held = run->snapshot();
  run->pull(std::nullopt);
  ASSERT_TRUE(run->restore(held));
  run->set_body(0, {5, 0, 0}, {0, 0, 0});
  ASSERT_TRUE(run->advance_to(3));
  EXPECT_EQ(run->position(0)[0], 5);
}

TEST(ShapesAndJoints, TheFastMotionIsTheirUsualOne) {
  const auto program = program_of("world { body crate at (0, 0) box (1, 1) }\nrun 0..1\n");
  EXPECT_TRUE(program->model.world->mode.fast);
  const auto other = simulate_world(program, {.method = "implicit_euler", .step = 0.01});
  ASSERT_EQ(other.diagnostics.size(), 1U);
  EXPECT_EQ(other.diagnostics[0].code, "E334");
  EXPECT_THAT(other.diagnostics[0].message, testing::StartsWith("`implicit_euler` moves balls without joints"));
}

/// A part of a compound, turned about the last axis.
template <int Dim, class Of>
ShapePart<double, Dim> part_of(const Of& shape, const Vector<double, Dim>& position, double turn) {
  ShapePart<double, Dim> part;
  part.shape = shape;
  part.position = position;
  if constexpr (Dim == 2) {
    part.orientation[0] = turn;
  } else {
    part.orientation[0] = std::cos(turn / 2), part.orientation[3] = std::sin(turn / 2);
  }
  return part;
}

// A compound of random parts has the mass, the radius and the place of the solid of shapes/.
TEST(ShapesAndJoints, CompoundsAreThoseOfShapes) {
  std::mt19937_64 random(6);
  std::uniform_real_distribution<double> number(0.5, 3);
  for (int k = 0; k < 5; ++k) {
    const double a = number(random), b = number(random), x = number(random), turn = number(random);
    Compound<double, 2> plane;
    plane.parts = {part_of<2>(Box<double, 2>{{{a, b}}}, {{0, 0}}, 0),
                   part_of<2>(Capsule<double>{b, 0.3}, {{x, 1}}, turn)};
    expect_solid<2>(
        fmt::format("box ({}, {})\n part of it at ({}, 1) angle {} capsule {} radius 0.3", a, b, x, turn, b), plane);
    Compound<double, 3> space;
    space.parts = {part_of<3>(Sphere<double>{a}, {{0, 0, 0}}, 0),
                   part_of<3>(Box<double, 3>{{{1, 2, b}}}, {{0, x, 1}}, turn)};
    expect_solid<3>(
        fmt::format("radius {}\n part of it at (0, {}, 1) axis (0, 0, 1) angle {} box (1, 2, {})", a, x, turn, b),
        space);
  }
}

// A sensor says what passes, and stops nothing; a body that is held in a direction stays there.
TEST(ShapesAndJoints, SensorsAndLockedDirections) {
  const model::Run run = run_of(
      "world { mode fast step 1/240\n gravity (0, -10)\n wall floor (0, 1) at -9\n body gate at (0, 0) box (3, 1) "
      "fixed sensor\n"
      "body stone at (0, 2) box (0.5, 0.5)\n body shelf at (9, 1) box (1, 1) locked_y locked_turn velocity (1, 0)\n"
      "body spun at (15, 1) box (1, 1) locked_x gravity_scale 0 spin 1 velocity (0, 2) }\nrun 0..1\n"
      "check count of \"gate meets stone\" = 1\n");
  EXPECT_EQ(failed_checks(run), "");
  EXPECT_LT(last(run, "stone.y"), -2.5);
  EXPECT_NEAR(last(run, "shelf.y"), 1, 1e-6);
  EXPECT_NEAR(last(run, "shelf.x"), 10, 1e-9);
  EXPECT_NEAR(last(run, "spun.x"), 15, 1e-6);
  EXPECT_NEAR(last(run, "spun.angle"), 1, 1e-9);
}

// Boxes that touch, or are turned beside each other, do not overlap; those that do are said to, with their depth.
TEST(ShapesAndJoints, OverlapsAreThoseOfTheShapes) {
  const auto said = [](const std::string& bodies) {
    const model::Source source("scene.sim", "world { wall (0, 1) at 0\n" + bodies + "}\nrun 0..1\n");
    const model::ParseResult parsed = model::parse(source);
    const model::Checked checked = check(parsed.model, source);
    return render(checked.diagnostics, source);
  };
  EXPECT_EQ(said("body a at (0, 0.5) box (1, 1)\nbody b at (0, 1.5) box (1, 1)\n"), "");
  EXPECT_EQ(said("body a at (0, 2) box (2, 2)\nbody b at (1.9, 3.9) box (2, 2) angle 45 [deg]\n"), "");
  EXPECT_THAT(said("body a at (0, 2) box (2, 2)\nbody b at (1.8, 2.5) box (2, 2)\n"), testing::HasSubstr("by 0.2"));
  EXPECT_THAT(said("body a at (0, 0.4) box (1, 1)\n"), testing::HasSubstr("by 0.1"));
  EXPECT_THAT(said("body a at (0, 2) capsule 1 radius 0.5\nbody b at (0.9, 2) capsule 1 radius 0.5\n"),
              testing::HasSubstr("by 0.1"));
  EXPECT_EQ(said("body a at (0, 2) box (2, 2)\nbody b at (1, 2) box (2, 2)\nhinge a to b at (0, 2)\n"), "");
}

// The bodies of a pattern, written one by one where the pattern puts them: the same bits, and not those without traits.
TEST(ShapesAndJoints, PatternsHaveTheTraitsOfSingleBodies) {
  const auto state_of = [](const std::string& bodies) {
    const auto run = started("world { gravity (1, -9.81)\n mode fast step 1/240\n wall floor (0, 1) at 0\n" + bodies +
                                 "body ball at (0.5, 9) radius 0.5\n}\nrun 0..1\n",
                             fast);
    const auto first = run->state();
    EXPECT_TRUE(run->advance_to(1.5)) << bodies;
    return std::pair(first, run->state());
  };
  for (const auto& [pattern, shape] :
       std::vector<std::pair<std::string, std::string>>{{"grid 2 from (0, 2) spacing (3, 1)", "box (1, 1)"},
                                                        {"stack 2 from (0, 1)", "capsule 0.5"},
                                                        {"random 2 in (0, 1) to (4, 6)", "radius 0.4"}}) {
    for (const std::string traits : {"driven", "sensor", "gravity_scale 0.5", "damping 0.7", "spin_damping 3",
                                     "locked_x", "locked_y", "locked_turn"}) {
      const std::string all = "bodies it " + pattern + " " + shape, moves = " velocity (0.3, 0.1) spin 2 ";
      const auto [starts, end] = state_of(all + moves + traits + "\n");
      std::string singles;
      for (std::size_t k = 0; k < 2; ++k)
        singles += fmt::format("body it[{}] at ({}, {}) {} {} {}\n", k + 1, starts[6 * k], starts[6 * k + 2], shape,
                               moves, traits);
      EXPECT_EQ(end, state_of(singles).second) << pattern << " " << traits;
      EXPECT_NE(end, state_of(all + moves + "\n").second) << pattern << " " << traits;
    }
  }
}

// Far away a pull has its greatest force: s = F t^2/(2 m). Near its target it is a damped oscillator of its frequency;
// its force is what it writes down, F = m a, against gravity where it hangs.
TEST(ShapesAndJoints, APullDrawsABodyToItsTarget) {
  const model::Run far = run_of(
      "world { mode fast step 1/480\n body crate at (0, 0) [m] box (1, 1) mass 4\n"
      " pull hand: crate to (300, 400) spring 2 [Hz] force at most 10 [N] }\nrun 0..2 [s]\n"
      "check crate.x at end = 0.6*10/4*2^2/2 [m] within 0.01 [m]\ncheck crate.y at end = 0.8*10/4*2^2/2 [m] within "
      "0.01 [m]\n"
      "check hypot(hand.force_x, hand.force_y) at end = 10 [N] within 1e-6 [N]\n");
  EXPECT_EQ(failed_checks(far), "");
  const model::Run near = run_of(
      "world { mode fast step 1/2000\n body crate at (0, 0) box (1, 1) mass 4\n"
      " pull hand: crate to (1, 0) spring 0.5 damping 0.1 }\nrun 0..3\n"
      "let w = pi, d = 0.1*pi, f = pi*sqrt(0.99)\n"
      "check crate.x at 1 = 1 - exp(-d)*(cos(f) + d/f*sin(f)) within 0.01\n"
      "check crate.x at 2.5 = 1 - exp(-2.5*d)*(cos(2.5*f) + d/f*sin(2.5*f)) within 0.02\n");
  EXPECT_EQ(failed_checks(near), "");
  const model::Run hanging = run_of(
      "world { dimension 3\n gravity (0, 0, -10)\n mode fast step 1/240\n body crate at (0, 0, 0) box (1, 1, 1) mass "
      "4\n"
      " pull hand: crate to (0, 0, 1) at (0, 0, 0.5) spring 2 }\nrun 0..3\n"
      "check hand.force_z at end = 40 within 0.01\n"
      "check crate.z at end = 0.5 - 10/(4*pi)^2 within 0.002\n");
  EXPECT_EQ(failed_checks(hanging), "");
}

// The target is any expression: of time, of an equation beside the bodies, of another body, and of an input; a corner
// that is drawn is where it is drawn to.
TEST(ShapesAndJoints, ThePullsTargetIsAnyExpression) {
  const std::string text =
      "input side = 1 in -9..9\nworld { mode fast step 1/480\n body crate at (0, 0) box (1, 1)\n"
      " body other at (0, 5) box (1, 1)\n body guide at (9, 9) velocity (1, 0) box (1, 1)\n"
      " pull hand: crate to (2*sin(t), y) at (0.5, 0.5) spring 20\n pull other to (side, guide.x) spring 5 }\n"
      "y' = 0.1*t\ny(0) = 0\nrun 0..4\n";
  const auto run = started(text, fast);
  ASSERT_TRUE(run->set(program_of(text)->model.inputs[0].variable, 3));
  ASSERT_TRUE(run->advance_to(4));
  const double angle = run->state()[4], c = std::cos(angle), s = std::sin(angle);
  EXPECT_NEAR(run->position(0)[0] + 0.5 * (c - s), 2 * std::sin(4.0), 0.03);
  EXPECT_NEAR(run->position(0)[1] + 0.5 * (s + c), 0.8, 0.03);
  EXPECT_NEAR(run->position(1)[0], 3, 1e-3);
  EXPECT_NEAR(run->position(1)[1], 13, 0.1);
  const auto again = started(text, fast);
  ASSERT_TRUE(again->restore(run->snapshot()));
  ASSERT_TRUE(run->advance_to(5));
  ASSERT_TRUE(again->advance_to(5));
  EXPECT_EQ(run->state(), again->state());
  const auto lost = started(
      "world { mode fast step 1/60\n body crate at (0, 0) box (1, 1)\n pull crate to (sqrt(1 - t), 0) spring 1 }\n"
      "run 0..4\n",
      fast);
  const Status status = lost->advance_to(4);
  EXPECT_THAT(status.message, testing::HasSubstr("the target of a pull, is no number"));
  EXPECT_NEAR(lost->time(), 1, 0.05);
}

}  // namespace
}  // namespace continuo::worlds::shapes_and_joints_test
