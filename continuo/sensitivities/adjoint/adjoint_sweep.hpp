// Goes back over the entries of a run. `w` is the derivative of the objective by the state at the present place, `time`
// that by the instant at which this place lies, as far as what comes after depends on it.
//
// At an event that the motion crosses, the instant t* is the one at which g(t*, y(t*), p) = 0 on the step before, y. So
// with the total derivative D by t*, which is `time` and that along y, and r = dg/dx y' + dg/dt,
//   dt* = -(dg/dx dy + dg/dp dp) / r:   to the seed w of the step comes -D/r dg/dx, and to dG/dp comes -D/r dg/dp.
#pragma once
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include <continuo/numerics/finite.hpp>
#include <continuo/sensitivities/adjoint/step_adjoint.hpp>
#include <continuo/sensitivities/adjoint/steps_recorder.hpp>
#include <continuo/sensitivities/objective.hpp>
#include <continuo/status/status.hpp>

namespace continuo::detail {

template <class F, State X, State P, class Terms>
class AdjointSweep {
 public:
  using Real = Scalar<X>;

  /// All arguments must outlive the sweep.
  AdjointSweep(const StepsOfRun<X>& run, const std::vector<ParametricEvent<X, P>>& events,
               const RungeKuttaTable<Real>& table, const ParameterDerivatives<F, X, P>& derivatives, const P& p,
               const Terms& terms, const X& last)
      : run_(run),
        events_(events),
        p_(p),
        terms_(terms),
        step_(table, derivatives, last, p, terms.integrand),
        lands_(table.is_implicit(table.step_stages - 1)),
        after_(last),
        w_(last),
        seed_(last),
        slopes_{last, {}},
        guard_slopes_{last, {}},
        by_p_(dimension(p)) {}

  /// From the end of the run, at t, to its start.
  [[nodiscard]] Status go_back(const Real& t) {
    for (std::size_t i = 0; i < dimension(w_); ++i) w_.data()[i] = Real(0);
    if constexpr (!std::same_as<decltype(terms_.at_end), NoTerm>) {
      value_ += term_(terms_.at_end, t, after_, p_, slopes_of_term_);
      add_term();
      time_ = slopes_of_term_.back();
    }
    for (std::size_t e = run_.entries.size(); e-- > 0;) {
      const RunEntry& entry = run_.entries[e];
      Status status;
      if (entry.kind == RunEntry::Kind::step) {
        status = pass_step(run_.steps[entry.place], begins_at_moving_event(e));
      } else if (entry.kind == RunEntry::Kind::event) {
        status = pass_event(run_.events[entry.place]);
      } else {
        pass_output(run_.outputs[entry.place]);
      }
      if (!status) return status;
    }
    return {};
  }

  [[nodiscard]] const Real& value() const { return value_; }
  [[nodiscard]] const Real& error_of_integral() const { return error_of_integral_; }
  [[nodiscard]] const X& by_state() const { return w_; }
  [[nodiscard]] const std::vector<Real>& by_parameters() const { return by_p_; }
  [[nodiscard]] DerivativeCosts costs() const { return step_.costs(); }

 private:
  using Integrand = decltype(Terms::integrand);

  [[nodiscard]] bool begins_at_moving_event(std::size_t e) const {
    return e > 0 && run_.entries[e - 1].kind == RunEntry::Kind::event &&
           run_.events[run_.entries[e - 1].place].timing != EventTiming::fixed;
  }

  void add_term() {
    const std::size_t n = dimension(w_);
    for (std::size_t i = 0; i < n; ++i) w_.data()[i] += slopes_of_term_[i];
    for (std::size_t k = 0; k < by_p_.size(); ++k) by_p_[k] += slopes_of_term_[n + k];
  }
  void pass_output(const OutputTaken<X>& output) {
    if constexpr (!std::same_as<decltype(terms_.at_times), NoTerm>) {
      const auto at_time = [&](const auto& t, const auto& x, const auto& p) {
        return terms_.at_times(output.index, t, x, p);
      };
      value_ += term_(at_time, output.t, output.x, p_, slopes_of_term_);
      add_term();
    }
  }

