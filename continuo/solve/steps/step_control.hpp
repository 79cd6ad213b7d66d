// Takes the steps of a run: attempts a step, measures its error, accepts or rejects it, and adapts the step size. The
// driver handles events.
#pragma once
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <utility>

#include <continuo/methods/support/weighted_norm.hpp>
#include <continuo/numerics/finite.hpp>
#include <continuo/solve/steps/consistent.hpp>
#include <continuo/solve/steps/own_steps.hpp>
#include <continuo/solve/steps/steps.hpp>

namespace continuo {

/// The steps of one method.
template <class System, State X, class M>
class StepControl final : public Steps<System, X> {
  using Base = Steps<System, X>;

 public:
  using Real = Scalar<X>;
  using Work = typename M::template Workspace<X>;

  StepControl(System f, X x0, Real t0, Real forward, const Options<X>& options)
      : Base(std::move(f), x0, t0, forward), work_(M::workspace(x0)), interpolant_(x0), origin_(t0) {
    this->corrects_ = corrects(options);
    this->jump(t0, x0, options);
  }

  [[nodiscard]] std::unique_ptr<Base> clone() const override { return std::make_unique<StepControl>(*this); }

  /// For checkpoints: what the next step depends on. Of the last step the dense output is not kept.
  template <class Archive>
  void transfer(Archive& archive) {
    this->transfer_base(archive);
    archive(work_, origin_, reach_, began_anew_);
  }

  [[nodiscard]] MethodNeeds needs(const X& x) const override { return needs_of<M>(system_, x); }

  [[nodiscard]] bool take(Real limit, const Options<X>& options, Outcome<Real>& outcome) override {
    advance_to_end();
    if constexpr (M::error_order > 0) {
      if (!fixed(options)) {
        if (next_ == 0 && !this->estimate_first(detail::starting_order<M>(), limit, options, outcome)) return false;
        return take_adaptive(limit, options, outcome);
      }
    }
    return take_fixed(limit, options, outcome);
  }

  [[nodiscard]] std::size_t take_quietly(const QuietSteps<Real>& wanted, const Options<X>& options) override {
    if (jumped_ || moved_ || corrects_ || fixed(options) || next_ == 0) return 0;
    [[maybe_unused]] const auto own = [&](X& slope, std::size_t most) {
      return detail::OwnSteps<X>{.t = end_,
                                 .x = x_end_,
                                 .next = next_,
                                 .carried = carried_,
                                 .errors = errors_,
                                 .slope = slope,
                                 .limit = wanted.limit,
                                 .longest = longest_step(wanted.limit, options),
                                 .until = wanted.until,
                                 .forward = forward_,
                                 .most = std::min(most, steps_before_probe()),
                                 .tolerance = tolerance(options),
                                 .controller = options.controller,
                                 .times = wanted.times.data(),
                                 .has_guards = wanted.has_guards};
    };
    std::size_t made = 0;
    if constexpr (detail::TakesManySteps<System, M, X>) {
      constexpr bool ends_with_f = M::tableau.first_same_as_last();
      // What was computed for the polynomial of the last step is f at another rounding of the time.
      const bool has_slope = work_.end_fresh;
      if (wanted.has_guards || has_slope != ends_with_f) return 0;
      made = system_.template take_steps<M>(own(work_.k[M::tableau.stages - 1], wanted.most_unseen));
      statistics_.evaluations += made * (M::tableau.stages - (ends_with_f ? 1 : 0));
    } else if constexpr (detail::MethodTakesManySteps<System, M, X>) {
      made = M::take_steps(system_, own(this->scratch_, wanted.most), work_);
      statistics_.evaluations += made * M::evaluations_of_step(work_);
    }
    statistics_.steps += made;
    return made;
  }

  [[nodiscard]] const Interpolant<X, M::dense_degree>& interpolant() {
    if (!interpolated_) {
      const X& x_new = moved_ ? *unmoved_ : x_end_;
      statistics_.evaluations +=
          static_cast<std::size_t>(M::interpolate(system_, begin_, x_begin_, h_, x_new, work_, interpolant_));
      if (moved_) [[unlikely]]
        bend();
      interpolated_ = true;
    }
    return interpolant_;
  }
  [[nodiscard]] std::span<const X> dense_output() override { return interpolant().c; }
  void at_part(Real theta, X& x) override {
    if constexpr (requires { M::at_part(std::as_const(work_), h_, theta, x); }) {
      if (!moved_) return M::at_part(std::as_const(work_), h_, theta, x);
    }
    interpolant()(theta, x);
  }
  void at_parts(std::span<const Real, Base::parts_at_once> thetas, std::span<X, Base::parts_at_once> xs) override {
    interpolant()(thetas, xs);
  }

