// Advances W runs of an ensemble together, one per lane: each has its own t and h, and accepts or rejects its own
// steps. A lane whose run ends takes the next one from the list. What a run does is the same as in StepControl,
// operation by operation; nothing that a lane computes depends on its neighbours.
#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <tuple>
#include <utility>
#include <vector>

#include <continuo/ensembles/lanes/lane_sizes.hpp>
#include <continuo/ensembles/lanes/own_runs.hpp>
#include <continuo/ensembles/lanes/pair_of_lane.hpp>
#include <continuo/ensembles/lanes/rosenbrock_lanes.hpp>
#include <continuo/ensembles/lanes/run_of_lane.hpp>
#include <continuo/ensembles/lanes/run_queue.hpp>
#include <continuo/ensembles/lanes/steps_by_system.hpp>
#include <continuo/numerics/bernstein.hpp>
#include <continuo/numerics/finite.hpp>
#include <continuo/numerics/lanes.hpp>
#include <continuo/solve/steps/first_step.hpp>
#include <continuo/system/rebound_state.hpp>

namespace continuo::detail {

template <class F, class Starts, class M, std::size_t W, class... E>
class LaneDriver {
 public:
  using X = StateOf<Starts>;
  using P = ParametersOf<Starts>;
  using Queue = RunQueue<X, P>;
  using Settings = RunSettings<X, P, E...>;

  /// For the runs of a queue that is not empty. It takes them when told to.
  LaneDriver(const F& f, const Starts& starts, const Settings& settings, Queue& queue)
      : f_(f),
        starts_(starts),
        settings_(settings),
        queue_(queue),
        system_{&f_, widened<WideP>(as_run_start(starts[0]).p)},
        x_(widened<WideX>(as_run_start(starts[0]).x)),
        x_new_(x_),
        slope_(x_),
        work_(M::workspace(x_)),
        polynomial_(x_),
        sizes_(settings.options, settings.interval, is_known_to_depend_on_time(f_)),
        tolerance_(settings.options),
        has_rows_(!settings.options.save.times.empty() || settings.watcher) {
    runs_.reserve(W);
    for (std::size_t lane = 0; lane < W; ++lane) runs_.emplace_back(f_, settings_, as_run_start(starts[0]));
    if constexpr (PartOfPair<M>) pairs_.assign(W, {as_run_start(starts[0]).x, settings.options});
    if constexpr (is_rosenbrock) {
      work_.tolerance = tolerance_.all();
      rosenbrock_.emplace(f_, as_run_start(starts[0]), x_, settings.options);
    }
    if constexpr (lands) again_.assign(W, {as_run_start(starts[0]).x, settings.options});
  }
  LaneDriver(const LaneDriver&) = delete;
  LaneDriver& operator=(const LaneDriver&) = delete;

  /// Whether a run is on its way in any lane.
  [[nodiscard]] bool is_active() const { return active_ > 0; }
  /// Whether an idle lane can take a run now.
  [[nodiscard]] bool idle_can_begin() const {
    return active_ < W && !exhausted_ && (!pending_ || queue_.has_room_for(*pending_));
  }
  /// The run that waits for room, if any.
  [[nodiscard]] const std::optional<std::size_t>& pending() const { return pending_; }

  /// Gives every idle lane a run, as long as there are any.
  void refill() {
    for (std::size_t lane = 0; lane < W; ++lane) {
      while (!sizes_.is_active(lane) && !exhausted_) {
        if (!pending_) pending_ = queue_.take();
        if (!pending_) {
          exhausted_ = true;
        } else if (!queue_.has_room_for(*pending_)) {
          return;
        } else {
          begin(*std::exchange(pending_, std::nullopt), lane);
        }
      }
    }
  }

  /// One step of every run.
  void take_step() {
    if (!size_first_steps()) return;
    if (one_by_one_ > 0) --one_by_one_;
    sizes_.choose();
    refresh();
    step();
    end_step();
  }

 private:
  // The step has been made.
  void end_step() {
    if constexpr (PartOfPair<M>) look_for_stiffness();
    judge();
    if (sizes_.any_refused()) [[unlikely]]
      sizes_.take_refused([this](const auto& refusal) { fail(refusal); });
    commit();
    if (sizes_.any_refused()) [[unlikely]]
      sizes_.take_refused([this](const auto& refusal) { fail(refusal); });
    if (++since_look_ >= steps_between_looks) {
      since_look_ = 0;
      if (queue_.interrupted()) interrupt();
    }
  }

