// Steps that take long: given up for a command, and begun again. What a client sees of it is in client_test.py.
#include <cmath>
#include <string>

#include <tests/live/spectator.hpp>

namespace continuo::live {
namespace {

/// Each state depends on all others, through their sum: the Jacobian is full.
std::string coupled(int n) {
  const std::string count = std::to_string(n);
  return "param N = " + count +
         ", k = 1 in 0..2\nfor i in 1..N {\n  u[i]' = -k*u[i] + 0.5*sin(u[i])*sum(j in 1..N: u[j])/N\n" +
         "  u[i](0) = 1 + i/N\n}\nrun 0..100 method radau tol 1e-9\n";
}

TEST(LiveHeavy, AnInterruptedStepChangesNothing) {
  Stage stage(coupled(80)), other(coupled(80));
  stage.session->interrupt();
  stage.session->play();
  stage.run(0.2);
  EXPECT_EQ(stage.session->shown_time(), 0);
  EXPECT_FALSE(stage.session->has_ended());
  stage.session->forget_interrupt();
  for (int k = 0; k < 20; ++k) {
    stage.session->interrupt();
    stage.session->step();
    stage.session->forget_interrupt();
    stage.session->step();
  }
  EXPECT_GT(stage.session->shown_time(), 0);
  EXPECT_FALSE(stage.session->has_ended());
  // The same motion as one that nobody interrupts: both are within the tolerance of the run.
  const model::Instant end = stage.session->history().back().main;
  other.cost = 1e-3;  // of a look at the clock: a turn ends
  other.session->set_speed(0);
  other.session->play();
  while (other.session->history().last_time() < end.t) other.session->turn();
  const History& undisturbed = other.session->history();
  const std::size_t k = undisturbed.index_at(end.t);
  ASSERT_LT(k + 1, undisturbed.size());
  const auto &before = undisturbed[k].main, &after = undisturbed[k + 1].main;
  ASSERT_LE(before.t, end.t);
  for (std::size_t i = 0; i < end.x.size(); ++i) {
    const double least = std::min(before.x[i], after.x[i]), most = std::max(before.x[i], after.x[i]);
    EXPECT_GE(end.x[i], least - 1e-6) << i;
    EXPECT_LE(end.x[i], most + 1e-6) << i;
  }
}

// Ten pictures a second, of which each look at the clock takes a third: the second turn knows that steps take long.
TEST(LiveHeavy, AChangeIsAnsweredBeforeTheNextStep) {
  Stage stage(coupled(70));
  stage.cost = 0.03;
  stage.session->set_rate(10);
  stage.session->set_speed(0);
  stage.session->play();
  stage.session->turn();
  const double before = stage.session->history().last_time();
  stage.session->set_parameter("k", 1.25);
  stage.audience.texts.clear();
  stage.session->turn();
  ASSERT_GT(stage.session->history().last_time(), before) << "a step was made";
  const auto states = stage.audience.said("state");
  ASSERT_FALSE(states.empty());
  EXPECT_EQ(states.front()["parameters"]["k"], 1.25);
  EXPECT_EQ(states.front()["history"][1], before);
  stage.session->pause();
  stage.session->turn();
  const double paused = stage.session->history().last_time();
  stage.session->play();
  stage.audience.texts.clear();
  stage.session->turn();
  EXPECT_EQ(stage.audience.said("state").at(0)["playing"], true);
  EXPECT_EQ(stage.audience.said("state").at(0)["history"][1], paused);
}

}  // namespace
}  // namespace continuo::live
