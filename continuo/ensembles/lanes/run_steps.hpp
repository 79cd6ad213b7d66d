// The last step of one run of an ensemble, as the logic of events asks for it. The steps themselves are taken in lanes.
#pragma once
#include <cmath>
#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <utility>

#include <continuo/ensembles/lanes/pair_of_lane.hpp>
#include <continuo/ensembles/lanes/rosenbrock_step.hpp>
#include <continuo/solve/steps/steps.hpp>

namespace continuo::detail {

/// The degree of the polynomial of a step, as one run alone has it: that of a pair is the greater one of both methods.
template <class M>
inline constexpr int degree_in_lanes = M::dense_degree;
template <PartOfPair M>
inline constexpr int degree_in_lanes<M> = M::Pair::dense_degree;

/// What takes a step of a lane once more, to end at an event.
/// @{
template <class M, State X>
struct StepAgainKind {
  using Type = PairOfLane<M, X>;
};
template <RosenbrockForLanes M, State X>
struct StepAgainKind<M, X> {
  using Type = RosenbrockStep<M, X>;
};
template <class M, State X>
using StepAgain = typename StepAgainKind<M, X>::Type;
/// @}

template <class System, State X, class M>
class RunSteps final : public Steps<System, X> {
  using Base = Steps<System, X>;

 public:
  RunSteps(System system, const X& x, double forward) : Base(std::move(system), x, 0.0, forward), polynomial_(x) {
    for (X& coefficient : polynomial_.c)
      for (std::size_t i = 0; i < dimension(x); ++i) coefficient.data()[i] = 0;
  }

  [[nodiscard]] std::unique_ptr<Base> clone() const override { return std::make_unique<RunSteps>(*this); }
  [[nodiscard]] MethodNeeds needs(const X& x) const override { return needs_of<M>(this->system_, x); }
  /// The lanes take the steps. A driver that asks for one that they have not taken yet is told that the run has come to
  /// its end: it goes on once that is extended.
  [[nodiscard]] bool take(double limit, const Options<X>&, Outcome<double>& outcome) override {
    limit_ = limit;
    waits_ = !std::exchange(has_step_, false);
    if (waits_) outcome = {.ending = Ending::reached_end, .t = this->end_};
    return !waits_;
  }
  /// Whether the driver waits for a step, and how far that may go.
  [[nodiscard]] bool waits() const { return waits_; }
  [[nodiscard]] double limit() const { return limit_; }
  std::span<const X> dense_output() override { return polynomial().c; }
  void at_part(double theta, X& x) override { polynomial()(theta, x); }
  void at_parts(std::span<const double, Base::parts_at_once> thetas, std::span<X, Base::parts_at_once> xs) override {
    polynomial()(thetas, xs);
  }
  /// The steps of a stiff method end at events, and those of a pair, as where its stiff method takes them.
  [[nodiscard]] bool lands() const override { return PartOfPair<M> || RosenbrockForLanes<M>; }
  [[nodiscard]] bool retake(double size, const Options<X>&) override {
    const bool is_solved = again_->retake(this->system_, this->begin_, size, this->x_end_);
    this->h_ = size;
    this->end_ = this->begin_ + size;
    this->interpolated_ = false;
    is_retaken_ = true;
    return is_solved && this->finite_end();
  }
  void move_end(const X&) override {}

  /// What takes the step of this run once more.
  void set_again(StepAgain<M, X>& again) { again_ = &again; }

  /// A new run: no step yet.
  void begin_run(double t, const X& x, const Options<X>& options) {
    this->h_ = 0;
    this->step_begin_ = t;
    has_step_ = waits_ = false;
    this->statistics_ = {};
    this->jump(t, x, options);
  }

  /// The size of the first step from the state of the last jump; 0 where there is none, with the reason.
  [[nodiscard]] double first_size(double limit, const Options<X>& options, Outcome<double>& outcome) {
    this->x_begin_ = this->x_end_;
    this->next_ = 0;
    const bool found = this->estimate_first(starting_order<M>(), limit, options, outcome);
    return found ? this->next_ : 0.0;
  }

  /// The step that the lanes have taken; its ends and its polynomial are written to the references.
  struct Ends {
    X &begin, &end;
    Interpolant<X, degree_in_lanes<M>>& polynomial;
  };
  [[nodiscard]] Ends took(double begin, double size, double end) {
    this->begin_ = this->step_begin_ = begin;
    this->h_ = size;
    this->end_ = end;
    this->jumped_ = false;
    asked_ = waits_ = is_retaken_ = false;
    has_step_ = true;
    return {this->x_begin_, this->x_end_, polynomial_};
  }

  /// Whether the step has been taken again, with another end.
  [[nodiscard]] bool is_retaken() const { return is_retaken_; }
  /// Whether the polynomial of the step has been evaluated.
  [[nodiscard]] bool asked() const { return asked_; }

  /// A step of size h from x at t that is not accepted, or not tried.
  struct Refused {
    Ending ending;
    double t, h, error;
    const X &x, &x_new;
    std::size_t worst;  // the component of the greatest error
  };
  /// Why it is not, as `solve` says it.
  [[nodiscard]] Outcome<double> failure(const Refused& step, const Options<X>& options) {
    Outcome<double> outcome;
    this->jump(step.t, step.x, options);
    this->x_begin_ = step.x;
    this->h_ = step.h;
    const auto fail = [&](std::string component, const char* hint) {
      static_cast<void>(this->fail(step.ending, step.error, std::move(component), hint, outcome));
    };
    if (step.ending == Ending::too_many_steps) {
      fail({}, "raise max_steps or loosen the tolerance");
    } else if (step.ending == Ending::nonlinear_solve_failed) {
      static_cast<void>(this->fail_to_solve(StepStatus::singular_matrix, options, outcome));
    } else if (Base::fixed(options) && step.ending == Ending::not_finite) {
      fail(this->first_not_finite(step.x_new),
           "f, its Jacobian or the state is not finite: take a smaller step, or a method with error control");
    } else if (Base::fixed(options)) {
      fail({}, "the step is below the spacing of numbers at t: take a longer one");
    } else if (step.ending == Ending::not_finite) {
      static_cast<void>(this->fail_not_finite(outcome));
    } else {
      fail(component_name(this->system_, step.worst), Base::singular_hint);
    }
    return outcome;
  }

 private:
  [[nodiscard]] const Interpolant<X, degree_in_lanes<M>>& polynomial() {
    asked_ = true;
    if (is_retaken_ && !std::exchange(this->interpolated_, true))
      again_->interpolate(this->system_, this->begin_, this->h_, this->x_end_, polynomial_);
    return polynomial_;
  }

  Interpolant<X, degree_in_lanes<M>> polynomial_;
  StepAgain<M, X>* again_ = nullptr;
  double limit_ = 0;
  bool asked_ = false, has_step_ = false, waits_ = false, is_retaken_ = false;
};

}  // namespace continuo::detail
