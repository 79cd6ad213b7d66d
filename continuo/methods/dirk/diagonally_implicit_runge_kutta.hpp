// continuo/methods/dirk/diagonally_implicit_runge_kutta.hpp
// The stepper of every diagonally implicit Runge-Kutta method, with an explicit first stage or without, and of additive
// ones, that treat a nonstiff part of f explicitly. A method is a struct with a name and a DiagonalTableau:
//
//   struct TrBdf2 : DiagonallyImplicitRungeKutta<TrBdf2> { ... static constexpr DiagonalTableau<3, 3> tableau = ...; };
//
// M may be singular (index 1). k_i comes from the solution of its stage, not from f, whose error there is that of the
// iteration times the stiffness; so does k_1 of the next step, where the last stage is its start. Therefore the
// estimate of the error needs no filter for stiff components: on a smooth solution all k_i are. The filter (c M - J)^-1
// c M of L. F. Shampine, L. S. Baca (J. Comp. Appl. Math. 11 (1984)) with a Jacobian that is kept from step to step
// took errors of ten to twenty tolerances for one where eigenvalues change, on van der Pol's oscillator and on HIRES.
#pragma once
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <type_traits>
#include <utility>

#include <continuo/methods/dirk/diagonal_tableau.hpp>
#include <continuo/methods/implicit/implicit_method.hpp>
#include <continuo/methods/implicit/stage_solver.hpp>
#include <continuo/methods/implicit/stiff_part.hpp>
#include <continuo/methods/implicit/unknowns_at_end.hpp>
#include <continuo/methods/implicit/unknowns_between.hpp>
#include <continuo/methods/method.hpp>
#include <continuo/methods/support/slope_in_time.hpp>
#include <continuo/methods/support/tolerance_proportionality.hpp>
#include <continuo/methods/support/weighted_norm.hpp>
#include <continuo/methods/support/weighted_sum.hpp>
#include <continuo/numerics/finite.hpp>
#include <continuo/system/mass.hpp>

namespace continuo {

template <class Derived>
struct DiagonallyImplicitRungeKutta : ImplicitMethod<InStageSolver> {
  static constexpr int error_order = 0;  // no estimate, unless Derived says so
  static constexpr bool second_order = false;

  template <State X>
  struct Workspace {
    std::array<X, Derived::tableau.stages> k;
    std::array<X, Derived::tableau.is_additive() ? Derived::tableau.stages : 1> nonstiff;  // of a split system
    X base, z, error;
    StageSolver<X> solver;
    UnknownsBetween<Derived, X> unknowns{};
    bool start_fresh = false;  // k[0] is x' at the start of the next step
    bool has_guess = false;    // k is that of the step before

    /// For checkpoints: what the next step depends on.
    template <class Archive>
    void transfer(Archive& archive) {
      archive(k, solver, start_fresh, has_guess);
    }
  };

  template <State X>
  [[nodiscard]] static Workspace<X> workspace(const X& x) {
    return [&]<std::size_t... s>(std::index_sequence<s...>) {
      Workspace<X> work{{((void)s, x)...}, {x}, x, x, x, StageSolver<X>(x)};
      work.nonstiff.fill(x);
      work.solver.insists = Derived::error_order == 0;
      for (std::size_t i = 0; i < dimension(x); ++i) work.error.data()[i] = Scalar<X>(0);
      return work;
    }(std::make_index_sequence<Derived::tableau.stages>());
  }

  template <class System, State X>
  static int step(System& system, const Scalar<X>& t, const X& x, const Scalar<X>& h, bool discontinuity,
                  Workspace<X>& work, X& x_new) {
    if constexpr (treats_as_split<System, X>()) {
      detail::StiffPart<System> stiff{system};
      return take_step(system, stiff, t, x, h, discontinuity, work, x_new);
    } else {
      return take_step(system, system, t, x, h, discontinuity, work, x_new);
    }
  }