  [[nodiscard]] bool lands() const override { return detail::is_implicit<M>(); }
  [[nodiscard]] bool retake(Real size, const Options<X>& options) override {
    if constexpr (detail::HasRetaken<M, Work>) M::retaken(work_);
    jumped_ = began_anew_;
    attempt(size, options);
    jumped_ = false;
    interpolated_ = false;
    end_ = begin_ + size;
    carried_ = 0;
    if (detail::status_of<M>(work_) != StepStatus::done || !finite_end()) return false;
    if (!corrects_) [[likely]]
      return true;
    const Real square = this->correct_end(end_, tolerance_of_step(size, options), options);
    return fixed(options) ? square < std::numeric_limits<Real>::infinity() : square <= Real(1);
  }
  void move_end(const X& x) override {
    static_cast<void>(interpolant());  // to where it was
    this->keep_unmoved();
    x_end_ = x;
  }

 private:
  using Base::accepted, Base::fail, Base::fail_to_solve, Base::finite_end, Base::first_not_finite, Base::fixed,
      Base::interrupted, Base::singular_hint, Base::tolerance;
  using Base::begin_, Base::carried_, Base::corrects_, Base::earlier_, Base::end_, Base::errors_, Base::forward_,
      Base::grid_, Base::grid_steps_, Base::h_, Base::interpolated_, Base::jumped_, Base::moved_, Base::next_,
      Base::statistics_, Base::step_begin_, Base::system_, Base::unmoved_, Base::x_begin_, Base::x_end_;

  void advance_to_end() {
    if (!jumped_) {
      M::accept(work_);
      if (moved_) [[unlikely]]
        tell_of_move();
    }
    moved_ = false;
    begin_ = step_begin_ = end_;
    std::swap(x_begin_, x_end_);
    interpolated_ = false;
  }

  [[gnu::noinline]] void tell_of_move() {
    if constexpr (detail::HasMoved<M, X, Work>) M::moved(work_, *unmoved_, x_end_);
  }

  // The polynomial ends where the step was moved to. What is added has no slope at both ends, as far as the degree
  // allows: theta^2 (3 - 2 theta), or theta.
  [[gnu::noinline]] void bend() {
    for (std::size_t i = 0; i < dimension(x_end_); ++i) {
      const Real way = x_end_.data()[i] - unmoved_->data()[i];
      if constexpr (M::dense_degree >= 3) {
        interpolant_.c[2].data()[i] += 3 * way;
        interpolant_.c[3].data()[i] -= 2 * way;
      } else {
        interpolant_.c[1].data()[i] += way;
      }
    }
  }

  void attempt(Real h, const Options<X>& options) {
    h_ = h;
    moved_ = false;
    began_anew_ = jumped_;
    if constexpr (detail::HasSetTolerance<M, X, Work>) M::set_tolerance(work_, tolerance_of_step(h, options));
    statistics_.evaluations += static_cast<std::size_t>(M::step(system_, begin_, x_begin_, h, jumped_, work_, x_end_));
    detail::keep_size(x_begin_, x_end_);
    if constexpr (detail::HasCosts<M, Work>) {
      const EquationCosts costs = M::costs(work_);
      statistics_.jacobians = earlier_.jacobians + costs.jacobians;
      statistics_.factorizations = earlier_.factorizations + costs.factorizations;
      statistics_.linear_solves = earlier_.linear_solves + costs.linear_solves;
    }
  }

  /// The tolerance by which the error of a step of size h is measured.
  [[nodiscard]] Tolerance<Real> tolerance_of_step(const Real& h, const Options<X>& options) const {
    using std::abs, std::max, std::min;
    constexpr double times_rounded = 4;
    Tolerance<Real> weights = tolerance(options);
    if constexpr (detail::is_implicit<M>() && (HasMassDiagonal<System, X> || HasMassMatrix<System, X>)) {
      if (!has_mass<X>(system_)) return weights;
      const Real spacing = std::numeric_limits<Real>::epsilon() * max(abs(begin_), abs(begin_ + h));
      weights.rounding_of_time = min(Real(greatest_rounding_of_time), Real(times_rounded) * spacing / abs(h));
    }
    return weights;
  }

