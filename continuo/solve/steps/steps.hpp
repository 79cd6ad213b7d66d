// The part of a run's steps that is independent of the method: the place of the last step, the data for the next one,
// and failures. The part of the method is in step_control.hpp.
#pragma once
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>

#include <continuo/methods/method.hpp>
#include <continuo/methods/support/stiffness_watch.hpp>
#include <continuo/numerics/finite.hpp>
#include <continuo/solve/options.hpp>
#include <continuo/solve/outcome.hpp>
#include <continuo/solve/steps/check_input.hpp>
#include <continuo/solve/steps/correct.hpp>
#include <continuo/solve/steps/first_step.hpp>
#include <continuo/solve/steps/step_budget.hpp>
#include <continuo/system/mass.hpp>

namespace continuo {

/// Steps at which nobody looks: none ends at `limit` or beyond `until`, and where guards are watched none has a root of
/// one in it.
template <class Real>
struct QuietSteps {
  Real limit, until;
  std::size_t most;         // at most so many, where their ends are noted in `times`,
  std::size_t most_unseen;  // and so many where they are not
  std::span<Real> times;    // as many as the first number
  bool has_guards;
};

/// The last accepted step and the data for the next one. A step goes from begin() to end(); the next one begins with
/// the state at end(), unless jump() has set another.
template <class System, State X>
class Steps {
 public:
  using Real = Scalar<X>;

  virtual ~Steps() = default;
  [[nodiscard]] virtual std::unique_ptr<Steps> clone() const = 0;

  [[nodiscard]] virtual MethodNeeds needs(const X& x) const = 0;
  /// Takes one accepted step from end(), not beyond limit. After a failure it returns false, and `outcome` tells the
  /// reason.
  [[nodiscard]] virtual bool take(Real limit, const Options<X>& options, Outcome<Real>& outcome) = 0;
  /// The last step's dense output: coefficients in theta = (t - begin) / size, see Interpolant.
  virtual std::span<const X> dense_output() = 0;
  virtual void at_part(Real theta, X& x) = 0;
  /// The same at several places at once, which is faster for small states.
  static constexpr std::size_t parts_at_once = 8;
  virtual void at_parts(std::span<const Real, parts_at_once> thetas, std::span<X, parts_at_once> xs) = 0;
  /// Whether the state within a step must be found by a shorter step, not from the dense output: the polynomial of an
  /// implicit method leaves the slow solution of a stiff system.
  [[nodiscard]] virtual bool lands() const = 0;
  /// Takes the last step again from its beginning, with this size. False where its equations could not be solved: then
  /// the step must be taken again with another size.
  [[nodiscard]] virtual bool retake(Real size, const Options<X>& options) = 0;
  /// Moves the end of the last step to x, which is nearer than the tolerance. The method keeps its history, moved by
  /// the same way. The dense output of the last step stays.
  virtual void move_end(const X& x) = 0;

  [[nodiscard]] System& system() { return system_; }
  [[nodiscard]] const System& system() const { return system_; }
  /// The last step, whatever has jumped since.
  [[nodiscard]] Real begin() const { return step_begin_; }
  [[nodiscard]] Real end() const { return end_; }
  [[nodiscard]] Real size() const { return h_; }
  [[nodiscard]] const X& x_begin() const { return x_begin_; }
  [[nodiscard]] const X& x_end() const { return x_end_; }
  /// Whether the next step begins without a history: at the start of a run, and after a jump.
  [[nodiscard]] bool jumped() const { return jumped_; }
  [[nodiscard]] const Statistics& statistics() const { return statistics_; }
  [[nodiscard]] Statistics& statistics() { return statistics_; }
  /// These steps follow others of the run, of states of another size: what those have cost is kept.
  void follow(const Statistics& earlier) {
    statistics_ = earlier;
    earlier_ = {earlier.jacobians, earlier.factorizations, earlier.linear_solves};
  }

