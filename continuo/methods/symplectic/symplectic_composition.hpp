// continuo/methods/symplectic/symplectic_composition.hpp
// Symplectic methods for q' = v, v' = a(t, q): kicks of the velocity and drifts of the position in turn,
//
//   v += h kick_i a(t + c_i h, q),   q += h drift_i v,   c_i = drift_1 + ... + drift_(i-1).
//
// E. Hairer, C. Lubich, G. Wanner, "Geometric Numerical Integration", 2nd ed. (2006), II.5 and V.3. With a fixed step
// the energy swings about its value for as long as anybody has calculated. What is left is rounding, which would let it
// walk: so q and v are summed with compensation (VIII.5; E. Hairer, R. I. McLachlan, A. Razakarivony, "Achieving
// Brouwer's law with implicit Runge-Kutta methods", BIT 48 (2008)): what a sum loses is kept beside it and added to the
// next.
#pragma once
#include <array>
#include <cstddef>
#include <limits>
#include <string_view>
#include <utility>

#include <continuo/methods/support/compensated_sum.hpp>
#include <continuo/methods/support/refined_quintic.hpp>
#include <continuo/methods/support/second_order_method.hpp>
#include <continuo/numerics/coefficient.hpp>

namespace continuo {

template <std::size_t Stages>
struct SymplecticTableau {
  static constexpr std::size_t stages = Stages;
  Coefficient kick[Stages] = {}, drift[Stages] = {};

  /// The last kick is the first of the next step: its acceleration is that at the end.
  [[nodiscard]] constexpr bool ends_with_kick() const { return drift[Stages - 1].is_zero(); }
};

/// c_i, where the time of kick i is t + c_i h.
template <std::size_t Stages>
[[nodiscard]] constexpr Coefficient node(SymplecticTableau<Stages> tableau, std::size_t i) {
  Coefficient sum = 0;
  for (std::size_t j = 0; j < i; ++j) sum = sum + tableau.drift[j];
  return sum;
}

/// The symmetric composition of velocity Verlet with steps w_i h: the first half of the w_i, the middle one last. Where
/// two steps meet, their kicks are one.
template <std::size_t Half>
[[nodiscard]] constexpr SymplecticTableau<2 * Half> symmetric_composition(const Coefficient (&half)[Half]) {
  const auto w = [&half](std::size_t i) {  // counted from 1, 0 on both sides
    return i == 0 || i == 2 * Half ? Coefficient(0) : half[i <= Half ? i - 1 : 2 * Half - 1 - i];
  };
  return [&w]<std::size_t... i>(std::index_sequence<i...>) {
    return SymplecticTableau<2 * Half>{{(w(i) + w(i + 1)) / 2 ...}, {w(i + 1)...}};
  }(std::make_index_sequence<2 * Half>());
}

/// `Derived` has a tableau. Fixed steps; systems whose accelerations read velocities are refused, unless `Derived` says
/// that it treats them.
template <class Derived>
struct SymplecticComposition : SecondOrderMethod {
  /// Between the ends the quintic that meets position, velocity and acceleration at both of them, made better in
  /// `Derived::dense_rounds` (refined_quintic.hpp) for two and four accelerations each.
  /// The velocity is its derivative and has the error of the step divided by h: one order less than the method's.
  static constexpr int dense_degree = 5, dense_order = 3, dense_rounds = 0;
  static constexpr bool compensated = true;

  template <State X>
  struct Workspace : EndDerivatives<X> {
    X rest, rest_new;  // what the sums that made x, and x_new, have lost
    X slope;           // f within the step
    X between;         // and f there, for the dense output
    std::array<X, 4> f_between;

    /// For checkpoints: what the next step depends on.
    template <class Archive>
    void transfer(Archive& archive) {
      EndDerivatives<X>::transfer(archive);
      archive(rest, rest_new);
    }
  };

  template <State X>
  [[nodiscard]] static Workspace<X> workspace(const X& x) {
    return {{x, x}, x, x, x, x, {x, x, x, x}};
  }

  template <class System, State X>
  [[nodiscard]] static std::string_view unsupported_reason(const System& system, const X& x) {
    return unsupported_reason_positions_only(system, x);
  }

  template <class System, State X>
  static int step(System& system, const Scalar<X>& t, const X& x, const Scalar<X>& h, bool discontinuity,
                  Workspace<X>& work, X& x_new) {
    int evaluations = work.evaluate_start(system, t, x, discontinuity);
    if (!Derived::unsupported_reason(system, x).empty()) {
      for (std::size_t i = 0; i < dimension(x); ++i)
        x_new.data()[i] = Scalar<X>(std::numeric_limits<double>::quiet_NaN());
      return evaluations;
    }
    if (discontinuity) {
      for (std::size_t i = 0; i < dimension(x); ++i) work.rest.data()[i] = Scalar<X>(0);
    }
    begin_step(system, x, h, work, x_new);
    work.rest_new = work.rest;
    [&]<std::size_t... i>(std::index_sequence<i...>) {
      (stage<i>(system, t, h, work, x_new), ...);
    }(std::make_index_sequence<Derived::tableau.stages>());
    if constexpr (Derived::tableau.ends_with_kick()) {
      for_each_pair(system, x, [&](std::size_t position, std::size_t velocity) {
        work.end.data()[position] = x_new.data()[velocity];
      });
      work.end_fresh = holds_after_kick(system, x);
    }
    return evaluations + static_cast<int>(Derived::tableau.stages) - 1;
  }

