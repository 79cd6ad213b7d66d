// The steps of W runs by a Rosenbrock method, one per lane: J, df/dt and the decomposition as RosenbrockMethod has them
// in one run, each lane with those of its own step.
#pragma once
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>
#include <vector>

#include <continuo/ensembles/lanes/lane_linearization.hpp>
#include <continuo/ensembles/lanes/lane_sizes.hpp>
#include <continuo/ensembles/lanes/rosenbrock_step.hpp>
#include <continuo/ensembles/lanes/system_with_parameters.hpp>
#include <continuo/ensembles/run_start.hpp>
#include <continuo/methods/implicit/jacobian_of_step.hpp>
#include <continuo/methods/method.hpp>
#include <continuo/methods/support/tolerance_proportionality.hpp>
#include <continuo/numerics/lanes.hpp>
#include <continuo/solve/options.hpp>
#include <continuo/system/jacobian.hpp>
#include <continuo/system/rebound_state.hpp>

namespace continuo::detail {

template <RosenbrockForLanes M, class F, State X, State P, std::size_t W>
class RosenbrockLanes {
 public:
  using Wide = Lanes<double, W>;
  using Mask = typename Wide::Mask;
  using WideX = ReboundState<X, Wide>;
  using WideP = ReboundState<P, Wide>;
  using System = SystemWithParameters<F, WideP>;
  using Work = typename M::template Workspace<WideX>;
  using Statuses = std::array<StepStatus, W>;

  /// For runs like this one; `wide` is a state of all lanes.
  RosenbrockLanes(F& f, const RunStart<X, P>& start, const WideX& wide, const Options<X>& options)
      : one_{&f, start.p},
        x_(start.x),
        slope_(start.x),
        linear_(start.x),
        tolerance_(tolerance_of(options)),
        moved_(wide),
        moved_slope_(wide),
        rows_(wide.size() * wide.size()) {}

  void begin_run(std::size_t lane, Work& work) { work.lu.begin_run(lane); }
  /// The motion of a lane begins, or begins anew.
  void begin_motion(std::size_t lane) {
    begins_.set(lane, 1.0);
    fresh_.set(lane, 0.0);
  }

  /// A step of the active lanes. Where its equations cannot be solved, x_new is not a state, and the square of the
  /// error is infinite. `square` may be null: it is not wanted.
  void step(System& system, const Wide& t, const WideX& x, const Wide& h, const Mask& active,
            const Tolerance<Wide>& tolerance, Work& work, WideX& x_new, Wide* square) {
    if constexpr (is_small) {
      flat_step(system, t, x, h, active, tolerance, work, x_new, square);
    } else {
      step_of_lanes(system, t, x, h, active, tolerance, work, x_new, square);
    }
  }
  /// The lanes whose equations were solved, and where they were not in all, how they have ended in each.
  [[nodiscard]] const Mask& solved() const { return solved_; }
  [[nodiscard]] const Statuses* statuses() const { return any_unsolved_ ? &statuses_ : nullptr; }

  /// Whether the step of a lane is the first one of its motion.
  [[nodiscard]] bool begins(std::size_t lane) const { return begins_[lane] != 0; }

  /// The accepted lanes go on. The others keep J for a shorter step, but where the motion begins.
  void accept(const Mask& accepted) {
    fresh_ = select(accepted | (begins_ != Wide(0.0)), Wide(0.0), Wide(1.0));
    begins_ = select(accepted, Wide(0.0), begins_);
  }

 private:
  static constexpr double gamma = M::tableau.gamma.template as<double>();
  static constexpr bool is_small = fixed_size<X>() <= greatest_small_size;

