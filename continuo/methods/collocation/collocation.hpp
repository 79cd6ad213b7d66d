// Fully implicit collocation methods for M x' = f(t, x), by one stepper: E. Hairer, G. Wanner, "Solving Ordinary
// Differential Equations II", IV.8, and "Stiff differential equations solved by Radau methods", J. Comput. Appl. Math.
// 111 (1999).
//
// With Z_i = X_i - x the stages solve M (A^-1 Z)_i = h f(t + c_i h, x + Z_i). In the coordinates W = forward Z that
// make A^-1 diagonal, an iteration of Newton's with one J for all stages solves (gamma / h M - J) dW = ... for each
// eigenvalue gamma of A^-1: a real system where s is odd, and s/2 complex ones. The collocation polynomial is the dense
// output, and beyond its end the first guess of the next step.
#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>

#include <continuo/methods/collocation/collocation_stages.hpp>
#include <continuo/methods/collocation/collocation_table.hpp>
#include <continuo/methods/collocation/collocation_workspace.hpp>
#include <continuo/methods/implicit/implicit_method.hpp>
#include <continuo/methods/implicit/jacobian_of_step.hpp>
#include <continuo/methods/implicit/linearization.hpp>
#include <continuo/methods/implicit/newton.hpp>
#include <continuo/methods/implicit/unknowns_at_end.hpp>
#include <continuo/methods/support/hermite.hpp>
#include <continuo/methods/support/tolerance_proportionality.hpp>
#include <continuo/methods/support/weighted_norm.hpp>
#include <continuo/numerics/finite.hpp>

namespace continuo {

/// A method with one or several numbers of stages, ascending; where several, the order is chosen by how fast Newton's
/// iteration converges.
template <collocation::Nodes nodes, std::size_t... Stages>
struct CollocationMethod : ImplicitMethod<> {
  static constexpr std::array<std::size_t, sizeof...(Stages)> all_stages{Stages...};
  static constexpr std::size_t least = all_stages.front(), most = all_stages.back();
  static constexpr bool radau = nodes == collocation::Nodes::radau;
  static constexpr int order = static_cast<int>(radau ? 2 * most - 1 : 2 * most);
  static constexpr int order_of_fixed_steps = static_cast<int>(radau ? 2 * least - 1 : 2 * least);
  static constexpr int error_order = radau ? static_cast<int>(most) : 3;
  static constexpr int dense_order = radau ? static_cast<int>(most) : 3;
  static constexpr int dense_degree = radau ? static_cast<int>(most) : 3;
  static constexpr bool second_order = false;

  template <State X>
  using Workspace = collocation::Workspace<X, most>;

  template <State X>
  [[nodiscard]] static Workspace<X> workspace(const X& x) {
    return Workspace<X>(x, least);
  }

  template <State X>
  static void set_tolerance(Workspace<X>& work, const Tolerance<Scalar<X>>& tolerance) {
    work.tolerance = tolerance;
    using std::max;
    Scalar<X> rtol = tolerance.rtol;
    if (tolerance.rtol_each) {
      rtol = Scalar<X>(0);
      for (std::size_t i = 0; i < dimension(work.f); ++i) rtol = max(rtol, tolerance.rtol_each[i]);
    }
    set_rtol(work, max(rtol, tolerance.atol_each ? rtol : tolerance.atol));
  }
  /// Whether the fastest of the system is an oscillation, as far as somebody knows. What is left of one counts in full.
  template <State X>
  static void expect_oscillation(Workspace<X>& work, bool oscillates) {
    if (work.oscillates != oscillates) work.rtol = Scalar<X>(-1);
    work.oscillates = oscillates;
  }
  template <State X>
  [[nodiscard]] static int error_order_of(const Workspace<X>& work) {
    return radau ? static_cast<int>(work.stages) : work.linear.has_mass() ? 2 : error_order;
  }

