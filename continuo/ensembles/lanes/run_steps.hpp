// The last step of one run of an ensemble, as the logic of events asks for it. The steps themselves are taken in lanes.
#pragma once
#include <cmath>
#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <utility>

#include <continuo/solve/steps/steps.hpp>

namespace continuo::detail {

template <class System, State X, class M>
class RunSteps final : public Steps<System, X> {
  using Base = Steps<System, X>;

 public:
  RunSteps(System system, const X& x, double forward) : Base(std::move(system), x, 0.0, forward), polynomial_(x) {}

  [[nodiscard]] std::unique_ptr<Base> clone() const override { return std::make_unique<RunSteps>(*this); }
  [[nodiscard]] MethodNeeds needs(const X& x) const override { return needs_of<M>(this->system_, x); }
  [[nodiscard]] bool take(double, const Options<X>&, Outcome<double>&) override { return false; }  // lanes do
  std::span<const X> dense_output() override {
    asked_ = true;
    return polynomial_.c;
  }
  void at_part(double theta, X& x) override {
    asked_ = true;
    polynomial_(theta, x);
  }
  void at_parts(std::span<const double, Base::parts_at_once> thetas, std::span<X, Base::parts_at_once> xs) override {
    asked_ = true;
    polynomial_(thetas, xs);
  }
  [[nodiscard]] bool lands() const override { return false; }
  [[nodiscard]] bool retake(double, const Options<X>&) override { return false; }
  void move_end(const X&) override {}

  /// A new run: no step yet.
  void begin_run(double t, const X& x, const Options<X>& options) {
    this->h_ = 0;
    this->step_begin_ = t;
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
    Interpolant<X, M::dense_degree>& polynomial;
  };
  [[nodiscard]] Ends took(double begin, double size, double end) {
    this->begin_ = this->step_begin_ = begin;
    this->h_ = size;
    this->end_ = end;
    this->jumped_ = false;
    asked_ = false;
    return {this->x_begin_, this->x_end_, polynomial_};
  }

  /// Whether the polynomial of the step has been evaluated.
  [[nodiscard]] bool asked() const { return asked_; }

  /// Why no step from x at t is accepted, as `solve` says it.
  [[nodiscard]] Outcome<double> failure(Ending ending, double t, double h, double error, const X& x, std::size_t worst,
                                        const Options<X>& options) {
    Outcome<double> outcome;
    this->jump(t, x, options);
    this->x_begin_ = x;
    this->h_ = h;
    if (ending == Ending::not_finite) {
      static_cast<void>(this->fail_not_finite(outcome));
    } else {
      const bool steps = ending == Ending::too_many_steps;
      static_cast<void>(this->fail(ending, error, steps ? std::string() : component_name(this->system_, worst),
                                   steps ? "raise max_steps or loosen the tolerance" : Base::singular_hint, outcome));
    }
    return outcome;
  }

 private:
  Interpolant<X, M::dense_degree> polynomial_;
  bool asked_ = false;
};

}  // namespace continuo::detail
