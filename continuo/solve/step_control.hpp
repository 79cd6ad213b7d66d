// continuo/solve/step_control.hpp
// Takes accepted steps: tries, measures the error, rejects, shrinks, grows. Knows nothing of events.
#pragma once
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <string>
#include <utility>

#include <continuo/methods/method.hpp>
#include <continuo/methods/stiffness_watch.hpp>
#include <continuo/solve/first_step.hpp>
#include <continuo/solve/options.hpp>
#include <continuo/solve/outcome.hpp>
#include <continuo/solve/pace.hpp>
#include <continuo/system/mass.hpp>

namespace continuo {

/// The last accepted step and what the next one needs. Steps run from begin() to end(); the state at end() is where
/// the next begins unless jump() says otherwise.
template <class System, State X, class M>
class StepControl {
 public:
  using Real = Scalar<X>;

  StepControl(System f, X x0, Real t0, Real forward, const Options<X>& options)
      : system_(std::move(f)),
        forward_(forward),
        begin_(t0),
        end_(t0),
        grid_(t0),
        x_begin_(x0),
        x_end_(x0),
        scratch_(x0),
        slope_(x0),
        work_(M::workspace(x0)),
        interpolant_(x0) {
    jump(t0, x0, options);
  }

  System& system() { return system_; }
  const System& system() const { return system_; }
  /// Of the last step, whatever has jumped since.
  Real begin() const { return step_begin_; }
  Real end() const { return end_; }
  Real size() const { return h_; }
  const X& x_begin() const { return x_begin_; }
  const X& x_end() const { return x_end_; }
  const Statistics& statistics() const { return statistics_; }
  Statistics& statistics() { return statistics_; }

  /// The trajectory goes on from another state (or with another f): step size and history begin anew.
  void jump(Real t, const X& x, const Options<X>& options) {
    begin_ = end_ = grid_ = t;
    carried_ = 0;
    grid_steps_ = 0;
    x_end_ = x;
    jumped_ = true;
    errors_ = {};
    pace_.forget();
    next_ = fixed(options) ? forward_ * options.step : Real(0);  // 0: to be estimated
  }

  /// x' at (t, x) by an evaluation of its own; 0 for the unknown of an algebraic equation.
  const X& slope(Real t, const X& x) {
    ++statistics_.evaluations;
    evaluate(system_, t, x, slope_);
    divide_by_mass(system_, slope_);
    return slope_;
  }

  /// One accepted step from end(), not beyond limit. False: failed, and outcome says how.
  bool take(Real limit, const Options<X>& options, Outcome<Real>& outcome) {
    advance_to_end();
    if constexpr (M::error_order > 0) {
      if (!fixed(options)) {
        if (next_ == 0 && !estimate_first(limit, options, outcome)) return false;
        return take_adaptive(limit, options, outcome);
      }
    }
    return take_fixed(limit, options, outcome);
  }

  /// Whether stability held most of the steps of an explicit method (of a run of some length).
  bool stiff() const { return probes_ >= least_probes && 2 * stiff_probes_ > probes_; }

  /// The steps that a run to `limit` would need, where stiffness holds them and they are far too many; else 0.
  Real endless(Real limit, const Options<X>& options) const {
    if (!pace_.steady()) [[likely]]
      return 0;
    const Real steps = pace_.steps_for(limit - end_);
    return steps > Real(Pace<Real>::far_beyond) * Real(static_cast<double>(options.max_steps)) ? steps : Real(0);
  }

  /// x at a time of the last step, on the dense output.
  void at(Real t, X& x) {
    if (t == end_) {
      x = x_end_;
    } else {
      interpolant()((t - step_begin_) / h_, x);
    }
  }

  const Interpolant<X, M::dense_degree>& interpolant() {
    if (!interpolated_) {
      statistics_.evaluations +=
          static_cast<std::size_t>(M::interpolate(system_, begin_, x_begin_, h_, x_end_, work_, interpolant_));
      interpolated_ = true;
    }
    return interpolant_;
  }

  static Tolerance<Real> tolerance(const Options<X>& options) {
    return {options.rtol, options.atol, options.rtol_each.empty() ? nullptr : options.rtol_each.data(),
            options.atol_each.empty() ? nullptr : options.atol_each.data()};
  }

 private:
  static bool fixed(const Options<X>& options) { return options.step > 0; }

  void advance_to_end() {
    if (!jumped_) M::accept(work_);
    begin_ = step_begin_ = end_;
    std::swap(x_begin_, x_end_);
    interpolated_ = false;
  }

  // x_begin_ is the start of the step from here on; after a failure the start is all that stands.
  static constexpr const char* singular_hint =
      "the solution may be singular here, or f jumps: declare an event at the jump, or loosen the tolerance";

  bool fail(Ending ending, Real error, std::string component, std::string hint, Outcome<Real>& outcome) {
    outcome = {ending, begin_, h_, error, std::move(component), {}, {}, std::move(hint)};
    end_ = begin_;
    x_end_ = x_begin_;
    jumped_ = true;
    return false;
  }