  [[nodiscard]] Status pass_event(const EventTaken<X>& event) {
    const std::size_t n = dimension(w_), m = by_p_.size(), width = n + m + 1;
    static_cast<void>(events_[event.event].act(event.t, event.before, p_, after_, rows_));
    for (std::size_t j = 0; j < n; ++j) seed_.data()[j] = Real(0);
    for (std::size_t i = 0; i < n; ++i) {
      const Real weight = w_.data()[i];
      for (std::size_t j = 0; j < n; ++j) seed_.data()[j] += weight * rows_[i * width + j];
      for (std::size_t k = 0; k < m; ++k) by_p_[k] += weight * rows_[i * width + n + k];
      time_ += weight * rows_[i * width + n + m];
    }
    std::swap(w_, seed_);
    after_ = event.before;
    if (event.timing == EventTiming::fixed) time_ = Real(0);
    crossed_ = event.timing == EventTiming::crossed ? &event : nullptr;
    return {};
  }

  [[nodiscard]] Status pass_step(const StepTaken<X>& step, bool start_moves) {
    const bool by_interpolant = crossed_ != nullptr && !lands_;
    if (!step_.take(step, after_, by_interpolant))
      return {.ending = Ending::nonlinear_solve_failed,
              .message = "the stages of a step could not be computed again: take smaller steps"};
    value_ += step_.integral();
    error_of_integral_ += step_.error_of_integral();
    step_.multiply_left(w_, true, start_moves || crossed_ != nullptr, slopes_);
    const bool interpolates = (by_interpolant || step.truncated) && step.h != Real(0);
    if (crossed_ != nullptr) {
      if (const Status status = meet_guard(interpolates); !status) return status;
    }
    std::swap(w_, slopes_.x);
    for (std::size_t k = 0; k < by_p_.size(); ++k) by_p_[k] += slopes_.p[k];
    // The step ends where it did if it begins later, so that h becomes shorter; of the interpolant theta changes too.
    time_ = slopes_.t - slopes_.h;
    if (interpolates) time_ += ((step.end - step.t) / step.h - Real(1)) * slopes_.end;
    after_ = step.x;
    return {};
  }

  /// Adds to the slopes of the step what its end at the guard gives.
  [[nodiscard]] Status meet_guard(bool interpolates) {
    const EventTaken<X>& event = *std::exchange(crossed_, nullptr);
    const std::size_t n = dimension(w_), m = by_p_.size();
    static_cast<void>(events_[event.event].guard(event.t, event.before, p_, slopes_of_term_));
    for (std::size_t j = 0; j < n; ++j) seed_.data()[j] = slopes_of_term_[j];
    step_.multiply_left(seed_, false, true, guard_slopes_);
    const auto along = [&](const StepSlopes<X>& slopes) { return interpolates ? slopes.end : slopes.h; };
    const Real rate = slopes_of_term_[n + m] + along(guard_slopes_), weight = -(time_ + along(slopes_)) / rate;
    if (!is_finite(weight))
      return {.ending = Ending::cannot_continue,
              .message = "an event, at t = " + std::to_string(static_cast<double>(event.t)) +
                         ", is not crossed with a slope: the motion has no derivative there"};
    for (std::size_t k = 0; k < m; ++k) by_p_[k] += weight * slopes_of_term_[n + k];
    for (std::size_t j = 0; j < n; ++j) slopes_.x.data()[j] += weight * guard_slopes_.x.data()[j];
    for (std::size_t k = 0; k < m; ++k) slopes_.p[k] += weight * guard_slopes_.p[k];
    slopes_.t += weight * guard_slopes_.t;
    slopes_.h += weight * guard_slopes_.h;
    slopes_.end += weight * guard_slopes_.end;
    return {};
  }

  const StepsOfRun<X>& run_;
  const std::vector<ParametricEvent<X, P>>& events_;
  const P& p_;
  const Terms& terms_;
  StepAdjoint<F, X, P, Integrand> step_;
  bool lands_;  // at events: steps of implicit methods end there
  X after_;     // the state at the end of the entry
  X w_, seed_;
  Real time_{};
  StepSlopes<X> slopes_, guard_slopes_;
  std::vector<Real> by_p_;
  const EventTaken<X>* crossed_ = nullptr;  // the event at the end of the next step back
  Real value_{}, error_of_integral_{};
  TracedTerm<X, P> term_;
  std::vector<Real> slopes_of_term_, rows_;
};

}  // namespace continuo::detail