  /// Continues the trajectory from another state, or with another f: step size and history are reset.
  void jump(Real t, const X& x, const Options<X>& options) {
    begin_ = end_ = grid_ = t;
    carried_ = 0;
    grid_steps_ = 0;
    x_end_ = x;
    jumped_ = true;
    moved_ = false;
    errors_ = {};
    step_budget_.forget();
    next_ = fixed(options) ? forward_ * options.step : Real(0);  // 0: to be estimated
  }

  /// Whether x is so near to the end of the last step, from which the next one begins, that the history of the method
  /// is worth keeping: within the tolerance (root mean square).
  [[nodiscard]] bool is_near_end(const X& x, const Options<X>& options) const {
    if (jumped_) return false;
    const Tolerance<Real> weights = tolerance(options);
    const auto part = [&](std::size_t i) {
      const Real from = x_end_.data()[i], to = x.data()[i];
      return to == from ? Real(0) : Real((to - from) / weights.scale(i, from, to));
    };
    return root_mean_square<Real>(dimension(x), part) <= Real(1);
  }

  /// x' at (t, x) by an evaluation of its own; 0 for the unknown of an algebraic equation.
  const X& slope(Real t, const X& x) {
    ++statistics_.evaluations;
    evaluate(system_, t, x, slope_);
    divide_by_mass(system_, slope_);
    return slope_;
  }

  /// Whether stability has limited most steps of an explicit method, in a run of some length.
  [[nodiscard]] bool stiff() const { return probes_ >= least_probes && 2 * stiff_probes_ > probes_; }

  /// The steps that a run to `limit` would need, where stiffness limits them and they are far too many; otherwise 0.
  [[nodiscard]] Real endless(Real limit, const Options<X>& options) const {
    if (!step_budget_.steady()) [[likely]]
      return 0;
    const Real steps = step_budget_.steps_for(limit - end_);
    return steps > Real(StepBudget<Real>::far_beyond) * Real(static_cast<double>(options.max_steps)) ? steps : Real(0);
  }

  /// Takes steps at which nobody looks, where the system takes many at once (own_steps.hpp). Returns how many; the next
  /// one is taken by `take`.
  [[nodiscard]] virtual std::size_t take_quietly([[maybe_unused]] const QuietSteps<Real>& wanted,
                                                 [[maybe_unused]] const Options<X>& options) {
    return 0;
  }

  /// x at a time of the last step, on the dense output.
  void at(Real t, X& x) {
    if (t == end_) {
      x = x_end_;
    } else {
      at_part((t - step_begin_) / h_, x);
    }
  }

  [[nodiscard]] static Tolerance<Real> tolerance(const Options<X>& options) { return tolerance_of(options); }

 protected:
  static constexpr std::size_t first_probe = 1000, probe_every = 50, least_probes = 10;
  static constexpr const char* singular_hint =
      "the solution may be singular here, or f jumps: declare an event at the jump, or loosen the tolerance";

  Steps(System f, X x0, Real t0, Real forward)
      : system_(std::move(f)),
        forward_(forward),
        begin_(t0),
        end_(t0),
        grid_(t0),
        x_begin_(x0),
        x_end_(x0),
        scratch_(x0),
        slope_(std::move(x0)) {}
  Steps(const Steps&) = default;
  Steps(Steps&&) = default;
  Steps& operator=(const Steps&) = default;
  Steps& operator=(Steps&&) = default;

  template <class Archive>
  void transfer_base(Archive& archive) {
    archive(system_, begin_, end_, h_, next_, step_begin_, carried_, grid_, grid_steps_, standing_, stood_at_, jumped_);
    archive(moved_, driven_, errors_, x_begin_, x_end_, slope_, statistics_, earlier_);
    if (dimension(x_begin_) > 0) archive.index(refused_, dimension(x_begin_) - 1);
    transfer_optional(archive, unmoved_);
    transfer_optional(archive, stiffness_);
    archive(probes_, stiff_probes_, step_budget_);
    interpolated_ = false;
  }

  [[nodiscard]] static bool fixed(const Options<X>& options) { return options.step > 0; }
  [[nodiscard]] static bool interrupted(const Options<X>& options) {
    return options.interrupt && options.interrupt->load(std::memory_order_relaxed);
  }