  using Wide = Lanes<double, W>;
  using WideX = ReboundState<X, Wide>;
  using WideP = ReboundState<P, Wide>;
  using Run = typename RunKind<F, X, P, M, E...>::Type;
  using Source = typename Run::Source;
  using RosenbrockSteps = StepsOfRosenbrock<M, F, X, P, W>;

  static constexpr bool has_own_runs = HasOwnRuns<F, M>;
  static constexpr bool is_rosenbrock = RosenbrockForLanes<M>;
  static constexpr bool lands = is_rosenbrock && has_own_runs;  // steps are taken again, to end at events

  static constexpr bool is_small = [] {
    if constexpr (FixedSize<X>) {
      return std::tuple_size_v<X> <= 12;
    } else {
      return false;
    }
  }();

 public:
  /// Whether steps of a fixed size may need no look at each.
  static constexpr bool can_step_freely = is_small && !Run::has_events && !is_rosenbrock;
  /// The runs of a driver while they take steps of a fixed size at which nothing is looked at.
  struct FreeMotion {
    SystemWithParameters<F, WideP> system;
    WideX x;
    Kept<WideX> slope;        // f at the start of the next step, where the method computes it
    Wide size, begin, first;  // of the steps, where their grid begins, and how many of it there were
  };
  /// How many such steps no run ends with; 0 where each step is looked at.
  [[nodiscard]] std::size_t free_steps() const {
    const bool looks = !sizes_.fixed() || has_rows_ || (is_active() && one_by_one_ > 0);
    return looks ? 0 : sizes_.free_steps(most_free_steps);
  }
  [[nodiscard]] FreeMotion free_motion() {
    if constexpr (keeps_slope) refresh();
    return {system_, x_, work_.k[0], sizes_.fixed_size(), sizes_.grid(), sizes_.fixed_steps()};
  }
  /// Takes the steps of all motions in turn: while a stage of one waits for the stage before, the processor computes
  /// those of the others. The state of a motion goes through memory, and its stages stay in registers. The motions are
  /// written out: of a loop over them the compiler would make one over several steps of each, which wait for each
  /// other.
  template <std::size_t count, std::size_t... motion>
  [[gnu::flatten, gnu::noinline]] static void take_free_steps(std::array<FreeMotion, count>& motions, std::size_t steps,
                                                              std::index_sequence<motion...>) {
    Wide step(0.0);
    for (std::size_t i = 0; i < steps; ++i, step += Wide(1.0)) (take_free_step(motions[motion], step), ...);
  }
  /// The motion has taken these steps. A component that is not finite stays so, as a step adds to it: one look at the
  /// end is enough. Where there is such a one, the steps are taken again one by one.
  void pass_free_steps(const FreeMotion& motion, std::size_t steps) {
    fresh_ = Wide(0.0);
    if (any(sizes_.active() & (zero_if_all_finite(motion.x) != Wide(0.0)))) [[unlikely]] {
      one_by_one_ = steps;
      return;
    }
    x_ = motion.x;
    if constexpr (keeps_slope) {
      work_.k[0] = motion.slope;
      fresh_ = Wide(1.0);
    }
    sizes_.pass_free_steps(steps);
  }

  /// Whether the system takes many steps of several drivers at once.
  static constexpr bool takes_many_steps = TakesStepsTogether<F> && M::error_order > 0 && !Run::has_events &&
                                           !has_own_runs && !is_rosenbrock && !PartOfPair<M>;
  using MotionOfSystem = MotionBySystem<F, LaneSizes<W>, WideX, WideP>;
  /// Whether it does now: nobody looks at the steps.
  [[nodiscard]] bool can_take_many_steps() {
    return size_first_steps() && !sizes_.fixed() && !has_rows_ && f_.template can_take_steps<M>();
  }
  [[nodiscard]] MotionOfSystem begin_many_steps() {
    refresh();
    return {&f_,      sizes_.numbers(),  &system_.p, &x_, &x_new_, &work_.k.front(), &work_.k[last_stage],
            &square_, !work_.start_fresh};
  }
  [[nodiscard]] StepSizeRules<Wide> step_size_rules() const {
    return {tolerance_.all(), sizes_.controller(), M::error_order, sizes_.forward(),
            sizes_.allowed_steps(most_steps_of_system)};
  }
  void end_many_steps(const MotionOfSystem& motion) {
    fresh_ = Wide(motion.waits || keeps_slope ? 1.0 : 0.0);
    if (!motion.waits) return;
    work_.start_fresh = true;
    work_.end_fresh = keeps_slope;
    has_square_ = true;
    sizes_.choose();
    end_step();
  }