  /// The square of M::error_norm, without computing its root where the method provides that. Not a number where a
  /// component of x_end_ is not finite: an estimate may not contain all components.
  [[nodiscard]] Real error_square(const Tolerance<Real>& weights) const {
    if constexpr (detail::HasErrorSquare<M, X, Work>) {
      return M::error_square(work_, h_, x_begin_, x_end_, weights);
    } else {
      const Real norm = M::error_norm(work_, h_, x_begin_, x_end_, weights);
      return norm * norm + detail::zero_if_all_finite(x_end_);
    }
  }

  [[nodiscard, gnu::always_inline]] bool take_fixed(Real limit, const Options<X>& options, Outcome<Real>& outcome) {
    // The grid is computed afresh at each step, so a million steps do not drift.
    const Real nominal = forward_ * options.step;
    const Real on_grid = grid_ + Real(grid_steps_ + 1) * nominal;
    using std::abs;
    const bool last = forward_ * (on_grid - limit) > Real(-1e-9) * options.step;
    const bool short_step = last && abs(on_grid - limit) > Real(1e-9) * options.step;
    if (!last && on_grid == begin_) {
      h_ = nominal;
      return fail(Ending::step_too_small, 0, {}, "the step is below the spacing of numbers at t: take a longer one",
                  outcome);
    }
    attempt(short_step ? limit - begin_ : nominal, options);
    const StepStatus status = detail::status_of<M>(work_);
    if (status == StepStatus::newton_diverged || status == StepStatus::singular_matrix)
      return fail_equations(status, options, outcome);
    if (status == StepStatus::not_finite || !finite_end()) {
      return fail(Ending::not_finite, 0, first_not_finite(x_end_),
                  "f, its Jacobian or the state is not finite: take a smaller step, or a method with error control",
                  outcome);
    }
    end_ = last ? limit : on_grid;
    if (corrects_) [[unlikely]] {
      if (!correct_fixed(options, outcome)) return false;
    }
    ++grid_steps_;
    if (short_step) grid_ = limit, grid_steps_ = 0;
    return accepted();
  }

  static constexpr int parts_of_run = 50;
  static constexpr std::size_t rejects_before_settling = 4;
  static constexpr double least_off = 1e-3;  // tolerances
  static constexpr bool sizes_its_steps = requires { requires M::sizes_its_steps; };
  static constexpr bool watches_stiffness = !detail::is_implicit<M>() && M::error_order > 0;

