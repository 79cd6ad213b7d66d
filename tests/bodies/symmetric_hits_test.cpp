// Hits at one instant: what is mirror-symmetric stays so, in any order of the bodies, and momentum is kept, with all
// energy where restitution is 1 and nothing rubs.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <numeric>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include <continuo/bodies/exact_motion.hpp>
#include <continuo/bodies/fast_motion.hpp>

namespace continuo::symmetric_hits_test {
namespace {

/// Balls of radius 0.5, each with its mirror image in the plane across the last axis through the origin.
template <int Dim>
struct Scene {
  using V = Vector<double, Dim>;
  struct Ball {
    V x{}, v{};
    std::size_t mirror = 0;
    double radius = 0.5, mass = 1;
  };
  std::vector<Ball> balls;

  /// A ball in the mirror.
  void add(const V& x, const V& v = {}, double mass = 1) { balls.push_back({x, v, balls.size(), 0.5, mass}); }
  /// A ball, and its image.
  void add_two(const V& x, const V& v = {}, double mass = 1) {
    V image = x, velocity = v;
    image[Dim - 1] = -image[Dim - 1], velocity[Dim - 1] = -velocity[Dim - 1];
    balls.push_back({x, v, balls.size() + 1, 0.5, mass});
    balls.push_back({image, velocity, balls.size() - 1, 0.5, mass});
  }
};
template <int Dim>
Vector<double, Dim> at(double x, double across) {
  Vector<double, Dim> v{};
  v[0] = x, v[Dim - 1] = across;
  return v;
}

/// Rows of touching balls, with one more ball than the one before, hit at the top.
template <int Dim>
Scene<Dim> rack(int rows) {
  Scene<Dim> scene;
  scene.add(at<Dim>(-2.03, 0), at<Dim>(3, 0));
  for (int row = 0; row < rows; ++row)
    for (int k = row % 2; k <= row; k += 2) {
      const auto place = at<Dim>(row * std::sqrt(3.0) / 2, k / 2.0);
      k == 0 ? scene.add(place) : scene.add_two(place);
    }
  return scene;
}
/// A ball that hits two, of another mass, which touch.
template <int Dim>
Scene<Dim> two(double mass) {
  Scene<Dim> scene;
  scene.add(at<Dim>(-2.03, 0), at<Dim>(3, 0));
  scene.add_two(at<Dim>(0, 0.5), {}, mass);
  return scene;
}
/// A ball between two that hit it from both sides, and a row of balls that is hit at both ends.
template <int Dim>
Scene<Dim> row(int half, double mass) {
  Scene<Dim> scene;
  scene.add({});
  for (int k = 1; k <= half; ++k) scene.add_two(at<Dim>(0, k), {}, k % 2 == 0 ? 1 : mass);
  scene.add_two(at<Dim>(0, half + 2.03), at<Dim>(0, -3));
  return scene;
}
/// A pyramid in space: a ball on four that touch, and one that comes from above.
Scene<3> pyramid() {
  Scene<3> scene;
  scene.add({{-2.03, 0, 0}}, {{3, 0, 0}});
  for (const double y : {-0.5, 0.5}) scene.add_two({{std::sqrt(0.5), y, 0.5}});
  scene.add({{0, 0, 0}});
  return scene;
}

/// The greatest difference of a velocity from that of the mirror image after a motion; the balls are in the order of a
/// seed, in a world that is turned by an angle.
template <class Motion, int Dim>
class MirroredRun {
 public:
  using V = Vector<double, Dim>;