 private:
  // What happens to a lane at the end of its step.
  enum class Next : char { step, ended, begins_anew };

  template <class WideState, class Narrow>
  [[nodiscard]] static WideState widened(const Narrow& narrow) {
    if constexpr (FixedSize<WideState>) {
      WideState wide{};
      for (std::size_t i = 0; i < narrow.size(); ++i) wide.data()[i] = Wide(narrow.data()[i]);
      return wide;
    } else {
      return WideState(narrow.data(), narrow.data() + narrow.size());
    }
  }
  template <class WideState, class Narrow>
  static void put(const Narrow& narrow, std::size_t lane, WideState& wide) {
    for (std::size_t i = 0; i < wide.size(); ++i) wide.data()[i].set(lane, narrow.data()[i]);
  }
  template <class WideState, class Narrow>
  static void get(const WideState& wide, std::size_t lane, Narrow& narrow) {
    for (std::size_t i = 0; i < wide.size(); ++i) narrow.data()[i] = wide.data()[i][lane];
  }

  // ---- runs begin and end

  void begin(std::size_t run, std::size_t lane) {
    auto start = as_run_start(starts_[run]);
    Run& one = runs_[lane];
    sizes_.begin_run(lane);
    if constexpr (is_rosenbrock) rosenbrock_->begin_run(lane, work_);
    ++active_;
    if (start.x.size() != x_.size() || start.p.size() != system_.p.size()) {
      static_cast<void>(one.begin(run, as_run_start(starts_[0])));
      one.end(Ending::invalid_input, "its start has another number of components or parameters than that of run 0");
      return finish(lane);
    }
    if (!one.begin(run, std::move(start))) return finish(lane);
    must_look_.set(lane, one.must_look() ? 1.0 : 0.0);
    if constexpr (PartOfPair<M>) pairs_[lane].begin(one.x());
    begin_motion(lane);
  }
  // The motion of a lane begins, or begins anew after an event, where its run is. Its first step gets a size before it
  // is taken, together with those of others.
  void begin_motion(std::size_t lane) {
    Run& one = runs_[lane];
    if constexpr (PartOfPair<M>) pairs_[lane].begin_anew();
    if constexpr (is_rosenbrock) rosenbrock_->begin_motion(lane);
    put(one.x(), lane, x_);
    put(one.p(), lane, system_.p);
    sizes_.begin_motion(lane, one.t(), one.limit());
    fresh_.set(lane, 0.0);
    if (!sizes_.fixed()) beginning_.set(lane, 1.0), any_begins_ = true;
  }
  // Sizes of the first steps of all motions that have begun. False where no run is left on its way.
  [[nodiscard]] bool size_first_steps() {
    if (!any_begins_) return active_ > 0;
    const Wide size = can_begin_together ? first_sizes() : Wide(0.0);
    for (std::size_t lane = 0; lane < W; ++lane) {
      if (beginning_[lane] == 0 || !sizes_.is_active(lane)) continue;
      double one = size[lane];
      if (one == 0)
        one = runs_[lane].steps().first_size(runs_[lane].limit(), settings_.options, runs_[lane].result().outcome);
      sizes_.set_first_size(lane, one);
      if (one == 0) finish(lane);
    }
    beginning_ = Wide(0.0);
    any_begins_ = false;
    return active_ > 0;
  }
  // As Steps::estimate_first finds them, operation by operation; 0 where f is not finite. That of one motion waits at
  // each operation for the one before, so that those of many take hardly longer.
  [[gnu::noinline]] Wide first_sizes() {
    const Options<X>& options = settings_.options;
    const Wide longest = min(abs(sizes_.limit() - sizes_.t()), Wide(options.max_step));
    const Wide forward(settings_.forward());
    if (options.first_step > 0) return forward * min(Wide(options.first_step), longest);
    WideX f0 = x_, x1 = x_, f1 = x_;
    evaluate(system_, sizes_.t(), x_, f0);
    const auto power = [](const Wide& base, const Wide& exponent) {
      Wide result;
      for (std::size_t lane = 0; lane < W; ++lane) result.set(lane, std::pow(base[lane], exponent[lane]));
      return result;
    };
    const auto choose = [](const auto& condition, const Wide& yes, const Wide& no) {
      return select(condition, yes, no);
    };
    const Wide size = first_step(system_, sizes_.t(), x_, f0, starting_order<M>(), forward, longest, tolerance_.all(),
                                 x1, f1, power, choose);
    return select(zero_if_all_finite(f0) == Wide(0.0), forward * size, Wide(0.0));
  }
  void finish(std::size_t lane) {
    sizes_.end_run(lane);
    --active_;
    auto& result = runs_[lane].result();
    result.steps = sizes_.steps(lane);
    result.rejected = sizes_.rejected(lane);
    queue_.put(runs_[lane].finish());
  }
  // Ends the run of a lane where its next step would begin.
  [[gnu::noinline]] void fail(const typename LaneSizes<W>::Refusal& refusal) {
    const std::size_t lane = refusal.lane;
    if (!sizes_.is_active(lane)) return;
    Run& one = runs_[lane];
    set_place(lane);
    X x_new = one.x();
    if (is_solved(lane)) get(x_new_, lane, x_new);
    one.result().outcome = one.steps().failure({.ending = refusal.ending,
                                                .t = sizes_.t()[lane],
                                                .h = sizes_.h()[lane],
                                                .error = refusal.error,
                                                .x = one.x(),
                                                .x_new = x_new,
                                                .worst = worst_component(lane)},
                                               settings_.options);
    finish(lane);
  }
  // Whether the last step has an end.
  [[nodiscard]] bool is_solved(std::size_t lane) const {
    if constexpr (is_rosenbrock) {
      return rosenbrock_->solved()[lane];
    } else {
      return true;
    }
  }
  void set_place(std::size_t lane) {
    X x = runs_[lane].x();
    get(x_, lane, x);
    runs_[lane].set_place(sizes_.t()[lane], std::move(x));
  }
  [[nodiscard]] std::size_t worst_component(std::size_t lane) const {
    std::size_t worst = 0;
    double greatest = -1;
    for (std::size_t i = 0; i < x_.size(); ++i) {
      const Wide scale = tolerance_.all().scale(i, x_.data()[i], x_new_.data()[i]);
      const Wide part = abs(M::error_of(work_, sizes_.h(), i)) / scale;
      if (part[lane] > greatest) greatest = part[lane], worst = i;
    }
    return worst;
  }
  // The runs that have begun end where they are; no other begins.
  [[gnu::noinline]] void interrupt() {
    for (std::size_t lane = 0; lane < W; ++lane) {
      if (!sizes_.is_active(lane)) continue;
      set_place(lane);
      runs_[lane].end(Ending::interrupted);
      finish(lane);
    }
    exhausted_ = true;
    pending_.reset();
  }

