// A run has the same bits whatever the number of lanes and of threads, the order of the starts and the other runs; and
// those of solve where f has no elementary functions.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <functional>
#include <numeric>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <oneapi/tbb/global_control.h>
#include <tests/ensembles/same_runs.hpp>

#include <continuo/ensembles/ensemble.hpp>
#include <continuo/methods/explicit_rk/bogacki_shampine3.hpp>
#include <continuo/methods/explicit_rk/dop853.hpp>
#include <continuo/methods/explicit_rk/dormand_prince5.hpp>
#include <continuo/methods/explicit_rk/rk4.hpp>
#include <continuo/methods/explicit_rk/tsitouras5.hpp>
#include <continuo/methods/explicit_rk/verner7.hpp>
#include <continuo/solve/integrator.hpp>
#include <continuo/solve/solve.hpp>

namespace continuo::ensembles_test {
namespace {

using X = std::array<double, 2>;
using P = std::array<double, 3>;
using List = std::vector<RunStart<X, P>>;
using Result = Ensemble<X, P>;

// A driven pendulum with damping: elementary functions, and a right-hand side that depends on time.
const auto pendulum = [](const auto& t, const auto& x, auto& dxdt, const auto& p) {
  using std::exp, std::sin;
  dxdt[0] = x[1];
  dxdt[1] = -p[0] * sin(x[0]) - p[1] * x[1] + exp(-0.1 * t) * p[2];
};
// Predator and prey: only sums and products.
const auto predators = [](const auto&, const auto& x, auto& dxdt, const auto& p) {
  dxdt[0] = x[0] * (p[0] - p[1] * x[1]);
  dxdt[1] = x[1] * (x[0] - p[2]);
};

List random_starts(std::size_t count, unsigned seed) {
  std::mt19937_64 generator(seed);
  std::uniform_real_distribution<double> number(0.5, 2);
  List list(count);
  for (auto& start : list) {
    for (double& x : start.x) x = number(generator);
    for (double& p : start.p) p = number(generator);
  }
  return list;
}

const auto turn = rises("turn", [](const auto&, const auto& x) { return x[1] - 1.0; });
// Takes effect in its own run alone, as a mode would.
const auto stop_of_prey = falls(
    "stop of prey", [](const auto&, const auto& x, const auto& p) { return x[0] - 0.5 * p[2]; },
    [](auto& now, auto& p) {
      now.x[1] *= 0.5;
      p[0] += 0.125;
    });

template <std::size_t W, class M, class F, class... Events>
Result run(const F& f, const List& list, int threads, const Events&... events) {
  return ensemble<W>(f, list, {0, 6}, M{}, {.rtol = 1e-7, .save_at = {0, 0.7, 3.1, 3.2, 6}, .threads = threads},
                     events...);
}

template <class M>
class EnsembleOf : public ::testing::Test {};
using Methods = ::testing::Types<Tsitouras5, Dop853>;
TYPED_TEST_SUITE(EnsembleOf, Methods, );

TYPED_TEST(EnsembleOf, ARunHasTheSameBitsWhateverTheLanesTheThreadsAndTheOrder) {
  const tbb::global_control allowed(tbb::global_control::max_allowed_parallelism, 4);
  List list = random_starts(37, 5);
  const Result alone = run<1, TypeParam>(pendulum, list, 1, turn);
  ASSERT_EQ(alone.failures(), 0U);
  const auto compare = [&](const Result& other) {
    ASSERT_EQ(other.runs.size(), list.size());
    for (std::size_t i = 0; i < list.size(); ++i) expect_same(alone.runs[i], other.runs[i]);
  };
  compare(run<2, TypeParam>(pendulum, list, 2, turn));
  compare(run<3, TypeParam>(pendulum, list, 3, turn));
  compare(run<8, TypeParam>(pendulum, list, 1, turn));
  compare(run<8, TypeParam>(pendulum, list, 2, turn));

  std::vector<std::size_t> order(list.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::shuffle(order.begin(), order.end(), std::mt19937_64(9));
  List shuffled;
  for (const std::size_t i : order) shuffled.push_back(list[i]);
  const Result other = run<8, TypeParam>(pendulum, shuffled, 2, turn);
  for (std::size_t i = 0; i < order.size(); ++i) expect_same(alone.runs[order[i]], other.runs[i]);
}

TYPED_TEST(EnsembleOf, TheOtherRunsDoNotMatter) {
  List list = random_starts(20, 6);
  const Result all = run<4, TypeParam>(predators, list, 1, stop_of_prey);
  for (const std::size_t i : {std::size_t{0}, std::size_t{7}, std::size_t{19}})
    expect_same(all.runs[i], run<16, TypeParam>(predators, List{list[i]}, 1, stop_of_prey).runs[0]);
  list[3].x[0] = NAN;  // in a lane between others
  list[8].p[1] = NAN;
  const Result spoiled = run<4, TypeParam>(predators, list, 1, stop_of_prey);
  for (std::size_t i = 0; i < list.size(); ++i)
    if (i != 3 && i != 8) expect_same(all.runs[i], spoiled.runs[i]);
  EXPECT_EQ(spoiled.runs[3].outcome.ending, Ending::invalid_input);
  EXPECT_EQ(spoiled.runs[8].outcome.ending, Ending::not_finite);
  EXPECT_EQ(spoiled.failures(), 2U);
}

#ifndef __FMA__  // with fused operations the compiler rounds one number and lanes of numbers in different places

template <class M>
class EnsembleAndSolve : public ::testing::Test {};
using AllMethods = ::testing::Types<BogackiShampine3, DormandPrince5, Tsitouras5, Dop853, Verner7>;
TYPED_TEST_SUITE(EnsembleAndSolve, AllMethods, );

TYPED_TEST(EnsembleAndSolve, HaveTheSameBits) {
  const List list = random_starts(9, 7);
  const auto kick = every("kick", 1.25, 0.5, [](auto& now) { now.x[0] += 0.25; });
  const Result result = run<4, TypeParam>(predators, list, 1, turn, stop_of_prey, kick);
  for (std::size_t i = 0; i < list.size(); ++i) {
    P p = list[i].p;
    const auto f = [&p](double t, const X& x, X& dxdt) { predators(t, x, dxdt, p); };
    const auto guard = [&p](double t, const X& x) { return stop_of_prey.guard(t, x, p); };
    const auto action = [&p](EventAction<X>& now) {
      stop_of_prey.action(now, p);
      now.restart = true;
    };
    const auto solution = solve(f, list[i].x, {0, 6}, TypeParam{},
                                {.rtol = 1e-7,
                                 .events = {turn, falls<X>("stop", guard, action), kick},
                                 .save = Save<X>::at({0, 0.7, 3.1, 3.2, 6})});
    RunResult<X, P> expected{i,
                             solution.outcome,
                             solution.final_state(),
                             p,
                             solution.statistics.steps,
                             solution.statistics.rejected,
                             solution.events,
                             solution.x};
    ASSERT_TRUE(solution.outcome);
    ASSERT_GE(solution.events.size(), 5U);
    expect_same(result.runs[i], expected);
  }
}

TEST(EnsembleAndSolve, HaveTheSameBitsWithFixedStepsAndForVectors) {
  const List list = random_starts(7, 8);
  const auto fixed = ensemble<3>(predators, list, {2, -1.03}, Rk4{}, {.step = 0.0625});
  std::vector<RunStart<std::vector<double>, std::vector<double>>> vectors;
  for (const auto& start : list)
    vectors.push_back({{start.x.begin(), start.x.end()}, {start.p.begin(), start.p.end()}});
  const auto of_vectors = ensemble<2>(predators, vectors, {0, 5}, Dop853{}, {.rtol = 1e-9});
  for (std::size_t i = 0; i < list.size(); ++i) {
    const P& p = list[i].p;
    const auto f = [&p](double t, const auto& x, auto& dxdt) { predators(t, x, dxdt, p); };
    EXPECT_EQ(solve(f, list[i].x, {2, -1.03}, Rk4{}, {.step = 0.0625}).final_state(), fixed.runs[i].x);
    EXPECT_EQ(solve(f, vectors[i].x, {0, 5}, Dop853{}, {.rtol = 1e-9}).final_state(), of_vectors.runs[i].x);
  }
}

template <class M>
void expect_the_bits_of_fixed_steps(const List& list) {
  // x0 escapes to infinity in the runs with a large p0, and x1 follows it there.
  const auto escaping = [](const auto& t, const auto& x, auto& dxdt, const auto& p) {
    dxdt[0] = (p[0] - 1.25) * x[0] * x[0] - 0.1 * p[1] * t;
    dxdt[1] = x[0] - p[2] * x[1];
  };
  const double step = 0.0078125;
  const auto one = ensemble<1>(escaping, list, {0, 3}, M{}, {.step = step, .threads = 1});
  const auto eight = ensemble(escaping, list, {0, 3}, M{}, {.step = step, .threads = 1});
  const auto wide = ensemble<32>(escaping, list, {0, 3}, M{}, {.step = step, .threads = 2});
  ASSERT_GT(one.failures(), 3U);
  ASSERT_LT(one.failures(), list.size() / 2);
  for (std::size_t i = 0; i < list.size(); ++i) {
    expect_same(one.runs[i], eight.runs[i]);
    expect_same(one.runs[i], wide.runs[i]);
    const P& p = list[i].p;
    const auto f = [&](double t, const X& x, X& dxdt) { escaping(t, x, dxdt, p); };
    const auto alone = solve(f, list[i].x, {0, 3}, M{}, {.step = step});
    EXPECT_EQ(alone.outcome.ending, one.runs[i].outcome.ending);
    EXPECT_EQ(alone.outcome.t, one.runs[i].outcome.t);
    EXPECT_EQ(alone.final_state(), one.runs[i].x);
    EXPECT_EQ(alone.statistics.steps, one.runs[i].steps);
  }
}

TEST(EnsembleAndSolve, HaveTheSameBitsOverManyFixedStepsWhereSomeRunsEscape) {
  const List list = random_starts(61, 11);
  expect_the_bits_of_fixed_steps<Rk4>(list);
  expect_the_bits_of_fixed_steps<Tsitouras5>(list);
  expect_the_bits_of_fixed_steps<Dop853>(list);
}

/// A system that says that it depends on time: its steps are at most a fiftieth of the run.
struct Pulse {
  bool autonomous = false;
  template <class Real, class State>
  void operator()(const Real& t, const State& x, State& dxdt, const std::vector<Real>& p) const {
    const Real away = t - p[0];
    dxdt[0] = Real(0.01) / (Real(1e-4) + away * away) - x[0];
  }
};
/// Keeps x at the middle of each step, and the last x.
struct Middles final : RunWatcher<std::vector<double>> {
  std::vector<double> last;
  std::vector<std::vector<double>> seen;
  explicit Middles(std::size_t runs) : last(runs, 0.0), seen(runs) {}
  bool wants(std::size_t run, double) override { return run != 1; }
  void on_piece(std::size_t run, double to, const std::function<void(double t, std::vector<double>& x)>& at) override {
    std::vector<double> x(1);
    for (const double t : {last[run] + (to - last[run]) / 2, to}) {
      at(t, x);
      seen[run].push_back(x[0]);
    }
    last[run] = to;
  }
};

struct PulseAlone {
  std::vector<double> p;
  bool autonomous = false;
  void operator()(double t, const std::vector<double>& x, std::vector<double>& dxdt) const { Pulse{}(t, x, dxdt, p); }
};
struct MiddlesAlone {
  std::vector<double>& seen;
  double& last;
  void on_segment(auto& run, double, double to) {
    std::vector<double> x(1);
    for (const double t : {last + (to - last) / 2, to}) {
      run.at(t, x);
      seen.push_back(x[0]);
    }
    last = to;
  }
  void on_event(auto&, const auto&) {}
};

TEST(EnsembleAndSolve, HaveTheSameBitsWhereTimeMattersAndBetweenSteps) {
  using V = std::vector<double>;
  const std::vector<RunStart<V, V>> list = {{{1.0}, {3.3}}, {{0.0}, {2.0}}, {{0.5}, {7.77}}};
  Middles middles(list.size());
  const auto event = every("kick", 1.7, 2, [](auto& now) { now.x[0] *= 0.5; });
  const auto result = ensemble<2>(Pulse{}, list, {0, 10}, Tsitouras5{}, {.watcher = &middles}, event);
  for (std::size_t i = 0; i < list.size(); ++i) {
    Integrator integrator(PulseAlone{list[i].p}, list[i].x, {0, 10}, Tsitouras5{}, {.events = {event}});
    std::vector<double> seen;
    double last = 0;
    MiddlesAlone look{seen, last};
    while (integrator.advance(look)) {
    }
    EXPECT_EQ(integrator.x(), result.runs[i].x);
    EXPECT_EQ(integrator.statistics().steps, result.runs[i].steps);
    EXPECT_GE(result.runs[i].steps, 50U);
    if (i != 1) {
      EXPECT_EQ(middles.seen[i], seen);
    }
  }
  EXPECT_TRUE(middles.seen[1].empty());
}

#endif

}  // namespace
}  // namespace continuo::ensembles_test