  // From here on x_begin_ is the start of the step; after a failure only the start is valid.
  [[nodiscard]] bool fail(Ending ending, Real error, std::string component, std::string hint, Outcome<Real>& outcome) {
    outcome = {ending, begin_, h_, error, std::move(component), {}, {}, std::move(hint)};
    if (ending != Ending::interrupted) name_wrong_size(outcome);
    end_ = begin_;
    x_end_ = x_begin_;
    jumped_ = true;
    moved_ = false;
    return false;
  }

  // A result of another size counts as not finite (see `evaluate`): here is the reason.
  void name_wrong_size(Outcome<Real>& outcome) {
    std::string why = problem_of_result(system_, begin_, x_begin_);
    if (why.empty()) why = problem_of_result(system_, Real(begin_ + h_), x_begin_);
    if (why.empty()) return;
    outcome = {};
    outcome.ending = Ending::invalid_input;
    outcome.t = begin_;
    outcome.hint = std::move(why);
  }

  // A step whose equations were not solved.
  [[nodiscard]] bool fail_to_solve(StepStatus status, const Options<X>& options, Outcome<Real>& outcome) {
    const char* hint =
        fixed(options)
            ? "Newton's iteration does not converge: take a smaller step, or look for a jump in f and declare "
              "an event there"
            : "Newton's iteration does not converge, however small the step: the solution may be singular or "
              "end here, or f jumps: declare an event at the jump";
    if (status == StepStatus::singular_matrix)
      hint =
          "the matrix of the step's equations is singular: a system with algebraic equations may be of an index above "
          "1, or an unknown appears in no equation";
    return fail(Ending::nonlinear_solve_failed, 0, {}, hint, outcome);
  }

  // The equations of a step spread values that are not finite over all components. An evaluation of f shows the
  // component from which they come.
  [[nodiscard]] bool fail_not_finite(Outcome<Real>& outcome) {
    std::string component = first_not_finite(slope(begin_ + h_, x_begin_));
    if (!component.empty())
      return fail(Ending::not_finite, 0, component,
                  "f is not finite just beyond this state: look for a division by zero, a root or logarithm of a "
                  "negative number, or a solution that grows without bound",
                  outcome);
    return fail(
        Ending::not_finite, 0, {},
        "f is finite at this state, but it, or its Jacobian, is not around it: look for an infinite slope, such "
        "as that of a root at 0, or a solution that grows without bound",
        outcome);
  }

  /// For a step that has not changed t but only the carried rounding error; true after too many of them. Some may occur
  /// at the start of a fast motion.
  [[nodiscard]] bool stands_still() {
    constexpr std::size_t most = 1000;
    if (stood_at_ != begin_) stood_at_ = begin_, standing_ = 0;
    return ++standing_ >= most;
  }

  [[nodiscard]] bool finite_end() const { return detail::is_finite_state(x_end_); }

  [[nodiscard]] std::string first_not_finite(const X& x) const {
    for (std::size_t i = 0; i < dimension(x); ++i)
      if (!detail::is_finite(x.data()[i])) return component_name(system_, i);
    return {};
  }

  /// Moves the end of the step, at the time t, to where the options want it. Returns the square of the way in
  /// tolerances; for signs 0 where no component lies beyond its sign by more than the tolerance. Infinite where there
  /// is no state.
  [[nodiscard]] [[gnu::noinline]] Real correct_end(const Real& t, const Tolerance<Real>& weights,
                                                   const Options<X>& options) {
    moved_ = false;
    keep_unmoved();
    refusal_ = Refusal::none;
    const Real square = options.projection ? project_end(t, weights, options) : keep_signs_of_end(weights, options);
    moved_ = false;
    for (std::size_t i = 0; i < dimension(x_end_); ++i) moved_ = moved_ || x_end_.data()[i] != unmoved_->data()[i];
    return square;
  }