  // ---- steps

  void step() {
    has_square_ = false;
    if constexpr (is_rosenbrock) {
      has_square_ = M::error_order > 0 && !sizes_.fixed();
      rosenbrock_->step(system_, sizes_.t(), x_, sizes_.h(), sizes_.active(), tolerance_.all(), work_, x_new_,
                        has_square_ ? &square_ : nullptr);
    } else if constexpr (is_small) {
      flat_step();
    } else if (!take_own_step()) {
      static_cast<void>(M::step(system_, sizes_.t(), x_, sizes_.h(), false, work_, x_new_));
    }
  }
  // A system may have steps of its own, with the bits of the method's, and the square of their error.
  [[nodiscard]] bool take_own_step() {
    constexpr bool takes_steps = requires(F& f, const Wide& wide, const WideX& x, const WideP& p, WideX& x_new) {
      f.template take_step<M>(wide, x, wide, p, work_, x_new, tolerance_.all(), &square_, true);
    };
    if constexpr (takes_steps) {
      const bool wants_square = M::error_order > 0 && !sizes_.fixed();
      has_square_ =
          f_.template take_step<M>(sizes_.t(), x_, sizes_.h(), system_.p, work_, x_new_, tolerance_.all(),
                                   wants_square ? &square_ : nullptr, has_rows_ || has_own_runs || Source::any_guard);
    }
    return has_square_;
  }
  // As the pair does for one run: what it learns in a step counts in the judgement of that step.
  void look_for_stiffness() {
    for (std::size_t lane = 0; lane < W; ++lane) {
      if (!sizes_.is_active(lane)) continue;
      auto& pair = pairs_[lane];
      if (pair.is_probe_due()) {
        get(x_, lane, pair.x());
        get(work_.k[0], lane, pair.slope());
      }
      pair.look(runs_[lane].steps().system(), sizes_.t()[lane], sizes_.h()[lane]);
    }
  }
  [[nodiscard]] Wide strictness() const {
    std::array<double, W> factors{};
    for (std::size_t lane = 0; lane < W; ++lane) factors[lane] = pairs_[lane].strictness();
    return Wide(factors);
  }
  // Runs that their pair would continue by its stiff method end here.
  void leave_stiff_ones(const std::array<Next, W>& next) {
    for (std::size_t lane = 0; lane < W; ++lane) {
      if (!sizes_.is_active(lane) || !sizes_.accepted()[lane] || next[lane] != Next::step) continue;
      if (pairs_[lane].accept()) continue;
      set_place(lane);
      runs_[lane].end(Ending::cannot_continue);
      finish(lane);
    }
  }

