// Searches a motion of a model for returns from which to solve for an orbit.
#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include <continuo/studies/orbits/hybrid/hybrid_orbit_start.hpp>
#include <continuo/studies/orbits/hybrid/section_passes.hpp>
#include <continuo/studies/support/hybrid_run.hpp>
#include <continuo/studies/support/state_roles.hpp>

namespace continuo::studies::detail {

namespace {

using Point = HybridRun::X;

constexpr double rtol_of_search = 1e-10;
constexpr double back_parts[] = {1e-6, 1e-3};  // of the size of the motion: so near, and it has come back
constexpr double nearby_part = 0.2;            // so near, and Newton's method may find an orbit
constexpr std::size_t most_returns = 16;       // through the section, or periods of the forcing, within one period
constexpr std::size_t most_nearby = 8;         // places to try where the motion does not come back
constexpr std::size_t fewest_samples = 40, most_samples = 4000;

/// What has to come back: all but the unknowns of algebraic equations and sums that nothing reads.
std::vector<std::size_t> returning(const model::ModelProgram& program) {
  std::vector<std::size_t> list;
  for (std::size_t i = 0; i < program.model.states.size(); ++i)
    if (!program.model.states[i].algebraic && !is_unread(program, i)) list.push_back(i);
  return list;
}

class StartSearch {
 public:
  StartSearch(const std::shared_ptr<const model::ModelProgram>& program, const model::Plan& plan,
              const model::Experiment& exact, const HybridOrbitOptions& options, OrbitStarts& result)
      : program_(*program),
        options_(options),
        result_(result),
        returning_(returning(*program)),
        run_(program, plan, exact),
        scan_(program, plan, exact) {
    settled_ = plan.from + options.settle;
    // What happens once at a set time belongs to the way to the orbit.
    for (const model::Scheduled& event : program_.model.schedule)
      if (const auto& once = event.kind == model::Scheduled::Kind::at ? event.time : event.first)
        settled_ = std::max(settled_, model::evaluate(program_.model, once->node, plan.variables));
    run_.on_jump = [this](double, const Point&, const Point& after) { widen(after); };
  }

  void search() {
    if (!go_to(settled_)) return;
    result_.low = result_.high = run_.x();
    if (options_.forcing) {
      sample(*options_.forcing);
    } else {
      pass();
    }
  }

 private:
  bool go_to(double t) {
    if (run_.advance_to(t)) return true;
    result_.outcome = run_.outcome();
    if (result_.outcome.ending != Ending::stopped_by_event) return false;
    result_.outcome.ending = Ending::nonlinear_solve_failed;
    result_.outcome.hint = fmt::format("`{}` ends the run at t = {}, before the motion has returned",
                                       run_.outcome().event, run_.outcome().t);
    return false;
  }
  void fail(std::string hint) {
    result_.outcome.ending = Ending::nonlinear_solve_failed;
    result_.outcome.hint = std::move(hint);
  }
  void widen(const Point& x) {
    for (std::size_t i = 0; i < result_.low.size(); ++i) {
      result_.low[i] = std::min(result_.low[i], x[i]);
      result_.high[i] = std::max(result_.high[i], x[i]);
    }
  }
  void watch_extent(double share, double before) {
    run_.on_stretch = [this, share, before, x = Point(run_.x())](double from, double to,
                                                                 const HybridRun::At& at) mutable {
      constexpr int parts = 4;
      for (int k = 1; k <= parts; ++k) {
        at(k == parts ? to : from + (to - from) * k / parts, x);
        widen(x);
      }
      if (options_.progress) options_.progress(before + share * std::min(1.0, (to - settled_) / options_.duration));
    };
  }

  /// The component that moves most for its size, of those that flow.
  std::optional<std::size_t> section() const {
    std::optional<std::size_t> most;
    double share_of_most = 1e-6;
    for (const std::size_t i : returning_) {
      if (model::stands_still(program_.model, i)) continue;
      const double share =
          (result_.high[i] - result_.low[i]) / std::max({std::abs(result_.low[i]), std::abs(result_.high[i]), 1e-300});
      if (share > share_of_most) most = i, share_of_most = share;
    }
    return most;
  }

  /// Without a forcing: passes through a plane.
  void pass() {
    const model::Instant first = run_.instant();
    watch_extent(0.3, 0);
    if (!go_to(settled_ + options_.duration)) return;
    const std::optional<std::size_t> component = section();
    if (!component) return fail("the motion converges to an equilibrium; start elsewhere, or find it with `steady`");
    const double level = (result_.low[*component] + result_.high[*component]) / 2;
    // Who does not let it settle begins near an orbit, on which it may not stay.
    if (options_.settle == 0) run_.go_on(first);
    const model::Instant begin = run_.instant();
    std::vector<SectionPoint> points;
    SectionPasses passes(*component, level, run_.t(), run_.x(), points);
    run_.on_stretch = [&](double from, double to, const HybridRun::At& at) { passes.piece(from, to, at); };
    run_.on_jump = [&](double t, const Point& before, const Point& after) { passes.jump(t, before, after); };
    if (!go_to(begin.t + options_.duration)) return;
    std::vector<model::Instant> instants;
    for (const SectionPoint& point : points) instants.push_back({point.t, point.x, 0, {}});
    for (const auto& [from, to] : returns(instants, 0))
      add_start(begin, instants[from].t, instants[to].t - instants[from].t, 0);
    end_search();
  }

