// The symplectic compositions: their order conditions, the energy of a planet over a hundred thousand orbits,
// reversibility.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

#include <bench/problems/kepler.hpp>
#include <boost/multiprecision/cpp_bin_float.hpp>
#include <gtest/gtest.h>

#include "dense_order.hpp"
#include "nystrom_trees.hpp"
#include <continuo/methods/symplectic/kahan_li8.hpp>
#include <continuo/methods/symplectic/mclachlan_atela4.hpp>
#include <continuo/methods/symplectic/yoshida6.hpp>
#include <continuo/solve/solve.hpp>

namespace continuo::symplectic_composition_test {
namespace {

using Quad = boost::multiprecision::number<boost::multiprecision::cpp_bin_float_quad::backend_type,
                                           boost::multiprecision::et_off>;
using X = std::array<double, 4>;

/// A planet; one that brakes has a force that reads the velocity.
struct Kepler : bench::Kepler {
  bool brakes = false;
  bool ignores_velocity(const auto&) const { return !brakes; }
};

template <class M>
class Symplectic : public ::testing::Test {};
using Compositions = ::testing::Types<McLachlanAtela4, Yoshida6, KahanLi8>;
TYPED_TEST_SUITE(Symplectic, Compositions);

/// Kicks and drifts as a Runge-Kutta-Nystrom method: the velocity has the increment of kick j from c_j on.
template <class M>
NystromNumbers<Quad> numbers() {
  constexpr std::size_t stages = M::tableau.stages;
  NystromNumbers<Quad> method{std::vector<Quad>(stages), {}, std::vector<Quad>(stages), std::vector<Quad>(stages)};
  for (std::size_t i = 0; i < stages; ++i) {
    method.c[i] = node(M::tableau, i).template as<Quad>();
    method.bv[i] = M::tableau.kick[i].template as<Quad>();
    method.b[i] = method.bv[i] * (1 - method.c[i]);
  }
  for (std::size_t i = 0; i < stages; ++i) {
    method.a.emplace_back(stages, Quad(0));
    for (std::size_t j = 0; j < i; ++j) method.a[i][j] = method.bv[j] * (method.c[i] - method.c[j]);
  }
  return method;
}

// 45 digits are given and 34 calculated with; products of up to eight numbers near 1.
TYPED_TEST(Symplectic, MeetsAllOrderConditionsAndNotTheNext) {
  const auto method = numbers<TypeParam>();
  const auto order = static_cast<std::size_t>(TypeParam::order);
  const auto trees = nystrom_trees(method, order);
  EXPECT_LT(position_defect(trees, method.b, order), Quad(1e-31));
  EXPECT_LT(velocity_defect(trees, method.bv, order), Quad(1e-31));
  EXPECT_GT(velocity_defect(trees, method.bv, order + 1), Quad(1e-6));
}

/// The state after n steps of size h.
template <class M, class S>
S after(const Kepler& planet, S x, Scalar<S> h, int n) {
  S x_new{};
  auto work = M::workspace(x);
  for (int i = 0; i < n; ++i) {
    M::step(planet, h * Scalar<S>(i), x, h, i == 0, work, x_new);
    M::accept(work);
    x = x_new;
  }
  return x;
}

TYPED_TEST(Symplectic, ErrorFallsWithTheOrder) {
  using Real = long double;
  if (std::numeric_limits<Real>::digits < 64) GTEST_SKIP() << "long double is double here";
  const std::array<Real, 4> start{Real(0.8L), 0, 0, std::sqrt(Real(1.5L))};  // e = 0.2, period 2 pi
  const auto error = [&](int n) {
    const auto end = after<TypeParam>(Kepler{}, start, 2 * std::numbers::pi_v<Real> / static_cast<Real>(n), n);
    return std::max(std::abs(end[0] - start[0]), std::abs(end[1] - start[1]));
  };
  EXPECT_NEAR(static_cast<double>(std::log2(error(100) / error(200))), TypeParam::order, 0.1);
}

long double energy(const std::array<double, 4>& x) {
  const long double r = std::hypot(static_cast<long double>(x[0]), static_cast<long double>(x[1]));
  return (static_cast<long double>(x[2]) * x[2] + static_cast<long double>(x[3]) * x[3]) / 2 - 1 / r;
}

/// The greatest error of the energy, and its mean, over the first and the last tenth of a run.
struct Swing {
  double first = 0, last = 0, mean_first = 0, mean_last = 0;
};
template <class M>
Swing swing(int orbits, int steps_an_orbit) {
  const Kepler planet;
  const double h = 2 * std::numbers::pi / steps_an_orbit;
  const long steps = static_cast<long>(orbits) * steps_an_orbit, tenth = steps / 10;
  X x = Kepler::start(), x_new{};
  const long double start = energy(x);
  auto work = M::workspace(x);
  Swing result;
  for (long i = 0; i < steps; ++i) {
    M::step(planet, 0.0, x, h, i == 0, work, x_new);
    M::accept(work);
    x = x_new;
    if (i >= tenth && i < steps - tenth) continue;
    const auto error = static_cast<double>((energy(x) - start) / start);
    double& worst = i < tenth ? result.first : result.last;
    worst = std::max(worst, std::abs(error));
    (i < tenth ? result.mean_first : result.mean_last) += error / static_cast<double>(tenth);
  }
  return result;
}

// Eccentricity 1/2. The energy error oscillates within each orbit, with a constant envelope. Steps fall on different
// places of the ellipse in each orbit, so that the envelope is measured to one per cent.
TEST(SymplecticHuge, EnergyDoesNotDriftInAHundredThousandOrbits) {
  const Swing swung = swing<Yoshida6>(100'000, 60);
  EXPECT_LT(swung.first, 1e-4);
  EXPECT_NEAR(swung.last / swung.first, 1, 0.01);
}
TYPED_TEST(Symplectic, EnergyDoesNotDriftInAThousandOrbits) {
  const Swing swung = swing<TypeParam>(1000, 100);
  EXPECT_LT(swung.first, 1e-5);
  EXPECT_NEAR(swung.last / swung.first, 1, 0.01);
}

// Rounding alone: the energy error of kahan_li8 with 200 steps is 1e-13. With compensated sums only the rounding of the
// accelerations remains, two ulps of kicks h |a| of up to 0.1 in each of 17 stages: a random walk of 1e-17 a step,
// 1e-14 after a million steps. Plain sums would lose an ulp of q and v in each stage, ten times as much.
TEST(Symplectic, RoundingIsNotAddedUp) {
  const Swing swung = swing<KahanLi8>(3000, 200);
  EXPECT_LT(swung.last, 3e-13);
  EXPECT_NEAR(swung.mean_last, swung.mean_first, 1e-14);
}

// Without forces a step is the sum of h drift_i v. The drifts add up to 1 but for the rounding of each, up to 17 of
// them of a size of up to 2: 4e-15 of the distance of 1/3. Without compensation each of a million sums would lose up to
// 1e-16, always about the same, 1e-12 in all.
TYPED_TEST(Symplectic, AFreeBodyKeepsItsWay) {
  auto free = second_order([](double, const auto&) { return std::array{0.0}; });
  constexpr int steps = 100'000;
  std::array<double, 2> x{1, 1.0 / 3}, x_new{};
  auto work = TypeParam::workspace(x);
  for (int i = 0; i < steps; ++i) {
    TypeParam::step(free, 0.0, x, 1.0 / steps, i == 0, work, x_new);
    TypeParam::accept(work);
    x = x_new;
  }
  EXPECT_NEAR(x[0], 4.0 / 3, 2e-15);
}

// Of the symmetric ones: a step of -h undoes a step of h, to rounding, which the compensated sums keep near 1e-16 h a
// stage; along the orbit it grows with the time.
template <class M>
void expect_way_back() {
  const X start = Kepler::start();
  const X there = after<M>(Kepler{}, start, 0.05, 2000);
  const X back = after<M>(Kepler{}, there, -0.05, 2000);
  for (std::size_t i = 0; i < start.size(); ++i) EXPECT_NEAR(back[i], start[i], 1e-11);
}
TEST(Yoshida6, RunsBackTheWayItCame) {
  expect_way_back<Yoshida6>();
}
TEST(KahanLi8, RunsBackTheWayItCame) {
  expect_way_back<KahanLi8>();
}

TYPED_TEST(Symplectic, TheInterpolantHasTheStatedOrder) {
  expect_dense_order_on_oscillator<TypeParam>(0.03125);
}

TYPED_TEST(Symplectic, EvaluatesOnceAStage) {
  const auto solution = solve(Kepler{}, Kepler::start(), {0.0, 1.0}, TypeParam{}, {.step = 0.01});
  const std::size_t stages = TypeParam::tableau.stages - (TypeParam::tableau.ends_with_kick() ? 1 : 0);
  EXPECT_EQ(solution.statistics.evaluations, 100 * stages + (TypeParam::tableau.ends_with_kick() ? 1 : 0));
}

TYPED_TEST(Symplectic, ACopyGoesOnToTheSameBits) {
  Integrator original(Kepler{}, Kepler::start(), {0.0, 50.0}, TypeParam{}, {.step = 0.03});
  for (int i = 0; i < 100; ++i) original.advance();
  Integrator copy = original;
  while (original.advance()) {
  }
  while (copy.advance()) {
  }
  EXPECT_EQ(original.x(), copy.x());
}

TYPED_TEST(Symplectic, AForceThatReadsTheVelocityIsRefusedByName) {
  Kepler damped;
  damped.brakes = true;
  const auto solution = solve(damped, Kepler::start(), {0.0, 1.0}, TypeParam{}, {.step = 0.1});
  EXPECT_EQ(solution.outcome.ending, Ending::invalid_input);
  EXPECT_NE(solution.outcome.hint.find("velocities"), std::string::npos) << solution.outcome.hint;
}

}  // namespace
}  // namespace continuo::symplectic_composition_test
