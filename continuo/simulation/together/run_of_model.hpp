// One run of a model with events in a lane, as `ensemble` takes it (ensembles/lanes/own_runs.hpp). Its events are those
// of the driver of a single run. Of steps in which its guards stay away from zero, that driver is not told.
#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include <continuo/ensembles/lanes/lane_sizes.hpp>
#include <continuo/ensembles/lanes/run_of_lane.hpp>
#include <continuo/numerics/polynomial_enclosure.hpp>
#include <continuo/simulation/program/dense_step.hpp>
#include <continuo/simulation/together/mode_equations.hpp>
#include <continuo/simulation/together/quiet_guards.hpp>
#include <continuo/simulation/together/seen_run.hpp>

namespace continuo::model {

template <class M>
class RunOfModel {
 public:
  using X = ModelSystem::X;
  using Source = continuo::detail::RunEvents<X>;
  using Settings = continuo::detail::RunSettings<X, X>;
  using Result = RunResult<X, X>;
  using Steps = continuo::detail::RunSteps<ModelSystem, X, M>;
  static constexpr bool has_events = true;

  RunOfModel(const ModeEquations& equations, const Settings& settings, const RunStart<X, X>& start)
      : equations_(equations), settings_(settings), guards_(equations.program()), p_(start.p) {}

  // What the driver of the lanes asks of a run, see RunOfLane.
  [[nodiscard]] bool begin(std::size_t run, RunStart<X, X>&& start) {
    result_.run = run;
    result_.outcome = {};
    p_ = std::move(start.p);
    has_skipped_ = false;
    Integration one = equations_.runs().integration(run);
    guards_.begin(one.system.variables());
    auto steps = std::make_unique<Steps>(std::move(one.system), one.x0, settings_.forward());
    steps->begin_run(settings_.interval.from, one.x0, one.options);
    steps_ = steps.get();
    run_.emplace(std::move(steps), std::move(one.x0), settings_.interval, std::move(one.options),
                 std::move(one.events));
    return pass();
  }
  [[nodiscard]] double t() const { return run_->t(); }
  [[nodiscard]] const X& x() const { return run_->x(); }
  [[nodiscard]] const X& p() const { return p_; }
  [[nodiscard]] Steps& steps() { return *steps_; }
  [[nodiscard]] Result& result() { return result_; }
  [[nodiscard]] double limit() const { return steps_->limit(); }
  [[nodiscard]] bool must_look() const { return run_->is_at_zero(); }
  [[nodiscard]] bool has_row_before(double end) const { return run_->next_scheduled() <= end; }
  [[nodiscard]] bool is_watched(double end) const { return equations_.runs().wants(result_.run, end); }
  [[nodiscard]] bool ends_at(double end) const { return end == limit(); }
  void skip_step() { has_skipped_ = true; }
  [[nodiscard]] bool pass_step() {
    if (std::exchange(has_skipped_, false)) run_->move_on(steps_->begin(), steps_->x_begin());
    if (!pass() || steps_->jumped()) return true;
    // The step was taken again to an event that has changed nothing: the lanes go on with another one.
    if (!steps_->is_retaken()) return false;
    set_place(steps_->begin(), {});
    has_ended_ = true;
    return !end(Ending::cannot_continue);
  }
  [[nodiscard]] bool ended() const { return has_ended_; }
  bool end(Ending ending, std::string hint = {}) {
    result_.outcome = {.ending = ending, .t = place_, .h = steps_->size(), .hint = std::move(hint)};
    return false;
  }
  void set_place(double t, const X&) { place_ = t; }
  [[nodiscard]] Result&& finish() {
    result_.x = run_->x();
    return std::move(result_);
  }

  template <std::size_t W>
  using PolynomialOf = Interpolant<std::vector<Lanes<double, W>>, M::dense_degree>;
  /// The lanes, among those that have accepted their step, in which a guard may come to zero.
  template <std::size_t W>
  [[nodiscard]] static LaneMask<double, W> near_guards(std::vector<RunOfModel>& runs,
                                                       const continuo::detail::LaneSizes<W>& sizes,
                                                       const PolynomialOf<W>& polynomial) {
    using Wide = Lanes<double, W>;
    const std::array<double, W> asked = select(sizes.active() & sizes.accepted(), Wide(1.0), Wide(0.0)).values();
    const auto each = [&](auto&& visit) {
      for (std::size_t lane = 0; lane < W; ++lane)
        if (asked[lane] != 0 && !runs[lane].must_look()) visit(runs[lane], lane);
    };
    for (const std::uint32_t i : runs.front().guards_.components()) {
      const auto [lo, hi] = range_of<W>(polynomial, i);
      each([&](RunOfModel& run, std::size_t lane) { run.guards_.set_component(run.mode(), i, lo[lane], hi[lane]); });
    }
    std::array<double, W> near{};
    each([&](RunOfModel& run, std::size_t lane) {
      near[lane] = run.guards_stay(sizes.t()[lane], sizes.h()[lane]) ? 0 : 1;
    });
    return Wide(near) != Wide(0.0);
  }

 private:
  // Lets the driver pass what is to be passed. Whether the run goes on.
  bool pass() {
    run_->pass(equations_.runs(), result_.run);
    has_ended_ = !steps_->waits();
    if (has_ended_) {
      result_.outcome = run_->outcome();
      return false;
    }
    run_->go_on();
    equations_.set_mode(p_, run_->system().mode());
    return true;
  }

  [[nodiscard]] std::size_t mode() const { return run_->system().mode(); }

  // Where a component is in the step: as enclose_whole_polynomial finds it.
  template <std::size_t W>
  [[nodiscard]] static std::array<Lanes<double, W>, 2> range_of(const PolynomialOf<W>& polynomial, std::size_t i) {
    using Wide = Lanes<double, W>;
    constexpr double rounding = enclosing::polynomial_rounding<double>(M::dense_degree + 1);
    constexpr double widened = 2 * std::numeric_limits<double>::epsilon();
    Wide weight(0.0), total(0.0);
    for (std::size_t j = 1; j < polynomial.c.size(); ++j) {
      weight += abs(polynomial.c[j][i]);
      total += polynomial.c[j][i];
    }
    const Wide reach = Wide(0.5) * weight + Wide(rounding) * weight, middle = Wide(0.5) * total;
    const Wide lo = polynomial.c[0][i] + (middle - reach), hi = polynomial.c[0][i] + (middle + reach);
    return {lo - (abs(lo) * Wide(widened) + Wide(underflow<double>)),
            hi + (abs(hi) * Wide(widened) + Wide(underflow<double>))};
  }
  // Whether they do between t and t + h, where the components have been set.
  [[nodiscard]] bool guards_stay(double t, double h) {
    for (const SeenRun::Constant& one : run_->constants())
      guards_.set_component(mode(), static_cast<std::uint32_t>(one.component), one.value, one.value);
    guards_.set_time(mode(), Step{t, h, {}}.time(0, 1));
    return guards_.stay(mode());
  }

  const ModeEquations& equations_;
  const Settings& settings_;
  QuietGuards guards_;
  X p_;
  Steps* steps_ = nullptr;  // of the driver
  std::optional<SeenRun> run_;
  Result result_;
  double place_ = 0;
  bool has_skipped_ = false, has_ended_ = false;
};

}  // namespace continuo::model