  void attempt(Real h, const Options<X>& options) {
    h_ = h;
    if constexpr (requires { M::aim(work_, tolerance(options)); }) M::aim(work_, tolerance(options));
    statistics_.evaluations += static_cast<std::size_t>(M::step(system_, begin_, x_begin_, h, jumped_, work_, x_end_));
    if constexpr (requires { M::costs(work_); }) {
      const EquationCosts costs = M::costs(work_);
      statistics_.jacobians = costs.jacobians;
      statistics_.decompositions = costs.decompositions;
      statistics_.solutions = costs.solutions;
    }
  }

  // A step whose equations were not solved.
  bool fail_to_solve(StepStatus status, const Options<X>& options, Outcome<Real>& outcome) {
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

  /// For a step that did not move t, and only some part of what is carried: a few may be, at the start of a fast
  /// motion.
  bool stands_still() {
    constexpr std::size_t most = 1000;
    if (stood_at_ != begin_) stood_at_ = begin_, standing_ = 0;
    return ++standing_ >= most;
  }

  /// The square of M::error_norm, without its root where the method has it so.
  Real error_square(const Tolerance<Real>& weights) const {
    if constexpr (requires { M::error_square(work_, h_, x_begin_, x_end_, weights); }) {
      return M::error_square(work_, h_, x_begin_, x_end_, weights);
    } else {
      const Real norm = M::error_norm(work_, h_, x_begin_, x_end_, weights);
      return norm * norm;
    }
  }

  bool finite_end() const {
    using std::isfinite;
    Real sum = 0;  // one NaN or infinity makes 0 * sum NaN
    for (std::size_t i = 0; i < dimension(x_end_); ++i) sum += Real(0) * x_end_.data()[i];
    return sum == Real(0);
  }

  std::string first_not_finite(const X& x) const {
    using std::isfinite;
    for (std::size_t i = 0; i < dimension(x); ++i)
      if (!(Real(0) * x.data()[i] == Real(0))) return component_name(system_, i);
    return {};
  }

  bool take_fixed(Real limit, const Options<X>& options, Outcome<Real>& outcome) {
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
      return fail_to_solve(status, options, outcome);
    if (status == StepStatus::not_finite || !finite_end()) {
      return fail(Ending::not_finite, 0, first_not_finite(x_end_),
                  "f, its Jacobian or the state is not finite: take a smaller step, or a method with error control",
                  outcome);
    }
    end_ = last ? limit : on_grid;
    ++grid_steps_;
    if (short_step) grid_ = limit, grid_steps_ = 0;
    return accepted();
  }

  bool accepted() {
    jumped_ = false;
    ++statistics_.steps;
    return true;
  }

  // Kept out of line: the loop of short steps has no room for it.
  [[gnu::noinline]] void probe_stiffness(const Tolerance<Real>& weights, std::size_t max_steps) {
    const X& slope_begin = M::derivative(work_);
    if (!stiffness_) stiffness_.emplace(x_begin_);
    stiffness_->probe(system_, begin_, x_begin_, slope_begin, weights);
    int evaluations = 1;
    const bool held = stiffness_->holds(system_, begin_, x_begin_, slope_begin, h_, weights, evaluations);
    statistics_.evaluations += static_cast<std::size_t>(evaluations);
    ++probes_;
    if (held) ++stiff_probes_;
    held ? pace_.mark(statistics_.steps, max_steps, begin_) : pace_.forget();
  }

  static constexpr bool watches_stiffness = !detail::is_implicit<M>() && M::error_order > 0;
  static constexpr std::size_t first_probe = 1000, probe_every = 50, least_probes = 10;

  bool estimate_first(Real limit, const Options<X>& options, Outcome<Real>& outcome) {
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
    next_ = forward_ * first_step(system_, begin_, x_begin_, slope_, detail::starting_order<M>(), forward_, longest,
                                  tolerance(options), scratch_, x_end_);
    ++statistics_.evaluations;
    return true;
  }

  bool take_adaptive(Real limit, const Options<X>& options, Outcome<Real>& outcome) {
    using std::abs, std::max, std::min, std::sqrt;
    const Real epsilon = std::numeric_limits<Real>::epsilon();
    const Tolerance<Real> weights = tolerance(options);
    const Real room = limit - begin_;
    bool was_rejected = false, last_not_finite = false;
    Real error = 0, h = next_;
    if (abs(h) > options.max_step) [[unlikely]]
      h = forward_ * options.max_step;
    for (std::size_t rejects = 0;; ++rejects) {
      // A step that would leave a crumb before the limit takes it along.
      const bool last = forward_ * (Real(1.01) * h - room) >= 0;
      if (last) [[unlikely]] {
        attempt(room, options);
      } else {
        attempt(h, options);
      }
      const bool solved = detail::status_of<M>(work_) == StepStatus::done;
      const Real square = solved ? error_square(weights) : std::numeric_limits<Real>::infinity();
      // Neither true nor false of a number that is none: it is one where x_end_ is not finite.
      const bool finite = square < std::numeric_limits<Real>::infinity();
      if (finite && square <= 1) {
        const Real factor = factor_after(static_cast<float>(square), was_rejected, weights, options);
        if (last) [[unlikely]] {
          // A step cut short by the limit says little about the next: never below what was planned.
          next_ = forward_ * max(abs(h), abs(h_) * factor);
          end_ = limit;
          carried_ = 0;
        } else {
          next_ = h_ * factor;
          // What the sum loses is carried to the next (W. Kahan): a million steps do not drift.
          const Real wanted = h_ + carried_;
          end_ = begin_ + wanted;
          carried_ = wanted - (end_ - begin_);
          if (end_ == begin_ && stands_still()) [[unlikely]]
            return fail(Ending::step_too_small, sqrt(square), worst_component(weights), singular_hint, outcome);
        }
        if constexpr (watches_stiffness) {
          if (statistics_.steps % probe_every == 0 && statistics_.steps >= first_probe) [[unlikely]]
            probe_stiffness(weights, options.max_steps);
        }
        return accepted();
      }
      ++statistics_.rejected;
      was_rejected = true;
      last_not_finite = detail::status_of<M>(work_) == StepStatus::not_finite || (solved && !finite);
      error = sqrt(square);
      h = h_ * factor_of_rejected(solved, finite, static_cast<float>(min(square, Real(1e30))), options);
      if constexpr (requires { M::rejected(work_, h); }) M::rejected(work_, h);
      if (abs(h) <= 4 * epsilon * max(abs(begin_), abs(begin_ + h)) || rejects >= options.max_rejects_in_a_row ||
          (options.interrupt && options.interrupt->load(std::memory_order_relaxed)))
        return give_up(rejects >= options.max_rejects_in_a_row, last_not_finite, error, weights, options, outcome);
    }
  }

  Real factor_after(float error_square, bool was_rejected, const Tolerance<Real>& weights, const Options<X>& options) {
    using std::min;
    float factor = errors_.accept(options.controller, detail::error_order_of<M>(work_), error_square);
    if (was_rejected) factor = min(factor, 1.0F);
    if constexpr (requires { M::next_factor(work_, Real(factor), h_, x_begin_, x_end_, weights); }) {
      const Real wanted = M::next_factor(work_, Real(factor), h_, x_begin_, x_end_, weights);
      return was_rejected ? min(wanted, Real(1)) : wanted;
    } else {
      return Real(factor);
    }
  }

  Real factor_of_rejected(bool solved, bool finite, float error_square, const Options<X>& options) const {
    if (!solved) return Real(0.25);
    if (!finite) return Real(0.2);
    return Real(ErrorHistory::reject(options.controller, detail::error_order_of<M>(work_), error_square));
  }

  bool give_up(bool too_many, bool not_finite, Real error, const Tolerance<Real>& weights, const Options<X>& options,
               Outcome<Real>& outcome) {
    if (options.interrupt && options.interrupt->load(std::memory_order_relaxed))
      return fail(Ending::interrupted, error, {}, {}, outcome);
    if (const StepStatus status = detail::status_of<M>(work_); status != StepStatus::done && !not_finite)
      return fail_to_solve(status, options, outcome);
    if (not_finite) return fail_not_finite(outcome);
    return fail(too_many ? Ending::too_many_rejects : Ending::step_too_small, error, worst_component(weights),
                singular_hint, outcome);
  }

  // The equations of a step spread what is not finite over all components: which it comes from f knows.
  bool fail_not_finite(Outcome<Real>& outcome) {
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

  std::string worst_component(const Tolerance<Real>& weights) const {
    using std::abs;
    std::size_t worst = 0;
    Real greatest = -1;
    for (std::size_t i = 0; i < dimension(x_begin_); ++i) {
      const Real part = abs(M::error_of(work_, h_, i)) / weights.scale(i, x_begin_.data()[i], x_end_.data()[i]);
      if (part > greatest) greatest = part, worst = i;
    }
    return dimension(x_begin_) == 0 ? std::string{} : component_name(system_, worst);
  }

  System system_;
  Real forward_, begin_, end_, h_{}, next_{};  // begin_: of the next step, once there was a jump
  Real step_begin_ = begin_;
  Real carried_{};  // of adaptive steps: what end_ lacks
  Real grid_;       // fixed steps are counted from here
  std::size_t grid_steps_ = 0, standing_ = 0;
  Real stood_at_{};  // where the last steps stood, while t did not move
  bool jumped_ = true, interpolated_ = false;
  ErrorHistory errors_;
  X x_begin_, x_end_, scratch_, slope_;
  typename M::template Workspace<X> work_;
  Interpolant<X, M::dense_degree> interpolant_;
  Statistics statistics_;
  std::optional<StiffnessWatch<X>> stiffness_;
  std::size_t probes_ = 0, stiff_probes_ = 0;
  Pace<Real> pace_;
};

}  // namespace continuo
