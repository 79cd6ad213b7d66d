// Integrator::at within the last step, after the events at its end have changed the state: the motion before them.
#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include <continuo/methods/automatic.hpp>
#include <continuo/methods/collocation/radau.hpp>
#include <continuo/methods/explicit_rk/dop853.hpp>
#include <continuo/methods/explicit_rk/tsitouras5.hpp>
#include <continuo/methods/multistep/bdf.hpp>
#include <continuo/methods/rosenbrock/rodas5p.hpp>
#include <continuo/solve/solve.hpp>

namespace continuo {
namespace {

using Height = std::vector<double>;  // and speed

// Thrown up at 3 m/s. Every method follows a parabola to rounding, on its polynomials too.
struct Throw {
  void operator()(double, const std::vector<double>& x, std::vector<double>& dxdt) const {
    dxdt[0] = x[1];
    dxdt[1] = -gravity;
  }
  double gravity = 9.8;
};

template <class M>
class BetweenEvents : public testing::Test {
 protected:
  using Run = Integrator<Throw, Height, M>;

  /// The greatest deviation from the parabola through `start`, over the stretch from there to the present time.
  double deviation(Run& run, double from, const Height& start) const {
    double worst = 0;
    Height x = start;
    for (int i = 1; i < 10; ++i) {
      const double s = (run.t() - from) * i / 10;
      run.at(from + s, x);
      worst = std::max({worst, std::abs(x[0] - (start[0] + start[1] * s - gravity_ * s * s / 2)),
                        std::abs(x[1] - (start[1] - gravity_ * s))});
    }
    return worst;
  }

  /// Advances the run to its end, and holds each stretch against its parabola.
  void follow(Run& run) const {
    Height start = run.x();
    double from = run.t();
    for (bool more = true; more;) {
      more = run.advance();
      ASSERT_LT(deviation(run, from, start), 1e-7) << "from " << from << " to " << run.t();
      from = run.t();
      start = run.x();
    }
  }

  double gravity_ = 9.8;
};

using MethodsOfRuns = testing::Types<Dop853, Tsitouras5, Radau, Bdf, Rodas5P, Tsitouras5Rodas5P, Dop853Radau>;
TYPED_TEST_SUITE(BetweenEvents, MethodsOfRuns);

TYPED_TEST(BetweenEvents, AGuardHasFired) {
  const auto floor = falls<Height>(
      "floor", [](double, const Height& x) { return x[0]; }, [](auto& now) { now.x[1] = -0.9 * now.before[1]; });
  typename TestFixture::Run run(Throw{}, Height{1, 3}, {0, 5}, TypeParam{}, {.rtol = 1e-9, .events = {floor}});
  this->follow(run);
  EXPECT_GT(run.statistics().events, 3u);
}

TYPED_TEST(BetweenEvents, ATimeHasCome) {
  const Event<Height> kick{.name = "kick", .action = [](auto& now) { now.x[1] += 5; }, .times = {0.7, 1.9, 2}};
  typename TestFixture::Run run(Throw{}, Height{1, 3}, {0, 3}, TypeParam{}, {.rtol = 1e-9, .events = {kick}});
  this->follow(run);
  EXPECT_EQ(run.statistics().events, 3u);
}

TYPED_TEST(BetweenEvents, TheUserHasChangedStateOrSystem) {
  for (const bool changes_system : {false, true}) {
    typename TestFixture::Run run(Throw{}, Height{1, 3}, {0, 5}, TypeParam{}, {.rtol = 1e-9, .max_step = 0.5});
    Height start{1, 3};
    double from = 0;
    for (int i = 0; i < 3; ++i) {
      from = run.t();
      start = run.x();
      ASSERT_TRUE(run.advance());
    }
    if (changes_system) {
      run.change_system([](Throw& f) { f.gravity = 1.6; });
    } else {
      run.set_state({20, -7});
    }
    EXPECT_LT(this->deviation(run, from, start), 1e-7);
  }
}

}  // namespace
}  // namespace continuo
