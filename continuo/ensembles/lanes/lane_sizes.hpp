// The times and step sizes of W runs, one per lane, and the decision whether a step is accepted: what StepControl does
// for one run, operation by operation.
#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>
#include <vector>

#include <continuo/methods/method.hpp>
#include <continuo/numerics/lanes.hpp>
#include <continuo/solve/options.hpp>
#include <continuo/solve/steps/controller.hpp>
#include <continuo/status/status.hpp>

namespace continuo::detail {

/// The tolerance of a run, for all lanes.
template <std::size_t W>
class LaneTolerance {
 public:
  using Wide = Lanes<double, W>;
  template <State X>
  explicit LaneTolerance(const Options<X>& options)
      : rtol_each_(options.rtol_each.begin(), options.rtol_each.end()),
        atol_each_(options.atol_each.begin(), options.atol_each.end()),
        all_{.rtol = Wide(options.rtol), .atol = Wide(options.atol)} {
    if (!rtol_each_.empty()) all_.rtol_each = rtol_each_.data();
    if (!atol_each_.empty()) all_.atol_each = atol_each_.data();
  }
  LaneTolerance(const LaneTolerance&) = delete;
  LaneTolerance& operator=(const LaneTolerance&) = delete;

  [[nodiscard]] const Tolerance<Wide>& all() const { return all_; }

 private:
  std::vector<Wide> rtol_each_, atol_each_;
  Tolerance<Wide> all_;
};

template <std::size_t W>
class LaneSizes {
 public:
  using Wide = Lanes<double, W>;
  using Mask = LaneMask<double, W>;

  /// `depends_on_time`: the system says so, and then steps are at most a fiftieth of the run, see StepControl.
  template <State X>
  LaneSizes(const Options<X>& options, Interval<double> interval, bool depends_on_time)
      : begin_(interval.from),
        forward_(interval.to < interval.from ? -1.0 : 1.0),
        step_(options.step),
        max_step_(options.max_step),
        depends_on_time_(depends_on_time),
        longest_(options.max_step),
        controller_(options.controller),
        max_steps_(static_cast<double>(options.max_steps)),
        max_rejects_(static_cast<float>(options.max_rejects_in_a_row)) {}

  [[nodiscard]] bool fixed() const { return step_ > 0; }

  // ---- the lanes

  [[nodiscard]] bool is_active(std::size_t lane) const { return active_[lane] != 0; }
  [[nodiscard]] Mask active() const { return active_ != Wide(0.0); }
  /// A run begins in this lane.
  void begin_run(std::size_t lane) {
    active_.set(lane, 1.0);
    steps_.set(lane, 0.0);
    rejected_[lane] = 0;
    reach_[lane] = 0;
  }
  void end_run(std::size_t lane) { active_.set(lane, 0.0); }
  /// The motion begins at t, or begins anew there.
  void begin_motion(std::size_t lane, double t, double limit) {
    t_.set(lane, t);
    grid_.set(lane, t);
    grid_steps_.set(lane, 0.0);
    next_.set(lane, 0.0);
    carried_.set(lane, 0.0);
    set_limit(lane, limit);
    errors_.last.set(lane, 0.0F);
    errors_.before_last.set(lane, 0.0F);
    rejects_.set(lane, 0.0F);
  }
  void set_first_size(std::size_t lane, double size) { next_.set(lane, size); }
  void set_limit(std::size_t lane, double limit) {
    limit_.set(lane, limit);
    if (!depends_on_time_) return;
    reach_[lane] = std::max(reach_[lane], std::abs(limit - begin_));
    longest_.set(lane, std::min(max_step_, reach_[lane] / parts_of_run));
  }
  [[nodiscard]] std::size_t steps(std::size_t lane) const { return static_cast<std::size_t>(steps_[lane]); }
  [[nodiscard]] std::size_t rejected(std::size_t lane) const { return static_cast<std::size_t>(rejected_[lane]); }

  // ---- a step

  /// Where it begins, its size, and where it ends once it has been judged.
  [[nodiscard]] const Wide& t() const { return t_; }
  [[nodiscard]] const Wide& h() const { return h_; }
  [[nodiscard]] const Wide& limit() const { return limit_; }
  [[nodiscard]] const Wide& end() const { return end_; }
  /// The lanes whose step was accepted, and of those the ones that have come to their limit.
  [[nodiscard]] const Mask& accepted() const { return accepted_; }
  [[nodiscard]] Mask at_limit() const { return accepted_ & last_; }

  /// Chooses the size of the next step of each lane.
  void choose() {
    const Wide room = limit_ - t_;
    if (fixed()) {
      const Wide nominal(forward_ * step_);
      planned_ = nominal;
      // The grid is computed afresh at each step, so a million steps do not drift.
      on_grid_ = grid_ + (grid_steps_ + Wide(1.0)) * nominal;
      last_ = Wide(forward_) * (on_grid_ - limit_) > Wide(-1e-9 * step_);
      short_ = last_ & (abs(on_grid_ - limit_) > Wide(1e-9 * step_));
      h_ = select(short_, room, nominal);
    } else {
      planned_ = select(abs(next_) > longest_, Wide(forward_) * longest_, next_);
      // A remainder below 1 % of h before the limit is absorbed into this step.
      last_ = Wide(forward_) * (Wide(1.01) * planned_ - room) >= Wide(0.0);
      h_ = select(last_, room, planned_);
    }
  }

