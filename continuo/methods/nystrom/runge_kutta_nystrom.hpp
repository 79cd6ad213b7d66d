// continuo/methods/nystrom/runge_kutta_nystrom.hpp
// Runge-Kutta-Nystrom methods: made for q'' = a(t, q), where they need far fewer evaluations than methods for x' = f(t,
// x). E. Hairer, S. P. Norsett, G. Wanner, "Solving Ordinary Differential Equations I", II.14, eq. 14.9:
//
//   k_i = a(t + c_i h, q + c_i h v + h^2 sum_j a_ij k_j),
//   q_new = q + h v + h^2 sum_i b_i k_i,   v_new = v + h sum_i bv_i k_i.
//
// The system says which components are q and which v (SecondOrder), and that a ignores v: the function of two arguments
// in `second_order` does. Where a does look at v these methods have no order at all: the driver does not begin such a
// run, and a step ends in "not a number".
#pragma once
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <string_view>
#include <utility>

#include <continuo/methods/method.hpp>
#include <continuo/methods/nystrom/pairs.hpp>
#include <continuo/methods/support/hermite.hpp>
#include <continuo/methods/support/refined_quintic.hpp>
#include <continuo/methods/support/second_order_method.hpp>
#include <continuo/methods/support/simd_state.hpp>
#include <continuo/methods/support/weighted_sum.hpp>
#include <continuo/numerics/finite.hpp>
#include <continuo/system/second_order.hpp>

namespace continuo {

/// The numbers of such a method; the embedded weights give positions and velocities of lower order.
template <std::size_t Stages>
struct NystromTableau {
  static constexpr std::size_t stages = Stages;
  Coefficient c[Stages] = {};
  Coefficient a[Stages][Stages] = {};
  Coefficient b[Stages] = {}, bv[Stages] = {};
  Coefficient embedded[Stages] = {}, embedded_v[Stages] = {};

  /// The last stage is a at the end of the step.
  [[nodiscard]] constexpr bool first_same_as_last() const {
    for (std::size_t j = 0; j < Stages; ++j) {
      if (!(a[Stages - 1][j] == b[j])) return false;
    }
    return Stages > 1 && c[Stages - 1] == Coefficient(1);
  }
};

/// A dense output of its own: q(theta) = q + theta h v + h^2 sum_i b_i(theta) k_i with b_i = theta^2 (r[i][0] + r[i][1]
/// theta + ...), and v(theta) its derivative.
template <std::size_t Stages, std::size_t Powers>
struct NystromDense {
  static constexpr std::size_t powers = Powers;
  Coefficient r[Stages][Powers] = {};
};

template <class Derived>
struct RungeKuttaNystrom {
  static constexpr bool second_order = true;
  /// Between the ends, where `Derived` has no `dense` of its own: positions by the quintic that meets position,
  /// velocity and acceleration at both ends, made better in `Derived::dense_rounds` (refined_quintic.hpp) for two and
  /// four accelerations each; velocities by its derivative.

  /// The accelerations of the stages (where it is first the same as last, the last is the next first) and at the end of
  /// the step.
  template <State X>
  struct Workspace {
    std::array<detail::Accelerations<X>, Derived::tableau.stages> k;
    detail::Accelerations<X> end;
    X slope, argument;  // f at the start; the argument of f, then the errors
    X between;          // and f there, for the dense output
    std::array<detail::Accelerations<X>, 4> k_between;
    bool start_fresh = false, end_fresh = false;

    /// For checkpoints: what the next step depends on.
    template <class Archive>
    void transfer(Archive& archive) {
      archive(k[0], k[Derived::tableau.stages - 1], end, slope, start_fresh, end_fresh);
    }
  };

  template <State X>
  [[nodiscard]] static Workspace<X> workspace(const X& x) {
    const detail::Accelerations<X> none = detail::no_accelerations(x);
    return [&]<std::size_t... j>(std::index_sequence<j...>) {
      return Workspace<X>{{((void)j, none)...}, none, x, x, x, {none, none, none, none}};
    }(std::make_index_sequence<Derived::tableau.stages>());
  }

  template <class System, State X>
  [[nodiscard]] static std::string_view unsupported_reason(const System& system, const X& x) {
    return unsupported_reason_positions_only(system, x);
  }

