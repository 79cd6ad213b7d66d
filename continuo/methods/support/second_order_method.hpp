// continuo/methods/support/second_order_method.hpp
// What the methods for q'' = a(t, q, v) share: f at both ends of the step, a cubic Hermite between, no error estimate.
// They read the pairs of position q and velocity v from the system; a component in no pair is a first-order one.
#pragma once
#include <array>
#include <cstddef>
#include <string_view>
#include <utility>

#include <continuo/methods/method.hpp>
#include <continuo/methods/support/hermite.hpp>
#include <continuo/numerics/finite.hpp>
#include <continuo/system/second_order.hpp>

namespace continuo {

/// f at the start of the last step and at its end, each with a flag that says whether it is known.
template <State X>
struct EndDerivatives {
  X start, end;
  bool start_fresh = false, end_fresh = false;

  /// For checkpoints: what the next step depends on.
  template <class Archive>
  void transfer(Archive& archive) {
    archive(start, end, start_fresh, end_fresh);
  }

  /// Returns the number of evaluations.
  template <class System>
  [[nodiscard]] int evaluate_start(System& system, const Scalar<X>& t, const X& x, bool discontinuity) {
    end_fresh = false;
    if (start_fresh && !discontinuity) return 0;
    evaluate(system, t, x, start);
    start_fresh = true;
    return 1;
  }
};

/// What a method for q'' = a(t, q) has against a system of another form; empty where it has nothing.
template <class System, State X>
[[nodiscard]] std::string_view unsupported_reason_positions_only(const System& system, const X& x) {
  static_assert(SecondOrder<System>, "the system must say which components are positions and which velocities");
  if (2 * system.pair_count(dimension(x)) != dimension(x))
    return "needs q'' = a(t, q): here a component is neither a position nor a velocity; take velocity_verlet or dop853";
  if (!ignores_velocity(system, x))
    return "needs q'' = a(t, q): here the accelerations read velocities; take velocity_verlet or dop853";
  return {};
}

struct SecondOrderMethod {
  static constexpr int error_order = 0, dense_degree = 3;
  static constexpr bool second_order = true;

  template <State X>
  using Workspace = EndDerivatives<X>;

  template <State X>
  [[nodiscard]] static Workspace<X> workspace(const X& x) {
    return {x, x};
  }

  /// There is no estimate: 0, or not a number where x_new is not finite.
  template <State X>
  [[nodiscard]] static Scalar<X> error_norm(const EndDerivatives<X>&, const Scalar<X>&, const X&, const X& x_new,
                                            const Tolerance<Scalar<X>>&) {
    return detail::zero_if_all_finite(x_new);
  }
  template <State X>
  [[nodiscard]] static Scalar<X> error_of(const EndDerivatives<X>&, const Scalar<X>&, std::size_t) {
    return Scalar<X>(0);
  }

  template <class System, State X>
  static int interpolate(System& system, const Scalar<X>& t, const X& x, const Scalar<X>& h, const X& x_new,
                         EndDerivatives<X>& work, Interpolant<X, dense_degree>& interpolant) {
    const int evaluations = work.end_fresh ? 0 : 1;
    if (!work.end_fresh) evaluate(system, t + h, x_new, work.end);
    work.end_fresh = true;
    for (std::size_t i = 0; i < dimension(x); ++i) {
      std::array<Scalar<X>, 4> c;
      detail::set_cubic_hermite<Scalar<X>>(x.data()[i], x_new.data()[i], Scalar<X>(h * work.start.data()[i]),
                                           Scalar<X>(h * work.end.data()[i]), c);
      for (std::size_t j = 0; j < c.size(); ++j) interpolant.c[j].data()[i] = c[j];
    }
    return evaluations;
  }

  template <State X>
  static void accept(EndDerivatives<X>& work) {
    using std::swap;
    if (work.end_fresh) swap(work.start, work.end);
    work.start_fresh = work.end_fresh;
    work.end_fresh = false;
  }

  /// f at the start of the next step is not that of the end of this one any more.
  template <State X>
  static void moved(EndDerivatives<X>& work, const X&, const X&) {
    work.start_fresh = false;
  }

  /// The same where each lane of the state is a run of its own: only the lanes in `accepted` go on.
  template <State X, class Mask>
  static void accept(EndDerivatives<X>& work, const Mask& accepted) {
    if (work.end_fresh) choose(accepted, work.end, work.start);
    work.start_fresh = work.start_fresh && (work.end_fresh || none(accepted));
    work.end_fresh = false;
  }

  template <State X>
  [[nodiscard]] static const X& derivative(const EndDerivatives<X>& work) {
    return work.start;
  }

 protected:
  template <State X, class Mask>
  static void choose(const Mask& accepted, const X& from, X& to) {
    for (std::size_t i = 0; i < dimension(to); ++i) to.data()[i] = select(accepted, from.data()[i], to.data()[i]);
  }
  /// x_new = x + h slope, component by component.
  template <State X>
  static void euler(const X& x, const Scalar<X>& h, const X& slope, X& x_new) {
    for (std::size_t i = 0; i < dimension(x); ++i) x_new.data()[i] = x.data()[i] + h * slope.data()[i];
  }
  /// x_new was predicted with `start` for the whole step; `end` was found there. Puts the mean of both in its place at
  /// the velocities and the components in no pair: + h/2 (end - start). The positions stay: their slopes are made equal
  /// first, and afterwards are what they have to be, the new velocities.
  template <class System, State X>
  static void correct(const System& system, const X& x, const Scalar<X>& half, EndDerivatives<X>& work, X& x_new) {
    for_each_pair(system, x,
                  [&](std::size_t position, std::size_t) { work.end.data()[position] = work.start.data()[position]; });
    for (std::size_t i = 0; i < dimension(x); ++i)
      x_new.data()[i] += half * (work.end.data()[i] - work.start.data()[i]);
    for_each_pair(system, x, [&](std::size_t position, std::size_t velocity) {
      work.end.data()[position] = x_new.data()[velocity];
    });
    work.end_fresh = holds_after_kick(system, x);
  }
  /// What f gave holds when velocities alone have changed: f ignores them but for the positions' slopes, which are the
  /// velocities.
  template <class System, State X>
  [[nodiscard]] static bool holds_after_kick(const System& system, const X& x) {
    return ignores_velocity(system, x) && 2 * system.pair_count(dimension(x)) == dimension(x);
  }
};

}  // namespace continuo