  /// Root mean square of error_i / scale_i (0 without an estimate), times what a step is held below the tolerance by;
  /// not a number where x_new is not finite.
  template <State X>
  [[nodiscard]] static Scalar<X> error_norm(const Workspace<X>& work, const Scalar<X>& h, const X& x, const X& x_new,
                                            const Tolerance<Scalar<X>>& tolerance) {
    using std::sqrt;
    return sqrt(error_square(work, h, x, x_new, tolerance));
  }
  template <State X>
  [[nodiscard]] static Scalar<X> error_square(const Workspace<X>& work, const Scalar<X>&, const X& x, const X& x_new,
                                              const Tolerance<Scalar<X>>& tolerance) {
    const Scalar<X> strict = strictness_of<Derived>(tolerance), between = work.unknowns.norm(x, x_new, tolerance);
    const Tolerance<Scalar<X>> weights = tolerance.of_error_times(strict);
    Scalar<X> sum(0);
    for (std::size_t i = 0; i < dimension(x); ++i) {
      const Scalar<X>& end = x_new.data()[i];
      const Scalar<X> part = work.error.data()[i] / weights.scale_of_step(i, x.data()[i], end);
      sum += part * part + detail::zero_if_finite(end);
    }
    return detail::greater(Scalar<X>(strict * strict * sum * detail::one_over_dimension(x)),
                           Scalar<X>(between * between));
  }
  template <State X>
  [[nodiscard]] static Scalar<X> error_of(const Workspace<X>& work, const Scalar<X>&, std::size_t i) {
    using std::abs;
    return detail::greater(Scalar<X>(abs(work.error.data()[i])), work.unknowns.error_of(i));
  }

  template <class System, State X, int Degree>
  static int interpolate(System&, const Scalar<X>&, const X& x, const Scalar<X>& h, const X&, const Workspace<X>& work,
                         Interpolant<X, Degree>& interpolant) {
    static_assert(Degree == Derived::dense_degree && Degree == static_cast<int>(Derived::tableau.degree));
    interpolant.c[0] = x;
    [&]<std::size_t... n>(std::index_sequence<n...>) {
      (set_power<n, System>(h, work, interpolant.c[n + 1]), ...);
    }(std::make_index_sequence<Derived::tableau.degree>());
    return 0;
  }

  template <State X>
  static void accept(Workspace<X>& work) {
    using std::swap;
    if constexpr (ends_with_slope()) {
      if (work.start_fresh) swap(work.k[0], work.k[Derived::tableau.last]);
    }
    work.solver.accept();
    work.has_guess = true;
  }

  /// f at the start of the next step is not that of the end of this one any more.
  template <State X>
  static void moved(Workspace<X>& work, const X&, const X&) {
    work.start_fresh = false;
  }
  template <State X>
  [[nodiscard]] static Scalar<X> next_factor(const Workspace<X>& work, const Scalar<X>& factor, const Scalar<X>&,
                                             const X&, const X&, const Tolerance<Scalar<X>>&) {
    return work.solver.next_factor(factor);
  }

  /// x' at the start of the last step; at its first stage, if that is implicit.
  template <State X>
  [[nodiscard]] static const X& derivative(const Workspace<X>& work) {
    return work.k[0];
  }

 private:
  template <std::size_t s>
  struct StageWeight {
    constexpr const Coefficient& operator()(std::size_t j) const { return Derived::tableau.a[s][j]; }
  };
  template <std::size_t s>
  struct NonstiffWeight {
    constexpr const Coefficient& operator()(std::size_t j) const { return Derived::tableau.explicit_a[s][j]; }
  };
  template <std::size_t s>
  struct GuessWeight {
    constexpr Coefficient operator()(std::size_t j) const { return Derived::tableau.predictor(s, j); }
  };
  struct EndWeight {
    constexpr const Coefficient& operator()(std::size_t j) const { return Derived::tableau.b[j]; }
  };
  struct ErrorWeight {
    constexpr Coefficient operator()(std::size_t j) const {
      return Derived::tableau.b[j] - Derived::tableau.embedded[j];
    }
  };
  template <std::size_t n>
  struct DenseWeight {
    constexpr const Coefficient& operator()(std::size_t j) const { return Derived::tableau.dense[n][j]; }
  };

  template <class System, State X>
  [[nodiscard]] static constexpr bool treats_as_split() {
    return Derived::tableau.is_additive() && IsSplit<System, X> && !HasMassMatrix<System, X> &&
           !HasMassDiagonal<System, X>;
  }
  [[nodiscard]] static constexpr bool ends_with_slope() {
    return Derived::tableau.starts_explicit() && Derived::tableau.stiffly_accurate();
  }
  /// How far the iteration goes, in tolerances; further than others where no estimate says that this is too much.
  template <class Real>
  [[nodiscard]] static Real target(const Tolerance<Real>& tolerance) {
    if constexpr (Derived::error_order == 0) return Real(1e-4);
    return iteration_target<Derived>(tolerance);
  }