  template <class System, State X>
  static int step(System& system, const Scalar<X>& t, const X& x, const Scalar<X>& h, bool discontinuity,
                  Workspace<X>& work, X& x_new) {
    if (!work.linear.prepared()) {
      work.linear.prepare(system, x);
      if (work.linear.has_mass()) work.rtol = Scalar<X>(-1);  // whose looseness it is was not known yet
    }
    work.linear.bind(system);
    if (discontinuity) work.restart(least);
    int evaluations = 0;
    if (!work.has_f) {
      evaluate(system, t, x, work.f);
      work.has_f = true;
      ++evaluations;
    }
    for (std::size_t i = 0; i < dimension(x); ++i)
      work.weight.data()[i] = Scalar<X>(1) / work.tolerance.scale(i, x.data()[i], x.data()[i]);
    if (!work.has_jacobian) evaluations += linearize(system, t, x, h, work);
    with_stages(work.stages, [&]<std::size_t s>() {
      for (;;) {
        evaluations += solve<s>(system, t, x, h, work);
        if (work.status == StepStatus::done || work.jacobian_age == 0) break;
        evaluations += linearize(system, t, x, h, work);  // once more, with the matrix of here
      }
      evaluations += finish<s>(system, t, x, h, work, x_new);
    });
    return evaluations;
  }

  template <State X>
  [[nodiscard]] static Scalar<X> error_norm(const Workspace<X>& work, const Scalar<X>&, const X& x, const X& x_new,
                                            const Tolerance<Scalar<X>>& tolerance) {
    return norm_of_error(work, x, x_new, tolerance) + detail::zero_if_all_finite(x_new);
  }
  template <State X>
  [[nodiscard]] static Scalar<X> error_of(const Workspace<X>& work, const Scalar<X>&, std::size_t i) {
    return work.error.data()[i] / work.looseness;
  }

  template <State X>
  [[nodiscard]] static Scalar<X> next_factor(Workspace<X>& work, const Scalar<X>&, const Scalar<X>& h, const X& x,
                                             const X& x_new, const Tolerance<Scalar<X>>& tolerance) {
    using Real = Scalar<X>;
    using std::min;
    const Real error = norm_of_error(work, x, x_new, tolerance);
    Real factor = work.wanted_factor(h, error, most_iterations<Real>(work.stages), error_order_of(work));
    // After a change of order the error between the nodes is not known yet.
    if (work.ahead_degree != 0 && work.ahead_degree != work.stages) factor = min(factor, Real(2));
    work.next_stages = stages_after(work, factor);
    const bool worth_keeping = work.memory.rate <= keeping_rate && work.next_stages == work.stages;
    return worth_keeping && factor >= Real(1) && factor <= Real(least_worthwhile) ? Real(1) : factor;
  }

  template <State X>
  static void rejected(Workspace<X>& work, const Scalar<X>&) {
    work.was_rejected = true;
    if (work.status != StepStatus::newton_diverged || work.stages == least) return;
    work.stages -= 2;  // see stages_after
    work.steps_of_order = 0;
    work.rtol = Scalar<X>(-1);
  }

  template <class System, State X>
  static int interpolate(System&, const Scalar<X>&, const X& x, const Scalar<X>& h, const X& x_new, Workspace<X>& work,
                         Interpolant<X, dense_degree>& interpolant) {
    with_stages(work.stages, [&]<std::size_t s>() {
      const auto& table = collocation::table_for<X, nodes, s>();
      for (std::size_t i = 0; i < dimension(x); ++i) {
        std::array<Scalar<X>, static_cast<std::size_t>(dense_degree) + 1> powers{};
        if (radau || work.linear.has_mass()) {
          powers[0] = x.data()[i];
          for (std::size_t k = 0; k < s; ++k)
            for (std::size_t j = 0; j < s; ++j) powers[k + 1] += table.powers[k][j] * work.Z[j].data()[i];
        } else if constexpr (!radau) {
          detail::set_cubic_hermite<Scalar<X>>(x.data()[i], x_new.data()[i], Scalar<X>(h * work.f.data()[i]),
                                               Scalar<X>(h * work.f_end.data()[i]), powers);
        }
        for (std::size_t k = 0; k < powers.size(); ++k) interpolant.c[k].data()[i] = powers[k];
      }
    });
    return 0;
  }

  template <State X>
  static void accept(Workspace<X>& work) {
    with_stages(work.stages, [&]<std::size_t s>() {
      const auto& table = collocation::table_for<X, nodes, s>();
      collocation::for_each_sums(
          table.ahead, work.Z, [&](std::size_t i, const auto& ahead) __attribute__((always_inline)) {
            detail::unrolled<0, s>([&](auto k) __attribute__((always_inline)) { work.ahead[k].data()[i] = ahead[k]; });
          });
    });
    work.ahead_degree = work.stages;
    work.ahead_h = work.h;
    work.has_f = !radau;
    if (!radau) std::swap(work.f, work.f_end);
    ++work.jacobian_age;
    if (work.memory.rate > keeping_rate) work.has_jacobian = false;
    work.was_rejected = false;
    if (work.next_stages != work.stages) work.rtol = Scalar<X>(-1);
    work.steps_of_order = work.next_stages == work.stages ? work.steps_of_order + 1 : 0;
    work.stages = work.next_stages;
  }