  template <class System, State X>
  static int step(System& system, const Scalar<X>& t, const X& x, const Scalar<X>& h, bool discontinuity,
                  Workspace<X>& work, X& x_new) {
    static_assert(SecondOrder<System>, "the system must say which components are positions and which velocities");
    if constexpr (detail::Packed<X>) {
      return flat_step(system, t, x, h, discontinuity, work, x_new);
    } else {
      return take_step(system, t, x, h, discontinuity, work, x_new);
    }
  }

  /// Root mean square of error_i / scale_i over positions and velocities; not a number where x_new is not finite.
  template <State X>
  [[nodiscard]] static Scalar<X> error_norm(const Workspace<X>& work, const Scalar<X>& h, const X& x, const X& x_new,
                                            const Tolerance<Scalar<X>>& tolerance) {
    using std::sqrt;
    return sqrt(error_square(work, h, x, x_new, tolerance));
  }
  /// Its square, as in ExplicitRungeKutta.
  template <State X>
  [[nodiscard]] static Scalar<X> error_square(const Workspace<X>& work, const Scalar<X>&, const X& x, const X& x_new,
                                              const Tolerance<Scalar<X>>& tolerance) {
    using Real = Scalar<X>;
    // `finish` left the errors in work.argument.
    Real sum(0);
    for (std::size_t i = 0; i < dimension(x); ++i) {
      const Real end = x_new.data()[i];
      const Real ratio = work.argument.data()[i] / tolerance.scale(i, x.data()[i], end);
      sum += ratio * ratio + detail::zero_if_finite(end);
    }
    return sum * detail::one_over_dimension(x);
  }
  template <State X>
  [[nodiscard]] static Scalar<X> error_of(const Workspace<X>& work, const Scalar<X>&, std::size_t i) {
    using std::abs;
    return abs(work.argument.data()[i]);
  }

  template <class System, State X, int Degree>
  static int interpolate(System& system, const Scalar<X>& t, const X& x, const Scalar<X>& h, const X& x_new,
                         Workspace<X>& work, Interpolant<X, Degree>& interpolant) {
    const std::size_t size = dimension(x);
    if constexpr (requires { Derived::dense; }) {
      for (std::size_t n = 0; n < system.pair_count(size); ++n) {
        set_own_dense(x, h, work, n, system.pair(n, size), interpolant);
      }
      return 0;
    } else {
      const bool end_known = Derived::tableau.first_same_as_last() || work.end_fresh;
      if (!end_known) detail::evaluate_accelerations(system, t + h, x_new, work.end);
      work.end_fresh = work.end_fresh || !end_known;
      const auto& last = Derived::tableau.first_same_as_last() ? work.k[Derived::tableau.stages - 1] : work.end;
      for (std::size_t n = 0; n < system.pair_count(size); ++n) {
        const PositionVelocity pair = system.pair(n, size);
        const Scalar<X> end = detail::acceleration<X>(last, n, pair);
        detail::set_quintic_hermite(x, h, x_new, work.slope.data()[pair.velocity], end, pair, interpolant);
      }
      int evaluations = end_known ? 0 : 1;
      if constexpr (Derived::dense_rounds >= 1) evaluations += refine<1>(system, t, h, work, interpolant);
      if constexpr (Derived::dense_rounds >= 2) evaluations += refine<2>(system, t, h, work, interpolant);
      return evaluations;
    }
  }

  template <State X>
  static void accept(Workspace<X>& work) {
    using std::swap;
    if constexpr (Derived::tableau.first_same_as_last()) {
      swap(work.k[0], work.k[Derived::tableau.stages - 1]);
      work.start_fresh = true;
    } else {
      if (work.end_fresh) swap(work.k[0], work.end);
      work.start_fresh = work.end_fresh;
    }
    work.end_fresh = false;
  }

  /// f at the start of the next step is not that of the end of this one any more.
  template <State X>
  static void moved(Workspace<X>& work, const X&, const X&) {
    work.start_fresh = false;
  }

  template <State X>
  [[nodiscard]] static const X& derivative(const Workspace<X>& work) {
    return work.slope;
  }