  void keep_unmoved() {
    if (moved_) return;
    unmoved_ = x_end_;
    moved_ = true;
  }

  /// Whether f has driven a component out of its sign that was at its bound already, by several tolerances in all: then
  /// no solution has the sign. f is asked at the bound itself, where that of a decay is 0: what overshoots there is the
  /// method.
  [[nodiscard]] bool leaves_sign(const Tolerance<Real>& weights, const Options<X>& options) {
    using std::abs, std::min;
    if (options.signs.empty()) return false;
    const Real most(10), one(1);
    const std::size_t i = refused_;
    const Real value = x_begin_.data()[i], scale = weights.scale(i, value, value);
    if (abs(value) > scale) return false;
    scratch_ = x_begin_;
    scratch_.data()[i] = Real(0);
    const Real way = h_ * slope(begin_, scratch_).data()[i];
    const bool from_above = options.signs[i] == Sign::nonnegative || options.signs[i] == Sign::positive;
    if (from_above ? way < Real(0) : way > Real(0)) driven_ += min(one, Real(abs(way) / scale));
    return driven_ >= most;
  }

  [[nodiscard]] bool fail_to_correct(Ending ending, Real error, Outcome<Real>& outcome) {
    switch (refusal_) {
      case Refusal::resized:
        return fail(Ending::invalid_input, 0, {}, "the projection changes the number of components", outcome);
      case Refusal::no_state:
        return fail(ending, 0, {}, "the projection finds no state on the invariants, however short the step", outcome);
      case Refusal::sign:
        return fail_to_keep_sign(ending, error, outcome);
      case Refusal::too_far:
      case Refusal::none:
        break;
    }
    return fail(ending, error, {},
                "the projection moves the state by more than the tolerance, however short the step: the step begins "
                "off the invariants, or f leads away from them",
                outcome);
  }

  [[nodiscard]] bool accepted() {
    jumped_ = false;
    ++statistics_.steps;
    return true;
  }

  /// The first h of an adaptive run, for a method of this order.
  [[nodiscard]] bool estimate_first(int order, Real limit, const Options<X>& options, Outcome<Real>& outcome) {
    using std::abs, std::min;
    const Real longest = min(abs(limit - begin_), options.max_step);
    if (options.first_step > 0) {
      next_ = forward_ * min(options.first_step, longest);
      return true;
    }
    slope(begin_, x_begin_);
    if (const std::string component = first_not_finite(slope_); !component.empty())
      return fail(Ending::not_finite, 0, component,
                  "f is not finite at this state: look for a division by zero, a root "
                  "or logarithm of a negative number",
                  outcome);
    next_ = forward_ * first_step(system_, begin_, x_begin_, slope_, order, forward_, longest, tolerance(options),
                                  scratch_, x_end_);
    ++statistics_.evaluations;
    return true;
  }

  // Not inlined, to keep the loop of short steps small.
  [[gnu::noinline]] void probe_stiffness(const X& slope_begin, const Tolerance<Real>& weights, std::size_t max_steps) {
    if (!stiffness_) stiffness_.emplace(x_begin_);
    stiffness_->probe(system_, begin_, x_begin_, slope_begin, weights);
    int evaluations = 1;
    const bool held = stiffness_->holds(system_, begin_, x_begin_, slope_begin, h_, weights, evaluations);
    statistics_.evaluations += static_cast<std::size_t>(evaluations);
    ++probes_;
    if (held) ++stiff_probes_;
    held ? step_budget_.mark(statistics_.steps, max_steps, begin_) : step_budget_.forget();
  }

  [[nodiscard]] bool fail_to_keep_sign(Ending ending, Real error, Outcome<Real>& outcome) {
    const char* hint =
        ending == Ending::cannot_continue
            ? "f drives it out of the sign that is asked of it: no solution keeps it from here on"
            : "it leaves the sign that is asked of it, however short the step: f jumps, or leads far away";
    return fail(ending, error, component_name(system_, refused_), hint, outcome);
  }

