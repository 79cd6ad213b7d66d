// continuo/methods/switching.hpp
// Two methods in one: an explicit one as long as accuracy bounds the steps, a stiff one where stability would. The
// system is watched by one evaluation of f every few steps (stiffness_watch.hpp); the step size goes over from one to
// the other. L. Petzold, "Automatic selection of methods for solving stiff and nonstiff systems of ordinary
// differential equations", SIAM J. Sci. Stat. Comput. 4 (1983).
//
//   struct Mine : Switching<Tsitouras5, Bdf> {
//     static constexpr std::string_view name = "mine";
//   };
#pragma once
#include <algorithm>
#include <cstddef>
#include <string_view>
#include <type_traits>

#include <continuo/methods/check_method.hpp>
#include <continuo/methods/support/stiffness_watch.hpp>
#include <continuo/system/mass.hpp>

namespace continuo {

/// A method that is NonStiff or Stiff, whichever takes fewer evaluations of f for the next steps. Both need an error
/// estimate, and Stiff must be implicit. It has the static functions of the concept Method; what they share is stated
/// there.
template <class NonStiff, class Stiff>
struct Switching {
  /// Of the explicit method.
  /// @{
  static constexpr int order = NonStiff::order, error_order = NonStiff::error_order;
  static constexpr int order_of_fixed_steps = detail::order_of_fixed_steps<NonStiff>();
  /// @}
  /// What holds of both methods.
  /// @{
  static constexpr int dense_order = std::min(NonStiff::dense_order, Stiff::dense_order);
  static constexpr int dense_degree = std::max(NonStiff::dense_degree, Stiff::dense_degree);
  static constexpr bool second_order = NonStiff::second_order, implicit = true, automatic = true;
  /// @}
  static_assert(detail::is_implicit<Stiff>() && !Stiff::second_order,
                "the second method of a pair is for stiff systems: it is implicit, and not only for x'' = a(t, x)");
  static_assert(detail::estimates_error<NonStiff>() && detail::estimates_error<Stiff>(),
                "the methods of a pair have error estimates: their error_order is above 0");

  /// The workspaces of the two methods.
  /// @{
  template <State X>
  using NonStiffWork = typename NonStiff::template Workspace<X>;
  template <State X>
  using StiffWork = typename Stiff::template Workspace<X>;
  /// @}
  /// The stages of both methods, and what is known of the stiffness.
  template <State X>
  struct Workspace {
    static_assert(check_method<NonStiff, X>() && check_method<Stiff, X>());
    static_assert(detail::HasDerivative<NonStiff, X, NonStiffWork<X>> && detail::HasDerivative<Stiff, X, StiffWork<X>>,
                  "the methods of a pair have a public and static member `derivative`, x' at the start of the last "
                  "step: static const X& derivative(const Workspace<X>& work)");
    NonStiffWork<X> nonstiff;
    StiffWork<X> stiff;
    Interpolant<X, NonStiff::dense_degree> nonstiff_interpolant;
    Interpolant<X, Stiff::dense_degree> stiff_interpolant;
    StiffnessWatch<X> watch;
    Tolerance<Scalar<X>> tolerance{Scalar<X>(1e-6), Scalar<X>(1e-9)};
    bool is_stiff = false, fresh = false;  // fresh: the method in use has not made a step here yet
    bool begun = false, has_mass = false;
    Scalar<X> h{};              // |h| of the last step
    std::size_t steps = 0;      // accepted, since the last change of method
    std::size_t turns = 0;      // accepted steps of the explicit method by the clock of an oscillation
    bool begins = true;         // no probe has told yet what the system is like
    std::size_t in_favour = 0;  // probes in a row that speak for a change
    std::size_t patience = least_patience;
    Scalar<X> worthwhile_h{};  // |h| from which the stiff method is the cheaper one, as it was when it took over
    bool worthwhile = false;   // it has come that far
    Scalar<X> h_of_stiff{};    // its |h| when it was left last

    /// For checkpoints: what the next step depends on.
    template <class Archive>
    void transfer(Archive& archive) {
      archive(nonstiff, stiff, watch, is_stiff, fresh, begun, has_mass, h, steps, turns, begins, in_favour, patience);
      archive(worthwhile_h, worthwhile, h_of_stiff);
    }
  };

  /// Allocates for both methods.
  template <State X>
  [[nodiscard]] static Workspace<X> workspace(const X& x) {
    return {NonStiff::workspace(x), Stiff::workspace(x), Interpolant<X, NonStiff::dense_degree>(x),
            Interpolant<X, Stiff::dense_degree>(x), StiffnessWatch<X>(x)};
  }

