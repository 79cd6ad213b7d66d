// continuo/methods/rosenbrock/rosenbrock_method.hpp
// The stepper of every Rosenbrock method: stiff systems M x' = f(t, x), M possibly singular (index 1), by linear
// systems alone. J and df/dt are evaluated once a step, c M - J is decomposed once, no iteration. A method is a struct
// with a name and a RosenbrockTableau:
//
//   struct Rodas4 : RosenbrockMethod<Rodas4> { ... static constexpr RosenbrockTableau<6, 3> tableau{...}; };
#pragma once
#include <array>
#include <cmath>
#include <cstddef>
#include <utility>

#include <continuo/methods/implicit/implicit_method.hpp>
#include <continuo/methods/implicit/jacobian_of_step.hpp>
#include <continuo/methods/implicit/linearization.hpp>
#include <continuo/methods/implicit/newton.hpp>
#include <continuo/methods/implicit/unknowns_between.hpp>
#include <continuo/methods/method.hpp>
#include <continuo/methods/rosenbrock/rosenbrock_tableau.hpp>
#include <continuo/methods/support/compensated_sum.hpp>
#include <continuo/methods/support/tolerance_proportionality.hpp>
#include <continuo/methods/support/weighted_norm.hpp>
#include <continuo/methods/support/weighted_sum.hpp>
#include <continuo/numerics/finite.hpp>

namespace continuo {

template <class Derived>
struct RosenbrockMethod : ImplicitMethod<> {
  static constexpr bool second_order = false;

  template <State X>
  struct Workspace : StepEquations<Scalar<X>> {
    std::array<detail::Kept<X>, Derived::tableau.stages> u;
    X slope, end_slope;          // f at the start of the step, and at its end where a stage gives it
    X time_slope;                // df/dt at the start
    X argument, right, product;  // of f; of the linear systems; M times a sum: where X has no fixed size
    X rest, rest_new;            // what the sums that made x, and x_new, have lost: see takes_many_steps
    Linearization<X> linear;
    Factorization<X> lu;
    UnknownsBetween<Derived, X> unknowns{};
    bool start_fresh = false;   // slope is f at the start of the next step
    bool linear_fresh = false;  // J and df/dt are those of the start of the next step: it was rejected

    /// For checkpoints: what the next step depends on.
    template <class Archive>
    void transfer(Archive& archive) {
      archive(this->costs, this->status, slope, end_slope, rest, rest_new, linear);
      lu.transfer(archive, linear);
      archive(start_fresh, linear_fresh);
    }
  };

  template <State X>
  [[nodiscard]] static Workspace<X> workspace(const X& x) {
    return [&]<std::size_t... s>(std::index_sequence<s...>) {
      return Workspace<X>{
          {}, {((void)s, detail::keep(x))...}, x, x, x, x, x, x, x, x, Linearization<X>(x), Factorization<X>(x)};
    }(std::make_index_sequence<Derived::tableau.stages>());
  }

  template <class System, State X>
  static int step(System& system, const Scalar<X>& t, const X& x, const Scalar<X>& h, bool discontinuity,
                  Workspace<X>& work, X& x_new) {
    work.linear.bind(system);
    int evaluations = linearize(system, t, x, h, discontinuity, work);
    ++work.costs.factorizations;
    if (!work.lu.factor(work.linear, 1 / (h * constant<GammaValue, Scalar<X>>()))) {
      work.status = work.linear.status_of_failure();
      return evaluations;
    }
    work.status = StepStatus::done;
    return evaluations + solve_stages(system, t, x, h, discontinuity, work, x_new);
  }
  /// The second half of a step: work has f, J and df/dt at its start, and c M - J decomposed. Of lanes it is the same
  /// as of numbers.
  template <class System, State X>
  static int solve_stages(System& system, const Scalar<X>& t, const X& x, const Scalar<X>& h, bool discontinuity,
                          Workspace<X>& work, X& x_new) {
    if constexpr (detail::Packed<X>) {
      flat_stages(system, t, x, h, work, x_new);
    } else {
      stages(system, t, x, h, work, x_new);
    }
    work.costs.linear_solves += Derived::tableau.stages;
    if constexpr (takes_many_steps()) sum_with_rest(x, discontinuity, work, x_new);
    if constexpr (estimates_its_own_error<Derived>()) filter_error(h, work);
    const int between = work.unknowns.measure(system, t, h, x, work.linear, work.lu, [&](auto& interpolant) {
      interpolate(system, t, x, h, x_new, work, interpolant);
    });
    return between + static_cast<int>(Derived::tableau.stages) - 1;
  }

