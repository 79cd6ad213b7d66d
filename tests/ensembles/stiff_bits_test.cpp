// Stiff runs by rodas5p have the bits of solve, whatever the number of lanes and of threads and the order, those that
// fail too. f is of sums, products, quotients and roots, which lanes round as one number does.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <random>
#include <vector>

#include <gtest/gtest.h>
#include <oneapi/tbb/global_control.h>
#include <tests/ensembles/same_runs.hpp>

#include <continuo/ensembles/ensemble.hpp>
#include <continuo/methods/rosenbrock/rodas5p.hpp>
#include <continuo/solve/integrator.hpp>
#include <continuo/solve/solve.hpp>

namespace continuo::ensembles_test {
namespace {

#ifndef __FMA__  // with fused operations the compiler rounds one number and lanes of numbers in different places

template <class X, class P, class F, class... Events>
void expect_the_bits_of_solve(const F& f, const std::vector<RunStart<X, P>>& list, const Ensemble<X, P>& ensemble,
                              Interval<double> interval, const EnsembleOptions<X, P>& options,
                              const Events&... events) {
  ASSERT_EQ(ensemble.runs.size(), list.size());
  for (std::size_t i = 0; i < list.size(); ++i) {
    const auto one = [&](double t, const X& x, X& dxdt) { f(t, x, dxdt, list[i].p); };
    Options<X> alone = options.of_one_run();
    alone.events = {events...};
    const auto solution = solve(one, list[i].x, interval, Rodas5P{}, alone);
    const RunResult<X, P>& run = ensemble.runs[i];
    EXPECT_EQ(run.outcome.ending, solution.outcome.ending) << "run " << i << ": " << solution.outcome.hint;
    EXPECT_EQ(run.outcome.t, solution.outcome.t);
    EXPECT_EQ(run.outcome.component, solution.outcome.component);
    EXPECT_EQ(run.outcome.h, solution.outcome.h) << "run " << i;
    EXPECT_EQ(run.outcome.error, solution.outcome.error);
    if (run.outcome.ending != Ending::too_many_steps) {
      EXPECT_EQ(run.outcome.hint, solution.outcome.hint);
    }
    EXPECT_EQ(run.x, solution.final_state()) << "run " << i;
    EXPECT_EQ(run.steps, solution.statistics.steps);
    EXPECT_EQ(run.rejected, solution.statistics.rejected);
    ASSERT_LE(run.rows.size(), solution.x.size());
    EXPECT_TRUE(std::equal(run.rows.begin(), run.rows.end(), solution.x.begin()));
  }
}

// ---- Van der Pol, by all numbers of lanes

using Two = std::array<double, 2>;
using One = std::array<double, 1>;
const auto van_der_pol = [](const auto&, const auto& x, auto& dxdt, const auto& p) {
  dxdt[0] = x[1];
  dxdt[1] = p[0] * ((1.0 - x[0] * x[0]) * x[1]) - x[0];
};
const EnsembleOptions<Two, One> pol_options{.rtol = 1e-4, .save_at = {1, 11.5}, .threads = 1};

TEST(StiffEnsemble, OfVanDerPolHasTheBitsOfSolveWhateverTheLanesTheThreadsAndTheOrder) {
  const tbb::global_control allowed(tbb::global_control::max_allowed_parallelism, 4);
  std::mt19937_64 generator(12);
  std::uniform_real_distribution<double> number(0, 1);
  std::vector<RunStart<Two, One>> list(21), shuffled;
  for (auto& start : list) start = {{2 * number(generator), number(generator)}, {std::pow(10, 4 * number(generator))}};
  const Interval<double> interval{0, 12};
  const auto eight = ensemble<8>(van_der_pol, list, interval, Rodas5P{}, pol_options);
  EXPECT_EQ(eight.failures(), 0U);
  expect_the_bits_of_solve(van_der_pol, list, eight, interval, pol_options);

  std::vector<std::size_t> order(list.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::shuffle(order.begin(), order.end(), generator);
  for (const std::size_t i : order) shuffled.push_back(list[i]);
  const auto compare = [&]<std::size_t W>(std::integral_constant<std::size_t, W>, int threads) {
    EnsembleOptions<Two, One> options = pol_options;
    options.threads = threads;
    const auto other = ensemble<W>(van_der_pol, shuffled, interval, Rodas5P{}, options);
    for (std::size_t i = 0; i < order.size(); ++i) expect_same(eight.runs[order[i]], other.runs[i]);
  };
  compare(std::integral_constant<std::size_t, 1>{}, 1);
  compare(std::integral_constant<std::size_t, 2>{}, 2);
  compare(std::integral_constant<std::size_t, 8>{}, 3);
}

TEST(StiffEnsemble, WithEventsAtGivenTimesHasTheBitsOfSolve) {
  std::mt19937_64 generator(15);
  std::uniform_real_distribution<double> number(0, 1);
  std::vector<RunStart<Two, One>> list(9);
  for (auto& start : list) start = {{2 * number(generator), number(generator)}, {std::pow(10, 4 * number(generator))}};
  const auto kick = every("kick", 1.25, 0.5, [](auto& now) { now.x[0] += 0.25; });
  const auto mark = at("mark", std::vector{2.1}, [](auto&) {});  // which changes nothing
  const auto result = ensemble<4>(van_der_pol, list, {0, 12}, Rodas5P{}, pol_options, kick, mark);
  for (const auto& run : result.runs) EXPECT_EQ(run.events.size(), 11U);
  expect_the_bits_of_solve(van_der_pol, list, result, {0, 12}, pol_options, kick, mark);
}

// ---- random systems of every size, and those that fail

/// dx/dt = A x, and what `kind` adds; A is p, row by row.
struct RandomSystem {
  enum class Kind { linear, kinetics, escaping, root };
  Kind kind;
  void operator()(const auto& t, const auto& x, auto& dxdt, const auto& p) const {
    using std::sqrt;
    const std::size_t n = x.size();
    for (std::size_t i = 0; i < n; ++i) {
      auto sum = p[i * n] * x[0];
      for (std::size_t j = 1; j < n; ++j) sum += p[i * n + j] * x[j];
      if (kind == Kind::kinetics) sum += 0.1 * t * p[i] - x[i] * x[(i + 1) % n];
      if (kind == Kind::escaping) sum += x[i] * x[i];
      if (kind == Kind::root) sum -= sqrt(x[i]);
      dxdt[i] = sum;
    }
  }
};

/// Rates from 0.1 to 1e4 on the diagonal, half of the rest zero: rows have to change their places.
void fill(RandomSystem::Kind kind, std::mt19937_64& generator, auto& x, auto& p) {
  std::uniform_real_distribution<double> number(0, 1);
  const std::size_t n = x.size();
  for (double& one : x) one = number(generator) < 0.2 ? 0 : number(generator);
  for (double& entry : p)
    entry = number(generator) < 0.5 ? 0 : (number(generator) - 0.5) * std::pow(10, 2 * number(generator));
  for (std::size_t i = 0; i < n; ++i)
    p[i * n + i] =
        kind == RandomSystem::Kind::escaping ? 3 * number(generator) - 2 : -std::pow(10, 5 * number(generator) - 1);
}

using Vector = std::vector<double>;

TEST(StiffEnsemble, OfVectorsOfAnySizeHasTheBitsOfSolveAndOfFailuresToo) {
  using Kind = RandomSystem::Kind;
  std::mt19937_64 generator(13);
  const Interval<double> interval{0, 1};
  const auto compare = [&](std::size_t n, Kind kind, double step) {
    std::vector<RunStart<Vector, Vector>> list(9);
    for (auto& start : list) {
      start = {Vector(n), Vector(n * n)};
      fill(kind, generator, start.x, start.p);
    }
    const EnsembleOptions<Vector, Vector> options{
        .rtol = 1e-4, .step = step, .max_steps = n > 5 ? 15U : 60U, .save_at = {0.3}, .threads = 1};
    const RandomSystem f{kind};
    expect_the_bits_of_solve(f, list, ensemble(f, list, interval, Rodas5P{}, options), interval, options);
  };
  for (const std::size_t n : {1U, 2U, 5U})
    for (const Kind kind : {Kind::linear, Kind::kinetics, Kind::escaping, Kind::root}) compare(n, kind, 0);
  for (const Kind kind : {Kind::kinetics, Kind::escaping, Kind::root}) compare(3, kind, 0.0625);
  compare(12, Kind::kinetics, 0);
  compare(17, Kind::root, 0);  // above PlainLaneLU::greatest_size
}

// Rows of up to four components stay in registers, as above; of more they are exchanged for the greatest.
TEST(StiffEnsemble, OfArraysHasTheBitsOfSolve) {
  using X = std::array<double, 6>;
  using P = std::array<double, 36>;
  const RandomSystem f{RandomSystem::Kind::kinetics};
  std::mt19937_64 generator(14);
  std::vector<RunStart<X, P>> list(9);
  for (auto& start : list) fill(f.kind, generator, start.x, start.p);
  const EnsembleOptions<X, P> options{.rtol = 1e-4, .max_steps = 60, .save_at = {0.3}, .threads = 1};
  expect_the_bits_of_solve(f, list, ensemble<4>(f, list, {0, 1}, Rodas5P{}, options), {0, 1}, options);
}

#endif

// ---- the Jacobian of the user, and matrices that are singular

/// x' = p x, which says so. With a step h and p = 1 / (gamma h) the matrix of the step is zero.
struct Growth {
  static constexpr bool autonomous = true;
  bool* asked;
  void operator()(const auto&, const auto& x, auto& dxdt, const auto& p) const { dxdt[0] = p[0] * x[0]; }
  void jacobian(const auto&, const auto&, auto rows, const auto& p) const {
    rows[0] = p[0];
    *asked = true;
  }
};

TEST(StiffEnsemble, TakesTheJacobianOfTheUserAndFailsAloneWhereAMatrixIsSingular) {
  bool asked = false;
  constexpr double step = 0.125;
  const double singular = 1.0 / (step * Rodas5P::tableau.gamma.as<double>());
  std::vector<RunStart<One, One>> list(5, {{1}, {-1}});
  list[2].p[0] = singular;
  const auto result = ensemble<4>(Growth{&asked}, list, {0, 1}, Rodas5P{}, {.step = step, .threads = 1});
  EXPECT_TRUE(asked);
  EXPECT_EQ(result.failures(), 1U);
  EXPECT_EQ(result.runs[2].outcome.ending, Ending::nonlinear_solve_failed);
  EXPECT_EQ(result.runs[2].steps, 0U);
  for (const std::size_t i : {0U, 1U, 3U, 4U}) EXPECT_EQ(result.runs[i].x, result.runs[0].x);
  // Eight steps of order 5: each is off by some h^6 / 720.
  EXPECT_NEAR(result.runs[0].x[0], std::exp(-1), 1e-6);
  // With step control shorter steps are not singular.
  const auto controlled = ensemble<4>(Growth{&asked}, list, {0, 1}, Rodas5P{}, {.first_step = step, .threads = 1});
  EXPECT_EQ(controlled.failures(), 0U);
  EXPECT_GE(controlled.runs[2].rejected, 1U);
}

}  // namespace
}  // namespace continuo::ensembles_test
