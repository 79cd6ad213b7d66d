// Runs a closed orbit through its events and records its line and its extent.
#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include <continuo/studies/orbits/hybrid/orbit_trace.hpp>
#include <continuo/studies/support/hybrid_run.hpp>

namespace continuo::studies::detail {

OrbitTrace traced(const std::shared_ptr<const model::ModelProgram>& program, const model::Experiment& exact,
                  const model::Instant& start, double period) {
  OrbitTrace trace;
  Outcome<double> outcome;
  std::optional<model::Plan> plan = plan_of(*program, exact, outcome);
  if (!plan) return trace;
  plan->to = start.t + period;
  HybridRun run(program, *plan, exact);
  run.go_on(start);
  trace.low = trace.high = start.x;
  const auto widen = [&](std::size_t i, double value) {
    trace.low[i] = std::min(trace.low[i], value);
    trace.high[i] = std::max(trace.high[i], value);
  };
  const auto keep = [&](double t, const std::vector<double>& x) {
    trace.t.push_back(t);
    trace.x.push_back(x);
    for (std::size_t i = 0; i < x.size(); ++i) widen(i, x[i]);
  };
  keep(start.t, start.x);
  run.on_stretch = [&](double from, double to, const HybridRun::At& at_time) {
    constexpr int parts = 8;
    std::vector<double> x = trace.x.back(), before, middle;
    for (int k = 1; k <= parts; ++k) {
      before = std::exchange(middle, trace.x.back());
      const double t = k == parts ? to : from + (to - from) * k / parts;
      at_time(t, x);
      keep(t, x);
      if (k == 1) continue;
      // The extremum of the parabola through three points lies between the outer ones, or is none.
      for (std::size_t i = 0; i < x.size(); ++i) {
        const double slope = (x[i] - before[i]) / 2, bend = x[i] - 2 * middle[i] + before[i];
        if (std::abs(slope) < std::abs(bend)) widen(i, middle[i] - slope * slope / (2 * bend));
      }
    }
  };
  run.on_jump = [&](double t, const std::vector<double>& before, const std::vector<double>& after) {
    keep(t, before);
    keep(t, after);
  };
  static_cast<void>(run.advance_to(start.t + period));
  return trace;
}

}  // namespace continuo::studies::detail