  /// Root mean square of error_i / scale_i; not a number where x_new is not finite.
  template <State X>
  [[nodiscard]] static Scalar<X> error_norm(const Workspace<X>& work, const Scalar<X>& h, const X& x, const X& x_new,
                                            const Tolerance<Scalar<X>>& tolerance) {
    using std::sqrt;
    return sqrt(error_square(work, h, x, x_new, tolerance));
  }
  template <State X>
  [[nodiscard]] static Scalar<X> error_square(const Workspace<X>& work, const Scalar<X>&, const X& x, const X& x_new,
                                              const Tolerance<Scalar<X>>& tolerance) {
    using Error = detail::Row<ErrorWeight, Derived::tableau.stages>;
    const auto u = detail::stages_of<Error, X>(work.u);
    const Scalar<X> spare(work.linear.has_mass() ? spare_of_constraints : 1);
    const Tolerance<Scalar<X>> weights = tolerance.of_error_times(spare);
    detail::Unit<X> sum{};
    detail::for_each_unit(x, [&](std::size_t i) __attribute__((always_inline)) {
      const detail::Unit<X> end = detail::load<X>(x_new.data(), i);
      const detail::Unit<X> ratio = detail::row_sum<Error, X>(u, i) / detail::step_scale<X>(weights, i, x, x_new);
      sum += ratio * ratio + detail::zero_if_finite(end);
    });
    const Scalar<X> between = work.unknowns.norm(x, x_new, tolerance);
    const Scalar<X> square = greater(Scalar<X>(spare * spare * detail::total<X>(sum) * detail::one_over_dimension(x)),
                                     Scalar<X>(between * between));
    if constexpr (!estimates_its_own_error<Derived>()) return square;
    // Errors that die out must be below the tolerance; those that stay must be so once they are added up.
    const Scalar<X> strict = strictness_of<Derived>(tolerance);
    const Scalar<X> lasting = strict * weighted_norm(work.product, x, x_new, tolerance.of_error_times(strict));
    return greater(square, Scalar<X>(lasting * lasting));
  }
  template <State X>
  [[nodiscard]] static Scalar<X> error_of(const Workspace<X>& work, const Scalar<X>&, std::size_t i) {
    using Error = detail::Row<ErrorWeight, Derived::tableau.stages>;
    return greater(detail::size_of_sum<Error, X>(work.u, Scalar<X>(1), i), work.unknowns.error_of(i));
  }

  template <class System, State X, int Degree>
  static int interpolate(System&, const Scalar<X>&, const X& x, const Scalar<X>&, const X& x_new,
                         const Workspace<X>& work, Interpolant<X, Degree>& interpolant) {
    static_assert(Degree == Derived::dense_degree && Degree == static_cast<int>(Derived::tableau.degree));
    using Unit = detail::Unit<X>;
    detail::for_each_unit(x, [&](std::size_t i) __attribute__((always_inline)) {
      const Unit start = detail::load<X>(x.data(), i), end = detail::load<X>(x_new.data(), i);
      std::array<Unit, static_cast<std::size_t>(Degree) + 1> power{start, end - start};
      [&]<std::size_t... n>(std::index_sequence<n...>) {
        (add_dense_term<n, X>(work, i, power), ...);
      }(std::make_index_sequence<Derived::tableau.degree - 1>());
      for (std::size_t j = 0; j < power.size(); ++j) detail::store<X>(power[j], i, interpolant.c[j].data());
    });
    return 0;
  }