  /// With a forcing: looks once every period.
  void sample(double forcing) {
    watch_extent(0.5, 0);
    const auto wanted =
        static_cast<std::size_t>(std::clamp(std::ceil(options_.duration / forcing), static_cast<double>(fewest_samples),
                                            static_cast<double>(most_samples)));
    std::vector<model::Instant> instants{run_.instant()};
    for (std::size_t k = 1; k <= wanted; ++k) {
      if (!go_to(settled_ + static_cast<double>(k) * forcing)) return;
      instants.push_back(run_.instant());
    }
    for (const auto& [from, to] : returns(instants, options_.turns))
      add_start(instants[from], instants[from].t, static_cast<double>(to - from) * forcing, to - from);
    end_search();
  }

  double apart(const Point& a, const Point& b) const {
    double most = 0;
    for (const std::size_t i : returning_) {
      const double distance = std::abs(a[i] - b[i]), size = result_.high[i] - result_.low[i];
      if (distance > 0) most = std::max(most, distance / std::max(size, 1e-12 * std::abs(a[i])));
    }
    return most;
  }

  /// Pairs of instants between which the motion has come back: the last one where it has settled, else those that are
  /// nearest to each other.
  std::vector<std::pair<std::size_t, std::size_t>> returns(const std::vector<model::Instant>& points,
                                                           std::size_t turns) {
    const std::size_t least = turns > 0 ? turns : 1, most = turns > 0 ? turns : most_returns;
    if (points.size() < 2) return {};
    const std::size_t last = points.size() - 1;
    std::vector<std::pair<std::size_t, std::size_t>> found;
    for (const double part : back_parts)
      for (std::size_t k = least; k <= most && k <= last; ++k)
        if (apart(points[last].x, points[last - k].x) <= part) found.emplace_back(last - k, last);
    if (!found.empty()) return found;
    result_.nearby = true;
    std::vector<std::pair<double, std::pair<std::size_t, std::size_t>>> near;
    for (std::size_t i = 0; i < points.size(); ++i)
      for (std::size_t k = least; k <= most && i + k <= last; ++k)
        if (const double distance = apart(points[i].x, points[i + k].x); distance < nearby_part)
          near.push_back({distance * static_cast<double>(k), {i, i + k}});
    const std::size_t count = std::min(most_nearby, near.size());
    std::ranges::partial_sort(near, near.begin() + static_cast<std::ptrdiff_t>(count));
    for (std::size_t i = 0; i < count; ++i) found.push_back(near[i].second);
    return found;
  }

  /// The middle of the longest stretch from t on, within a period, in which nothing happens.
  void add_start(const model::Instant& begin, double t, double period, std::size_t turns) {
    scan_.on_stretch = {};
    scan_.go_on(begin);
    if (!scan_.advance_to(t)) return;
    double gap_begin = t, best_from = t, best_length = 0;
    std::size_t seen = scan_.discontinuities();
    scan_.on_stretch = [&](double from, double to, const HybridRun::At&) {
      if (scan_.discontinuities() != std::exchange(seen, scan_.discontinuities()))
        gap_begin = std::max(gap_begin, from);
      if (scan_.slides()) gap_begin = to;
      if (to - gap_begin > best_length) best_from = gap_begin, best_length = to - gap_begin;
    };
    const bool comes_round = scan_.advance_to(t + period);
    scan_.on_stretch = {};
    if (!comes_round || !(best_length > 0)) return;
    scan_.go_on(begin);
    if (!scan_.advance_to(best_from + best_length / 2)) return;
    result_.starts.push_back({scan_.instant(), period, turns});
  }

  void end_search() {
    if (!result_.starts.empty()) return;
    fail(
        fmt::format("the motion does not return to an earlier state within a time of {}; it may need longer to settle, "
                    "or have no period",
                    options_.duration));
    result_.wanders = true;
  }

  const model::ModelProgram& program_;
  const HybridOrbitOptions& options_;
  OrbitStarts& result_;
  std::vector<std::size_t> returning_;
  HybridRun run_, scan_;
  double settled_ = 0;
};

}  // namespace

OrbitStarts orbit_starts(const std::shared_ptr<const model::ModelProgram>& program, const model::Experiment& experiment,
                         const HybridOrbitOptions& options) {
  OrbitStarts result;
  model::Experiment exact = exactly(*program, experiment, rtol_of_search);
  exact.interrupt = options.interrupt;
  exact.max_steps = model::usual_max_steps;
  std::optional<model::Plan> plan = plan_of(*program, exact, result.outcome);
  if (!plan) return result;
  plan->to = plan->from + options.settle + 2 * options.duration;
  StartSearch(program, *plan, exact, options, result).search();
  return result;
}

}  // namespace continuo::studies::detail