  /// Of steps of a fixed size, how many of the next every active lane takes in any case: at most `most`.
  [[nodiscard]] std::size_t free_steps(std::size_t most) const {
    const std::array<double, W> left = (abs(limit_ - t_) / Wide(step_)).values();
    double count = static_cast<double>(most) + safety_of_count;
    for (std::size_t lane = 0; lane < W; ++lane) {
      if (!is_active(lane)) continue;
      count = std::min({count, left[lane], max_steps_ - steps_[lane]});
    }
    return count > safety_of_count ? static_cast<std::size_t>(count - safety_of_count) : 0;
  }
  /// The size of such steps, where their grid begins, and how many of it there were.
  [[nodiscard]] Wide fixed_size() const { return Wide(forward_ * step_); }
  [[nodiscard]] const Wide& grid() const { return grid_; }
  [[nodiscard]] const Wide& fixed_steps() const { return grid_steps_; }
  /// All active lanes have taken this many of the free steps.
  void pass_free_steps(std::size_t count) {
    const Wide steps = select(active(), Wide(static_cast<double>(count)), Wide(0.0));
    steps_ += steps;
    grid_steps_ += steps;
    t_ = select(active(), grid_ + grid_steps_ * fixed_size(), t_);
  }

  /// How the equations of each lane's step have ended; null where there are none.
  using Statuses = std::array<StepStatus, W>;

  /// Judges a step by the squares of its errors, in units of the tolerance. That of a step whose equations were not
  /// solved is infinite.
  void judge(const Wide& square, int error_order, const Statuses* statuses = nullptr) {
    accepted_ = active() & (square <= Wide(1.0));  // not where it is not a number
    const Wide good = select(accepted_, Wide(1.0), Wide(0.0));
    const Wide factor = factors_of(square, good, error_order);
    // A step that was shortened by the limit says little about the next one, which is no shorter than planned.
    const Wide shrunk = h_ * factor;
    next_ = select(last_, Wide(forward_) * max(abs(planned_), abs(h_) * factor), shrunk);
    // The rounding error of the sum is carried to the next step (W. Kahan), so that a million steps do not drift.
    const Wide wanted = h_ + carried_;
    end_ = select(last_, limit_, t_ + wanted);
    carried_ = select(accepted_, select(last_, Wide(0.0), wanted - (end_ - t_)), carried_);
    steps_ += good;
    if (any(active() & !accepted_)) [[unlikely]]
      reject(square.values(), error_order, statuses);
    if (any(accepted_ & !last_ & (end_ == t_))) [[unlikely]]
      stand_still();
  }
  /// Judges a step of fixed size: `nothing` is 0 where its equations were solved and the new state is finite.
  void judge_fixed(const Wide& nothing, const Statuses* statuses = nullptr) {
    const Mask stands = (on_grid_ == t_) & !last_;
    accepted_ = active() & !stands & (nothing == Wide(0.0));
    end_ = select(last_, limit_, on_grid_);
    steps_ += select(accepted_, Wide(1.0), Wide(0.0));
    grid_steps_ = select(short_, Wide(0.0), grid_steps_ + Wide(1.0));
    grid_ = select(short_, limit_, grid_);
    for (std::size_t lane = 0; any(active() & !accepted_) && lane < W; ++lane) {
      if (!is_active(lane) || accepted_[lane]) continue;
      const bool is_singular = statuses && (*statuses)[lane] == StepStatus::singular_matrix;
      refuse(lane,
             stands[lane]  ? Ending::step_too_small
             : is_singular ? Ending::nonlinear_solve_failed
                           : Ending::not_finite,
             0);
    }
  }
  /// The accepted lanes go on to the end of their step. Those with too many steps are refused another one.
  void commit() {
    t_ = select(accepted_, end_, t_);
    const Wide tries = steps_ + Wide(rejected_);
    if (any(accepted_ & (tries >= Wide(max_steps_)))) [[unlikely]]
      for (std::size_t lane = 0; lane < W; ++lane)
        if (accepted_[lane] && tries[lane] >= max_steps_) refuse(lane, Ending::too_many_steps, 0);
  }

  // ---- steps that a system takes itself, see steps_by_system.hpp

