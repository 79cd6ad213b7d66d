// Interaction with a session: parameters, inputs, methods, the mouse, the text.
#include <filesystem>
#include <fstream>

#include <tests/live/spectator.hpp>

namespace continuo::live {
namespace {

TEST(LiveHands, AParameterCountsFromTheInstantThatIsShown) {
  Stage stage("param k = 1 in 0..5\nx' = k\nx(0) = 0\nrun 0..100\n");  // steps far longer than a picture
  stage.play(1);
  const double t = stage.session->shown_time();
  stage.session->set_parameter("k", 3);
  stage.run(1);
  EXPECT_NEAR(stage.state("x"), t + 3 * (stage.session->shown_time() - t), 1e-9);
  stage.session->undo();
  EXPECT_EQ(stage.audience.said("message").size(), 0U);
  const double x = stage.state("x"), t2 = stage.session->shown_time();
  stage.run(1);
  EXPECT_NEAR(stage.state("x"), x + stage.session->shown_time() - t2, 1e-9);
}

TEST(LiveHands, ASliderIsOneChange) {
  Stage stage("param k = 1\nx' = k\nx(0) = 0\nrun 0..10\n");
  for (int i = 0; i < 30; ++i) {
    stage.session->set_parameter("k", 1 + 0.1 * i);
    stage.run(0.05);
  }
  stage.run(2);
  stage.session->set_parameter("k", 9);
  stage.session->undo();
  stage.run(0.2);
  EXPECT_NEAR(stage.audience.said("state").back()["parameters"]["k"].get<double>(), 3.9, 1e-12);
  stage.session->undo();
  stage.run(0.2);
  EXPECT_EQ(stage.audience.said("state").back()["parameters"]["k"], 1);
  EXPECT_EQ(stage.audience.said("state").back()["undo"], 0);
}

TEST(LiveHands, OtherParametersFollow) {
  Stage stage("param a = 2\nparam b = a*3\nx' = b\nx(0) = 0\nrun 0..10\n");
  stage.session->set_parameter("a", 5);
  stage.run(0.2);
  EXPECT_EQ(stage.audience.said("state").back()["parameters"]["b"], 15);
  stage.session->restore_parameters();
  stage.run(0.2);
  EXPECT_EQ(stage.audience.said("state").back()["parameters"]["b"], 6);
}

TEST(LiveHands, AParameterThatDecidesHowManyEquationsThereAre) {
  Stage stage("param N = 3\nfor i in 1..N { x[i]' = -x[i]; x[i](0) = i }\nrun 0..1\n");
  EXPECT_EQ(stage.session->shown().model().states.size(), 3U);
  stage.session->set_parameter("N", 5);
  EXPECT_EQ(stage.session->shown().model().states.size(), 5U);
  stage.session->undo();
  EXPECT_EQ(stage.session->shown().model().states.size(), 3U);
}

TEST(LiveHands, AKeyDrivesTheCar) {
  Stage stage("car");  // in a run its pedals follow a file; here the user moves them
  stage.play(1);
  EXPECT_NEAR(stage.state("v"), 0, 1e-12);
  stage.session->move_input("throttle", 1);
  stage.run(2);
  EXPECT_NEAR(stage.state("v"), std::sqrt(6000 / 1.5) * std::tanh(2 * std::sqrt(6000 * 1.5) / 1200), 0.1);
  stage.session->move_input("throttle", 7);  // beyond its range
  stage.run(0.2);
  EXPECT_EQ(stage.audience.said("state").back()["inputs"]["throttle"], 1);
}

TEST(LiveHands, TheMethodChangesOnTheWay) {
  Stage stage("x'' = -x\nx(0) = 1;  x'(0) = 0\nenergy all = 1/2*x'^2 + 1/2*x^2\nrun 0..10 tol 1e-9\n");
  stage.play(1);
  stage.session->take_method({.name = "explicit_euler", .step = 0.1});
  stage.run(10);
  EXPECT_GT(stage.shown("energy"), 0.5 * 1.5);  // (1 + h^2)^100 = 2.7
  stage.session->take_method({.name = "rk4"});  // without a step: refused, and the run continues
  EXPECT_EQ(stage.audience.said("message").back()["code"], "E331");
  const double t = stage.session->shown_time();
  stage.run(1);
  EXPECT_NEAR(stage.session->shown_time(), t + 1, 1e-9);
  EXPECT_EQ(stage.audience.said("state").back()["method"], "explicit_euler");
}

TEST(LiveHands, AGhostRunsBeside) {
  Stage stage("x'' = -x\nx(0) = 1;  x'(0) = 0\nrun 0..10 tol 1e-9\n");
  stage.session->take_ghost(MethodChoice{.name = "explicit_euler", .step = 0.05});
  stage.play(3);
  EXPECT_NEAR(stage.state("x"), std::cos(stage.session->shown_time()), 1e-6);
  // Euler's error after t = 3 is about h/2*t = 0.075.
  EXPECT_GT(stage.shown("distance"), 0.01);
  EXPECT_LT(stage.shown("distance"), 0.15);
  EXPECT_TRUE(stage.audience.slices.back()->ghost);
  stage.session->take_ghost(std::nullopt);
  stage.run(0.1);
  EXPECT_FALSE(stage.audience.slices.back()->ghost);
  EXPECT_TRUE(std::isnan(stage.shown("distance")));
}

TEST(LiveDrag, MovesTheMassAndTheEnergyShowsTheWork) {
  Stage stage("spring_pendulum");
  stage.play(1);
  const double before = stage.shown("energy");
  const std::vector<double> to = {1.5, -2};
  stage.session->drag(1, to);
  stage.run(0.5);  // held while time goes on
  EXPECT_NEAR(stage.state("x"), 1.5, 1e-12);
  EXPECT_NEAR(stage.state("y"), -2, 1e-12);
  EXPECT_EQ(stage.state("x'"), 0);
  // 1/2*k*(L - natural)^2 + m*g*y at rest there; the energy of before is that of the start, 0.8 J.
  const double there = 0.5 * 40 * std::pow(std::hypot(1.5, 2) - 1, 2) - 9.81 * 2;
  EXPECT_NEAR(before, 0.8, 1e-5);
  EXPECT_NEAR(stage.shown("energy"), there, 1e-5);
  stage.session->release();
  stage.run(1);
  EXPECT_GT(std::abs(stage.state("x'")), 0.1);
  EXPECT_NEAR(stage.shown("energy"), there, 1e-5);  // without a drag no work is done
}

TEST(LiveDrag, TurnsAPendulum) {
  Stage stage("pendulum");
  const std::vector<double> to = {1.2, -1.6};  // twice too far out, in the direction of atan(3/4)
  stage.session->drag(1, to);
  EXPECT_NEAR(stage.state("theta"), std::atan2(0.6, 0.8), 1e-6);  // the search minimizes the square of the distance
  EXPECT_EQ(stage.state("theta'"), 0);
}

TEST(LiveDrag, AHandDoesNotPushThroughTheFloor) {
  Stage stage("bouncing_ball");
  stage.session->play();
  for (int i = 0; i < 60; ++i) {
    const std::vector<double> to = {0, 3 - 0.1 * i};
    stage.session->drag(1, to);
    stage.run(1.0 / 60);
    EXPECT_GE(stage.state("h"), 0);
  }
  stage.session->release();
  stage.run(2);
  EXPECT_GE(stage.state("h"), -1e-12);
  const std::vector<double> up = {0, 5};
  stage.session->drag(1, up);  // at rest: a drag makes it move again
  stage.session->release();
  stage.run(0.5);
  EXPECT_LT(stage.state("h"), 5 - 9.8 * 0.1);
  EXPECT_GT(stage.state("h"), 1);
}

TEST(LiveDrag, WhatIsNotToBeDraggedIsNot) {
  Stage stage("spring_pendulum");
  const std::vector<double> to = {1, 1};
  stage.session->drag(0, to);
  stage.session->drag(77, to);
  EXPECT_EQ(stage.audience.said("message").size(), 2U);
}

TEST(LiveText, AnotherTextRunsInPlace) {
  Stage stage("x' = 1\nx(0) = 0\nrun 0..3\n");
  stage.play(1);
  const auto run = stage.audience.slices.back()->run;
  stage.session->run_text("y' = 2\ny(0) = 0\nrun 0..3\n");
  stage.run(0.1);
  EXPECT_GT(stage.audience.slices.back()->run, run);
  EXPECT_EQ(stage.session->shown().columns[0].name, "y");
  stage.session->run_text("y' = \n");  // a wrong text: the running model continues
  EXPECT_EQ(stage.audience.said("message").back()["line"], 1);
  EXPECT_EQ(stage.session->shown().columns[0].name, "y");
}

TEST(LiveText, ModelsForTheBoundarySolverAreRefused) {
  Stage stage("x' = 1\nx(0) = 0\nrun 0..3\n");
  stage.session->run_text("y'' = -y\ny(0) = 0;  y(1) = 1\nrun 0..1\n");
  EXPECT_EQ(stage.audience.said("message").back()["code"], "E321");
  stage.run(0.1);
  EXPECT_EQ(stage.session->shown().columns[0].name, "x");
}

TEST(LiveText, IsSavedToItsFileOnly) {
  Stage stage("x' = 1\nx(0) = 0\nrun 0..3\n");
  const std::string name = stage.audience.said("model").back()["path"];
  EXPECT_EQ(name.find('/'), std::string::npos) << "where it lies is nobody's business";
  EXPECT_TRUE(stage.path.ends_with("/" + name));
  stage.session->save_text("x' = 2\nx(0) = 0\nrun 0..3\n");
  std::ifstream file(stage.path);
  std::string line;
  std::getline(file, line);
  EXPECT_EQ(line, "x' = 2");
  EXPECT_EQ(stage.audience.said("saved").size(), 1U);
}

const std::string sliding =
    "param g = 1 in 0..2\ninput push = 0.5 in 0..2\ninput lift = 0 in 0..1 key \"l\"\n"
    "x'' = 0; y'' = push - 0.5 + lift*g\nx(0) = 0; x'(0) = 0; y(0) = 0; y'(0) = 0\n"
    "draw { ball (x, y) radius 0.1 drag }\nrun 0..10\n";

TEST(LiveHands, AThingFliesOnAsFastAsTheHandWent) {
  for (const double speed : {1.0, 0.1}) {  // slow motion: ten times as fast in the time of the model
    Stage stage(sliding);
    stage.session->set_speed(speed);
    stage.session->play();
    for (int i = 1; i <= 20; ++i) {
      stage.session->drag(0, {std::vector<double>{0.05 * i, 0}});
      stage.run(1.0 / 60);
    }
    EXPECT_EQ(stage.state("x'"), 0);
    stage.session->release();
    stage.run(0.1);
    EXPECT_NEAR(stage.state("x'"), 0.05 * 60 / speed, 1e-6 / speed);
  }
}

TEST(LiveHands, InputsAreUndoneAndRestored) {
  Stage stage(sliding);
  const auto input = [&](const char* name) {
    return nlohmann::json::parse(stage.session->state_json())["inputs"][name].get<double>();
  };
  const auto wait = [&] { stage.wall += 2; };  // two changes, not one continuous movement of a slider
  stage.session->move_input("push", 1);
  wait();
  stage.session->move_input("push", 1.5);
  wait();
  for (const double down : {1.0, 0.0, 1.0, 0.0, 1.0}) stage.session->move_input("lift", down), wait();
  stage.session->set_parameter("g", 2);
  stage.session->undo();
  EXPECT_EQ(input("lift"), 1);
  stage.session->undo();  // all that a key did is one change
  EXPECT_EQ(input("lift"), 0);
  EXPECT_EQ(input("push"), 1.5);
  stage.session->undo();
  EXPECT_EQ(input("push"), 1);
  stage.session->restore_parameters();
  EXPECT_EQ(input("push"), 0.5);
  stage.session->undo();
  EXPECT_EQ(input("push"), 1);
  const auto model = nlohmann::json::parse(stage.session->model_json());
  EXPECT_EQ(model["inputs"][0]["value"], 1);
  EXPECT_EQ(model["inputs"][0]["file"], 0.5);
}

TEST(LiveHands, AParameterKnowsItsValueInTheFile) {
  Stage stage(sliding);
  stage.session->set_parameter("g", 1.5);
  stage.session->reset();
  const auto parameter = stage.audience.said("model").back()["parameters"][0];
  EXPECT_EQ(parameter["value"], 1.5);
  EXPECT_EQ(parameter["file"], 1);
}

/// An input that follows a file in steps, beside a slider.
TEST(LiveHands, AnInputKeepsToItsFileWhileASliderMoves) {
  const auto csv = std::filesystem::path(::testing::TempDir()) / "live_steps.csv";
  std::ofstream(csv) << "t,u\n0,1\n1,5\n9,5\n";
  Stage stage("param k = 1 in 0..2\ninput u = 0 in 0..9 from \"" + csv.string() +
              "\" step\nx' = u\nx(0) = 0\nrun 0..10\n");
  stage.play(2);
  const double before = stage.state("x"), t = stage.session->shown_time();
  stage.session->set_parameter("k", 2);
  stage.run(1);
  EXPECT_NEAR(stage.state("x"), before + 5 * (stage.session->shown_time() - t), 1e-9);
  stage.session->move_input("u", 2);
  stage.run(0.5);
  const double moved = stage.state("x"), then = stage.session->shown_time();
  stage.session->undo();  // the file's again
  stage.run(1);
  EXPECT_NEAR(stage.state("x"), moved + 5 * (stage.session->shown_time() - then), 1e-9);
}

/// Where nobody can press the key, as in a film of a run, the input follows its file.
TEST(LiveHands, AnInputWithAKeyFollowsItsFileWhereKeysRest) {
  const auto csv = std::filesystem::path(::testing::TempDir()) / "live_keys.csv";
  std::ofstream(csv) << "t,u\n0,1\n1,5\n9,5\n";
  const std::string text =
      "input u = 0 in 0..9 key \"w\" from \"" + csv.string() + "\" step\nx' = u\nx(0) = 0\nrun 0..10\n";
  for (const Keys keys : {Keys::are_pressed, Keys::rest}) {
    Stage stage(text, keys);
    stage.play(2);
    const double t = stage.session->shown_time();
    ASSERT_GT(t, 1);
    EXPECT_NEAR(stage.state("x"), keys == Keys::rest ? 1 + 5 * (t - 1) : 0, 1e-9);
    stage.session->move_input("u", 2);  // a hand takes it all the same
    stage.run(0.5);
    const double moved = stage.session->shown_time() - t;
    EXPECT_NEAR(stage.state("x"), (keys == Keys::rest ? 1 + 5 * (t - 1) : 0) + 2 * moved, 1e-9);
  }
}

}  // namespace
}  // namespace continuo::live
