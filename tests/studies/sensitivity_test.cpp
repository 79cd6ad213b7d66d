#include <cmath>
#include <memory>
#include <string>

#include <gtest/gtest.h>

#include "problems.hpp"
#include <continuo/studies/sensitivity.hpp>

namespace continuo::studies::sensitivity_test {
namespace {

Influence parameter(const model::ModelProgram& program, const std::string& name) {
  return {.index = model::find_parameter(program.model, name)};
}
Influence initial(const model::ModelProgram& program, const std::string& name) {
  return {Influence::Kind::initial, model::find_state(program.model, name)};
}

std::vector<double> final_row(const SensitivityRun& run) {
  EXPECT_TRUE(run.good()) << describe(run.status);
  const auto row = run.row(run.rows() - 1);
  return {row.begin(), row.end()};
}

// x = F/k (1 - E C), E = exp(-d t), C = cos(w t) + d/w sin(w t), d = c/(2 m), w^2 = k/m - d^2.
TEST(Sensitivity, OfMassSpringDamperIsThatOfTheClosedForm) {
  const auto program = gallery("mass_spring_damper");
  const SensitivityStudy study(program, {parameter(*program, "k"), parameter(*program, "c")});
  const SensitivityRun run = study.run({.experiment = {.rtol = 1e-11}});
  ASSERT_TRUE(run.good());
  const double m = 1, c = 0.6, k = 4, force = 2, d = c / (2 * m), w = std::sqrt(k / m - d * d);
  ASSERT_EQ(run.rows(), 301u);
  for (std::size_t row = 0; row < run.rows(); ++row) {
    const double t = run.times[row], e = std::exp(-d * t), sine = std::sin(w * t), cosine = std::cos(w * t);
    const double shape = cosine + d / w * sine;
    const double shape_by_w = -t * sine - d / (w * w) * sine + d / w * t * cosine, shape_by_d = sine / w;
    const double w_by_k = 1 / (2 * m * w), d_by_c = 1 / (2 * m), w_by_c = -d / w * d_by_c;
    const double by_k = -force / (k * k) * (1 - e * shape) - force / k * e * shape_by_w * w_by_k;
    const double by_c = -force / k * (-t * d_by_c * e * shape + e * (shape_by_w * w_by_c + shape_by_d * d_by_c));
    EXPECT_NEAR(run.sensitivity(row, 0, 0), by_k, 1e-8) << t;
    EXPECT_NEAR(run.sensitivity(row, 0, 1), by_c, 1e-8) << t;
  }
}

// Bounce n is at t_n = T (1 + 2 (e + ... + e^(n-1))), T = sqrt(2 h0/g), and leaves with v_n = e^n sqrt(2 g h0); then
// h = v_n s - g s^2/2 with s = t - t_n.
TEST(Sensitivity, OfABallAfterTenBouncesIsThatOfTheClosedForm) {
  const auto program = gallery("bouncing_ball");
  const SensitivityStudy study(program,
                               {parameter(*program, "e"), parameter(*program, "g"), parameter(*program, "h0")});
  const double g = 9.8, e = 0.9, h0 = 10, first = std::sqrt(2 * h0 / g), speed = std::sqrt(2 * g * h0);
  const int n = 10;
  double sum = 0.5, sum_by_e = 0;
  for (int j = 1; j < n; ++j) sum += std::pow(e, j), sum_by_e += j * std::pow(e, j - 1);
  const double bounce = 2 * first * sum, v = std::pow(e, n) * speed, s = 0.3;
  const std::vector<double> end = final_row(study.run({.experiment = {.rtol = 1e-12, .to = bounce + s}}));
  EXPECT_NEAR(end[0], v * s - g * s * s / 2, 1e-9);
  const auto by = [&](double v_by, double bounce_by, double g_by) {
    return v_by * s - (v - g * s) * bounce_by - g_by * s * s / 2;
  };
  EXPECT_NEAR(end[2], by(n * v / e, 2 * first * sum_by_e, 0), 1e-8);
  EXPECT_NEAR(end[4], by(v / (2 * g), -bounce / (2 * g), 1), 1e-8);
  EXPECT_NEAR(end[6], by(v / (2 * h0), bounce / (2 * h0), 0), 1e-8);
}

TEST(Sensitivity, SaysHowTheTimesOfEventsMove) {  // the first impact is at sqrt(2 h0/g)
  const auto program = gallery("bouncing_ball");
  const SensitivityRun run = SensitivityStudy(program, {parameter(*program, "g")}).run({.experiment = {.to = 2}});
  ASSERT_EQ(run.events.size(), 1u);
  EXPECT_EQ(run.events[0].name, "h falls through 0 in flight");
  EXPECT_NEAR(run.events[0].time_moves[0], -std::sqrt(2 * 10 / 9.8) / (2 * 9.8), 1e-9);
}

// x = x0 exp(-2 a t): b follows from a, x0 from b.
TEST(Sensitivity, FollowsParametersThroughOthersAndIntoInitialValues) {
  const auto program = program_of("param a = 0.5, b = 2*a\nx' = -b*x\nx(0) = b^2\nrun 0..1 tol 1e-11\n");
  const double a = 0.5, b = 2 * a, x = b * b * std::exp(-b);
  const auto of = [&](std::vector<Influence> influences, const model::Overrides& overrides = {}) {
    const SensitivityStudy study(program, std::move(influences), overrides);
    return final_row(study.run({.experiment = {.parameters = overrides}}));
  };
  EXPECT_NEAR(of({parameter(*program, "a")})[1], 2 * (2 / b - 1) * x, 1e-9);
  EXPECT_NEAR(of({parameter(*program, "b")})[1], (2 / b - 1) * x, 1e-9);
  // b is varied or set by itself here, so nothing depends on a.
  EXPECT_EQ(of({parameter(*program, "a"), parameter(*program, "b")})[1], 0);
  EXPECT_EQ(of({parameter(*program, "a")}, {{"b", 1.0}})[1], 0);
  EXPECT_NEAR(of({initial(*program, "x")})[1], std::exp(-b), 1e-9);
}

// x' = u until t = a, 0 until the times first + k period begin to add b: x = u a + b * (how many).
TEST(Sensitivity, KnowsTimesOfScheduledEventsThatDependOnParameters) {
  const auto program = program_of(
      "param a = 0.7, b = 0.1, p = 0.5, q = 0.2\nmode on { x' = 2*t }\nmode off { x' = -x }\nx(0) = 0\n"
      "at a { go off }\nevery p from a + q { x := x + b }\nrun 0..1.6 tol 1e-12\n");
  const double a = 0.7, b = 0.1, p = 0.5, q = 0.2, t = 1.6;  // additions at a + q = 0.9 and 1.4
  const std::vector<double> end =
      final_row(SensitivityStudy(program, {parameter(*program, "a"), parameter(*program, "b"), parameter(*program, "p"),
                                           parameter(*program, "q")})
                    .run());
  const double one = std::exp(-(t - a - q)), two = std::exp(-(t - a - q - p)), kept = std::exp(-(t - a));
  EXPECT_NEAR(end[0], a * a * kept + b * (one + two), 1e-9);
  EXPECT_NEAR(end[1], 2 * a * kept + a * a * kept + b * (one + two), 1e-8);
  EXPECT_NEAR(end[2], one + two, 1e-8);
  EXPECT_NEAR(end[3], b * two, 1e-8);
  EXPECT_NEAR(end[4], b * (one + two), 1e-8);
}

// A run that begins at a(p): x' = x from x(a) = 1 is exp(t - a).
TEST(Sensitivity, KnowsAStartThatMoves) {
  const auto program = program_of("param a = 0.25\nx' = x\nx(a) = 1\nrun a..1 tol 1e-11\n");
  EXPECT_NEAR(final_row(SensitivityStudy(program, {parameter(*program, "a")}).run())[1], -std::exp(0.75), 1e-8);
}

// x = a t reaches 1 at 1/a and fires an event that resets y; the jump of y resets w at the same instant.
TEST(Sensitivity, FollowsOneEventThatSetsOffAnother) {
  const auto program = program_of(
      "param a = 2\nx' = a\ny' = 1\nw' = 3\nx(0) = 0; y(0) = 0; w(0) = 0\n"
      "when x rises through 1 { y := -y }\nwhen y falls through 0.001 { w := w + t }\nrun 0..1 tol 1e-11\n");
  // y = t - 2/a after 1/a; w = 3 t + 1/a.
  const std::vector<double> end = final_row(SensitivityStudy(program, {parameter(*program, "a")}).run());
  EXPECT_NEAR(end[3], 1, 1e-10);
  EXPECT_NEAR(end[4], 2.0 / 4, 1e-10);
  EXPECT_NEAR(end[5], -1.0 / 4, 1e-10);
}

// Two balls that land at the same instant, each with a derivative of its own time: y2 = 1 - b t^2/2.
TEST(Sensitivity, TellsEventsOfOneInstantApart) {
  const auto program = program_of(
      "param a = 2, b = 2\nx'' = -a\ny'' = -b\nx(0) = 1; x'(0) = 0; y(0) = 1; y'(0) = 0\n"
      "when x falls through 0 { x' := -x' }\nwhen y falls through 0 { y' := -y' }\nrun 0..1.5 tol 1e-12\n");
  const std::vector<double> end =
      final_row(SensitivityStudy(program, {parameter(*program, "a"), parameter(*program, "b")}).run());
  // x = v (t - T) - a (t - T)^2/2, v = sqrt(2 a), T = sqrt(2/a): dv/da = 1/v, dT/da = -T/(2 a).
  const double by = 0.5 / 2 + (2 - 2 * 0.5) * 0.25 - 0.125;
  EXPECT_NEAR(end[4], by, 1e-8);
  EXPECT_NEAR(end[6], 0, 1e-12);
  EXPECT_NEAR(end[8], 0, 1e-12);
  EXPECT_NEAR(end[10], by, 1e-8);
}

// The guard jumps through zero without a slope: no implicit function gives its time.
TEST(Sensitivity, SaysWhereAMotionHasNoDerivative) {
  const auto program = program_of(
      "param p = 1\nx' = 1\nx(0) = 0\nlet side = if x > 1 then p else -p\nwhen side rises through 0 { x := 0 }\nrun "
      "0..2\n");
  const SensitivityRun run = SensitivityStudy(program, {parameter(*program, "p")}).run();
  EXPECT_FALSE(run.good());
  EXPECT_EQ(run.status.ending, Ending::cannot_continue);
  EXPECT_NE(run.status.message.find("jumps across its threshold"), std::string::npos) << run.status.message;
  EXPECT_NEAR(run.outcome.t, 1, 1e-9);  // what was computed until then is kept
}

// 0 = y - a x, x' = -y: x = exp(-a t).
TEST(Sensitivity, OfAlgebraicEquations) {
  const auto program = program_of("param a = 1.5\nunknown y = 1\nx' = -y\n0 = y - a*x\nx(0) = 1\nrun 0..1 tol 1e-10\n");
  const std::vector<double> end = final_row(SensitivityStudy(program, {parameter(*program, "a")}).run());
  EXPECT_NEAR(end[2], -std::exp(-1.5), 1e-8);
  EXPECT_NEAR(end[3], std::exp(-1.5) * (1 - 1.5), 1e-8);
}

// Collocation with polynomials of degree 4 is exact for what follows, or its residual is below 1e-10.
// x = a t^2/2 + c t, c = (1 - a T^2/2)/T: the time of a condition moves with T.
TEST(Sensitivity, OfConditionsAtSeveralTimes) {
  const auto program = program_of("param a = 3, T = 0.8\nx'' = a\nx(0) = 0\nx(T) = 1\nrun 0..1 tol 1e-10\n");
  const SensitivityRun run =
      SensitivityStudy(program, {parameter(*program, "a"), parameter(*program, "T")}).run({.times = {0, 0.3, 1}});
  ASSERT_TRUE(run.good());
  const double T = 0.8, by_T = -1 / (T * T) - 1.5;
  for (std::size_t row = 0; row < 3; ++row) {
    const double t = run.times[row];
    EXPECT_NEAR(run.value(row, 0), 1.5 * t * t + (1 - 1.5 * T * T) / T * t, 1e-12);
    EXPECT_NEAR(run.sensitivity(row, 0, 0), t * t / 2 - T / 2 * t, 1e-12);
    EXPECT_NEAR(run.sensitivity(row, 1, 0), t - T / 2, 1e-12);
    EXPECT_NEAR(run.sensitivity(row, 0, 1), by_T * t, 1e-12);
    EXPECT_NEAR(run.sensitivity(row, 1, 1), by_T, 1e-12);
  }
}

// x = a + C exp(-t) with x(0) = b x(T): C = a (b - 1)/(1 - b exp(-T)), dC/dT = -a (b - 1) b exp(-T)/(1 - b exp(-T))^2.
TEST(Sensitivity, OfConditionsThatReadOtherTimes) {
  const auto program = program_of("param a = 2, b = 0.5, T = 1\nx' = a - x\nx(0) = b*x(T)\nrun 0..2 tol 1e-10\n");
  const SensitivityRun run =
      SensitivityStudy(program, {parameter(*program, "a"), parameter(*program, "b"), parameter(*program, "T")})
          .run({.times = {0, 1.5}});
  ASSERT_TRUE(run.good());
  const double q = std::exp(-1.0), below = 1 - 0.5 * q;
  const double by_a = -0.5 / below, by_b = 2 * (1 - q) / (below * below), by_T = 2 * 0.5 * 0.5 * q / (below * below);
  for (std::size_t row = 0; row < 2; ++row) {
    const double decay = std::exp(-run.times[row]);
    EXPECT_NEAR(run.sensitivity(row, 0, 0), 1 + by_a * decay, 1e-9);
    EXPECT_NEAR(run.sensitivity(row, 0, 1), by_b * decay, 1e-9);
    EXPECT_NEAR(run.sensitivity(row, 0, 2), by_T * decay, 1e-9);
  }
}

TEST(Sensitivity, RefusesWhatHasNone) {
  const auto boundary = program_of("param a = 1\nx'' = a\nx(0) = 0\nx(1) = 1\nrun 0..1\n");
  const std::vector<Influence> initial{{Influence::Kind::initial, 1}};
  EXPECT_EQ(no_sensitivity(boundary->model, initial)->code, "E361");
  const auto family =
      program_of("param N = 2\nfor i in 1..N { x[i]' = -x[i] }\nfor i in 1..N { x[i](0) = 1 }\nrun 0..1\n");
  EXPECT_EQ(no_sensitivity(family->model, std::vector{parameter(*family, "N")})->code, "E361");
  const auto event = program_of(
      "param a = 1\nunknown y = 1\nx' = -y\n0 = y - a*x\nx(0) = 1\nwhen x falls through 0.5 { x := 1 }\nrun 0..1\n");
  EXPECT_EQ(no_sensitivity(event->model, std::vector{parameter(*event, "a")})->code, "E361");
}

TEST(Sensitivity, HasTheUnitsOfARatio) {
  EXPECT_EQ(unit_of_ratio("m", "N/m"), "m/(N/m)");
  EXPECT_EQ(unit_of_ratio("m/s", "s"), "(m/s)/s");
  EXPECT_EQ(unit_of_ratio("m", "s"), "m/s");
  EXPECT_EQ(unit_of_ratio("m", "m"), "1");
  EXPECT_EQ(unit_of_ratio("m", ""), "m");
  EXPECT_EQ(unit_of_ratio("", "s"), "1/s");
  EXPECT_EQ(unit_of_ratio("", ""), "");
}

}  // namespace
}  // namespace continuo::studies::sensitivity_test