  MirroredRun(const Scene<Dim>& scene, unsigned seed, double angle, const Material<double>& material,
              const V& gravity = {})
      : scene_(scene), angle_(angle), number_(scene.balls.size()) {
    std::vector<std::size_t> order(scene.balls.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::mt19937 engine(seed);
    for (std::size_t k = order.size(); k > 1; --k) std::swap(order[k - 1], order[engine() % k]);
    world.gravity = turned(gravity, angle_);
    for (std::size_t k = 0; k < order.size(); ++k) {
      const auto& ball = scene.balls[order[k]];
      number_[order[k]] = k;
      EXPECT_TRUE(world.add({.shape = Sphere<double>{ball.radius},
                             .position = turned(ball.x, angle_),
                             .velocity = turned(ball.v, angle_),
                             .mass = ball.mass,
                             .material = material}));
    }
    momentum_before_ = momentum(), energy_before_ = kinetic_energy(world);
  }
  void move(double t) {
    Motion motion(world);
    const Status status = motion.advance_to(t);
    ASSERT_TRUE(status) << describe(status);
  }
  [[nodiscard]] double asymmetry() const {
    double most = 0;
    for (std::size_t k = 0; k < scene_.balls.size(); ++k) {
      const V v = turned(world.velocity[number_[k]], -angle_);
      V image = turned(world.velocity[number_[scene_.balls[k].mirror]], -angle_);
      image[Dim - 1] = -image[Dim - 1];
      most = std::max(most, length(V(v - image)));
    }
    return most;
  }
  [[nodiscard]] double change_of_momentum() const { return length(V(momentum() - momentum_before_)); }
  [[nodiscard]] double gain() const { return kinetic_energy(world) / energy_before_ - 1; }

  World<double, Dim> world;

 private:
  /// Turned in the plane of the first and the last axis.
  static V turned(V v, double angle) {
    const double x = v[0], y = v[Dim - 1];
    v[0] = std::cos(angle) * x - std::sin(angle) * y, v[Dim - 1] = std::sin(angle) * x + std::cos(angle) * y;
    return v;
  }
  [[nodiscard]] V momentum() const {
    V sum{};
    for (std::size_t k = 0; k < world.size(); ++k) sum += world.velocity[k] * world.mass[k];
    return sum;
  }
  const Scene<Dim>& scene_;
  double angle_;
  std::vector<std::size_t> number_;
  V momentum_before_{};
  double energy_before_ = 0;
};

constexpr double rounding = 2e-12;

template <class Motion, int Dim>
void expect_symmetry(const Scene<Dim>& scene, const Material<double>& material) {
  for (unsigned seed = 0; seed < 5; ++seed)
    for (const double angle : {0.0, 0.7}) {
      MirroredRun<Motion, Dim> run(scene, seed, angle, material);
      run.move(1.2);
      const auto said = [&] {
        return ::testing::Message() << scene.balls.size() << " balls, seed " << seed << ", angle " << angle << ", e "
                                    << material.restitution << ", friction " << material.friction;
      };
      EXPECT_LE(run.asymmetry(), rounding) << said();
      EXPECT_LE(run.change_of_momentum(), rounding) << said();
      EXPECT_LE(run.gain(), rounding) << said();
      if (material.restitution == 1 && material.friction == 0) {
        EXPECT_GE(run.gain(), -rounding) << said();
      }
    }
}
template <class Motion, int Dim>
void expect_symmetric_hits(const Material<double>& material) {
  for (const int rows : {2, 3, 4, 5}) expect_symmetry<Motion, Dim>(rack<Dim>(rows), material);
  for (const double mass : {1.0, 0.3, 7.0}) {
    expect_symmetry<Motion, Dim>(two<Dim>(mass), material);
    for (const int half : {0, 1, 2, 4}) expect_symmetry<Motion, Dim>(row<Dim>(half, mass), material);
  }
}
TEST(SymmetricHits, StaySymmetricInTheExactMotion) {
  for (const double restitution : {0.0, 0.5, 1.0})
    for (const double friction : {0.0, 0.3}) {
      const Material<double> material{.restitution = restitution, .friction = friction};
      expect_symmetric_hits<ExactMotion<double, 2>, 2>(material);
      expect_symmetric_hits<ExactMotion<double, 3>, 3>(material);
      expect_symmetry<ExactMotion<double, 3>, 3>(pyramid(), material);
    }
}
/// Where balls bounce: contacts without restitution are soft.
TEST(SymmetricHits, StaySymmetricInTheFastMotion) {
  for (const double restitution : {0.5, 1.0})
    for (const double friction : {0.0, 0.3}) {
      const Material<double> material{.restitution = restitution, .friction = friction};
      expect_symmetric_hits<FastMotion<double, 2>, 2>(material);
      expect_symmetric_hits<FastMotion<double, 3>, 3>(material);
      expect_symmetry<FastMotion<double, 3>, 3>(pyramid(), material);
    }
}

/// The closed form. A ball of mass 1 with speed v hits two of mass m at angles of 30 degrees: along each line of
/// centres it parts with e times the approach v cos 30. With u of both along their lines and w of the ball,
/// w = v - 2 m u cos 30 and u - w cos 30 = e v cos 30.
TEST(SymmetricHits, OfTwoBallsHaveTheirClosedForm) {
  for (const double mass : {0.3, 1.0, 7.0})
    for (const double e : {0.3, 0.5, 1.0}) {
      const Scene<2> scene = two<2>(mass);
      MirroredRun<ExactMotion<double, 2>, 2> run(scene, 1, 0, {.restitution = e, .friction = 0});
      run.move(1);
      const double c = std::sqrt(0.75), u = 3 * (1 + e) * c / (1 + 2 * mass * c * c), w = 3 - 2 * mass * u * c;
      std::vector<double> speeds, expected{u, u, std::abs(w)};
      for (const auto& v : run.world.velocity) speeds.push_back(length(v));
      std::ranges::sort(speeds), std::ranges::sort(expected);
      for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(speeds[k], expected[k], 1e-13) << mass << ' ' << e;
    }
}

/// A row of balls passes the momentum on, as if they were a hair apart: the last one leaves with all of it, though the
/// ball at the other end comes at the same instant.
TEST(SymmetricHits, BothEndsOfARowPassThrough) {
  for (const int half : {1, 2, 5}) {
    const Scene<2> scene = row<2>(half, 1);
    MirroredRun<ExactMotion<double, 2>, 2> run(scene, 3, 0.3, {.restitution = 1, .friction = 0});
    run.move(1.2);
    std::vector<double> speeds;
    for (const auto& v : run.world.velocity) speeds.push_back(length(v));
    std::ranges::sort(speeds);
    for (std::size_t k = 0; k + 2 < speeds.size(); ++k) EXPECT_NEAR(speeds[k], 0, 1e-13);
    EXPECT_NEAR(speeds[speeds.size() - 2], 3, 1e-13);
    EXPECT_NEAR(speeds.back(), 3, 1e-13);
  }
}

}  // namespace
}  // namespace continuo::symmetric_hits_test