  /// Component i of sum_j row_j k_j.
  template <class Source, std::size_t Size, State X, std::size_t Slots>
  [[nodiscard]] [[gnu::always_inline]] static Scalar<X> sum_of(const std::array<X, Slots>& k, std::size_t i) {
    using Weights = detail::Row<Source, Size>;
    return [&]<std::size_t... n>(std::index_sequence<n...>) __attribute__((always_inline)) {
      return (Scalar<X>(0) + ... + (Weights::template weight<Scalar<X>, n>() * k[Weights::place[n]].data()[i]));
    }(std::make_index_sequence<Weights::count>());
  }

  template <class System, class Stiff, State X>
  [[nodiscard]] static int take_step(System& system, Stiff& stiff, const Scalar<X>& t, const X& x, const Scalar<X>& h,
                                     bool discontinuity, Workspace<X>& work, X& x_new) {
    using Real = Scalar<X>;
    constexpr std::size_t stages = Derived::tableau.stages;
    auto& solver = work.solver;
    const Real c = 1 / (h * Derived::tableau.gamma.template as<Real>());
    int evaluations = solver.prepare(stiff, t, x, h, discontinuity);
    if constexpr (Derived::tableau.starts_explicit()) {
      if (discontinuity || !work.start_fresh) evaluations += start(system, stiff, t, x, h, work);
    }
    if (discontinuity) work.has_guess = false;
    for (;;) {
      if (!solver.decompose(c)) return evaluations;
      const bool solved = [&]<std::size_t... s>(std::index_sequence<s...>) {
        return (stage<s>(system, stiff, t, x, h, work, evaluations) && ...);
      }(std::make_index_sequence<stages>());
      if (solved) break;
      if (solver.cannot_try_again()) return evaluations;
      solver.status = StepStatus::done;
      evaluations += solver.evaluate_jacobian(stiff, t, x, h);
    }
    finish<System>(x, h, work, x_new);
    if constexpr (!Derived::tableau.stiffly_accurate()) {
      if (detail::has_unknowns(solver.linear, dimension(x)))
        return evaluations + settle_unknowns(system, t, x, h, work, x_new);
    }
    if constexpr (Derived::error_order > 0) {
      evaluations += work.unknowns.measure(system, t, h, x, solver.linear, solver.lu, [&](auto& interpolant) {
        interpolate(system, t, x, h, x_new, work, interpolant);
      });
    }
    return evaluations;
  }

  /// x' at the start of the step.
  template <class System, class Stiff, State X>
  [[nodiscard]] static int start(System& system, Stiff& stiff, const Scalar<X>& t, const X& x, const Scalar<X>& h,
                                 Workspace<X>& work) {
    evaluate(stiff, t, x, work.k[0]);
    int evaluations = 1;
    if constexpr (treats_as_split<System, X>()) {
      system.nonstiff(t, x, work.nonstiff[0]);
      detail::keep_size(x, work.nonstiff[0]);
    } else {
      if constexpr (HasMassMatrix<System, X> || HasMassDiagonal<System, X>) {
        if (has_mass<X>(system)) evaluations += divide_by_singular_mass(system, t, x, h, work);
      }
      work.start_fresh = ends_with_slope();
    }
    return evaluations;
  }

  /// k_1 = x' where M x' = f with an M that may be singular: of an unknown of an algebraic equation 0 = g it is what
  /// keeps g at 0, g_x x' = -g_t. (c M - J) x' = c f + f_t says that for the rows without mass, and M x' = f for the
  /// others as far as c is large. f itself is left out of the rows of a diagonal M that are 0: it is no more than what
  /// the consistency of the start has left.
  template <class System, State X>
  [[nodiscard]] static int divide_by_singular_mass(System& system, const Scalar<X>& t, const X& x, const Scalar<X>& h,
                                                   Workspace<X>& work) {
    using Real = Scalar<X>;
    X& k = work.k[0];
    const Real c = 1 / (h * detail::sqrt_of_epsilon<Real>());
    work.base = k;
    int evaluations = 0;
    for (std::size_t i = 0; i < dimension(x); ++i) k.data()[i] = is_algebraic<X>(system, i) ? Real(0) : c * k.data()[i];
    if (!is_autonomous(system)) {
      evaluations = detail::slope_in_time(system, t, h, x, work.base, work.z);
      for (std::size_t i = 0; i < dimension(x); ++i) k.data()[i] += work.z.data()[i];
    }
    if (!work.solver.decompose(c)) {
      work.solver.status = StepStatus::done;
      for (std::size_t i = 0; i < dimension(x); ++i) k.data()[i] = Real(0);
    } else {
      work.solver.lu.solve(work.solver.linear, k.data());
    }
    if constexpr (HasMassDiagonal<System, X>) {
      for (std::size_t i = 0; i < dimension(x); ++i)
        if (!is_algebraic<X>(system, i)) k.data()[i] = work.base.data()[i] / system.mass(i);
    }
    return evaluations;
  }