  [[nodiscard]] bool take_adaptive(Real limit, const Options<X>& options, Outcome<Real>& outcome) {
    using std::abs, std::max, std::min, std::sqrt;
    const Real epsilon = std::numeric_limits<Real>::epsilon();
    Tolerance<Real> weights = tolerance(options);
    const Real room = limit - begin_;
    bool was_rejected = false, last_not_finite = false;
    Real error = 0, h = next_;
    if (const Real longest = longest_step(limit, options); abs(h) > longest) [[unlikely]]
      h = forward_ * longest;
    for (std::size_t rejects = 0;; ++rejects) {
      // A remainder below 1 % of h before the limit is absorbed into this step.
      const bool last = forward_ * (Real(1.01) * h - room) >= 0;
      if (last) [[unlikely]] {
        attempt(room, options);
      } else {
        attempt(h, options);
      }
      weights = tolerance_of_step(h_, options);
      const bool solved = detail::status_of<M>(work_) == StepStatus::done;
      Real square = solved ? error_square(weights) : std::numeric_limits<Real>::infinity();
      if (has_fault()) return fail_by_method(outcome);
      bool corrected = true;
      if (corrects_ && square <= 1) [[unlikely]] {
        const Real way = this->correct_end(last ? limit : Real(begin_ + h_), weights, options);
        corrected = way <= 1;
        square = detail::greater(square, way);
      }
      // Also false where `square` is NaN, which it is where x_end_ is not finite.
      const bool finite = square < std::numeric_limits<Real>::infinity();
      if (finite && square <= 1) {
        if (moved_ && this->leaves_sign(weights, options)) [[unlikely]]
          return this->fail_to_keep_sign(Ending::cannot_continue, sqrt(square), outcome);
        const Real factor = factor_after(static_cast<float>(square), was_rejected, weights, options);
        if (has_fault()) return fail_by_method(outcome);
        if (last) [[unlikely]] {
          // A step that was shortened by the limit says little about the next one, which is no shorter than planned.
          next_ = forward_ * max(abs(h), abs(h_) * factor);
          end_ = limit;
          carried_ = 0;
        } else {
          next_ = h_ * factor;
          // The rounding error of the sum is carried to the next step (W. Kahan), so that a million steps do not drift.
          const Real wanted = h_ + carried_;
          end_ = begin_ + wanted;
          carried_ = wanted - (end_ - begin_);
          if (end_ == begin_ && this->stands_still()) [[unlikely]]
            return fail(Ending::step_too_small, sqrt(square), worst_component(weights), singular_hint, outcome);
        }
        if constexpr (watches_stiffness) {
          if (statistics_.steps % Base::probe_every == 0 && statistics_.steps >= Base::first_probe &&
              stability_may_limit()) [[unlikely]]
            this->probe_stiffness(M::derivative(work_), weights, options.max_steps);
        }
        return accepted();
      }
      ++statistics_.rejected;
      was_rejected = true;
      last_not_finite = detail::status_of<M>(work_) == StepStatus::not_finite || (solved && !finite);
      error = sqrt(square);
      h = h_ * factor_of_rejected(solved, finite, static_cast<float>(min(square, Real(1e30))), options);
      if constexpr (detail::HasRejected<M, X, Work>) M::rejected(work_, h);
      if (!corrected && this->leaves_sign(weights, options)) [[unlikely]]
        return this->fail_to_keep_sign(Ending::cannot_continue, error, outcome);
      if constexpr (HasMassDiagonal<System, X>) {
        if (rejects == rejects_before_settling) settle_unknowns(weights);
      }
      if (abs(h) <= 4 * epsilon * max(abs(begin_), abs(begin_ + h)) || rejects >= options.max_rejects_in_a_row ||
          interrupted(options)) {
        if (!corrected && !interrupted(options))
          return this->fail_to_correct(
              rejects >= options.max_rejects_in_a_row ? Ending::too_many_rejects : Ending::step_too_small, error,
              outcome);
        return give_up(rejects >= options.max_rejects_in_a_row, last_not_finite, error, weights, options, outcome);
      }
    }
  }

  // Not inlined, as all that few runs need: the loop of short steps is faster by a third if it fits the registers.
  [[nodiscard, gnu::noinline]] bool correct_fixed(const Options<X>& options, Outcome<Real>& outcome) {
    if (this->correct_end(end_, tolerance(options), options) < std::numeric_limits<Real>::infinity()) return true;
    return this->fail_to_correct(Ending::cannot_continue, 0, outcome);
  }

  [[nodiscard]] bool has_fault() const {
    if constexpr (detail::HasFault<M, Work>) {
      return !std::string_view(M::fault(work_)).empty();
    } else {
      return false;
    }
  }
  [[nodiscard]] bool fail_by_method(Outcome<Real>& outcome) {
    if constexpr (detail::HasFault<M, Work>) {
      return fail(Ending::invalid_input, 0, {}, std::string(M::fault(work_)), outcome);
    } else {
      return false;
    }
  }

  // The steps before the next one after which stiffness is looked for.
  [[nodiscard]] std::size_t steps_before_probe() const {
    const std::size_t since = statistics_.steps % Base::probe_every;
    return since == 0 && statistics_.steps >= Base::first_probe ? 0 : Base::probe_every - since;
  }

  // A stabilised method adds stages where the stability of a step needs them.
  [[nodiscard]] bool stability_may_limit() const {
    if constexpr (detail::HasStabilityLimits<M, Work>) {
      return M::stability_limits(work_);
    } else {
      return true;
    }
  }

