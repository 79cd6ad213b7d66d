// The verbs that study a model's equations, and boundary-value problems by `run`: their output, and their refusals of
// bad questions.
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "shell.hpp"

namespace continuo::app {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

TEST(BoundaryValues, RunSolvesThemByItself) {
  const Shell shell;
  shell.write("p.sim", "x'' = 2\nx(1) = 3\nx(7) = 4\nrun 1..7\ncheck x(4) = -5.5 within 1e-12\n");
  const Result result = shell.run("run p.sim -o p.csv");
  EXPECT_EQ(result.exit, 0) << result.err;
  EXPECT_THAT(result.out, AllOf(HasSubstr("checks  1 passed"), HasSubstr("collocation")));
  EXPECT_THAT(shell.read("p.csv"), HasSubstr("t,x,x'"));
  EXPECT_EQ(shell.run("verify p.sim").exit, 0);
}

TEST(BoundaryValues, SeveralSolutionsCanBeChosen) {
  const Shell shell;
  EXPECT_THAT(shell.run("run " + gallery("bratu")).out, HasSubstr("2 guesses led to 2 different solutions"));
  EXPECT_THAT(shell.run("run " + gallery("bratu") + " --solution 2").out, HasSubstr("u' = -10.8"));
  const Result third = shell.run("run " + gallery("bratu") + " --solution 3");
  EXPECT_EQ(third.exit, 3);
  EXPECT_THAT(third.err, HasSubstr("2 were found"));
}

TEST(BoundaryValues, HardOnesAreFollowedFromEasyOnesOrEarlierRuns) {
  const Shell shell;
  shell.write("shock.sim", "param eps = 1e-3\ny'' = (y - y*y')/eps\ny(0) = 1; y(1) = -1/3\nrun 0..1\n");
  const Result along = shell.run("run shock.sim --along eps=0.1..1e-4 -o shock.csv");
  EXPECT_EQ(along.exit, 0) << along.err;
  const Result again = shell.run("run shock.sim --set eps=1e-4 --guess shock.csv");
  EXPECT_EQ(again.exit, 0) << again.err;
  EXPECT_EQ(lines_of(again.out)[2], lines_of(along.out)[2]);  // y' to six digits
}

TEST(BoundaryValues, WrongBeginningsAreRefused) {
  const Shell shell;
  shell.write("easy.sim", "param c = 2 [m/s^2], N = 2\ny'' = c\ny(0) = 0 [m]; y(1) = 1 [m]\nrun 0..1 [s]\n");
  const auto refusal = [&](const std::string& options) {
    const Result result = shell.run("run easy.sim " + options);
    EXPECT_EQ(result.exit, 1) << options << result.err;
    return result.err;
  };
  EXPECT_THAT(refusal("--along c"), HasSubstr("--along eps=1..1e-3"));
  EXPECT_THAT(refusal("--along c=1"), HasSubstr("two values are wanted"));
  EXPECT_THAT(refusal("--along d=1..2"), HasSubstr("no parameter `d`"));
  EXPECT_THAT(refusal("--along c=1..2x"), HasSubstr("--along"));
  EXPECT_THAT(refusal("--guess none.csv"), HasSubstr("cannot read none.csv"));
  shell.write("text.csv", "t,y\n0,much\n1,2\n");
  EXPECT_THAT(refusal("--guess text.csv"), HasSubstr("text.csv:2"));
  shell.write("start.sim", "x' = -x\nx(0) = 1\nrun 0..1\n");
  EXPECT_THAT(shell.run("run start.sim --guess text.csv").err, HasSubstr("is for boundary-value problems"));
}

TEST(BoundaryValues, WhatCannotBeSolvedIsSaidWithItsLine) {
  const Shell shell;
  shell.write("none.sim", "u'' = -4*exp(u)\nu(0) = 0\nu(1) = 0\nrun 0..1\n");  // Bratu beyond its fold
  const Result none = shell.run("run none.sim");
  EXPECT_EQ(none.exit, 3);
  EXPECT_THAT(none.err, AllOf(HasSubstr("error[E322]"), HasSubstr("none.sim:2:1"), HasSubstr("guess")));

  shell.write("outside.sim", "x'' = 2\nx(1) = 3\nx(9) = 4\nrun 1..7\n");
  const Result outside = shell.run("run outside.sim");
  EXPECT_EQ(outside.exit, 2);
  EXPECT_THAT(outside.err, AllOf(HasSubstr("error[E245]"), HasSubstr("outside.sim:3:1"), HasSubstr("from 1 to 7")));

  shell.write("few.sim", "x'' = 2\nx(1) = 3\ny' = x\ny(7) = 4\nrun 1..7\n");
  EXPECT_THAT(shell.run("run few.sim").err, AllOf(HasSubstr("error[E244]"), HasSubstr("3 boundary conditions")));

  shell.write("events.sim", "x'' = 2\nx(1) = 3\nx(7) = 4\nwhen x falls through 0 { mark \"zero\" }\nrun 1..7\n");
  EXPECT_THAT(shell.run("run events.sim").err, AllOf(HasSubstr("error[E321]"), HasSubstr("events")));
  EXPECT_THAT(shell.run("compare outside.sim --methods rk4").err, HasSubstr("E245"));
}

TEST(Steady, FindsAndFollows) {
  const Shell shell;
  const Result result = shell.run("steady " + gallery("lorenz") + " --along rho=0..30");
  EXPECT_EQ(result.exit, 0) << result.err;
  EXPECT_THAT(result.out, AllOf(HasSubstr("to 3 equilibria"), HasSubstr("rho = 24.7368"), HasSubstr("Hopf point"),
                                HasSubstr("rho = 1: pitchfork")));
}

TEST(Steady, WhatCannotBeAsked) {
  const Shell shell;
  shell.write("fall.sim", "h'' = -9.8\nh(0) = 10; h'(0) = 0\nrun 0..1\n");
  const Result none = shell.run("steady fall.sim");
  EXPECT_EQ(none.exit, 3);
  EXPECT_THAT(none.err, AllOf(HasSubstr("no equilibrium"), HasSubstr("the smallest residual is 9.8, of `h'`")));
  EXPECT_THAT(none.out, IsEmpty());
  const std::string lorenz = "steady " + gallery("lorenz");
  EXPECT_THAT(shell.run(lorenz + " --along roh=0..3").err, HasSubstr("did you mean `rho`?"));
  EXPECT_THAT(shell.run(lorenz + " --along rho=3").err, HasSubstr("NAME=LOW..HIGH"));
  EXPECT_THAT(shell.run(lorenz + " --box q=0..1").err, HasSubstr("there is no state `q`"));
  EXPECT_THAT(shell.run(lorenz + " --mode fly").err, HasSubstr("there is no mode `fly`"));
  EXPECT_EQ(shell.run(lorenz + " --along rho=0..3 --plot /nowhere/x.svg").exit, 1);
  EXPECT_EQ(shell.run("steady " + gallery("bratu")).exit, 2);
  EXPECT_EQ(shell.run("steady nothing.sim").exit, 1);
}

TEST(Linearize, MassSpringDamper) {
  const Shell shell;
  const Result text = shell.run("linearize " + gallery("mass_spring_damper"));
  EXPECT_EQ(text.exit, 0) << text.err;
  EXPECT_THAT(text.out, HasSubstr("frequency 0.31831, damping 0.15"));  // sqrt(4)/2pi, 0.6/(2 sqrt 4)
  EXPECT_THAT(shell.run("linearize " + gallery("mass_spring_damper") + " --json").out, HasSubstr("\"A\""));
  shell.write("fall.sim", "h'' = -9.8\nh(0) = 10; h'(0) = 0\nrun 0..1\n");
  const Result none = shell.run("linearize fall.sim");
  EXPECT_EQ(none.exit, 3);
  EXPECT_THAT(none.err, HasSubstr("--start"));
  EXPECT_EQ(shell.run("linearize fall.sim --start").exit, 0);
  EXPECT_THAT(shell.run("linearize fall.sim --at h=high").err, HasSubstr("`h=high` is not NAME=NUMBER"));
  shell.write("kink.sim", "x' = -sqrt(x)\nx(0) = 0\nrun 0..1\n");
  EXPECT_THAT(shell.run("linearize kink.sim --start").err, HasSubstr("no derivative"));
}

// A node between two resistors, its voltage an unknown, and the same circuit with the node written out.
TEST(Linearize, AlgebraicEquationsAreTakenOut) {
  const Shell shell;
  const std::string given = "param R1 = 2, R2 = 3, C = 0.5, L = 0.1\ninput e = 5 in 0..10\n";
  const std::string start = "q(0) = 0; i(0) = 0\noutput at_node = v, current = (e - v)/R1\nrun 0..1\n";
  shell.write("dae.sim",
              given + "unknown v = 1\nq' = (v - q/C)/R2\ni' = (v - i)/L\n0 = (e - v)/R1 - (v - q/C)/R2 - i\n" + start);
  shell.write("ode.sim",
              given + "let v = (e/R1 + q/C/R2 - i)/(1/R1 + 1/R2)\nq' = (v - q/C)/R2\ni' = (v - i)/L\n" + start);
  const auto with = nlohmann::json::parse(shell.run("linearize dae.sim --json").out);
  const auto without = nlohmann::json::parse(shell.run("linearize ode.sim --json").out);
  EXPECT_EQ(with["states"], without["states"]);
  EXPECT_EQ(with["unknowns"], nlohmann::json::parse("[\"v\"]"));
  for (const std::string matrix : {"A", "B", "C", "D"})
    for (std::size_t i = 0; i < 2; ++i)
      for (std::size_t j = 0; j < without[matrix][i].size(); ++j)
        EXPECT_NEAR(with[matrix][i][j], without[matrix][i][j], 1e-10) << matrix << i << j;
  ASSERT_EQ(with["modes"].size(), without["modes"].size());
  for (std::size_t k = 0; k < with["modes"].size(); ++k)
    for (std::size_t part = 0; part < 2; ++part)
      EXPECT_NEAR(with["modes"][k]["eigenvalue"][part], without["modes"][k]["eigenvalue"][part], 1e-10);
  // Elsewhere the unknown follows from the equations, not from its guess: 0 = (5 - v)/2 - (v - 2)/3 - 1.
  EXPECT_THAT(shell.run("linearize dae.sim --at q=1,i=1").out, HasSubstr("v = 2.6"));
}

TEST(Steady, ModelsWithAlgebraicEquations) {
  const Shell shell;
  const Result diode = shell.run("steady " + gallery("rc_diode"));
  EXPECT_EQ(diode.exit, 0) << diode.err;
  // With a full capacitor the diode is a resistor of Vt/Is in series with R: one eigenvalue, -1/((R + Vt/Is) C).
  EXPECT_THAT(diode.out, AllOf(HasSubstr("stable"), HasSubstr("u = 5 V"), HasSubstr("eigenvalues -3.868")));
  shell.write("fold.sim",
              "unknown z = 0\nunknown w = 1\nx' = 1 + z - x\n0 = w - 3*x\n0 = x - 1 - z^2\nx(0) = 1\nrun 0..1\n");
  const Result open = shell.run("linearize fold.sim --at x=1,z=0");
  EXPECT_EQ(open.exit, 3);
  EXPECT_THAT(open.err, AllOf(HasSubstr("do not determine `z`"), HasSubstr("`0 = x - 1 - z^2` (line 5)")));
  EXPECT_THAT(shell.run("orbit " + gallery("rc_diode")).err, HasSubstr("algebraic"));
  const Result along = shell.run("steady " + gallery("rc_diode") + " --along battery=1..5");
  EXPECT_EQ(along.exit, 0) << along.err;
}

// AUTO's demo pp2: the branches without prey and with prey alone cross at p = 3/5, those of prey alone and of both
// where the prey is 1/3.
TEST(Steady, BranchesThatCrossAsTableAndJson) {
  const Shell shell;
  shell.write("pp2.sim",
              "param p = 0\nu' = 3*u*(1 - u) - u*v - p*(1 - exp(-5*u))\nv' = -v + 3*u*v\n"
              "u(0) = 0.1; v(0) = 0.1\nrun 0..20\n");
  const Result result = shell.run("steady pp2.sim --along p=0..1 --json -o b.csv");
  EXPECT_EQ(result.exit, 0) << result.err;
  const auto found = nlohmann::json::parse(result.out);
  EXPECT_EQ(found["equilibria"].size(), 3u);
  std::size_t transcritical = 0, hopf = 0;
  for (const auto& branch : found["branches"])
    for (const auto& point : branch["bifurcations"]) {
      const double p = point["at"], at_third = 2.0 / 3 / (1 - std::exp(-5.0 / 3));
      if (point["kind"] == "transcritical point") {
        ++transcritical;
        EXPECT_LT(std::min(std::abs(p - 0.6), std::abs(p - at_third)), 1e-10);
      } else if (point["kind"] == "Hopf point") {
        ++hopf;
        EXPECT_LT(point["first_lyapunov_coefficient"], 0);
      }
    }
  EXPECT_EQ(hopf, 1u);
  EXPECT_EQ(transcritical, 4u);  // each on both of the branches that cross there
  EXPECT_THAT(shell.read("b.csv"), testing::StartsWith("branch,kind,p,stable,u,v,eigenvalue 1 re,eigenvalue 1 im"));
  EXPECT_THAT(shell.run("steady pp2.sim --along p=0..1 --ds-min 0.1 --ds 0.01").err, HasSubstr("--ds-min is 0.1"));
  EXPECT_THAT(shell.run("steady pp2.sim --along p=0..1 --ds-max 0").err, HasSubstr("greater than zero"));
  EXPECT_EQ(shell.run("steady pp2.sim --ds 0.1").exit, 1);
}

TEST(Phase, DrawsThePlane) {
  const Shell shell;
  const Result result = shell.run("phase " + gallery("pendulum") + " --box \"theta=-7..7,theta'=-8..8\" --plot p.svg");
  EXPECT_EQ(result.exit, 0) << result.err;
  EXPECT_THAT(result.out, HasSubstr("8 separatrices"));
  EXPECT_THAT(shell.read("p.svg"), HasSubstr("separatrices"));
  EXPECT_THAT(shell.run("phase " + gallery("lorenz")).err, HasSubstr("two states, this model has 3"));
}

TEST(Orbit, PeriodSectionAndExponents) {
  const Shell shell;
  const std::string oscillator = "orbit " + gallery("van_der_pol_stiff") + " --set mu=10";
  EXPECT_THAT(shell.run(oscillator).out, HasSubstr("period 19.07836957"));
  EXPECT_NEAR(nlohmann::json::parse(shell.run(oscillator + " --json").out)["period"], 19.07836957, 1e-8);
  // The search also finds a period forty times as long as the model's run.
  shell.write("relax.sim", "param mu = 1000\nx'' = mu*(1 - x^2)*x' - x\nx(0) = 2; x'(0) = 0\nrun 0..40\n");
  EXPECT_THAT(shell.run("orbit relax.sim").out, HasSubstr("period 1614.40"));
  const Result section = shell.run("orbit " + gallery("lorenz") + " --section z=27 --duration 10");
  EXPECT_THAT(section.out, testing::StartsWith("t,x,y,z\n"));
  EXPECT_THAT(shell.run("orbit " + gallery("lorenz") + " --lyapunov --duration 20").out,
              HasSubstr("Lyapunov exponents"));
  EXPECT_THAT(shell.run("orbit " + gallery("pendulum")).out, HasSubstr("one of a family"));
  EXPECT_EQ(shell.run("orbit " + gallery("lorenz") + " --section q=27").exit, 1);
}

TEST(Orbit, SectionsAndExponentsAsJsonAndAPicture) {
  const Shell shell;
  const std::string lorenz = "orbit " + gallery("lorenz");
  const Result drawn = shell.run(lorenz + " --section z=27 --duration 10 --json --plot p.svg");
  const auto section = nlohmann::json::parse(drawn.out);
  ASSERT_GE(section["points"].size(), 3u);
  for (const auto& point : section["points"]) EXPECT_NEAR(point["x"][2], 27, 1e-6);
  EXPECT_THAT(shell.read("p.svg"), HasSubstr("passes"));
  const auto found = nlohmann::json::parse(shell.run(lorenz + " --lyapunov --duration 50 --json").out);
  ASSERT_EQ(found["exponents"].size(), 3u);
  // Their sum is the divergence, -(sigma + 1 + beta).
  const double sum =
      found["exponents"][0].get<double>() + found["exponents"][1].get<double>() + found["exponents"][2].get<double>();
  EXPECT_NEAR(sum, -(10 + 1 + 8.0 / 3), 1e-3);
}

TEST(Steady, HoldsWhatIsConserved) {  // a + b = total, at rest a = total / 3
  const Shell shell;
  shell.write("pair.sim", "param total = 3\na' = b - 2*a\nb' = 2*a - b\na(0) = total; b(0) = 0\nrun 0..10\n");
  const Result text = shell.run("steady pair.sim");
  EXPECT_THAT(text.out, HasSubstr("stable\n   a = 1\n   b = 2\n"));
  EXPECT_THAT(text.out, HasSubstr("conserved: a + b = 3"));
  const auto found = nlohmann::json::parse(shell.run("steady pair.sim --along total=1..9 --json").out);
  EXPECT_EQ(found["conserved"][0]["sum"], "a + b");
  ASSERT_EQ(found["branches"].size(), 1u);
  for (const auto& point : found["branches"][0]["points"])
    EXPECT_NEAR(point["x"][0].get<double>(), point["at"].get<double>() / 3, 1e-9);
  EXPECT_THAT(shell.run("sense pair.sim --of equilibrium --param total").out, HasSubstr("0.333333"));
  EXPECT_THAT(shell.run("explore pair.sim").out, HasSubstr("conserved   a + b = 3\nequilibria"));
}

TEST(Steady, SaysEverywhereThatEventsMayChangeWhatIsConserved) {
  const Shell shell;
  const std::string equations = "param total = 3\na' = b - 2*a\nb' = 2*a - b\na(0) = total; b(0) = 0\nrun 0..10\n";
  shell.write("pair.sim", equations);
  shell.write("fed.sim", equations + "when a falls through 0.5 { a := a + 1 }\n");
  const std::string said = "by the equations; events, which may change it, are not considered\n";
  EXPECT_THAT(shell.run("steady fed.sim").out, HasSubstr("conserved: a + b = 3\n           " + said));
  EXPECT_THAT(shell.run("explore fed.sim").out, HasSubstr("conserved   a + b = 3\n            " + said));
  for (const std::string& verb : {std::string("steady"), std::string("explore")}) {
    const auto with = nlohmann::json::parse(shell.run(verb + " fed.sim --json").out);
    EXPECT_EQ(with["events_may_change_conserved"], true) << verb;
    EXPECT_EQ(with["conserved"][0]["value"], 3) << verb;
    const auto without = nlohmann::json::parse(shell.run(verb + " pair.sim --json").out);
    EXPECT_EQ(without["events_may_change_conserved"], false) << verb;
  }
}

TEST(Orbit, ABranchWithItsTableAndPicture) {
  const Shell shell;
  shell.write("bautin.sim",
              "model Bautin\nparam mu = 0.5 in -1..1\nlet grow = mu + (x^2 + y^2) - (x^2 + y^2)^2\n"
              "x' = grow*x - 1.5*y\ny' = grow*y + 1.5*x\nx(0) = 1; y(0) = 0\nrun 0..40\n");
  const Result found = shell.run("orbit bautin.sim --along mu=-1..1 -o b.csv --plot b.svg");
  EXPECT_EQ(found.exit, 0) << found.err;
  EXPECT_THAT(found.out, AllOf(HasSubstr("begins at mu = 0: the orbit shrinks"), HasSubstr("mu = -0.25: fold"),
                               HasSubstr("ends at mu = 1")));
  EXPECT_THAT(
      shell.read("b.csv"),
      testing::StartsWith("branch,mu,period,stable,x min,x max,y min,y max,multiplier 1 re,multiplier 1 im\n1,"));
  EXPECT_THAT(shell.read("b.svg"), HasSubstr("least and greatest"));
  EXPECT_THAT(shell.run("orbit bautin.sim --along mu=-1..1 --from-hopf").out, HasSubstr("mu = -0.25: fold"));
  const auto as_json = nlohmann::json::parse(shell.run("orbit bautin.sim --along mu=-1..1 --json").out);
  ASSERT_EQ(as_json["branches"].size(), 1u);
  EXPECT_NEAR(as_json["branches"][0]["bifurcations"][0]["at"], -0.25, 1e-8);
  EXPECT_EQ(as_json["branches"][0]["ends"][1]["at"], 1);
  // From the initial values the motion tends to an equilibrium; the orbits begin elsewhere.
  const Result fallback = shell.run("orbit bautin.sim --along mu=-1..1 --set mu=-0.5");
  EXPECT_EQ(fallback.exit, 0);
  EXPECT_THAT(fallback.err, HasSubstr("trying the Hopf points of equilibria"));
  EXPECT_THAT(fallback.out, HasSubstr("mu = -0.25: fold"));
}

TEST(Orbit, WhatCannotBeFollowed) {
  const Shell shell;
  const std::string lorenz = "orbit " + gallery("lorenz");
  EXPECT_THAT(shell.run(lorenz + " --along roh=10..30").err, HasSubstr("did you mean `rho`?"));
  EXPECT_THAT(shell.run(lorenz + " --along rho=10..20").err, AllOf(HasSubstr("outside of 10..20"), HasSubstr("--set")));
  EXPECT_THAT(shell.run(lorenz + " --along rho=30").err, HasSubstr("NAME=LOW..HIGH"));
  EXPECT_THAT(shell.run(lorenz + " --along rho=10..30 --of q").err, HasSubstr("there is no state `q`"));
  EXPECT_THAT(shell.run(lorenz + " --from-hopf").err, HasSubstr("--along"));
  EXPECT_EQ(shell.run(lorenz + " --along rho=10..30 -o /nowhere/x.csv").exit, 1);
  shell.write("line.sim", "param k = 1\nx' = -k*x\nx(0) = 1\nrun 0..1\n");
  const Result none = shell.run("orbit line.sim --along k=0.5..2");
  EXPECT_EQ(none.exit, 3);
  EXPECT_THAT(none.err, HasSubstr("no orbit was found to follow along k=0.5..2"));
}

TEST(Studies, OrbitGoesThroughEventsAndForces) {
  const Shell shell;
  shell.write("ball.sim",
              "h' = v\nv' = -9.81\nh(0) = 1\nv(0) = 0\nn' = 0\nn(0) = 0\n"
              "when h falls through 0 { v := -0.7*v + 2; n := n + 1 }\nrun 0..60\n");
  const Result ball = shell.run("orbit ball.sim --plot ball.svg");
  EXPECT_THAT(ball.out, AllOf(HasSubstr("period 1.359157"), HasSubstr("multipliers 1, 0.7\n"),
                              HasSubstr("`h falls through 0` once a period"),
                              HasSubstr("n does not return; nothing depends on it")));
  EXPECT_THAT(shell.read("ball.svg"), HasSubstr("<svg"));
  shell.write("forced.sim", "x'' = -x - 0.2*x' + cos(2*pi*t)\nx(0) = 0\nx'(0) = 0\nrun 0..200\n");
  const auto forced = nlohmann::json::parse(shell.run("orbit forced.sim --json").out);
  EXPECT_EQ(forced["turns"], 1);
  EXPECT_NEAR(std::hypot(forced["multipliers"][0][0].get<double>(), forced["multipliers"][0][1].get<double>()),
              std::exp(-0.1), 1e-9);
  shell.write("grows.sim", "x' = t - x\nx(0) = 0\nrun 0..20\n");
  EXPECT_THAT(shell.run("orbit grows.sim").err,
              AllOf(HasSubstr("grows.sim:2:"), HasSubstr("the period of this time-dependent term")));
  EXPECT_THAT(shell.run("orbit grows.sim --period 1").err, HasSubstr("is not periodic with the period"));
  EXPECT_THAT(shell.run("orbit forced.sim --period 1.5").err, HasSubstr("not a multiple of 1"));
  EXPECT_THAT(shell.run("orbit ball.sim --turns 2").err, HasSubstr("the model does not depend on time"));
}

TEST(Studies, SenseOfWhatAMotionComesTo) {
  const Shell shell;
  // tau (ln(12/10) + ln(30/28)): its derivative by tau is itself over tau, in hours.
  const auto period =
      nlohmann::json::parse(shell.run("sense " + gallery("thermostat") + " --param tau --of period --json").out);
  const double turn = std::log(12.0 / 10) + std::log(30.0 / 28);
  EXPECT_NEAR(period["period"].get<double>(), 2 * turn, 1e-9);
  EXPECT_NEAR(period["period_by"][0].get<double>(), turn, 1e-7);
  EXPECT_THAT(shell.run("sense " + gallery("thermostat") + " --param tau --of events --until 1").out,
              AllOf(HasSubstr("d t / d tau"), HasSubstr("T rises through high")));
  // x = a/b, y = a^2/b^2.
  shell.write("rest.sim", "param a = 3, b = 2\nx' = a - b*x\ny' = x^2 - y\nx(0) = 1\ny(0) = 1\nrun 0..1\n");
  const auto rest = nlohmann::json::parse(shell.run("sense rest.sim --param a,b --of equilibrium --json").out);
  EXPECT_NEAR(rest["x_by"][0][0].get<double>(), 0.5, 1e-9);
  EXPECT_NEAR(rest["x_by"][0][1].get<double>(), 1.5, 1e-9);
  EXPECT_NEAR(rest["x_by"][1][1].get<double>(), -2.25, 1e-9);
  EXPECT_THAT(shell.run("sense rest.sim --param a --of equilibrium").out, HasSubstr("d y / d a"));
  EXPECT_EQ(shell.run("sense rest.sim --param a --of equilibrium --initial x").exit, 1);
}

TEST(Studies, PlacesOfRestNameTheEventsOnTheWay) {
  const Shell shell;
  // While it heats, the room tends to 323, which it leaves for 295 at the latest.
  for (const std::string verb : {"steady ", "linearize "})
    EXPECT_THAT(shell.run(verb + gallery("thermostat")).out,
                AllOf(HasSubstr("in mode heating"), HasSubstr("beyond `T rises through high in heating`")))
        << verb;
  shell.write("floor.sim", "h' = v\nv' = -h - v\nh(0) = 1\nv(0) = 0\nwhen h falls through 0 { v := -v }\nrun 0..9\n");
  EXPECT_THAT(shell.run("steady floor.sim").out, HasSubstr("on the surface of the event `h falls through 0`"));
  const auto rest = nlohmann::json::parse(shell.run("linearize floor.sim --json").out);
  EXPECT_EQ(rest["events"][0]["where"], "on");
  shell.write("far.sim", "x' = -x\nx(0) = 1\nwhen x > 2 { x := 1 }\nrun 0..9\n");
  EXPECT_THAT(shell.run("steady far.sim").out, Not(HasSubstr("event")));
}

TEST(Studies, HelpBeginsWithExamples) {
  const Shell shell;
  for (const std::string verb : {"steady", "linearize", "phase", "orbit"})
    EXPECT_THAT(shell.run(verb + " --help").out, testing::StartsWith("Examples:\n  continuo " + verb)) << verb;
}

TEST(StudiesAsJson, SayWhatTheirTablesSay) {
  const Shell shell;
  shell.write(
      "friction.sim",
      "param mu = 0.5\nv' = 2*sin(t) - mu*sign(v)\nv(0) = 0\nwhen v rises through 1 { mark \"one\" }\nrun 0..3\n");
  const auto object = [&](const std::string& command, int exit = 0) {
    const Result result = shell.run(command + " --json");
    EXPECT_EQ(result.exit, exit) << command << result.err;
    return nlohmann::json::parse(result.out);
  };
  const auto sense = object("sense friction.sim --param mu");
  // It slips from sin t = mu/2 on: v = 2 (cos t0 - cos t) - mu (t - t0).
  const double t0 = std::asin(0.25);
  EXPECT_EQ(sense["by"], nlohmann::json({"mu"}));
  EXPECT_NEAR(sense["rows"].back()["by"][0][0].get<double>(), -(3 - t0), 1e-5);
  EXPECT_EQ(sense["events"][0]["name"], "v rises through 1");

  const auto compare = object("compare " + gallery("mass_spring") + " --methods rk4,euler --step 0.1");
  EXPECT_EQ(compare["contenders"].size(), 2u);
  EXPECT_LT(compare["contenders"][0]["final_error"], compare["contenders"][1]["final_error"]);
  const auto converge = object("converge " + gallery("mass_spring") + " --methods rk4 --most-steps 1024");
  EXPECT_NEAR(converge["methods"][0]["global"]["order"].get<double>(), 4, 0.2);
  const auto stability = object("stability rk4,bdf2 --model " + gallery("mass_spring_damper"));
  EXPECT_NEAR(stability["methods"][0]["real_axis_to"].get<double>(), -2.785293563405282, 1e-9);
  EXPECT_EQ(stability["methods"][1]["largest"]["step"], "none");
  const auto phase = object("phase " + gallery("pendulum"));
  EXPECT_EQ(phase["states"].size(), 2u);
  EXPECT_FALSE(phase["motions"].empty());
}

TEST(Sense, RefusesAJumpThatNobodyLocates) {
  const Shell shell;
  shell.write("u.sim", "param q = 2\nunknown u = 1\nx' = if u > 1 then -q else q\n0 = u - x\nx(0) = 0\nrun 0..3\n");
  const Result result = shell.run("sense u.sim --param q");
  EXPECT_EQ(result.exit, 2);
  EXPECT_THAT(result.err, AllOf(HasSubstr("E361"), HasSubstr("1 < u")));
  shell.write(
      "floor.sim",
      "param q = 0.7\nx' = 1\ny' = 0\nx(0) = 0; y(0) = 0\nwhen floor(x/q) rises through 1.5 { y := x }\nrun 0..3\n");
  const Result floor = shell.run("sense floor.sim --param q");
  EXPECT_EQ(floor.exit, 3);
  EXPECT_THAT(floor.err, HasSubstr("jumps across its threshold"));
}

// The map's fixed point doubles at 3, its cycle of two at 1 + sqrt(6) (Feigenbaum 1978).
TEST(Orbit, ThroughEventsIsFollowedAlongAParameter) {
  const Shell shell;
  shell.write("map.sim", "param r = 2.8\ny' = 0\ny(0) = 0.3\nevery 1 { y := r*y*(1 - y) }\nrun 0..100\n");
  const Result text = shell.run("orbit map.sim --along r=2..3.5 -o map.csv --plot map.svg");
  EXPECT_EQ(text.exit, 0) << text.err;
  EXPECT_THAT(text.out, AllOf(HasSubstr("r = 3: period doubling, period 1, multipliers -1"),
                              HasSubstr("r = 3.449489743: period doubling, period 2, multipliers -1")));
  EXPECT_THAT(shell.read("map.csv"), HasSubstr("branch,r,period,stable,y min,y max,multiplier 1 re,multiplier 1 im"));
  EXPECT_THAT(shell.read("map.svg"), HasSubstr("<svg"));
  const auto found = nlohmann::json::parse(shell.run("orbit map.sim --along r=2..3.5 --branches 1 --json").out);
  ASSERT_EQ(found["branches"].size(), 2u);
  EXPECT_EQ(found["branches"][0]["bifurcations"][0]["kind"], "period doubling");
  EXPECT_NEAR(found["branches"][0]["bifurcations"][0]["at"].get<double>(), 3, 1e-9);
  const auto refused = [&](const std::string& options, const std::string& reason) {
    const Result result = shell.run("orbit map.sim " + options);
    EXPECT_NE(result.exit, 0) << options;
    EXPECT_THAT(result.err, HasSubstr(reason)) << options;
  };
  refused("--along r=2..3.5 --from-hopf", "--from-hopf follows orbits of autonomous equations without events");
  refused("--along r=2..3.5 --period 1.5", "not a multiple of 1");
  refused("--along r=2..3.5 --period 1e300", "far longer than the run");
  refused("--along q=2..3.5", "there is no parameter `q`");
  refused("--along r=3..2", "is not NAME=LOW..HIGH");
  refused("--along r=3..3.5", "r is 2.8, outside of 3..3.5");
  refused("--turns -1", "--turns");
  refused("--along r=2..3 --branches -1", "--branches");
}

TEST(Explore, SaysWhatIsThereAndWhatIsOpen) {
  const Shell shell;
  const Result lorenz = shell.run("explore " + gallery("lorenz"));
  EXPECT_EQ(lorenz.exit, 0) << lorenz.err;
  EXPECT_THAT(lorenz.out, AllOf(HasSubstr("equilibria  3 from"), HasSubstr("Hopf point at rho = 24.7368"),
                                HasSubstr("the motion is chaotic"), HasSubstr("note        no closed orbit")));
  // The equilibria mirror each other: each bifurcation is listed once, with a state where the parameter is not enough.
  const auto count = [&](std::string_view text) {
    std::size_t found = 0;
    for (std::size_t at = 0; (at = lorenz.out.find(text, at)) != std::string::npos; ++at) ++found;
    return found;
  };
  EXPECT_EQ(count("Hopf point at rho = 24.7368, x = 7.95602, "), 1u) << lorenz.out;
  EXPECT_EQ(count("Hopf point at rho = 24.7368, x = -7.95602, "), 1u);
  EXPECT_EQ(count("pitchfork at rho = 1\n"), 1u);
  EXPECT_EQ(count("Hopf point at sigma = 6.47329, x = 8.48528, "), 1u);
  EXPECT_EQ(count("Hopf point at sigma = 6.47329, x = -8.48528, "), 1u);
  EXPECT_EQ(count("crossing of branches at sigma = 0, x = 0\n"), 1u);
  const Result spring = shell.run("explore " + gallery("mass_spring_damper"));
  EXPECT_THAT(spring.out, AllOf(HasSubstr("later converges to equilibrium 1"), HasSubstr("1 stable: x = 0.5")));
  // Its orbit has the period 2 pi (1 + mu^2/16 + ...), 6.6632868593231 for mu = 1.
  shell.write("vdp.sim", "param mu = 1 in 0.5..2\nx'' = mu*(1 - x^2)*x' - x\nx(0) = 1; x'(0) = 0\nrun 0..20\n");
  const Result orbit = shell.run("explore vdp.sim --json --plot page.svg");
  EXPECT_EQ(orbit.exit, 0) << orbit.err;
  const auto page = nlohmann::json::parse(orbit.out);
  EXPECT_NEAR(page["orbit"]["period"].get<double>(), 6.6632868593231, 1e-8);
  EXPECT_TRUE(page["orbit"]["stable"].get<bool>());
  EXPECT_EQ(page["equilibria"].size(), 1u);
  EXPECT_THAT(shell.read("page.svg"), HasSubstr("<svg"));
}

// The search for an orbit includes the time-dependent force and the events, for as long as the model's run.
TEST(Explore, LooksForNothingWhereItCannotSee) {
  const Shell shell;
  shell.write("forced.sim", "param c = 0.2\nx'' = -x - c*x' + cos(t)\nx(0) = 0; x'(0) = 0\nrun 0..20\n");
  const Result forced = shell.run("explore forced.sim");
  EXPECT_EQ(forced.exit, 0) << forced.err;
  EXPECT_THAT(forced.out,
              AllOf(HasSubstr("no equilibria were searched for"), HasSubstr("orbit       period 6.283185307, stable"),
                    Not(HasSubstr("note        no closed"))));
  shell.write("clock.sim", "x' = 1\nx(0) = 0\nwhen x > 1e-3 { x := 0 }\nrun 0..0.01\n");
  EXPECT_THAT(shell.run("explore clock.sim").out, HasSubstr("orbit       period 0.001,"));
  shell.write("none.sim", "let a = 1\nrun 0..1\n");
  EXPECT_NE(shell.run("explore none.sim").exit, 0);
}

// Implicit Euler's curve is the circle of radius 1 about 1, and its region all that is outside, which has no end.
TEST(Stability, APictureOfRegionsIsAsLargeAsTheirCurves) {
  if (std::system("command -v gnuplot >/dev/null") != 0) GTEST_SKIP() << "gnuplot is not installed";
  const Shell shell;
  ASSERT_EQ(shell.run("stability euler,implicit_euler --plot regions.svg").exit, 0);
  const std::string picture = shell.read("regions.svg");
  EXPECT_THAT(picture, HasSubstr(">2</text>"));
  EXPECT_THAT(picture, Not(HasSubstr(">100</text>")));
  EXPECT_THAT(picture, Not(HasSubstr(">50</text>")));
}

}  // namespace
}  // namespace continuo::app