 private:
  template <class System, State X>
  [[nodiscard]] [[gnu::always_inline]] static int take_step(System& system, const Scalar<X>& t, const X& x,
                                                            const Scalar<X>& h, bool discontinuity, Workspace<X>& work,
                                                            X& x_new) {
    constexpr std::size_t stages = Derived::tableau.stages;
    int evaluations = static_cast<int>(stages) - 1;
    work.end_fresh = false;
    if (discontinuity || !work.start_fresh) {
      detail::evaluate_accelerations(system, t, x, work.k[0]);
      work.start_fresh = true;
      ++evaluations;
    }
    set_slope(system, x, work);
    const auto start = detail::start_of_pairs(system, x);
    const auto take_stages = [&](X& argument) __attribute__((always_inline)) {
      argument = x;
      [&]<std::size_t... s>(std::index_sequence<s...>) __attribute__((always_inline)) {
        (stage<s + 1>(system, t, start, h, work, argument), ...);
      }(std::make_index_sequence<stages - 1>());
    };
    if constexpr (detail::Packed<X>) {
      X argument{};
      take_stages(argument);
    } else {
      take_stages(work.argument);
    }
    finish(system, x, start, h, work, x_new);
    return evaluations;
  }

  /// With f compiled into it, as in ExplicitRungeKutta.
  template <class System, State X>
  [[nodiscard]] [[gnu::flatten]] static int flat_step(System& system, Scalar<X> t, const X& x, Scalar<X> h,
                                                      bool discontinuity, Workspace<X>& work, X& x_new) {
    return take_step(system, t, x, h, discontinuity, work, x_new);
  }

  template <class System, State X>
  [[gnu::always_inline]] static void set_slope(const System& system, const X& x, Workspace<X>& work) {
    const std::size_t size = dimension(x), pairs = system.pair_count(size);
    for (std::size_t n = 0; n < pairs; ++n) {
      const PositionVelocity pair = system.pair(n, size);
      work.slope.data()[pair.position] = x.data()[pair.velocity];
      work.slope.data()[pair.velocity] = detail::acceleration<X>(work.k[0], n, pair);
    }
  }

  template <std::size_t s>
  struct StageWeight {
    constexpr const Coefficient& operator()(std::size_t j) const { return Derived::tableau.a[s][j]; }
  };
  template <std::size_t s>
  struct StageNode {
    constexpr const Coefficient& operator()(std::size_t) const { return Derived::tableau.c[s]; }
  };
  struct PositionWeight {
    constexpr const Coefficient& operator()(std::size_t j) const { return Derived::tableau.b[j]; }
  };
  struct VelocityWeight {
    constexpr const Coefficient& operator()(std::size_t j) const { return Derived::tableau.bv[j]; }
  };
  struct PositionError {
    constexpr Coefficient operator()(std::size_t j) const {
      return Derived::tableau.b[j] - Derived::tableau.embedded[j];
    }
  };
  struct VelocityError {
    constexpr Coefficient operator()(std::size_t j) const {
      return Derived::tableau.bv[j] - Derived::tableau.embedded_v[j];
    }
  };

  template <std::size_t s, class System, State X>
  [[gnu::always_inline]] static void stage(System& system, const Scalar<X>& t, const detail::StartOfPairs<X>& start,
                                           const Scalar<X>& h, Workspace<X>& work, X& argument) {
    using Real = Scalar<X>;
    using P = detail::PerPair<X>;
    using Weights = detail::Row<StageWeight<s>, s>;
    const Real node = h * detail::Row<StageNode<s>, 1>::template weight<Real, 0>(), square = h * h;
    const Real newest = square * Weights::template weight<Real, Weights::count - 1>();
    const auto k = detail::stages_of<Weights, P>(work.k);
    // As in detail::advance, the sum of the older stages does not wait for the newest.
    detail::set_pairs(system, start, argument, &PositionVelocity::position,
                      [&](const auto& q, const auto& v, std::size_t i) __attribute__((always_inline)) {
                        const detail::Unit<P> last = newest * k[Weights::count - 1][i];
                        if constexpr (Weights::count == 1) {
                          return detail::Unit<P>((q + node * v) + last);
                        } else {
                          const detail::Unit<P> sum = detail::row_sum<Weights, P, Weights::count - 1>(k, i);
                          return detail::Unit<P>((q + (node * v + square * sum)) + last);
                        }
                      });
    detail::evaluate_accelerations(system, t + node, argument, work.k[s]);
  }