  template <State X>
  static void accept(Workspace<X>& work) {
    using std::swap;
    if constexpr (Derived::tableau.first_same_as_last()) swap(work.slope, work.end_slope);
    if constexpr (takes_many_steps()) swap(work.rest, work.rest_new);
    work.start_fresh = Derived::tableau.first_same_as_last();
    work.linear_fresh = false;
  }

  /// f at the start of the next step is not that of the end of this one any more.
  template <State X>
  static void moved(Workspace<X>& work, const X&, const X&) {
    work.start_fresh = false;
  }

  /// f at the start of the last step; with a mass matrix that is M x'.
  template <State X>
  [[nodiscard]] static const X& derivative(const Workspace<X>& work) {
    return work.slope;
  }

 private:
  struct GammaValue {
    constexpr const Coefficient& operator()(std::size_t) const { return Derived::tableau.gamma; }
  };
  template <std::size_t s>
  struct NodeValue {
    constexpr const Coefficient& operator()(std::size_t) const { return Derived::tableau.alpha[s]; }
  };
  template <std::size_t s>
  struct TimeValue {
    constexpr const Coefficient& operator()(std::size_t) const { return Derived::tableau.gamma_sum[s]; }
  };
  template <std::size_t s>
  struct StageWeight {
    constexpr const Coefficient& operator()(std::size_t j) const { return Derived::tableau.a[s][j]; }
  };
  template <std::size_t s>
  struct SolvedWeight {
    constexpr const Coefficient& operator()(std::size_t j) const { return Derived::tableau.c[s][j]; }
  };
  struct EndWeight {
    constexpr const Coefficient& operator()(std::size_t j) const { return Derived::tableau.m[j]; }
  };
  struct ErrorWeight {
    constexpr const Coefficient& operator()(std::size_t j) const { return Derived::tableau.error[j]; }
  };
  template <std::size_t n>
  struct DenseWeight {
    constexpr const Coefficient& operator()(std::size_t j) const { return Derived::tableau.dense[n][j]; }
  };

  /// The greater one, as in detail::greater; of lanes, each.
  template <class Real>
  [[nodiscard]] static Real greater(const Real& a, const Real& b) {
    if constexpr (requires { select(b <= a, a, b); }) {
      return select(b <= a, a, b + (a - a));
    } else {
      return detail::greater(a, b);
    }
  }

  /// A method of order 2 makes ten million steps where one of order 4 makes ten thousand. Near 1 each of them loses up
  /// to 1e-16, and mostly on the same side while a component creeps: 4e-12 in Robertson's reaction at rtol = 1e-10.
  [[nodiscard]] static constexpr bool takes_many_steps() { return Derived::order <= 2; }

  /// x_new once more, from x and what was lost when it was made.
  template <State X>
  static void sum_with_rest(const X& x, bool discontinuity, Workspace<X>& work, X& x_new) {
    using Weights = detail::Row<EndWeight, Derived::tableau.stages>;
    const auto u = detail::stages_of<Weights, X>(work.u);
    if (discontinuity) {
      for (std::size_t i = 0; i < dimension(x); ++i) work.rest.data()[i] = Scalar<X>(0);
    }
    detail::for_each_unit(x, [&](std::size_t i) {
      detail::Unit<X> sum = detail::load<X>(x.data(), i), rest = detail::load<X>(work.rest.data(), i);
      detail::add_compensated(detail::row_sum<Weights, X>(u, i), sum, rest);
      detail::store<X>(sum, i, x_new.data());
      detail::store<X>(rest, i, work.rest_new.data());
    });
  }

