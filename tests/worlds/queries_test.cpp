// Queries in the text of a model: closed forms, the answers of the index of bodies, and events by a sensor.
#include <cmath>
#include <random>
#include <string>

#include <tests/worlds/scene.hpp>

#include <continuo/bodies/queries.hpp>
#include <continuo/worlds/build_world.hpp>

namespace continuo::worlds::queries_test {
namespace {

TEST(QueriesInText, MeasureBetweenSurfaces) {
  const model::Run run = run_of(R"(
world {
  body ball at (3, 4) radius 1 fixed
  body apple at (0, 0) radius 2 fixed
  bodies row grid 5 from (10, 4) spacing (3, 0) radius 0.5 fixed
  wall slope (3, 4) at -5
  wall sheet (0, 1) at 3 thin
  container box (-50, -50) to (50, 60)
}
run 0..1
check distance(ball, apple) = 2 within 1e-15
check distance(apple, ball) = 2 within 1e-15
check distance(ball, row) at 1 = 5.5 within 1e-15
check distance(row, ball) = 5.5 within 1e-15
check distance(ball, row[2]) = 8.5 within 1e-15
check distance(ball, slope) = 5 within 1e-14
check distance(ball, sheet) = 0 within 0
check distance(apple, sheet) = 1 within 0
check distance(apple, box) = 48 within 0
check distance((6, 8), ball) = 4 within 1e-15
check distance((6, 8), (9, 12)) = 5 within 1e-15
check distance(ball, row, slope, apple) = 2 within 1e-15
check distance(ball) = 0 within 0
check distance(row) = 0.5 within 1e-15
check within(ball, 2) = 2 within 0
check within(ball, 5.5, row) = 1 within 0
check within(ball, 8.6, row, apple) = 3 within 0
check within((10, 4), 0, row) = 1 within 0
)");
  EXPECT_EQ(failed_checks(run), "");
}

TEST(QueriesInText, CastRays) {
  const model::Run run = run_of(R"(
world {
  dimension 3
  body car at (0, 0, 1) radius 0.5 fixed
  body tree at (7, 0, 1) radius 1 fixed
  body bird at (0, 0, 9) radius 0.5 fixed
  wall ground (0, 0, 2) at 0
  wall sheet (1, 0, 0) at -4 thin
}
run 0..1
check ray(car, (5, 0, 0), 100) = 6 within 1e-15
check ray(car, (5, 0, 0), 4) = 4 within 0
check ray(car, (0, 0, -1), 100) = 1 within 1e-15
check ray(car, (0, 0, 1), 100) = 7.5 within 1e-15
check ray(car, (-1, 0, 0), 100) = 4 within 1e-15
check ray((-9, 0, 1), (1, 0, 0), 100) = 5 within 1e-15
check ray(car, (0, 1, 0), 100) = 100 within 0
check ray(car, (3, 0, -4), 100) = 1.25 within 1e-15
check ray(car, (0, 0, -1), 100, tree, bird) = 100 within 0
check ray((7, 0.5, 1), (0, 0, 1), 100) = 0 within 0
check ray((0, 0, -2), (0, 0, 1), 100) = 0 within 0
check ray(car, (0, 0, 0), 100) = 100 within 0
)");
  EXPECT_EQ(failed_checks(run), "");
}

/// Against the tree of boxes of continuo/bodies/queries.hpp, in a crowd of discs of three sizes between walls.
TEST(QueriesInText, AgreeWithTheIndexOfTheBodies) {
  const auto program = program_of(R"(
param px = 0, py = 0, dx = 1, dy = 0, reach = 40
world {
  bodies gas random 60 in (0, 0) to (30, 30) radius 0.6 seed 3
  bodies dust random 60 in (0, 0) to (30, 30) radius 0.2 seed 4
  body rock at (35, 15) radius 4
  container box (-5, -5) to (45, 35)
  wall sheet (1, 2) at 20 thin
}
output way = ray((px, py), (dx, dy), reach)
output gap = distance((px, py), gas, dust, rock)
output near = within((px, py), 2)
run 0..1
)");
  std::vector<double> variables = start_values(program->model);
  const auto built = build_world<2>(program->model, variables);
  ASSERT_TRUE(built.status) << built.status.message;
  const Queries queries(built.world);
  std::mt19937 engine(5);
  std::uniform_real_distribution<double> uniform(0, 1);
  std::size_t hits = 0, crowded = 0;
  for (int k = 0; k < 1000; ++k) {
    const Vector<double, 2> origin{{-4 + 48 * uniform(engine), -4 + 38 * uniform(engine)}};
    const double angle = 6.3 * uniform(engine);
    const Vector<double, 2> direction = Vector<double, 2>{{std::cos(angle), std::sin(angle)}} * (3 * uniform(engine));
    for (const auto& [name, value] :
         {std::pair("px", origin[0]), {"py", origin[1]}, {"dx", direction[0]}, {"dy", direction[1]}})
      variables[program->model.parameters[model::find_parameter(program->model, name)].variable] = value;
    const auto asked = [&](std::string_view name) {
      for (const model::Quantity& output : program->model.outputs)
        if (output.name == name) return evaluate(program->model, output.node, variables);
      ADD_FAILURE() << name;
      return 0.0;
    };
    const auto hit = queries.first_hit({.origin = origin, .direction = direction, .reach = 40});
    ASSERT_TRUE(hit) << hit.status().message;
    // Both solve the same quadratic, in different orders of operations: they agree to 1e-16 of its terms, of up to
    // 50^2, over twice a root that is small only for a grazing ray; there, to half of the digits.
    EXPECT_NEAR(asked("way"), hit->empty() ? 40 : hit->front().distance, 1e-6) << k;
    hits += !hit->empty() && !hit->front().is_wall() ? 1 : 0;
    EXPECT_NEAR(asked("gap"), queries.nearest(origin, 1)->front().distance, 1e-13) << k;
    const auto touched = queries.in_sphere(origin, 2);
    EXPECT_EQ(asked("near"), static_cast<double>(touched->bodies.size() + touched->walls.size())) << k;
    crowded += touched->bodies.size() > 1 ? 1 : 0;
  }
  EXPECT_GT(hits, 300U);
  EXPECT_GT(crowded, 100U);
}

/// A car at 5 m/s has a sensor, detects a wall 20 m ahead, and brakes at a distance of 4 m; a stone that rolls into the
/// beam is detected, too.
std::string car(const std::string& mode) {
  return R"(
world {
  body car at (0, 1) [m] velocity (5, 0) radius 50 [cm]
  body stone at (17, 6) [m] velocity (0, -2) radius 1 friction 0 restitution 0 density 100
  wall ahead (-1, 0) at -20
)" + mode +
         R"(
}
output seen = ray(car, (car.x', 0), 3000 [cm], ahead)
when ray(car, (1, 0), 30, ahead) falls through 400 [cm] { car.x' := 0.01; mark "brakes" }
when ray(car, (1, 0), 30) - ray(car, (1, 0), 30, ahead) falls through -1e-9 [m] { mark "sees the stone" }
run 0..4 [s] output 0.5
)";
}
TEST(QueriesInText, AreSensorsOfEvents) {
  for (const auto& [mode, step] : {std::pair("", 1e-12), std::pair("mode fast step 1/100", 0.0100001)}) {
    const model::Run run = run_of(car(mode));
    std::vector<model::RecordedEvent> marks;
    for (const model::RecordedEvent& event : run.events)
      if (!event.mark.empty()) marks.push_back(event);
    ASSERT_EQ(marks.size(), 2U) << mode;
    // The stone, with its centre at y = 6 and a radius of 1, moves down at 2 m/s: its edge reaches the beam at y = 1
    // after 2 s.
    EXPECT_EQ(marks[0].mark, "sees the stone");
    EXPECT_GE(marks[0].t, 2 - 1e-12);
    EXPECT_LE(marks[0].t, 2 + step) << mode;
    EXPECT_EQ(marks[1].mark, "brakes");
    EXPECT_GE(marks[1].t, 16.0 / 5 - 1e-12);
    EXPECT_LE(marks[1].t, 16.0 / 5 + step) << mode;
    EXPECT_EQ(run.motion.columns.back().unit, "m");
    EXPECT_NEAR(last(run, "seen"), 4 - 0.01 * (4 - marks[1].t) - 5 * (marks[1].t - 16.0 / 5), 1e-12);
  }
}

/// m y'' = -k (y - r - l) about the wall: a swing of amplitude 1 about l + r, omega = 2.
TEST(QueriesInText, StandInForces) {
  const std::string text = R"(
world {
  body ball at (0, 4) radius 0.5 mass 2
  wall floor (0, 1) at 0
)";
  const std::string force = "}\nforce on ball = (0, -8*(distance(ball, floor) - 2.5))\nrun 0..3\n";
  EXPECT_NEAR(last(run_of(text + force), "ball.y"), 3 + std::cos(6), 1e-8);  // of the tolerance 1e-10
  const model::Run fast = run_of(text + "mode fast step 0.01 integrator central_difference\n" + force);
  EXPECT_NEAR(last(fast, "ball.y"), 3 + std::cos(6),
              6 * 4 * 0.0025 * 0.0025 / 24 * 2);  // t omega (omega h)^2 / 24, h = step / substeps
}

TEST(QueriesInText, LeaveTheirNamesToModels) {
  const model::Run run = run_of(R"(
world { body ball at (0, 0) velocity (1, 0) }
distance' = ball.x'
distance(0) = 2
output ray = 2*distance
run 0..3
check distance(3) = 5 within 1e-9
check ray at end = 10 within 1e-9
)");
  EXPECT_EQ(failed_checks(run), "");
}

}  // namespace
}  // namespace continuo::worlds::queries_test