  /// x_new, and the estimated errors into work.argument.
  template <class System, State X>
  [[gnu::always_inline]] static void finish(const System& system, const X& x, const detail::StartOfPairs<X>& start,
                                            const Scalar<X>& h, Workspace<X>& work, X& x_new) {
    using Real = Scalar<X>;
    using P = detail::PerPair<X>;
    using Position = detail::Row<PositionWeight, Derived::tableau.stages>;
    using Velocity = detail::Row<VelocityWeight, Derived::tableau.stages>;
    using PositionOff = detail::Row<PositionError, Derived::tableau.stages>;
    using VelocityOff = detail::Row<VelocityError, Derived::tableau.stages>;
    constexpr auto positions = &PositionVelocity::position, velocities = &PositionVelocity::velocity;
    const auto kq = detail::stages_of<Position, P>(work.k);
    const auto kv = detail::stages_of<Velocity, P>(work.k);
    const auto eq = detail::stages_of<PositionOff, P>(work.k);
    const auto ev = detail::stages_of<VelocityOff, P>(work.k);
    if (!unsupported_reason(system, x).empty()) {
      for (std::size_t i = 0; i < dimension(x); ++i) x_new.data()[i] = Real(std::numeric_limits<double>::quiet_NaN());
      return;
    }
    using U = detail::Unit<P>;
    detail::set_pairs(system, start, x_new, positions, [&](const U& q, const U& v, std::size_t i) {
      return U(q + h * (v + h * detail::row_sum<Position, P>(kq, i)));
    });
    detail::set_pairs(system, start, x_new, velocities, [&](const U&, const U& v, std::size_t i) {
      return U(v + h * detail::row_sum<Velocity, P>(kv, i));
    });
    detail::set_pairs(system, start, work.argument, positions, [&](const U&, const U&, std::size_t i) {
      return U(h * (h * detail::row_sum<PositionOff, P>(eq, i)));
    });
    detail::set_pairs(system, start, work.argument, velocities,
                      [&](const U&, const U&, std::size_t i) { return U(h * detail::row_sum<VelocityOff, P>(ev, i)); });
  }

  template <int Round, class System, State X, int Degree>
  [[nodiscard]] static int refine(System& system, const Scalar<X>& t, const Scalar<X>& h, Workspace<X>& work,
                                  Interpolant<X, Degree>& interpolant) {
    constexpr auto& round = detail::QuinticRound<Round>::data;
    const std::size_t size = dimension(work.between);
    for (std::size_t j = 0; j < round.nodes; ++j) {
      const Scalar<X> theta(round.node[j].template as<CoefficientOf<Scalar<X>>>());
      interpolant(theta, work.between);
      detail::evaluate_accelerations(system, t + theta * h, work.between, work.k_between[j]);
    }
    for (std::size_t n = 0; n < system.pair_count(size); ++n) {
      const PositionVelocity pair = system.pair(n, size);
      const auto acceleration = [&](std::size_t j) { return detail::acceleration<X>(work.k_between[j], n, pair); };
      detail::refine_quintic<Round>(h, pair, acceleration, interpolant);
    }
    return static_cast<int>(round.nodes);
  }

  template <State X, int Degree>
  static void set_own_dense(const X& x, const Scalar<X>& h, const Workspace<X>& work, std::size_t n,
                            PositionVelocity pair, Interpolant<X, Degree>& interpolant) {
    using Real = Scalar<X>;
    constexpr std::size_t powers = Derived::dense.powers;
    static_assert(Degree == powers + 1);
    const auto [q, v] = pair;
    interpolant.c[0].data()[q] = x.data()[q];
    interpolant.c[1].data()[q] = h * x.data()[v];
    interpolant.c[0].data()[v] = x.data()[v];
    interpolant.c[Degree].data()[v] = Real(0);
    for (std::size_t power = 0; power < powers; ++power) {
      Real sum(0);
      for (std::size_t i = 0; i < Derived::tableau.stages; ++i) {
        if (Derived::dense.r[i][power].is_zero()) continue;
        sum +=
            Derived::dense.r[i][power].template as<CoefficientOf<Real>>() * detail::acceleration<X>(work.k[i], n, pair);
      }
      interpolant.c[power + 2].data()[q] = h * (h * sum);
      interpolant.c[power + 1].data()[v] = Real(static_cast<double>(power + 2)) * (h * sum);
    }
  }
};

}  // namespace continuo