  /// (c M - J)^-1 c M times the error: what of it is left where stiff components have lost theirs.
  template <State X>
  static void filter_error(const Scalar<X>& h, Workspace<X>& work) {
    using Error = detail::Row<ErrorWeight, Derived::tableau.stages>;
    const auto u = detail::stages_of<Error, X>(work.u);
    detail::for_each_unit(work.argument, [&, to = work.argument.data()](std::size_t i) __attribute__((always_inline)) {
      set_unit<X>(detail::row_sum<Error, X>(u, i), i, to);
    });
    work.linear.multiply_mass(work.argument, work.product);
    const Scalar<X> c = 1 / (h * constant<GammaValue, Scalar<X>>());
    for (std::size_t i = 0; i < dimension(work.product); ++i) work.product.data()[i] *= c;
    work.lu.solve(work.linear, work.product.data());
    ++work.costs.linear_solves;
  }

  /// One coefficient, 0 too.
  template <class Source, class Real>
  [[nodiscard]] static Real constant() {
    if constexpr (Source{}(0).is_zero()) {
      return Real(0);
    } else {
      return Real(detail::Row<Source, 1>::template weight<Real, 0>());
    }
  }

  /// f, J and df/dt at the start of the step, as far as they are not known.
  template <class System, State X>
  [[nodiscard]] static int linearize(System& system, const Scalar<X>& t, const X& x, const Scalar<X>& h,
                                     bool discontinuity, Workspace<X>& work) {
    int evaluations = 0;
    if (discontinuity || !work.start_fresh) {
      evaluate(system, t, x, work.slope);
      work.start_fresh = true;
      ++evaluations;
    }
    if (!discontinuity && work.linear_fresh) return evaluations;
    if (!work.linear.prepared()) work.linear.prepare(system, x);
    evaluations += detail::evaluate_jacobian_of_step(system, t, x, work.slope, h, work.tolerance, work.linear);
    if (!is_autonomous(system)) evaluations += evaluate_time_derivative(system, t, h, x, work.slope, work.time_slope);
    ++work.costs.jacobians;
    work.linear_fresh = true;
    return evaluations;
  }

  template <class System, State X>
  [[gnu::always_inline]] static void stages(System& system, const Scalar<X>& t, const X& x, const Scalar<X>& h,
                                            Workspace<X>& work, X& x_new) {
    const Scalar<X> inverse_h = 1 / h;
    [&]<std::size_t... s>(std::index_sequence<s...>) __attribute__((always_inline)) {
      (stage<s>(system, t, x, h, inverse_h, work), ...);
    }(std::make_index_sequence<Derived::tableau.stages>());
    add_sum<EndWeight>(x, work, x_new);
  }
  /// With f compiled into it: see ExplicitRungeKutta.
  template <class System, State X>
  [[gnu::flatten]] static void flat_stages(System& system, const Scalar<X>& t, const X& x, const Scalar<X>& h,
                                           Workspace<X>& work, X& x_new) {
    stages(system, t, x, h, work, x_new);
  }

  template <std::size_t s, class System, State X>
  [[gnu::always_inline]] static void stage(System& system, const Scalar<X>& t, const X& x, const Scalar<X>& h,
                                           const Scalar<X>& inverse_h, Workspace<X>& work) {
    if constexpr (detail::FixedSize<X>) {
      X argument{}, right{}, product{};
      solve_stage<s>(system, t, x, h, inverse_h, work, argument, right, product);
      if constexpr (detail::Packed<X>) {
        work.u[s] = detail::keep(right);
      } else {
        work.u[s] = right;
      }
    } else {
      solve_stage<s>(system, t, x, h, inverse_h, work, work.argument, work.u[s], work.product);
    }
  }
  template <std::size_t s, class System, State X>
  [[gnu::always_inline]] static void solve_stage(System& system, const Scalar<X>& t, const X& x, const Scalar<X>& h,
                                                 const Scalar<X>& inverse_h, Workspace<X>& work, X& argument, X& right,
                                                 X& product) {
    constexpr bool last = s + 1 == Derived::tableau.stages;
    if constexpr (s == 0) {
      right = work.slope;
    } else {
      add_sum<StageWeight<s>>(x, work, argument);
      evaluate(system, Scalar<X>(t + h * constant<NodeValue<s>, Scalar<X>>()), argument, right);
      if constexpr (last && Derived::tableau.first_same_as_last()) work.end_slope = right;
      add_solved<s, System>(work, inverse_h, argument, right, product);
    }
    if constexpr (!Derived::tableau.gamma_sum[s].is_zero()) {
      if (!is_autonomous(system)) {
        const Scalar<X> weight = h * constant<TimeValue<s>, Scalar<X>>();
        for (std::size_t i = 0; i < dimension(x); ++i) right.data()[i] += weight * work.time_slope.data()[i];
      }
    }
    work.lu.solve(work.linear, right.data());
  }