  void step_of_lanes(System& system, const Wide& t, const WideX& x, const Wide& h, const Mask& active,
                     const Tolerance<Wide>& tolerance, Work& work, WideX& x_new, Wide* square) {
    evaluate(system, t, x, work.slope);
    const Mask due = active & (fresh_ == Wide(0.0));
    if (any(due)) linearize(system, t, x, h, due, !any(active & !due), tolerance, work);
    const Mask regular = work.lu.factor(work.linear, Wide(1.0) / (h * Wide(gamma)));
    solved_ = regular | !active;
    any_unsolved_ = !all(solved_);
    if (any_unsolved_) [[unlikely]]
      find_statuses(work);
    static_cast<void>(M::solve_stages(system, t, x, h, false, work, x_new));
    if (square)
      *square =
          select(solved_, M::error_square(work, h, x, x_new, tolerance), Wide(std::numeric_limits<double>::infinity()));
  }
  // With everything compiled into it: a call sends the lanes of a small state through memory.
  [[gnu::flatten, gnu::noinline]] void flat_step(System& system, const Wide& t, const WideX& x, const Wide& h,
                                                 const Mask& active, const Tolerance<Wide>& tolerance, Work& work,
                                                 WideX& x_new, Wide* square) {
    step_of_lanes(system, t, x, h, active, tolerance, work, x_new, square);
  }

  // J and df/dt of the lanes that are due; `alone`: no other lane needs those that are there.
  void linearize(System& system, const Wide& t, const WideX& x, const Wide& h, const Mask& due, bool alone,
                 const Tolerance<Wide>& tolerance, Work& work) {
    const std::span<Wide> rows = work.linear.entries();
    const std::span<Wide> found = alone ? rows : std::span<Wide>(rows_);
    if constexpr (HasJacobian<SystemWithParameters<F, P>, X> && !HasJacobian<System, WideX>) {
      linearize_apart(system, t, x, h, due, work.slope, found);
    } else {
      const LeastIncrementsOfLanes least(tolerance, h, x, work.slope);
      static_cast<void>(evaluate_jacobian(system, t, x, work.slope, moved_, moved_slope_, least, found));
      const Mask apart = due & may_leave_infinite_slope(x, work.slope, h, tolerance, found);
      if (any(apart)) [[unlikely]]
        linearize_apart(system, t, x, h, apart, work.slope, found);
    }
    if (!alone)
      for (std::size_t i = 0; i < rows.size(); ++i) rows[i] = select(due, found[i], rows[i]);
    if (is_autonomous(*system.f)) return;
    find_time_slope(system, t, x, h, work.slope);
    for (std::size_t i = 0; i < x.size(); ++i)
      work.time_slope.data()[i] = select(due, moved_slope_.data()[i], work.time_slope.data()[i]);
  }

  // As LeastIncrements.
  class LeastIncrementsOfLanes {
   public:
    LeastIncrementsOfLanes(const Tolerance<Wide>& tolerance, const Wide& h, const WideX& x, const WideX& fx)
        : tolerance_(tolerance), x_(x), factor_(1.0) {
      if constexpr (HasJacobian<System, WideX>) return;
      Wide sum(0.0);
      for (std::size_t i = 0; i < x.size(); ++i) {
        const Wide part = fx.data()[i] / scale(i);
        sum += part * part;
      }
      const Wide least = Wide(1000.0) * abs(h) * Wide(std::numeric_limits<double>::epsilon()) *
                         sqrt(Wide(static_cast<double>(x.size())) * sum);
      factor_ = select(least > Wide(0.0), least, Wide(1.0));
    }
    Wide operator()(std::size_t j) const { return factor_ * scale(j); }

   private:
    [[nodiscard]] Wide scale(std::size_t i) const { return tolerance_.scale(i, x_.data()[i], x_.data()[i]); }
    const Tolerance<Wide>& tolerance_;
    const WideX& x_;
    Wide factor_;
  };