  /// What the explicit method has against the system; empty where nothing.
  template <class System, State X>
  [[nodiscard]] static std::string_view unsupported_reason(const System& system, const X& x) {
    if constexpr (detail::HasUnsupportedReason<NonStiff, X, System>) return NonStiff::unsupported_reason(system, x);
    return {};
  }

  /// The tolerance of the equations of a stiff step.
  template <State X>
  static void set_tolerance(Workspace<X>& work, const Tolerance<Scalar<X>>& tolerance) {
    work.tolerance = tolerance;
    if constexpr (requires { Stiff::expect_oscillation(work.stiff, true); })
      Stiff::expect_oscillation(work.stiff, work.watch.oscillates());
    if constexpr (detail::HasSetTolerance<Stiff, X, StiffWork<X>>) Stiff::set_tolerance(work.stiff, tolerance);
    if constexpr (detail::HasSetTolerance<NonStiff, X, NonStiffWork<X>>)
      NonStiff::set_tolerance(work.nonstiff, tolerance);
  }

  /// One step, and every few steps one evaluation of f more, to test for stiffness.
  template <class System, State X>
  [[nodiscard]] static int step(System& system, const Scalar<X>& t, const X& x, const Scalar<X>& h, bool discontinuity,
                                Workspace<X>& work, X& x_new) {
    if (!work.begun) {
      work.begun = true;
      work.has_mass = work.is_stiff = continuo::has_mass<X>(system);
    }
    if (discontinuity) work.in_favour = 0;
    const bool anew = discontinuity || work.fresh;
    int evaluations = work.is_stiff ? Stiff::step(system, t, x, h, anew, work.stiff, x_new)
                                    : NonStiff::step(system, t, x, h, anew, work.nonstiff, x_new);
    return evaluations + watch_step(system, t, x, h, work);
  }
  /// Whether `watch_step` evaluates f, for which `work` has x' at the start of the step.
  template <State X>
  [[nodiscard]] static bool is_probe_due(const Workspace<X>& work) {
    return !work.has_mass && (work.begins || work.steps % probe_every == probe_every - 1);
  }
  /// What is to be learnt of the system at the start of a step that has been taken; part of `step`. The number of
  /// evaluations of f.
  template <class System, State X>
  static int watch_step(System& system, const Scalar<X>& t, const X& x, const Scalar<X>& h, Workspace<X>& work) {
    int evaluations = 0;
    if (is_probe_due(work)) {
      const bool change = work.is_stiff ? explicit_would_do(system, t, x, h, work, evaluations)
                                        : stiff_would_help(system, t, x, h, work, evaluations);
      work.in_favour = change ? work.in_favour + 1 : 0;
      const bool felt_by_now = work.steps >= least_probes_at_start && work.in_favour == 0 &&
                               work.watch.radius() * work.h > Scalar<X>(5 * felt);
      work.begins = work.begins && work.steps + 1 < most_probes_at_start && !felt_by_now;
    }
    work.h = h < 0 ? -h : h;
    return evaluations;
  }

  /// Another motion begins at x: what was learnt of the system is forgotten.
  template <State X>
  static void forget(Workspace<X>& work, const X& x) {
    work.watch = StiffnessWatch<X>(x);
    work.is_stiff = work.fresh = work.begun = work.has_mass = work.worthwhile = false;
    work.begins = true;
    work.steps = work.turns = work.in_favour = 0;
    work.patience = least_patience;
    work.h = work.worthwhile_h = work.h_of_stiff = Scalar<X>(0);
  }