  /// At least a register of floats: those of the lanes, and zeros.
  using Floats = Lanes<float, (W + 3) / 4 * 4>;
  /// What it reads and changes.
  struct Numbers {
    Wide &t, &next, &carried, &steps;
    const Wide &limit, &longest, &active;
    Floats &last, &before_last, &rejects;
  };
  [[nodiscard]] Numbers numbers() {
    return {t_, next_, carried_, steps_, limit_, longest_, active_, errors_.last, errors_.before_last, rejects_};
  }
  [[nodiscard]] const Controller& controller() const { return controller_; }
  [[nodiscard]] double forward() const { return forward_; }
  /// How many steps every active lane may accept, at most `most`, before one has too many.
  [[nodiscard]] std::size_t allowed_steps(std::size_t most) const {
    double count = static_cast<double>(most);
    for (std::size_t lane = 0; lane < W; ++lane)
      if (is_active(lane)) count = std::min(count, max_steps_ - steps_[lane] - rejected_[lane] - 1);
    return count > 0 ? static_cast<std::size_t>(count) : 0;
  }

  // ---- lanes that cannot go on

  struct Refusal {
    std::size_t lane;
    Ending ending;
    double error;
  };
  [[nodiscard]] bool any_refused() const { return refused_count_ > 0; }
  /// Handles those since the last time.
  template <class Handle>
  void take_refused(Handle&& handle) {
    const std::size_t count = std::exchange(refused_count_, 0);
    for (std::size_t i = 0; i < count; ++i) handle(refused_[i]);
  }

 private:
  // The factor of each lane for its next step; those in `good` have accepted the last one.
  [[nodiscard]] Wide factors_of(const Wide& square, const Wide& good, int error_order) {
    const Floats keep_or_not = good.template to<Floats>(), one(1.0F);
    const auto keep = keep_or_not != Floats(0.0F);
    ErrorHistoryOf<Floats> history = errors_;
    const Floats factor = history.accept(controller_, error_order, square.template to<Floats>());
    const Floats bounded = select(rejects_ > Floats(0.0F), min(factor, one), factor);
    errors_.last = select(keep, history.last, errors_.last);
    errors_.before_last = select(keep, history.before_last, errors_.before_last);
    rejects_ = select(keep, Floats(0.0F), rejects_);
    return bounded.template to<Wide>();
  }
  [[gnu::noinline]] void reject(const std::array<double, W>& squares, int error_order, const Statuses* statuses) {
    for (std::size_t lane = 0; lane < W; ++lane) {
      if (!is_active(lane) || accepted_[lane]) continue;
      rejected_[lane] += 1;
      const double square = squares[lane];
      const StepStatus status = statuses ? (*statuses)[lane] : StepStatus::done;
      const bool solved = status == StepStatus::done, finite = square < std::numeric_limits<double>::infinity();
      const double factor = !solved   ? 0.25
                            : !finite ? 0.2
                                      : static_cast<double>(ErrorHistory::reject(
                                            controller_, error_order, static_cast<float>(std::min(square, 1e30))));
      const double begin = t_[lane], h = h_[lane] * factor;
      next_.set(lane, h);
      const bool too_many = rejects_[lane] >= max_rejects_;
      const double spacing = std::numeric_limits<double>::epsilon() * std::max(std::abs(begin), std::abs(begin + h));
      if (std::abs(h) <= 4 * spacing || too_many) {
        refuse(lane,
               status == StepStatus::singular_matrix ? Ending::nonlinear_solve_failed
               : !finite                             ? Ending::not_finite
               : too_many                            ? Ending::too_many_rejects
                                                     : Ending::step_too_small,
               std::sqrt(square));
      }
      rejects_.set(lane, rejects_[lane] + 1.0F);
    }
  }
  // For steps that have not changed t but only the carried rounding error; some may occur at the start of a fast
  // motion.
  [[gnu::noinline]] void stand_still() {
    constexpr std::size_t most = 1000;
    for (std::size_t lane = 0; lane < W; ++lane) {
      if (!accepted_[lane] || last_[lane] || end_[lane] != t_[lane]) continue;
      if (stood_at_[lane] != t_[lane]) stood_at_[lane] = t_[lane], standing_[lane] = 0;
      if (++standing_[lane] >= most) refuse(lane, Ending::step_too_small, 0);
    }
  }
  void refuse(std::size_t lane, Ending ending, double error) {
    for (std::size_t i = 0; i < refused_count_; ++i)
      if (refused_[i].lane == lane) return;
    refused_[refused_count_++] = {lane, ending, error};
  }

  static constexpr double safety_of_count = 2;  // steps: the last ones are looked at one by one
  static constexpr double parts_of_run = 50;

  double begin_, forward_, step_, max_step_;
  bool depends_on_time_;
  Wide longest_;                   // the longest step
  std::array<double, W> reach_{};  // the greatest distance of a limit from the start of the run
  Controller controller_;
  double max_steps_;
  float max_rejects_;

  Wide t_, h_, next_, planned_, limit_, end_, carried_, grid_, grid_steps_, on_grid_;
  Wide active_, steps_;
  Mask last_, short_, accepted_;
  ErrorHistoryOf<Floats> errors_;
  Floats rejects_;  // in a row
  std::array<double, W> rejected_{};
  std::array<std::size_t, W> standing_{};  // in a row
  std::array<double, W> stood_at_{};
  std::array<Refusal, W> refused_{};
  std::size_t refused_count_ = 0;
};

}  // namespace continuo::detail