  template <class System, State X, int Degree>
  static int interpolate(System& system, const Scalar<X>& t, const X& x, const Scalar<X>& h, const X& x_new,
                         Workspace<X>& work, Interpolant<X, Degree>& interpolant) {
    int evaluations = work.end_fresh ? 0 : 1;
    if (!work.end_fresh) evaluate(system, t + h, x_new, work.end);
    work.end_fresh = true;
    for_each_pair(system, x, [&](std::size_t position, std::size_t velocity) {
      detail::set_quintic_hermite(x, h, x_new, work.start.data()[velocity], work.end.data()[velocity],
                                  {position, velocity}, interpolant);
    });
    if constexpr (Derived::dense_rounds >= 1) evaluations += refine<1>(system, t, h, work, interpolant);
    if constexpr (Derived::dense_rounds >= 2) evaluations += refine<2>(system, t, h, work, interpolant);
    return evaluations;
  }

  template <State X>
  static void accept(Workspace<X>& work) {
    using std::swap;
    SecondOrderMethod::accept<X>(work);
    swap(work.rest, work.rest_new);
  }
  template <State X, class Mask>
  static void accept(Workspace<X>& work, const Mask& accepted) {
    SecondOrderMethod::accept<X>(work, accepted);
    choose(accepted, work.rest_new, work.rest);
  }

 private:
  /// x_new = x, but components in no pair take an explicit Euler step.
  template <class System, State X>
  static void begin_step(const System& system, const X& x, const Scalar<X>& h, const Workspace<X>& work, X& x_new) {
    x_new = x;
    if (2 * system.pair_count(dimension(x)) == dimension(x)) return;
    euler(x, h, work.start, x_new);
    for_each_pair(system, x, [&](std::size_t position, std::size_t velocity) {
      x_new.data()[position] = x.data()[position];
      x_new.data()[velocity] = x.data()[velocity];
    });
  }

  template <int Round, class System, State X, int Degree>
  [[nodiscard]] static int refine(System& system, const Scalar<X>& t, const Scalar<X>& h, Workspace<X>& work,
                                  Interpolant<X, Degree>& interpolant) {
    constexpr auto& round = detail::QuinticRound<Round>::data;
    for (std::size_t j = 0; j < round.nodes; ++j) {
      const Scalar<X> theta(round.node[j].template as<CoefficientOf<Scalar<X>>>());
      interpolant(theta, work.between);
      evaluate(system, t + theta * h, work.between, work.f_between[j]);
    }
    for_each_pair(system, work.between, [&](std::size_t position, std::size_t velocity) {
      const auto acceleration = [&](std::size_t j) { return work.f_between[j].data()[velocity]; };
      detail::refine_quintic<Round>(h, {position, velocity}, acceleration, interpolant);
    });
    return static_cast<int>(round.nodes);
  }

  template <std::size_t i, class System, State X>
  static void stage(System& system, const Scalar<X>& t, const Scalar<X>& h, Workspace<X>& work, X& x) {
    using Real = Scalar<X>;
    static constexpr Coefficient kick = Derived::tableau.kick[i], drift = Derived::tableau.drift[i],
                                 time = node(Derived::tableau, i);
    constexpr bool at_end = i + 1 == Derived::tableau.stages && Derived::tableau.ends_with_kick();
    X& slope = i == 0 ? work.start : at_end ? work.end : work.slope;
    if constexpr (i > 0) evaluate(system, t + h * time.template as<CoefficientOf<Real>>(), x, slope);
    const Real kicked = h * kick.template as<CoefficientOf<Real>>();
    const Real drifted = h * drift.template as<CoefficientOf<Real>>();
    const auto add = [&](const Real& term, std::size_t component) {
      if constexpr (Derived::compensated) {
        detail::add_compensated<Real>(term, x.data()[component], work.rest_new.data()[component]);
      } else {
        x.data()[component] += term;
      }
    };
    for_each_pair(system, x, [&](std::size_t position, std::size_t velocity) {
      if constexpr (!kick.is_zero()) add(kicked * slope.data()[velocity], velocity);
      if constexpr (!drift.is_zero()) add(drifted * x.data()[velocity], position);
    });
  }
};

}  // namespace continuo