  /// How the last step ended.
  template <State X>
  [[nodiscard]] static StepStatus status(const Workspace<X>& work) {
    return work.is_stiff ? detail::status_of<Stiff>(work.stiff) : detail::status_of<NonStiff>(work.nonstiff);
  }
  /// What the stiff method says of a step that it could not solve; empty where it says nothing.
  template <State X>
  [[nodiscard]] static std::string_view failure(const Workspace<X>& work) {
    if constexpr (detail::HasFailure<Stiff, StiffWork<X>>) {
      if (work.is_stiff) return Stiff::failure(work.stiff);
    }
    return {};
  }
  /// What the stiff method's equations have cost so far.
  template <State X>
  [[nodiscard]] static EquationCosts costs(const Workspace<X>& work) {
    return Stiff::costs(work.stiff);
  }
  /// The order of the error estimate of the method in use.
  template <State X>
  [[nodiscard]] static int error_order_of(const Workspace<X>& work) {
    return work.is_stiff ? detail::error_order_of<Stiff>(work.stiff) : detail::error_order_of<NonStiff>(work.nonstiff);
  }
  /// The norm of the error of the last step: good where it is <= 1. In long oscillations it is stricter, so that the
  /// errors of many turns do not add up.
  template <State X>
  [[nodiscard]] static Scalar<X> error_norm(const Workspace<X>& work, const Scalar<X>& h, const X& x, const X& x_new,
                                            const Tolerance<Scalar<X>>& tolerance) {
    return work.is_stiff ? Stiff::error_norm(work.stiff, h, x, x_new, tolerance)
                         : strictness_of_turns(work) * NonStiff::error_norm(work.nonstiff, h, x, x_new, tolerance);
  }
  /// The factor of the explicit method's error norm in that.
  template <State X>
  [[nodiscard]] static Scalar<X> strictness_of_turns(const Workspace<X>& work) {
    if (work.begins && work.watch.oscillates()) return Scalar<X>(strictness_at_start);
    if (work.turns <= free_turns) return Scalar<X>(1);
    return Scalar<X>(static_cast<double>(work.turns) / static_cast<double>(free_turns));
  }
  /// The estimated local error of component i.
  template <State X>
  [[nodiscard]] static Scalar<X> error_of(const Workspace<X>& work, const Scalar<X>& h, std::size_t i) {
    return work.is_stiff ? Stiff::error_of(work.stiff, h, i) : NonStiff::error_of(work.nonstiff, h, i);
  }
  /// The factor for the next step, from the stiff method where it has an opinion.
  template <State X>
  [[nodiscard]] static Scalar<X> next_factor(Workspace<X>& work, const Scalar<X>& factor, const Scalar<X>& h,
                                             const X& x, const X& x_new, const Tolerance<Scalar<X>>& tolerance) {
    if constexpr (detail::HasNextFactor<Stiff, X, StiffWork<X>>) {
      if (work.is_stiff) return Stiff::next_factor(work.stiff, factor, h, x, x_new, tolerance);
    }
    if constexpr (detail::HasNextFactor<NonStiff, X, NonStiffWork<X>>) {
      if (!work.is_stiff) return NonStiff::next_factor(work.nonstiff, factor, h, x, x_new, tolerance);
    }
    return factor;
  }
  /// The last step was rejected, and h_next is tried instead.
  template <State X>
  static void rejected(Workspace<X>& work, const Scalar<X>& h_next) {
    if constexpr (detail::HasRejected<Stiff, X, StiffWork<X>>) {
      if (work.is_stiff) Stiff::rejected(work.stiff, h_next);
    }
    if constexpr (detail::HasRejected<NonStiff, X, NonStiffWork<X>>) {
      if (!work.is_stiff) NonStiff::rejected(work.nonstiff, h_next);
    }
  }

  /// The last step is taken once more, to end at an event.
  template <State X>
  static void retaken(Workspace<X>& work) {
    if constexpr (detail::HasRetaken<Stiff, StiffWork<X>>) {
      if (work.is_stiff) Stiff::retaken(work.stiff);
    }
    if constexpr (detail::HasRetaken<NonStiff, NonStiffWork<X>>) {
      if (!work.is_stiff) NonStiff::retaken(work.nonstiff);
    }
  }

  /// The end of the last step was moved. A method that has just taken over begins anew in any case.
  template <State X>
  static void moved(Workspace<X>& work, const X& from, const X& to) {
    if constexpr (detail::HasMoved<Stiff, X, StiffWork<X>>) {
      if (work.is_stiff) Stiff::moved(work.stiff, from, to);
    }
    if constexpr (detail::HasMoved<NonStiff, X, NonStiffWork<X>>) {
      if (!work.is_stiff) NonStiff::moved(work.nonstiff, from, to);
    }
  }

  /// The polynomial of the last step, raised to the higher of the two degrees.
  template <class System, State X>
  [[nodiscard]] static int interpolate(System& system, const Scalar<X>& t, const X& x, const Scalar<X>& h,
                                       const X& x_new, Workspace<X>& work, Interpolant<X, dense_degree>& interpolant) {
    if (work.is_stiff) {
      const int evaluations = Stiff::interpolate(system, t, x, h, x_new, work.stiff, work.stiff_interpolant);
      widen(work.stiff_interpolant, interpolant);
      return evaluations;
    }
    const int evaluations = NonStiff::interpolate(system, t, x, h, x_new, work.nonstiff, work.nonstiff_interpolant);
    widen(work.nonstiff_interpolant, interpolant);
    return evaluations;
  }

