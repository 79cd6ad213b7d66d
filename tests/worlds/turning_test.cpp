// Orientations and rotation of bodies, and walls with two sides, in the language.
#include <cmath>
#include <numbers>

#include <tests/worlds/scene.hpp>

namespace continuo::worlds::turning_test {
namespace {

// A disc of radius 1 m and mass 2 kg has 1 kg m^2: on a torsion spring of 4 N m it swings with omega = 2 /s. The fast
// mode is of order 2 here: (omega h)^2/24 a radian of phase, over 6 radians.
const std::string torsion = R"(
param c = 400 [N cm]
world {
  body disc at (0, 0) [m] radius 1 mass 2 angle 90 [deg] spin 0 MODE
}
torque on disc = -c*disc.angle
energy torsion = c/2*disc.angle^2
output top = disc.y + disc.radius*cos(disc.angle)
run 0..3 [s]
check disc.angle(3) = pi/2*cos(6) within TOLERANCE
check disc.angle'(3) = -pi*sin(6) [1/s] within TOLERANCE
check top at 3 = cos(pi/2*cos(6)) [m] within TOLERANCE
check energy drift < TOLERANCE
)";

std::string with(std::string text, const std::string& mode, const std::string& tolerance) {
  text.replace(text.find("MODE"), 4, mode);
  for (std::size_t at = text.find("TOLERANCE"); at != text.npos; at = text.find("TOLERANCE"))
    text.replace(at, 9, tolerance);
  return text;
}

TEST(Turning, TorquesTurnDiscs) {
  EXPECT_EQ(failed_checks(run_of(with(torsion, "", "1e-8"))), "");  // a tolerance of 1e-10, some twenty steps
  EXPECT_EQ(
      failed_checks(run_of(with(torsion, "; mode fast step 0.001 substeps 1 integrator central_difference", "1e-5"))),
      "");
}

// A torque (W x L) makes the spin of a ball precess about W; the state of an equation with a constant rate is the
// angle. The height of the painted pole, the z axis of the ball, is 1 - 2 (q_x^2 + q_y^2).
TEST(Turning, TorquesAndEquationsMoveTogetherInSpace) {
  const model::Run run = run_of(R"(
param W = 1.5
world {
  dimension 3
  body ball at (0, 0, 0) radius 1 mass 2.5 angle (0, pi/2, 0) spin (2, 0, 0)   # J = 1
}
phase' = W
phase(0) = 0
torque on ball = (-2*W*sin(phase), 2*W*cos(phase), 0)
output pole = 1 - 2*(ball.q_x^2 + ball.q_y^2)
run 0..2
check ball.spin_x(2) = 2*cos(3) within 1e-8
check ball.spin_y(2) = 2*sin(3) within 1e-8
check ball.q_w(0) = sqrt(1/2) within 1e-15
check ball.q_y(0) = sqrt(1/2) within 1e-15
check pole at 0 = 0 within 1e-15
check always abs(ball.q_w^2 + ball.q_x^2 + ball.q_y^2 + ball.q_z^2 - 1) < 1e-9
)");
  EXPECT_EQ(failed_checks(run), "");
}

TEST(Turning, OrientationsAreReadInForcesAndEvents) {
  const model::Run run = run_of(R"(
param thrust = 3
world {
  body rocket at (0, 0) mass 1 angle pi/2 spin -pi/2
  dimension 2
}
force on rocket = (thrust*cos(rocket.angle), thrust*sin(rocket.angle))
when rocket.angle falls through 0 { mark "level" }
run 0..1
check rocket.x'(1) = 3*2/pi within 1e-9          # the integral of 3 sin(pi t/2)
check rocket.y'(1) = 3*2/pi within 1e-9
)");
  EXPECT_EQ(failed_checks(run), "");
}

TEST(Turning, PatternsTurnToo) {
  const model::Run run = run_of(R"(
world {
  dimension 3
  bodies wheel grid 2 from (0, 0, 0) spacing (3, 0, 0) angle (0, 0, 90 [deg]) spin (0, 0, pi/2)
}
run 0..1
check wheel[2].q_z(1) = 1 within 1e-14        # a half turn about z
check wheel[1].q_w(1) = 0 within 1e-14
)");
  EXPECT_EQ(failed_checks(run), "");
}

TEST(Turning, ThinWallsHaveTwoSides) {
  const std::string text = R"(
world {
  wall screen (1, 0) at 0 [m] THIN
  material restitution 1 friction 0
  body left at (-3, 0) [m] velocity (1, 0)
  body right at (3, 2) [m] velocity (-1, 0)
}
run 0..5 [s]
)";
  std::string thin = text, thick = text;
  thin.replace(thin.find("THIN"), 4, "thin");
  thick.replace(thick.find("THIN"), 4, "");
  for (const std::string method : {"exact", "fast"}) {
    const model::Run run = run_of(thin, {.method = method, .step = 0.01});
    EXPECT_NEAR(last(run, "left.x"), -3, 1e-9) << method;  // 2.5 there, 2.5 back
    EXPECT_NEAR(last(run, "right.x"), 3, 1e-9) << method;
  }
  EXPECT_GT(last(run_of(thick), "left.x"), 0);  // it started inside of the wall, and left it
}

}  // namespace
}  // namespace continuo::worlds::turning_test