  /// f at the start of the next step is not that of the end of this one any more.
  template <State X>
  static void moved(Workspace<X>& work, const X&, const X&) {
    work.has_f = false;
  }

  template <State X>
  [[nodiscard]] static X derivative(const Workspace<X>& work) {
    return work.linear.has_mass() ? work.slope : work.f;
  }

 private:
  static constexpr double keeping_rate = 1e-3, least_worthwhile = 1.2;
  // The error between the nodes is held to this many tolerances: it is known from the step before, and changes.
  static constexpr double dense_looseness = 5;

  template <class Do>
  static void with_stages(std::size_t stages, Do&& act) {
    ((stages == Stages ? act.template operator()<Stages>() : void()), ...);
  }
  template <class Real>
  [[nodiscard]] static constexpr int most_iterations(std::size_t stages) {
    constexpr int in_double = 7, digits = std::numeric_limits<Real>::digits;
    return in_double * (digits > 53 ? digits : 53) / 53 + (radau ? 5 * (static_cast<int>(stages) - 3) / 2 : 3);
  }

  // The estimate is of order s + 1 in h and the method's error of order 2s: what the estimate must stay below for the
  // error to follow the tolerance is 0.1 rtol^((s+1)/2s), here as a factor on the tolerance. But the error of stiff
  // components is of the order of the estimate, and about a tenth of it: a factor above 100 would show there. That of
  // an oscillation, which a step of several of its periods damps, is as large as the estimate.
  template <State X>
  static void set_rtol(Workspace<X>& work, const Scalar<X>& rtol) {
    using std::max, std::min, std::pow;
    using Real = Scalar<X>;
    if (rtol == work.rtol) return;
    work.rtol = rtol;
    const Real epsilon = std::numeric_limits<Real>::epsilon();
    const Real least_rtol = max(rtol, epsilon), s = Real(static_cast<double>(work.stages));
    work.looseness = radau && !work.oscillates
                         ? min(Real(100), Real(0.1) * pow(min(least_rtol, Real(1)), (1 - s) / (2 * s)))
                         : Real(1);
    // With a mass there are constraints below the algebraic equations as a rule, and nothing holds a run to those.
    if (work.linear.has_mass()) work.looseness = max(Real(1), work.looseness / Real(spare_of_constraints));
    // Gauss keeps its invariants as far as its equations are solved. So does what algebraic equations were
    // differentiated from: what an iteration leaves has always the same sign, and adds up.
    const Real part = Real(work.linear.has_mass() ? 3e-3 : 3e-2);
    work.target = max(10 * epsilon / least_rtol, radau ? part * min(Real(1), work.looseness) : Real(1e-3));
  }

  template <State X>
  [[nodiscard]] static Scalar<X> norm_of_error(const Workspace<X>& work, const X& x, const X& x_new,
                                               const Tolerance<Scalar<X>>& tolerance) {
    using std::max, std::sqrt;
    Scalar<X> sum(0), dense_sum(0);
    for (std::size_t i = 0; i < dimension(x); ++i) {
      const Scalar<X> unit = Scalar<X>(1) / tolerance.scale_of_step(i, x.data()[i], x_new.data()[i]);
      const Scalar<X> part = work.error.data()[i] * unit;
      sum += part * part;
      if constexpr (radau) {
        const Scalar<X> dense = work.dense_error.data()[i] * unit;
        dense_sum += dense * dense;
      }
    }
    const Scalar<X> dense_part = max(Scalar<X>(1), work.looseness / Scalar<X>(dense_looseness));
    dense_sum *= dense_part * dense_part;
    const Scalar<X> size = sum > dense_sum ? sum : dense_sum;
    return dimension(x) == 0 ? size
                             : Scalar<X>(sqrt(size / Scalar<X>(static_cast<double>(dimension(x)))) / work.looseness);
  }

  // What RADAU calls fast is a rate of 0.002. The stricter the tolerance, the more a higher order gains, and a few
  // iterations more are nothing against it: a nonlinearity that spoils the rate would keep a strict run at order 5.
  template <class Real>
  [[nodiscard]] static Real fast_rate(const Real& rtol) {
    using std::clamp, std::sqrt;
    return Real(2e-3) * clamp(sqrt(Real(1e-6) / rtol), Real(1), Real(50));
  }

