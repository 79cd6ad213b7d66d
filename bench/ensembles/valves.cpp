// Pressure relief valves whose body strikes its seat: C. Hos, A. Champneys, Physica D 241 (2012), with the parameters
// of the second tutorial of MPGOS. x: the lift of the body, its velocity, the pressure; the parameter: the flow.
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include <bench/ensembles/hard_problems.hpp>
#include <boost/numeric/odeint/stepper/generation.hpp>
#include <boost/numeric/odeint/stepper/runge_kutta_dopri5.hpp>

#include <continuo/ensembles/ensemble.hpp>
#include <continuo/methods/explicit_rk/dop853.hpp>
#include <continuo/methods/explicit_rk/tsitouras5.hpp>

namespace continuo::bench {
namespace {

using Valve = std::array<double, 3>;
using Flow = std::array<double, 1>;

constexpr std::size_t valves = 2000;
constexpr double end = 5, restitution = 0.8;

const auto valve = [](const auto&, const auto& x, auto& dxdt, const auto& p) {
  using std::sqrt;
  dxdt[0] = x[1];
  dxdt[1] = -1.25 * x[1] - (x[0] + 10.0) + x[2];
  dxdt[2] = 20.0 * (p[0] - x[0] * sqrt(x[2]));
};
constexpr Valve start{0.2, 0, 10.2};
Flow flow(std::size_t run) {
  return {1 + 9 * static_cast<double>(run) / static_cast<double>(valves - 1)};
}

template <class M>
std::vector<Valve> together(double tolerance) {
  const auto impact = falls(
      "impact", [](const auto&, const auto& x) { return x[0]; },
      [](auto& now) {
        now.x[0] = 0;
        now.x[1] = -restitution * now.before[1];
      });
  const auto result =
      ensemble(valve, starts(valves, [](std::size_t run) { return RunStart{start, flow(run)}; }), {0, end}, M{},
               {.rtol = tolerance, .atol = tolerance, .keep_events = false, .threads = 1}, impact);
  std::vector<Valve> ends;
  for (const auto& run : result.runs) ends.push_back(run.outcome ? run.x : Valve{HUGE_VAL, HUGE_VAL, HUGE_VAL});
  return ends;
}

/// As users of odeint write it: steps with dense output, and a bisection where one ends below the seat.
std::vector<Valve> odeint(double tolerance) {
  namespace odeint = boost::numeric::odeint;
  std::vector<Valve> ends;
  for (std::size_t run = 0; run < valves; ++run) {
    const auto f = [p = flow(run)](const Valve& y, Valve& dydt, double t) { valve(t, y, dydt, p); };
    auto stepper = odeint::make_dense_output(tolerance, tolerance, odeint::runge_kutta_dopri5<Valve>());
    stepper.initialize(start, 0.0, 0.01);
    Valve x = start;
    while (true) {
      const auto [from, to] = stepper.do_step(f);
      double until = std::fmin(to, end);
      stepper.calc_state(until, x);
      if (x[0] < 0) {
        double above = from, below = until;
        while (below - above > 1e-14 * end) {
          const double middle = (above + below) / 2;
          stepper.calc_state(middle, x);
          (x[0] < 0 ? below : above) = middle;
        }
        stepper.calc_state(below, x);
        x[0] = 0;
        x[1] = -restitution * x[1];
        stepper.initialize(x, below, stepper.current_time_step());
        continue;
      }
      if (until == end) break;
    }
    ends.push_back(x);
  }
  return ends;
}

}  // namespace

void compare_valves() {
  constexpr double allowed = 1e-6;
  const std::vector<Valve> exact = together<Dop853>(1e-13);
  std::printf("2,000 pressure relief valves with impacts, to t = 5\n");
  std::printf("  the reference differs from that of tsitouras5 by %.1e\n",
              largest_error_of(together<Tsitouras5>(1e-13), exact));
  const Cost unit = cost_at(allowed, exact, odeint);
  print_cost("odeint runge_kutta_dopri5", unit, valves, unit);
  print_cost("ensemble, tsitouras5", cost_at(allowed, exact, together<Tsitouras5>), valves, unit);
  print_cost("ensemble, dop853", cost_at(allowed, exact, together<Dop853>), valves, unit);
}

}  // namespace continuo::bench