  // With f compiled into it, however often it occurs: a call sends the lanes of a small state through memory.
  [[gnu::flatten]] void flat_step() {
    static_cast<void>(M::step(system_, sizes_.t(), x_, sizes_.h(), false, work_, x_new_));
  }

  // On a workspace that nothing else can see, so that the compiler may keep it in registers.
  static void take_free_step(FreeMotion& motion, const Wide& number) {
    typename M::template Workspace<WideX> work;
    WideX x_new;
    if constexpr (keeps_slope) work.k[0] = motion.slope;
    work.start_fresh = keeps_slope;
    const Wide t = motion.begin + (motion.first + number) * motion.size;
    static_cast<void>(M::step(motion.system, t, motion.x, motion.size, false, work, x_new));
    M::accept(work);
    if constexpr (keeps_slope) motion.slope = work.k[0];
    motion.x = x_new;
  }

  // f at the beginning of the step, for the lanes that have not kept it from the step before.
  void refresh() {
    if constexpr (!is_rosenbrock) refresh_slopes();
  }
  void refresh_slopes() {
    const auto fresh = fresh_ != Wide(0.0), active = sizes_.active();
    work_.start_fresh = true;
    if (none(active & fresh)) {
      if constexpr (is_small) {
        evaluate(system_, sizes_.t(), x_, work_.k[0]);
      } else {
        work_.start_fresh = false;  // the step does that
      }
    } else if (any(active & !fresh)) {
      evaluate(system_, sizes_.t(), x_, slope_);
      for (std::size_t i = 0; i < x_.size(); ++i)
        work_.k[0].data()[i] = select(fresh, work_.k[0].data()[i], slope_.data()[i]);
    }
    fresh_ = Wide(1.0);
  }

  void judge() {
    if constexpr (M::error_order > 0) {
      if (!sizes_.fixed()) {
        if (!has_square_) square_ = M::error_square(work_, sizes_.h(), x_, x_new_, tolerance_.all());
        if constexpr (is_rosenbrock) return sizes_.judge(square_, M::error_order, rosenbrock_->statuses());
        if constexpr (PartOfPair<M>) {
          const Wide norm = strictness() * sqrt(square_);
          square_ = norm * norm;
        }
        return sizes_.judge(square_, M::error_order);
      }
    }
    Wide nothing = zero_if_all_finite(x_new_);
    if constexpr (is_rosenbrock) {
      nothing = select(rosenbrock_->solved(), nothing, Wide(1.0));
      return sizes_.judge_fixed(nothing, rosenbrock_->statuses());
    }
    sizes_.judge_fixed(nothing);
  }

  [[nodiscard]] bool any_guard() const {
    if constexpr (has_own_runs) {
      return f_.any_guard();
    } else {
      return Source::any_guard;
    }
  }