  /// y = x + sum_j row_j u_j. The newest term is added last and by itself: see advance().
  template <class Source, State X>
  [[gnu::always_inline]] static void add_sum(const X& x, const Workspace<X>& work, X& y) {
    using Weights = detail::Row<Source, Derived::tableau.stages>;
    constexpr std::size_t last = Weights::count - 1;
    const auto u = detail::stages_of<Weights, X>(work.u);
    detail::for_each_unit(x, [&, from = x.data(), to = y.data()](std::size_t i) __attribute__((always_inline)) {
      const detail::Unit<X> older = detail::load<X>(from, i) + detail::row_sum<Weights, X, last>(u, i);
      set_unit<X>(older + Weights::template weight<Scalar<X>, last>() * u[last][i], i, to);
    });
  }

  /// right += M sum_j c_sj u_j / h.
  template <std::size_t s, class System, State X>
  [[gnu::always_inline]] static void add_solved(const Workspace<X>& work, const Scalar<X>& inverse_h, X& sum, X& right,
                                                X& product) {
    using Weights = detail::Row<SolvedWeight<s>, s>;
    const auto u = detail::stages_of<Weights, X>(work.u);
    if constexpr (HasMassMatrix<System, X> || HasMassDiagonal<System, X>) {
      if (work.linear.has_mass()) {
        detail::for_each_unit(right, [&, to = sum.data()](std::size_t i) __attribute__((always_inline)) {
          set_unit<X>(inverse_h * detail::row_sum<Weights, X>(u, i), i, to);
        });
        work.linear.multiply_mass(sum, product);
        for (std::size_t i = 0; i < dimension(right); ++i) right.data()[i] += product.data()[i];
        return;
      }
    }
    detail::for_each_unit(right, [&, to = right.data()](std::size_t i) __attribute__((always_inline)) {
      set_unit<X>(unit<X>(to, i) + inverse_h * detail::row_sum<Weights, X>(u, i), i, to);
    });
  }

  /// A unit of a local state, which stays in registers that way.
  template <State X>
  [[nodiscard]] [[gnu::always_inline]] static detail::Unit<X> unit(const Scalar<X>* from, std::size_t i) {
    if constexpr (detail::Packed<X>) {
      return detail::gather<X>(from, i, Scalar<X>(0));
    } else {
      return from[i];
    }
  }
  template <State X>
  [[gnu::always_inline]] static void set_unit(const detail::Unit<X>& value, std::size_t i, Scalar<X>* to) {
    if constexpr (detail::Packed<X>) {
      detail::scatter<X>(value, i, to);
    } else {
      to[i] = value;
    }
  }

  /// To the powers of theta: theta (1 - theta) theta^n d_n.
  template <std::size_t n, State X, class Powers>
  [[gnu::always_inline]] static void add_dense_term(const Workspace<X>& work, std::size_t i, Powers& power) {
    using Weights = detail::Row<DenseWeight<n>, Derived::tableau.stages>;
    const detail::Unit<X> term = detail::row_sum<Weights, X>(detail::stages_of<Weights, X>(work.u), i);
    power[n + 1] += term;
    power[n + 2] -= term;
  }
};

}  // namespace continuo