  // The strategy of RADAU: the order goes up where Newton's iteration converges fast and steps are calm, and down where
  // it barely converges, for then it is what bounds the step (Hairer & Wanner 1999, section 4).
  template <State X>
  [[nodiscard]] static std::size_t stages_after(const Workspace<X>& work, const Scalar<X>& factor) {
    if (sizeof...(Stages) == 1 || work.steps_of_order < 10) return work.stages;
    const auto& memory = work.memory;
    if (memory.rate >= Scalar<X>(0.8) && work.stages > least) return work.stages - 2;
    const bool calm = factor > Scalar<X>(0.8) && factor < Scalar<X>(1.2);
    if (calm && memory.iterations > 1 && memory.rate <= fast_rate(work.rtol) && work.stages < most)
      return work.stages + 2;
    return work.stages;
  }

  template <class System, State X>
  [[nodiscard]] static int linearize(System& system, const Scalar<X>& t, const X& x, const Scalar<X>& h,
                                     Workspace<X>& work) {
    const int evaluations = detail::evaluate_jacobian_of_step(system, t, x, work.f, h, work.tolerance, work.linear);
    ++work.costs.jacobians;
    work.has_jacobian = true;
    work.jacobian_age = 0;
    work.decomposed_for = Scalar<X>(0);
    return evaluations;
  }

  // The stages. work.status says whether they were found.
  template <std::size_t s, class System, State X>
  [[nodiscard]] static int solve(System& system, const Scalar<X>& t, const X& x, const Scalar<X>& h,
                                 Workspace<X>& work) {
    collocation::guess<nodes, s>(h, work);
    if (!collocation::decompose<nodes, s>(h, work)) return 0;
    if (work.linear.has_mass()) work.memory.measure_anew(work.tolerance);
    work.memory.matrix_is_known = work.jacobian_age == 0 || !work.memory.measures_anew;
    // With a mass the target is closer, and rejecting a step costs more than an iteration or two.
    const int iterations = most_iterations<Scalar<X>>(s) + (work.linear.has_mass() ? 3 : 0);
    const bool converged = newton(work.memory, work.target, iterations, [&] {
      collocation::stage_slopes<nodes, s>(system, t, x, h, work);
      return collocation::correct<nodes, s>(h, work);
    });
    work.status = work.memory.status(converged);
    return static_cast<int>(s) * work.memory.iterations;
  }

  // x_new, and the error where the stages were found.
  template <std::size_t s, class System, State X>
  [[nodiscard]] static int finish(System& system, const Scalar<X>& t, const X& x, const Scalar<X>& h,
                                  Workspace<X>& work, X& x_new) {
    using Real = Scalar<X>;
    const auto& table = collocation::table_for<X, nodes, s>();
    work.h = h;
    work.next_stages = s;
    const Real one_over_h = Real(1) / h;
    for (std::size_t i = 0; i < dimension(x); ++i) {
      Real change(0), slope(0), slope_end(0);
      for (std::size_t j = 0; j < s; ++j) {
        const Real z = work.Z[j].data()[i];
        change += table.end[j] * z;
        slope += table.powers[0][j] * z;
        slope_end += table.ahead[0][j] * z;
      }
      x_new.data()[i] = x.data()[i] + change;
      work.slope.data()[i] = slope * one_over_h;
      work.slope_end.data()[i] = slope_end * one_over_h;
    }
    if (work.status != StepStatus::done) return name_not_finite<s>(work, x_new);
    if constexpr (radau) {
      collocation::estimate_dense<nodes, s>(h, work);
      return estimate_radau(system, t, x, work, x_new);
    } else {
      const int evaluations = settle_unknowns(system, t, x, h, work, x_new);
      return work.status == StepStatus::done ? evaluations + estimate_gauss(system, t, x, h, work, x_new) : evaluations;
    }
  }

  // The end of a step of Gauss is no stage.
  template <class System, State X>
  [[nodiscard]] static int settle_unknowns(System& system, const Scalar<X>& t, const X& x, const Scalar<X>& h,
                                           Workspace<X>& work, X& x_new) {
    if (!detail::has_unknowns(work.linear, dimension(x))) return 0;
    if (!work.lu.factor(work.linear, detail::shift_for_unknowns(h))) {
      work.status = StepStatus::singular_matrix;
      return 0;
    }
    ++work.costs.factorizations;
    return detail::settle_unknowns(system, Scalar<X>(t + h), x, work.linear, work.lu, work.tolerance, work.target,
                                   work.f_end, x_new, work.status);
  }