  // The accepted lanes go on to the end of their steps, and what happens on the way happens.
  void commit() {
    std::array<Next, W> next{};
    Wide asked(0.0);  // lanes whose run has evaluated the polynomial of the step
    bool any_next = false;
    if (any_guard()) {
      interpolate();
      asked = Wide(1.0);
      any_next = look_at_lanes(near_guards(), next, asked);
    } else if (Source::any_scheduled || has_own_runs || has_rows_) {
      any_next = look_at_lanes(typename Wide::Mask(false), next, asked);
    } else if (any(sizes_.at_limit())) {
      any_next = true;
      for (std::size_t lane = 0; lane < W; ++lane)
        if (sizes_.at_limit()[lane]) arrive_at_end(lane), next[lane] = Next::ended;
    }
    keep_slopes(asked);
    for (std::size_t i = 0; i < x_.size(); ++i)
      x_.data()[i] = select(sizes_.accepted(), x_new_.data()[i], x_.data()[i]);
    sizes_.commit();
    if constexpr (PartOfPair<M>) leave_stiff_ones(next);
    if (!any_next) [[likely]]
      return;
    for (std::size_t lane = 0; lane < W; ++lane) {
      if (next[lane] == Next::ended) finish(lane);
      if (next[lane] == Next::begins_anew) begin_motion(lane);
    }
  }
  void arrive_at_end(std::size_t lane) {
    X x = runs_[lane].x();
    get(x_new_, lane, x);
    runs_[lane].set_place(sizes_.end()[lane], std::move(x));
    runs_[lane].end(Ending::reached_end);
  }

  // f at the end of a step is that at the start of the next one, where the method computes it, or the polynomial of the
  // step has needed it. It is kept by the lanes that have asked for it, whatever their neighbours do.
  void keep_slopes(const Wide& asked) {
    if constexpr (is_rosenbrock) {
      rosenbrock_->accept(sizes_.accepted());
    } else {
      keep_explicit_slopes(asked);
    }
  }
  void keep_explicit_slopes(const Wide& asked) {
    constexpr bool always = M::tableau.first_same_as_last();
    M::accept(work_, sizes_.accepted());
    if constexpr (!always) fresh_ = select(sizes_.accepted(), asked, fresh_);
  }

  void interpolate() {
    if constexpr (is_small) {
      flat_interpolate();
    } else {
      static_cast<void>(M::interpolate(system_, sizes_.t(), x_, sizes_.h(), x_new_, work_, polynomial_));
    }
  }
  [[gnu::flatten]] void flat_interpolate() {
    static_cast<void>(M::interpolate(system_, sizes_.t(), x_, sizes_.h(), x_new_, work_, polynomial_));
  }

  // Lets the runs of those lanes pass their step in which there is something: a guard near to zero, a row, a tick.
  [[nodiscard]] bool look_at_lanes(const typename Wide::Mask& near, std::array<Next, W>& next, Wide& asked) {
    const auto visited = lanes_to_visit(near);
    skipped_ = select(sizes_.accepted() & !visited, Wide(1.0), skipped_);
    if (none(visited)) return false;
    bool any_next = false, interpolated = any_guard();
    for (std::size_t lane = 0; lane < W; ++lane) {
      if (!visited[lane]) continue;
      Run& one = runs_[lane];
      const double end = sizes_.end()[lane];
      const bool looks = near[lane] || one.must_look() || one.has_row_before(end) || one.is_watched(end);
      if (!looks && !one.ends_at(end)) {
        one.skip_step();
        continue;
      }
      if (looks && !std::exchange(interpolated, true)) interpolate();
      next[lane] = pass_step(lane, asked);
      any_next = any_next || next[lane] != Next::step;
    }
    return any_next;
  }
  // Those whose runs have to be asked. Where only guards are watched, the others have none near to zero and do not end:
  // they are told of the steps that they have skipped when they pass one.
  [[nodiscard]] typename Wide::Mask lanes_to_visit(const typename Wide::Mask& near) const {
    const auto accepted = sizes_.active() & sizes_.accepted();
    if (has_own_runs || Source::any_scheduled || has_rows_) return accepted;
    return accepted & (near | (must_look_ != Wide(0.0)) | (sizes_.end() == Wide(settings_.interval.to)));
  }
  [[nodiscard]] Next pass_step(std::size_t lane, Wide& asked) {
    Run& one = runs_[lane];
    if (skipped_[lane] != 0) {
      one.skip_step();
      skipped_.set(lane, 0.0);
    }
    auto step = one.steps().took(sizes_.t()[lane], sizes_.h()[lane], sizes_.end()[lane]);
    get(x_, lane, step.begin);
    get(x_new_, lane, step.end);
    for (std::size_t j = 0; j < polynomial_.c.size(); ++j) get(polynomial_.c[j], lane, step.polynomial.c[j]);
    if constexpr (PartOfPair<M>) {
      pairs_[lane].x() = step.begin;
      get(work_.k[0], lane, pairs_[lane].slope());
      one.steps().set_again(pairs_[lane]);
    }
    if constexpr (lands) {
      again_[lane].set(step.begin, work_, lane, rosenbrock_->begins(lane));
      one.steps().set_again(again_[lane]);
    }
    const bool changed = one.pass_step();
    must_look_.set(lane, one.must_look() ? 1.0 : 0.0);
    if (one.steps().asked()) asked.set(lane, 1.0);
    if (one.ended()) return Next::ended;
    if (changed) return Next::begins_anew;
    if (Source::any_scheduled || has_own_runs) sizes_.set_limit(lane, one.limit());
    return Next::step;
  }