  // Solves for the unknowns of algebraic equations again, at the start of the step. Where the previous step has ended
  // with an unknown that does not satisfy its equation, no h makes the error smaller; where a diode begins to conduct,
  // an error estimate may have missed this.
  void settle_unknowns(const Tolerance<Real>& weights) {
    if (!has_mass<X>(system_)) return;
    X settled = x_begin_;
    const Consistency found = make_consistent(system_, begin_, settled, weights);
    statistics_.evaluations += static_cast<std::size_t>(found.evaluations);
    if (!found) return;
    std::swap(x_begin_, settled);
    for (std::size_t i = 0; i < dimension(settled); ++i) settled.data()[i] -= x_begin_.data()[i];
    // The method restarts only where its initial values were wrong.
    jumped_ = jumped_ || weighted_norm(settled, x_begin_, x_begin_, weights) > least_off;
  }

  // The longest step of a system that is known to depend on time (a model tells this, a function alone does not). No
  // step shows how f depends on later times: while the solution is at rest, steps would grow until one of them has a
  // whole pulse of an input between its stages. So steps are at most a fiftieth of the run as far as it is known, the
  // resolution of a plot of it.
  [[nodiscard]] Real longest_step(Real limit, const Options<X>& options) {
    using std::abs, std::max, std::min;
    if (!is_known_to_depend_on_time(system_)) return options.max_step;
    reach_ = max(reach_, Real(abs(limit - origin_)));
    return min(options.max_step, reach_ / Real(parts_of_run));
  }

  [[nodiscard]] Real factor_after(float error_square, bool was_rejected, const Tolerance<Real>& weights,
                                  const Options<X>& options) {
    using std::min;
    float factor = 1;
    if constexpr (!sizes_its_steps)
      factor = errors_.accept(options.controller, detail::error_order_of<M>(work_), error_square);
    if (was_rejected) factor = min(factor, 1.0F);
    if constexpr (detail::HasNextFactor<M, X, Work>) {
      const Real wanted = M::next_factor(work_, Real(factor), h_, x_begin_, x_end_, weights);
      if (!(wanted > 0)) [[unlikely]]  // time would stop, or run backwards
        return Real(factor);
      return was_rejected ? min(wanted, Real(1)) : wanted;
    } else {
      return Real(factor);
    }
  }

  [[nodiscard]] Real factor_of_rejected(bool solved, bool finite, float error_square, const Options<X>& options) const {
    if (!solved) return Real(0.25);
    if (!finite) return Real(0.2);
    return Real(ErrorHistory::reject(options.controller, detail::error_order_of<M>(work_), error_square));
  }

  [[nodiscard]] bool give_up(bool too_many, bool not_finite, Real error, const Tolerance<Real>& weights,
                             const Options<X>& options, Outcome<Real>& outcome) {
    if (interrupted(options)) return fail(Ending::interrupted, error, {}, {}, outcome);
    if (const StepStatus status = detail::status_of<M>(work_); status != StepStatus::done && !not_finite)
      return fail_equations(status, options, outcome);
    if (not_finite) return this->fail_not_finite(outcome);
    return fail(too_many ? Ending::too_many_rejects : Ending::step_too_small, error, worst_component(weights),
                singular_hint, outcome);
  }

  [[nodiscard, gnu::noinline]] bool fail_equations(StepStatus status, const Options<X>& options,
                                                   Outcome<Real>& outcome) {
    if constexpr (detail::HasFailure<M, Work>) {
      if (const std::string_view why = M::failure(work_); !why.empty())
        return fail(Ending::nonlinear_solve_failed, 0, {}, std::string(why), outcome);
    }
    return fail_to_solve(status, options, outcome);
  }

  [[nodiscard]] std::string worst_component(const Tolerance<Real>& weights) const {
    using std::abs;
    std::size_t worst = 0;
    Real greatest = -1;
    for (std::size_t i = 0; i < dimension(x_begin_); ++i) {
      const Real part = abs(M::error_of(work_, h_, i)) / weights.scale_of_step(i, x_begin_.data()[i], x_end_.data()[i]);
      if (part > greatest) greatest = part, worst = i;
    }
    return dimension(x_begin_) == 0 ? std::string{} : component_name(system_, worst);
  }

  Work work_;
  Interpolant<X, M::dense_degree> interpolant_;
  Real origin_, reach_{};   // the start of the run, and the greatest distance of a limit from it
  bool began_anew_ = true;  // the last step: nothing was kept from before it
};

}  // namespace continuo