  // f is to blame where one of its components is not finite: x_new takes it over, for the driver to name.
  template <std::size_t s, State X>
  [[nodiscard]] static int name_not_finite(const Workspace<X>& work, X& x_new) {
    if (work.status == StepStatus::not_finite) {
      for (std::size_t i = 0; i < dimension(x_new); ++i) {
        x_new.data()[i] = Scalar<X>(0);
        for (std::size_t j = 0; j < s; ++j) x_new.data()[i] += Scalar<X>(0) * work.F[j].data()[i];
      }
    }
    return 0;
  }

  // The quadrature on 0, c_1, ..., c_s whose weight of f(t, x) is 1 / gamma differs from the method by
  // h / gamma (f(t, x) - q'(0)); divided by 1 - h/gamma J it is bounded for stiff components too (eq. 8.19).
  template <class System, State X>
  [[nodiscard]] static int estimate_radau(System& system, const Scalar<X>& t, const X& x, Workspace<X>& work,
                                          const X& x_new) {
    const std::size_t n = dimension(x);
    work.linear.multiply_mass(work.slope, work.right);
    for (std::size_t i = 0; i < n; ++i) work.error.data()[i] = work.f.data()[i] - work.right.data()[i];
    work.lu.solve(work.linear, work.error.data());
    ++work.costs.linear_solves;
    // Once more where h may be far off: the filter alone does not go to 0 with it (eq. 8.20).
    const bool doubtful = work.was_rejected || work.ahead_degree == 0;
    if (!doubtful || !(norm_of_error(work, x, x_new, work.tolerance) >= Scalar<X>(1))) return 0;
    for (std::size_t i = 0; i < n; ++i) work.point.data()[i] = x.data()[i] + work.error.data()[i];
    evaluate(system, t, work.point, work.error);
    for (std::size_t i = 0; i < n; ++i) work.error.data()[i] -= work.right.data()[i];
    work.lu.solve(work.linear, work.error.data());
    ++work.costs.linear_solves;
    return 1;
  }

  // The cubic p through both ends with the slopes there does not solve the equation at c = 1/2 - sqrt(3)/6: h (f(t + c
  // h, p) - p'/h) is c (1 - c) (1 - 2 c)/12 h^4 x'''' = 0.008 h^4 x'''' at first, three times the error of p itself.
  // (The difference of f - q' between the ends would cost no evaluation, and the same in the middle would be of the
  // method's order; but where f is linear, q' and p' agree there whatever the step.) The filter is the complex matrix
  // there is, (gamma/h - J)^-1, whose real part is h/4 where J = 0. With a mass, f is not the slope, and equations may
  // be algebraic: there f - M q' at the end is used, of order h^2, which shows how far the end is from solving them.
  template <class System, State X>
  [[nodiscard]] static int estimate_gauss(System& system, const Scalar<X>& t, const X& x, const Scalar<X>& h,
                                          Workspace<X>& work, const X& x_new) {
    using Real = Scalar<X>;
    using std::sqrt;
    const std::size_t n = dimension(x_new);
    evaluate(system, Real(t + h), x_new, work.f_end);
    auto& pair = work.pair_right[0];
    if (work.linear.has_mass()) {
      work.linear.multiply_mass(work.slope_end, work.right);
      for (std::size_t i = 0; i < n; ++i) pair[i] = ComplexNumber<Real>(work.f_end.data()[i] - work.right.data()[i]);
    } else {
      const Real sixth = sqrt(Real(3)) / 6, c = Real(0.5) - sixth, part = Real(0.5) - 4 * sixth / 3;
      for (std::size_t i = 0; i < n; ++i)
        work.point.data()[i] = x.data()[i] + part * (x_new.data()[i] - x.data()[i]) +
                               h * (((1 - c) * work.f.data()[i] - c * work.f_end.data()[i]) / 6);
      evaluate(system, Real(t + c * h), work.point, work.right);
      for (std::size_t i = 0; i < n; ++i) {
        const Real slope = (x_new.data()[i] - x.data()[i]) / h + sixth * (work.f.data()[i] - work.f_end.data()[i]);
        pair[i] = ComplexNumber<Real>(4 * (work.right.data()[i] - slope));
      }
    }
    work.pair_lu[0].solve(work.linear, pair.data());
    ++work.costs.linear_solves;
    for (std::size_t i = 0; i < n; ++i) work.error.data()[i] = pair[i].re;
    return work.linear.has_mass() ? 1 : 2;
  }
};

}  // namespace continuo