  // The lanes in which a guard may cross zero in the step: it does not where its distance from zero exceeds its whole
  // range over nine places of the step, see EventLocator.
  [[nodiscard]] typename Wide::Mask near_guards() {
    if constexpr (has_own_runs) {
      return Run::near_guards(runs_, sizes_, polynomial_);
    } else {
      return near_sampled_guards();
    }
  }
  [[nodiscard]] typename Wide::Mask near_sampled_guards() {
    std::array<Wide, Source::count> least, greatest;
    const auto sample = [&](bool first, const Wide& t, const WideX& x) {
      std::size_t i = 0;
      const auto one = [&](const auto& event) {
        if constexpr (has_guard<decltype(event)>) {
          const Wide g = guard_value(event.guard, t, x, system_.p);
          least[i] = first ? g : select(g >= least[i], least[i], g);
          greatest[i] = first ? g : select(g <= greatest[i], greatest[i], g);
        }
        ++i;
      };
      std::apply([&](const auto&... event) { (one(event), ...); }, settings_.events);
    };
    sample(true, sizes_.t(), x_);
    std::conditional_t<is_small, WideX, WideX&> x = slope_;  // of its own: what no guard reads is not computed
    for (std::size_t k = 1; k + 1 < bernstein::count; ++k) {
      const Wide theta(bernstein::nodes[k]);
      polynomial_(theta, x);
      sample(false, sizes_.t() + theta * sizes_.h(), x);
    }
    sample(false, sizes_.end(), x_new_);
    typename Wide::Mask near(false);
    for (std::size_t i = 0; i < Source::count; ++i) {
      if (!is_guard_[i]) continue;
      const Wide range = greatest[i] - least[i];
      near = near | !((least[i] > range) | (greatest[i] < -range));
    }
    return near;
  }

  static constexpr bool can_begin_together = !has_own_runs && !is_rosenbrock;
  static constexpr bool keeps_slope = M::tableau.first_same_as_last();
  static constexpr std::size_t last_stage = M::tableau.stages - 1;  // where it is f at the end
  static constexpr std::size_t steps_between_looks = 64, most_free_steps = 256, most_steps_of_system = 64;
  static constexpr std::array<bool, Source::count> is_guard_{has_guard<E>...};

  F f_;
  const Starts& starts_;
  const Settings& settings_;
  Queue& queue_;
  SystemWithParameters<F, WideP> system_;
  WideX x_, x_new_, slope_;
  typename M::template Workspace<WideX> work_;
  Interpolant<WideX, M::dense_degree> polynomial_;
  LaneSizes<W> sizes_;
  LaneTolerance<W> tolerance_;
  Wide fresh_{0.0};      // 1 where work_ has f at the beginning of the next step
  Wide must_look_{0.0};  // 1 where the run has to be asked at each step
  Wide skipped_{0.0};    // 1 where the run has not been told of all its steps
  Wide square_;          // of the error of the step
  bool has_square_ = false;
  std::vector<Run> runs_;
  std::vector<PairOfLane<M, X>> pairs_;  // where the method is part of one
  std::optional<RosenbrockSteps> rosenbrock_;
  std::vector<StepAgain<M, X>> again_;  // where steps end at events
  bool has_rows_;                       // or somebody who may want to see pieces of the motion
  bool exhausted_ = false;              // no run is left to begin
  std::size_t active_ = 0, since_look_ = 0;
  std::size_t one_by_one_ = 0;          // so many of the next steps are not free: a run escapes in one of them
  Wide beginning_{0.0};                 // 1 where a motion begins, whose first step has no size yet
  bool any_begins_ = false;             // in one of the lanes
  std::optional<std::size_t> pending_;  // a run that waits for room
};

}  // namespace continuo::detail