  /// Accepts the last step, and changes the method where three tests in a row speak for it (six in an oscillation; more
  /// after changes that did not pay).
  template <State X>
  static void accept(Workspace<X>& work) {
    work.fresh = false;
    ++work.steps;
    if (!work.is_stiff && work.watch.oscillates()) count_turn(work);
    if (work.is_stiff && work.h >= work.worthwhile_h) work.worthwhile = true;
    // Of an oscillation a probe may meet the moment that it is least to be seen: several phases are asked.
    const bool several_phases = !work.is_stiff && work.watch.oscillates();
    if (work.in_favour >= (several_phases ? 2 * work.patience : work.patience)) {
      work.is_stiff ? leave_stiff(work) : enter_stiff(work);
      work.is_stiff = !work.is_stiff;
      work.fresh = true;
      work.steps = work.in_favour = 0;
    } else if (work.is_stiff) {
      Stiff::accept(work.stiff);
    } else {
      NonStiff::accept(work.nonstiff);
    }
  }

  /// x' at the start of the last step.
  template <State X>
  [[nodiscard]] static X derivative(const Workspace<X>& work) {
    if (work.is_stiff) return Stiff::derivative(work.stiff);
    return NonStiff::derivative(work.nonstiff);
  }

 private:
  static constexpr std::size_t probe_every = 8, least_patience = 3;
  // At the start there is a probe in each step until lambda is felt: before the errors of an explicit method have set
  // off an oscillation that the solution does not have.
  static constexpr std::size_t least_probes_at_start = 5, most_probes_at_start = 12;
  static constexpr double felt = 0.1, strictness_at_start = 10;
  // h |lambda|; where the error of a step is that of rounding.
  static constexpr double least_part_of_turn = NonStiff::order < 8 ? 0.04 : NonStiff::second_order ? 0.25 : 0.1;
  static constexpr double unseen = 1;  // tolerances: what the stiff method may damp
  // Steps of an oscillation whose errors may be as large as the tolerance. Nothing damps them; from there on those of
  // the n-th are held below 1/n of that, so that their sum grows with log n alone.
  // dop853, which gets strict tolerances, has the smaller errors against their estimate.
  static constexpr std::size_t free_turns = NonStiff::order < 8 || NonStiff::second_order ? 5 : 15;
  static constexpr int worthwhile = 8;  // a stiff step costs some three to ten explicit ones

  // Steps that have become a small part of a turn gain nothing any more: rounding is what they follow.
  template <State X>
  static void count_turn(Workspace<X>& work) {
    if (work.watch.radius() * work.h > Scalar<X>(least_part_of_turn)) {
      ++work.turns;
    } else {
      work.turns -= work.turns / 16;
    }
  }

  // The explicit method is held by stiffness, or its steps are far shorter than those of the stiff method were, even if
  // it is accuracy that shortens them.
  template <class System, State X>
  [[nodiscard]] static bool stiff_would_help(System& system, const Scalar<X>& t, const X& x, const Scalar<X>& h,
                                             Workspace<X>& work, int& evaluations) {
    using std::abs;
    const auto& slope = NonStiff::derivative(work.nonstiff);
    work.watch.probe(system, t, x, slope, work.tolerance);
    ++evaluations;
    return work.watch.holds(system, t, x, slope, h, work.tolerance, evaluations, unseen) ||
           worthwhile * abs(h) < work.h_of_stiff;
  }

  // Any explicit method could make steps like those of the stiff one, or they are not so much longer.
  template <class System, State X>
  [[nodiscard]] static bool explicit_would_do(System& system, const Scalar<X>& t, const X& x, const Scalar<X>& h,
                                              Workspace<X>& work, int& evaluations) {
    using std::abs;
    work.watch.probe(system, t, x, Stiff::derivative(work.stiff), work.tolerance);
    ++evaluations;
    // With h |lambda| below some periods a stiff method does no more than follow an oscillation, at a higher price.
    const Scalar<X> followed(work.watch.oscillates() ? 6 : 1);
    return work.watch.radius() * abs(h) < followed || (!work.worthwhile && abs(h) < work.worthwhile_h);
  }

  template <State X>
  static void enter_stiff(Workspace<X>& work) {
    work.worthwhile_h = worthwhile * work.h;
    work.worthwhile = work.begins = false;
  }
  // A stiff method that was of no use waits twice as long the next time: a system at the border is not tossed to and
  // fro, and one that only looks stiff costs a few attempts.
  template <State X>
  static void leave_stiff(Workspace<X>& work) {
    if (!work.worthwhile) work.patience *= 2;
    work.h_of_stiff = work.worthwhile ? work.h : Scalar<X>(0);
  }

  template <State X, int Degree>
  static void widen(const Interpolant<X, Degree>& from, Interpolant<X, dense_degree>& to) {
    for (std::size_t power = 0; power <= static_cast<std::size_t>(dense_degree); ++power) {
      if (power <= static_cast<std::size_t>(Degree)) {
        to.c[power] = from.c[power];
      } else {
        for (std::size_t i = 0; i < dimension(to.c[power]); ++i) to.c[power].data()[i] = Scalar<X>(0);
      }
    }
  }
};

}  // namespace continuo