  // The lanes for which leave_infinite_slope looks further than at J. They are few.
  [[nodiscard]] static Mask may_leave_infinite_slope(const WideX& x, const WideX& fx, const Wide& h,
                                                     const Tolerance<Wide>& tolerance, std::span<const Wide> rows) {
    constexpr double steep = 1e3;
    Mask moves(false), is_steep(false);
    for (std::size_t i = 0; i < x.size(); ++i) {
      const Wide& one = x.data()[i];
      moves = moves | ((abs(one) < tolerance.scale(i, one, one)) & (fx.data()[i] != Wide(0.0)));
    }
    if (none(moves)) return moves;
    for (const Wide& slope : rows) is_steep = is_steep | !(abs(h * slope) < Wide(steep));
    return moves & is_steep;
  }

  // J of some lanes, as one run has it.
  [[gnu::noinline]] void linearize_apart(System& system, const Wide& t, const WideX& x, const Wide& h,
                                         const Mask& lanes, const WideX& fx, std::span<Wide> rows) {
    for (std::size_t lane = 0; lane < W; ++lane) {
      if (!lanes[lane]) continue;
      for (std::size_t i = 0; i < x.size(); ++i) {
        x_.data()[i] = x.data()[i][lane];
        slope_.data()[i] = fx.data()[i][lane];
      }
      for (std::size_t i = 0; i < system.p.size(); ++i) one_.p.data()[i] = system.p.data()[i][lane];
      if (!linear_.prepared()) linear_.prepare(one_, x_);
      static_cast<void>(evaluate_jacobian_of_step(one_, t[lane], x_, slope_, h[lane], tolerance_, linear_));
      for (std::size_t i = 0; i < rows.size(); ++i) rows[i].set(lane, linear_.entries()[i]);
    }
  }

  // As evaluate_time_derivative, to moved_slope_.
  void find_time_slope(System& system, const Wide& t, const WideX& x, const Wide& h, const WideX& fx) {
    if constexpr (HasTimeDerivative<System, WideX>) {
      system.time_derivative(t, x, moved_slope_);
    } else {
      const Wide sign = select(h < Wide(0.0), Wide(-1.0), Wide(1.0));
      const Wide wanted = Wide(std::sqrt(std::numeric_limits<double>::epsilon())) * max(abs(t), abs(h)) * sign;
      const Wide moved = t + wanted;
      evaluate(system, moved, x, moved_slope_);
      for (std::size_t i = 0; i < x.size(); ++i)
        moved_slope_.data()[i] = (moved_slope_.data()[i] - fx.data()[i]) / (moved - t);
    }
  }

  [[gnu::noinline]] void find_statuses(const Work& work) {
    Wide sum(0.0);
    for (const Wide& entry : work.linear.entries()) sum += zero_if_finite(entry);
    const Mask finite = sum == Wide(0.0);
    for (std::size_t lane = 0; lane < W; ++lane)
      statuses_[lane] = solved_[lane]  ? StepStatus::done
                        : finite[lane] ? StepStatus::singular_matrix
                                       : StepStatus::not_finite;
  }

  SystemWithParameters<F, P> one_;  // of one run
  X x_, slope_;
  Linearization<X> linear_;
  Tolerance<double> tolerance_;
  WideX moved_, moved_slope_;
  std::vector<Wide> rows_;
  Wide fresh_{0.0};   // 1 where work has J of the start of the step
  Wide begins_{0.0};  // 1 where no step has been accepted since the motion began
  Mask solved_{true};
  bool any_unsolved_ = false;
  Statuses statuses_{};
};

/// Of other methods: nothing.
struct NoRosenbrockLanes {};
template <class M, class F, State X, State P, std::size_t W>
struct RosenbrockKind {
  using Type = NoRosenbrockLanes;
};
template <RosenbrockForLanes M, class F, State X, State P, std::size_t W>
struct RosenbrockKind<M, F, X, P, W> {
  using Type = RosenbrockLanes<M, F, X, P, W>;
};
template <class M, class F, State X, State P, std::size_t W>
using StepsOfRosenbrock = typename RosenbrockKind<M, F, X, P, W>::Type;

}  // namespace continuo::detail