  template <std::size_t s, class System, class Stiff, State X>
  [[nodiscard]] static bool stage(System& system, Stiff& stiff, const Scalar<X>& t, const X& x, const Scalar<X>& h,
                                  Workspace<X>& work, int& evaluations) {
    using Real = Scalar<X>;
    if constexpr (!Derived::tableau.a[s][s].is_zero()) {
      auto& solver = work.solver;
      const Real t_stage = t + h * Derived::tableau.c[s].template as<Real>();
      for (std::size_t i = 0; i < dimension(x); ++i) {
        Real sum = sum_of<StageWeight<s>, s>(work.k, i);
        if constexpr (treats_as_split<System, X>()) sum += sum_of<NonstiffWeight<s>, s>(work.nonstiff, i);
        work.base.data()[i] = x.data()[i] + h * sum;
        if constexpr (s > 0) {
          work.z.data()[i] = sum_of<GuessWeight<s>, s>(work.k, i) / solver.shift;
        } else {
          work.z.data()[i] = work.has_guess ? work.k[0].data()[i] / solver.shift : Real(0);
        }
      }
      if (!solver.solve(stiff, t_stage, work.base, x, work.z, target(solver.tolerance), evaluations)) return false;
      for (std::size_t i = 0; i < dimension(x); ++i) work.k[s].data()[i] = solver.shift * work.z.data()[i];
      if constexpr (treats_as_split<System, X>()) {
        for (std::size_t i = 0; i < dimension(x); ++i)
          solver.argument.data()[i] = work.base.data()[i] + work.z.data()[i];
        system.nonstiff(t_stage, solver.argument, work.nonstiff[s]);
        detail::keep_size(x, work.nonstiff[s]);
      }
    }
    return true;
  }

  template <class System, State X>
  static void finish(const X& x, const Scalar<X>& h, Workspace<X>& work, X& x_new) {
    constexpr std::size_t stages = Derived::tableau.stages;
    constexpr bool split = treats_as_split<System, X>();
    for (std::size_t i = 0; i < dimension(x); ++i) {
      if constexpr (Derived::tableau.stiffly_accurate() && !split) {
        x_new.data()[i] = work.base.data()[i] + work.z.data()[i];
      } else {
        Scalar<X> sum = sum_of<EndWeight, stages>(work.k, i);
        if constexpr (split) sum += sum_of<EndWeight, stages>(work.nonstiff, i);
        x_new.data()[i] = x.data()[i] + h * sum;
      }
      if constexpr (Derived::error_order > 0) {
        Scalar<X> sum = sum_of<ErrorWeight, stages>(work.k, i);
        if constexpr (split) sum += sum_of<ErrorWeight, stages>(work.nonstiff, i);
        work.error.data()[i] = h * sum;
      }
    }
  }

  // With the Jacobian of the step; where that does not lead to the unknowns, with those of where it does lead.
  template <class System, State X>
  [[nodiscard]] static int settle_unknowns(System& system, const Scalar<X>& t, const X& x, const Scalar<X>& h,
                                           Workspace<X>& work, X& x_new) {
    constexpr int most_jacobians = 20;
    auto& solver = work.solver;
    int evaluations = 0;
    for (int tries = 0; tries < most_jacobians; ++tries) {
      if (tries > 0) evaluations += solver.evaluate_jacobian(system, Scalar<X>(t + h), x_new, h);
      solver.status = StepStatus::done;
      if (!solver.decompose(detail::shift_for_unknowns(h))) return evaluations;
      evaluations += detail::settle_unknowns(system, Scalar<X>(t + h), x, solver.linear, solver.lu, solver.tolerance,
                                             target(solver.tolerance), solver.residual, x_new, solver.status);
      if (solver.status != StepStatus::newton_diverged) break;
    }
    return evaluations;
  }

  template <std::size_t n, class System, State X>
  static void set_power(const Scalar<X>& h, const Workspace<X>& work, X& power) {
    constexpr std::size_t stages = Derived::tableau.stages;
    for (std::size_t i = 0; i < dimension(power); ++i) {
      Scalar<X> sum = sum_of<DenseWeight<n>, stages>(work.k, i);
      if constexpr (treats_as_split<System, X>()) sum += sum_of<DenseWeight<n>, stages>(work.nonstiff, i);
      power.data()[i] = h * sum;
    }
  }
};

}  // namespace continuo
