// Ensembles beside the same runs one by one: 10,000 Lorenz systems beside Boost.odeint's runge_kutta_fehlberg78 and our
// `solve`, bubbles and valves beside Boost.odeint, a million bouncing balls beside `solve`, and steps of RK4 of a fixed
// size beside the operations per second that the core can do. Processor time, of one thread but for the last line.
#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <string>
#include <vector>

#include <bench/ensembles/hard_problems.hpp>
#include <bench/processor_time.hpp>
#include <boost/numeric/odeint/integrate/integrate_adaptive.hpp>
#include <boost/numeric/odeint/stepper/generation.hpp>
#include <boost/numeric/odeint/stepper/runge_kutta_fehlberg78.hpp>

#include <continuo/ensembles/ensemble.hpp>
#include <continuo/methods/explicit_rk/dop853.hpp>
#include <continuo/methods/explicit_rk/rk4.hpp>
#include <continuo/methods/explicit_rk/tsitouras5.hpp>
#include <continuo/methods/explicit_rk/verner9.hpp>
#include <continuo/solve/solve.hpp>

namespace {

using namespace continuo;
using Two = std::array<double, 2>;
using Three = std::array<double, 3>;
using One = std::array<double, 1>;

/// The processor time of one call, the shortest of those that fit into three seconds, of two at least.
template <class F>
double seconds(F&& f) {
  double best = HUGE_VAL, spent = 0;
  for (int i = 0; i < 2 || spent < 3; ++i) {
    const double begin = bench::processor_seconds();
    f();
    const double time = bench::processor_seconds() - begin;
    best = std::min(best, time);
    spent += time;
  }
  return best;
}

// ---- Lorenz

constexpr std::size_t lorenz_runs = 10'000;
constexpr double lorenz_end = 10;
const auto lorenz = [](const auto&, const auto& x, auto& dxdt, const auto& p) {
  dxdt[0] = 10.0 * (x[1] - x[0]);
  dxdt[1] = x[0] * (p[0] - x[2]) - x[1];
  dxdt[2] = x[0] * x[1] - 8.0 / 3.0 * x[2];
};
One rho(std::size_t run) {
  return {28.0 * static_cast<double>(run) / static_cast<double>(lorenz_runs - 1)};
}

template <class M>
std::vector<Three> lorenz_one_by_one(double tolerance) {
  std::vector<Three> ends;
  for (std::size_t run = 0; run < lorenz_runs; ++run) {
    const auto f = [p = rho(run)](double t, const Three& x, Three& dxdt) { lorenz(t, x, dxdt, p); };
    ends.push_back(solve(f, Three{1, 0, 0}, {0, lorenz_end}, M{},
                         {.rtol = tolerance, .atol = tolerance, .save = Save<Three>::only_end()})
                       .final_state());
  }
  return ends;
}
template <class M>
std::vector<Three> lorenz_together(double tolerance, int threads, double atol = 0) {
  const auto result =
      ensemble(lorenz, starts(lorenz_runs, [](std::size_t run) { return RunStart{Three{1, 0, 0}, rho(run)}; }),
               {0, lorenz_end}, M{}, {.rtol = tolerance, .atol = atol > 0 ? atol : tolerance, .threads = threads});
  std::vector<Three> ends;
  for (const auto& run : result.runs) ends.push_back(run.x);
  return ends;
}
std::vector<Three> lorenz_odeint(double tolerance) {
  namespace odeint = boost::numeric::odeint;
  std::vector<Three> ends;
  for (std::size_t run = 0; run < lorenz_runs; ++run) {
    Three x{1, 0, 0};
    const auto f = [p = rho(run)](const Three& y, Three& dydt, double t) { lorenz(t, y, dydt, p); };
    odeint::integrate_adaptive(odeint::make_controlled(tolerance, tolerance, odeint::runge_kutta_fehlberg78<Three>()),
                               f, x, 0.0, lorenz_end, 0.01);
    ends.push_back(x);
  }
  return ends;
}

double largest_error(const std::vector<Three>& ends, const std::vector<Three>& exact) {
  double largest = 0;
  for (std::size_t run = 0; run < ends.size(); ++run)
    for (std::size_t i = 0; i < 3; ++i) largest = std::max(largest, std::abs(ends[run][i] - exact[run][i]));
  return largest;
}

void compare_lorenz() {
  const std::vector<Three> exact = lorenz_together<Verner9>(1e-13, 0);
  std::vector<Three> ends;
  const auto report = [&](const char* who, double tolerance, double time, double unit) {
    std::printf("  %-34s tol %-7.0e %9.0f runs/s  largest error %.1e  %6.2f times odeint\n", who, tolerance,
                static_cast<double>(lorenz_runs) / time, largest_error(ends, exact), unit / time);
  };
  std::printf("10,000 Lorenz systems, rho 0..28, to t = 10\n");
  const double odeint = seconds([&] { ends = lorenz_odeint(1e-8); });
  report("odeint runge_kutta_fehlberg78", 1e-8, odeint, odeint);
  const auto ours = [&]<class M>(M, double tolerance) {
    const double alone = seconds([&] { ends = lorenz_one_by_one<M>(tolerance); });
    report(("solve, " + std::string(M::name)).c_str(), tolerance, alone, odeint);
    const double together = seconds([&] { ends = lorenz_together<M>(tolerance, 1); });
    report(("ensemble, " + std::string(M::name)).c_str(), tolerance, together, odeint);
  };
  ours(Dop853{}, 1e-8);
  ours(Verner9{}, 2e-6);  // about the error of odeint
  ours(Verner9{}, 3e-8);
  // Near the origin, where a small error decides on which side a trajectory goes on, the state is small.
  const double together = seconds([&] { ends = lorenz_together<Verner9>(5e-8, 1, 5e-9); });
  report("ensemble, verner9, atol 5e-9", 5e-8, together, odeint);
}

// ---- bouncing balls

constexpr std::size_t balls = 1'000'000;
const auto ball = [](const auto&, const auto& x, auto& dxdt, const auto& p) {
  dxdt[0] = x[1];
  dxdt[1] = -p[0];
};
RunStart<Two, One> ball_start(std::size_t run) {
  return {{1 + 9 * static_cast<double>(run) / static_cast<double>(balls), 0}, {9.81}};
}
double error_of_landing(std::size_t run, double t) {
  return std::abs(t - std::sqrt(2 * ball_start(run).x[0] / ball_start(run).p[0]));
}
double balls_together(int threads) {
  double largest = 0;
  const auto note = [&](const RunResult<Two, One>& one) {
    largest = std::max(largest, error_of_landing(one.run, one.outcome.t));
  };
  static_cast<void>(
      ensemble(ball, starts(balls, ball_start), {0, 100}, Tsitouras5{},
               {.keep_events = false, .threads = threads, .finished = note},
               falls("floor", [](const auto&, const auto& x) { return x[0]; }, [](auto& now) { now.stop = true; })));
  return largest;
}
double balls_one_by_one() {
  double largest = 0;
  const auto floor = falls("floor", [](double, const Two& x) { return x[0]; }, [](auto& now) { now.stop = true; });
  for (std::size_t run = 0; run < balls; ++run) {
    const auto start = ball_start(run);
    const auto f = [&start](double t, const Two& x, Two& dxdt) { ball(t, x, dxdt, start.p); };
    const auto solution = solve(f, start.x, {0, 100}, Tsitouras5{}, {.events = {floor}, .save = Save<Two>::only_end()});
    largest = std::max(largest, error_of_landing(run, solution.outcome.t));
  }
  return largest;
}

void compare_balls() {
  double largest = 0;
  std::printf("1,000,000 balls fall to the floor\n");
  const double alone = seconds([&] { largest = balls_one_by_one(); });
  std::printf("  %-34s %6.2f us/ball  largest error %.1e s\n", "solve, tsitouras5", alone, largest);
  const double together = seconds([&] { largest = balls_together(1); });
  std::printf("  %-34s %6.2f us/ball  largest error %.1e s  %.2f of solve's time\n", "ensemble, tsitouras5", together,
              largest, together / alone);
}

// ---- steps of a fixed size, and threads

/// Multiplications and additions in a second, each counted, of eight chains of fused operations on whole registers.
double peak_operations() {
  using Wide = Lanes<double, xsimd::batch<double>::size>;
  constexpr std::size_t chains = 12, rounds = 20'000'000;
  std::array<Wide, chains> value;
  value.fill(Wide(1.0));
  const Wide factor(0.999999), term(1e-6);
  const auto compute_here = [&] { asm volatile("" : "+m"(value)); };  // not before or after the clock is read
  const double time = seconds([&] {
    compute_here();
    for (std::size_t round = 0; round < rounds; ++round) {
#pragma GCC unroll 12
      for (std::size_t i = 0; i < chains; ++i) value[i] = value[i] * factor + term;
    }
    compute_here();
  });
  return 2.0 * static_cast<double>(chains * rounds * Wide::width) / time;
}

void compare_fixed_steps() {
  constexpr std::size_t runs = 1000;
  constexpr double steps = 10'000;
  const auto make = starts(runs, [](std::size_t run) { return RunStart{Three{1, 0, 0}, rho(10 * run)}; });
  const double time =
      seconds([&] { static_cast<void>(ensemble(lorenz, make, {0, 10}, Rk4{}, {.step = 10 / steps, .threads = 1})); });
  // f has 8 operations. The arguments of the stages take 2 for each component, the new state 9.
  const double operations = (4 * 8 + 3 * (3 * 2 + 9)) * steps * static_cast<double>(runs);
  std::printf("RK4, steps of a fixed size, Lorenz: %.1f ns a step, %.2f of the peak of %.1f GFlop/s\n",
              1e9 * time / steps / static_cast<double>(runs), operations / time / peak_operations(),
              peak_operations() / 1e9);
}

void compare_threads() {
  const auto wall = [](int threads) {
    double best = HUGE_VAL;
    for (int i = 0; i < 3; ++i) {
      const auto begin = std::chrono::steady_clock::now();
      static_cast<void>(lorenz_together<Dop853>(1e-10, threads));
      best = std::min(best, std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count());
    }
    return best;
  };
  std::printf("two threads: %.2f times one (wall time; only on an idle machine)\n", wall(1) / wall(2));
}

}  // namespace

int main() {
  std::printf("lanes: %zu, register: %zu numbers\n", default_lanes, xsimd::batch<double>::size);
  compare_lorenz();
  bench::compare_bubbles();
  bench::compare_valves();
  bench::compare_stiff_runs();
  compare_balls();
  compare_fixed_steps();
  compare_threads();
}