  template <class Archive, class Value>
  void transfer_optional(Archive& archive, std::optional<Value>& value) {
    bool is_there = value.has_value();
    archive(is_there);
    if (!is_there) return value.reset();
    if (!value) value.emplace(x_begin_);
    archive(*value);
  }

  enum class Refusal { none, too_far, no_state, resized, sign };

  [[nodiscard]] Real project_end(const Real& t, const Tolerance<Real>& weights, const Options<X>& options) {
    if (!project(options, t, x_end_, scratch_)) {
      refusal_ = dimension(scratch_) == dimension(x_end_) ? Refusal::no_state : Refusal::resized;
      if (refusal_ == Refusal::resized) scratch_ = x_end_;
      return std::numeric_limits<Real>::infinity();
    }
    const Real way = root_mean_square<Real>(dimension(x_end_), [&](std::size_t i) {
      const Real from = unmoved_->data()[i];
      return Real((x_end_.data()[i] - from) / weights.scale_of_step(i, x_begin_.data()[i], from));
    });
    if (!(way <= Real(1))) refusal_ = Refusal::too_far;
    return way * way;
  }

  [[nodiscard]] Real keep_signs_of_end(const Tolerance<Real>& weights, const Options<X>& options) {
    using std::abs;
    Real farthest(0);
    bool all_kept = true;
    for (std::size_t i = 0; i < dimension(x_end_); ++i) {
      const Real value = x_end_.data()[i];
      if (detail::has_sign(options.signs[i], value)) continue;
      all_kept = false;
      const Real beyond = abs(value) / weights.scale_of_step(i, x_begin_.data()[i], value);
      if (beyond > farthest) farthest = beyond, refused_ = i;
    }
    if (all_kept) {
      const Real value = x_end_.data()[refused_];
      if (abs(value) > weights.scale(refused_, value, value)) driven_ = 0;
    } else if (farthest <= Real(1)) {
      keep_signs(options, x_end_);
      return Real(0);  // no reason for shorter steps
    } else {
      refusal_ = Refusal::sign;
    }
    return farthest * farthest;
  }

  System system_;
  Real forward_, begin_, end_, h_{}, next_{};  // begin_: of the next step, once there was a jump
  Real step_begin_ = begin_;
  Real carried_{};  // of adaptive steps: the rounding error of end_
  Real grid_;       // fixed steps are counted from here
  std::size_t grid_steps_ = 0, standing_ = 0;
  Real stood_at_{};  // the time of the last steps that did not change t
  bool jumped_ = true, interpolated_ = false;
  bool corrects_ = false;  // the options may move the end of a step
  bool moved_ = false;     // and they have: the method ended at unmoved_
  std::optional<X> unmoved_;
  Refusal refusal_ = Refusal::none;  // of the last correction
  std::size_t refused_ = 0;          // the component farthest beyond its sign
  Real driven_{};                    // how far f has driven it out, in tolerances
  ErrorHistory errors_;
  X x_begin_, x_end_, scratch_, slope_;
  Statistics statistics_;
  EquationCosts earlier_;  // of the steps before these, see follow()
  std::optional<StiffnessWatch<X>> stiffness_;
  std::size_t probes_ = 0, stiff_probes_ = 0;
  StepBudget<Real> step_budget_;
};

/// Steps as a value: a copy is a checkpoint.
template <class System, State X>
class StepsValue {
 public:
  explicit StepsValue(std::unique_ptr<Steps<System, X>> steps) : steps_(std::move(steps)) {}
  StepsValue(const StepsValue& other) : steps_(other.steps_->clone()) {}
  StepsValue(StepsValue&&) noexcept = default;
  StepsValue& operator=(const StepsValue& other) {
    steps_ = other.steps_->clone();
    return *this;
  }
  StepsValue& operator=(StepsValue&&) noexcept = default;
  ~StepsValue() = default;

  Steps<System, X>& operator*() { return *steps_; }
  const Steps<System, X>& operator*() const { return *steps_; }

 private:
  std::unique_ptr<Steps<System, X>> steps_;
};

}  // namespace continuo
