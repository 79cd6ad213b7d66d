// continuo/methods/structural/structural_dynamics.hpp
// One-step methods of structural dynamics, for M q'' = f(t, q, v), f linear or not. With the new accelerations a_1 as
// unknowns,
//
//   q_1 = q + h v + h^2 ((1/2 - beta) a + beta a_1),   v_1 = v + h ((1 - gamma) a + gamma a_1),
//   M ((1 - alpha_m) a_1 + alpha_m a) = f at the point alpha_f of the way back from (t_1, q_1, v_1) to (t, q, v).
//
// N. M. Newmark, J. Eng. Mech. Div. ASCE 85 (1959); J. Chung, G. M. Hulbert, "A time integration algorithm for
// structural dynamics with improved numerical dissipation", J. Appl. Mech. 60 (1993) 371-375, with f taken at the point
// between, not averaged: the same for linear systems. The accelerations are carried from step to step.
#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include <continuo/methods/implicit/effective_matrix.hpp>
#include <continuo/methods/implicit/implicit_method.hpp>
#include <continuo/methods/implicit/newton.hpp>
#include <continuo/methods/support/hermite.hpp>
#include <continuo/methods/support/tolerance_proportionality.hpp>
#include <continuo/methods/support/weighted_norm.hpp>
#include <continuo/numerics/finite.hpp>
#include <continuo/system/mass.hpp>
#include <continuo/system/second_order.hpp>

namespace continuo {

template <class Real>
struct StructuralNumbers {
  Real alpha_m, alpha_f, beta, gamma;
};

/// `Derived` has `numbers<Real>()` and, where its error_order is not 0, `estimate(system, work)`, which sets
/// work.error.
template <class Derived>
struct StructuralDynamics : ImplicitMethod<> {
  static constexpr bool second_order = true;
  /// Between the ends: positions by the cubic that meets positions and velocities, velocities by the one that meets
  /// velocities and accelerations.
  static constexpr int dense_degree = 3, dense_order = 2;

  template <State X>
  struct Workspace : StepEquations<Scalar<X>> {
    using Real = Scalar<X>;
    X a, a_new, a_last;  // accelerations at the places of the velocities: start, end, start of the step before
    X stage, f, correction, error;
    Linearization<X> linear;
    EffectiveMatrix<X> effective;
    NewtonMemory<Real> memory{};
    Real h{}, h_last{}, decomposed_for{};  // of this step, of the one before, of the matrix; 0 for none
    Real offset{}, offset_new{};           // a is the acceleration of the time t + offset, a_new of t + h + offset_new
    Real gamma{};                          // of this step
    bool has_jacobian = false, is_current = false;

    /// For checkpoints: what the next step depends on.
    template <class Archive>
    void transfer(Archive& archive) {
      archive(this->costs, this->status, a, a_new, a_last, linear);
      effective.transfer(archive, linear);
      archive(memory, h, h_last, decomposed_for, offset, offset_new, gamma, has_jacobian, is_current);
    }
  };

  template <State X>
  [[nodiscard]] static Workspace<X> workspace(const X& x) {
    return {{}, x, x, x, x, x, x, x, Linearization<X>(x), EffectiveMatrix<X>(x)};
  }

  template <class System, State X>
  [[nodiscard]] static std::string_view unsupported_reason(const System& system, const X& x) {
    static_assert(SecondOrder<System>, "the system must say which components are positions and which velocities");
    const std::size_t n = dimension(x);
    if (2 * system.pair_count(n) != n) return "needs positions and velocities, and no other components";
    if (!positions_have_unit_mass(system, x)) return "needs q' = v without a mass, and M in the equations of v' only";
    return {};
  }

  template <class System, State X>
  static int step(System& system, const Scalar<X>& t, const X& x, const Scalar<X>& h, bool discontinuity,
                  Workspace<X>& work, X& x_new) {
    if (!work.linear.prepared()) {
      work.linear.prepare(system, x);
      work.effective.prepare(system, work.linear);
    }
    int evaluations = discontinuity ? begin(system, t, x, work) : 0;
    work.h = h;
    for (;;) {
      if (!work.has_jacobian) evaluations += linearize(system, t, x, work);
      if (h != work.decomposed_for && !decompose(system, h, work)) {
        if (work.is_current) break;
        work.has_jacobian = false;
        continue;
      }
      const bool converged = solve(system, t, x, work, evaluations);
      work.status = work.memory.status(converged);
      if (converged || work.is_current) break;
      work.has_jacobian = false;  // once more, with the matrix of here
    }
    set_end(system, x, work, x_new, Scalar<X>(1));
    if constexpr (Derived::error_order > 0) Derived::estimate(system, work);
    return evaluations;
  }

  template <class System, State X>
  static int interpolate(System& system, const Scalar<X>&, const X& x, const Scalar<X>& h, const X& x_new,
                         Workspace<X>& work, Interpolant<X, dense_degree>& interpolant) {
    using Real = Scalar<X>;
    const auto set = [&](std::size_t i, const Real& first, const Real& last) {
      std::array<Real, 4> c;
      detail::set_cubic_hermite<Real>(x.data()[i], x_new.data()[i], Real(h * first), Real(h * last), c);
      for (std::size_t j = 0; j < c.size(); ++j) interpolant.c[j].data()[i] = c[j];
    };
    const Real per_time = Real(1) / (h + work.offset_new - work.offset);
    for_each_pair(system, x, [&](std::size_t q, std::size_t v) {
      const Real a = work.a.data()[v], a_new = work.a_new.data()[v], rate = per_time * (a_new - a);
      set(q, x.data()[v], x_new.data()[v]);
      set(v, a - work.offset * rate, a_new - work.offset_new * rate);
    });
    return 0;
  }

  /// A step a little longer is not worth a factorization (E. Hairer, G. Wanner, "Solving Ordinary Differential
  /// Equations II", IV.8).
  template <State X>
  [[nodiscard]] static Scalar<X> next_factor(const Workspace<X>&, const Scalar<X>& factor, const Scalar<X>&, const X&,
                                             const X&, const Tolerance<Scalar<X>>&) {
    return factor >= Scalar<X>(1) && factor < Scalar<X>(1.2) ? Scalar<X>(1) : factor;
  }

  template <State X>
  static void accept(Workspace<X>& work) {
    using std::swap;
    swap(work.a_last, work.a);
    swap(work.a, work.a_new);
    work.h_last = work.h;
    work.offset = work.offset_new;
    work.is_current = false;
    if (work.memory.rate > slow) work.has_jacobian = false;
  }

  /// Root mean square of the errors against the tolerance, of a method that estimates them; not a number where x_new is
  /// not finite.
  template <State X>
  [[nodiscard]] static Scalar<X> error_norm(const Workspace<X>& work, const Scalar<X>&, const X& x, const X& x_new,
                                            const Tolerance<Scalar<X>>& tolerance) {
    Scalar<X> sum = detail::zero_if_all_finite(x_new);
    if constexpr (Derived::error_order > 0) {
      // The number of steps grows like tolerance^(-1/3), and so does what their errors add up to: held below the
      // tolerance by that factor, the error at the end stays in proportion to the tolerance.
      using std::pow;
      sum += weighted_norm(work.error, x, x_new, tolerance) *
             pow(relative_as_number(tolerance), Scalar<X>(-1) / Scalar<X>(3));
    }
    return sum;
  }
  template <State X>
  [[nodiscard]] static Scalar<X> error_of(const Workspace<X>& work, const Scalar<X>&, std::size_t i) {
    return Derived::error_order == 0 ? Scalar<X>(0) : work.error.data()[i];
  }

 protected:
  static constexpr int most_iterations = 8;
  static constexpr double slow = 0.1;

 private:
  template <class System, State X>
  [[nodiscard]] static bool positions_have_unit_mass(const System& system, const X& x) {
    using Real = Scalar<X>;
    bool unit = true;
    if constexpr (HasMassMatrix<System, X>) {
      const std::size_t n = dimension(x);
      std::vector<Real> rows(n * n);
      system.mass_matrix(std::span<Real>(rows));
      for_each_pair(system, x, [&](std::size_t position, std::size_t) {
        for (std::size_t j = 0; j < n; ++j) {
          unit = unit && rows[position * n + j] == Real(j == position ? 1 : 0);
          unit = unit && rows[j * n + position] == Real(j == position ? 1 : 0);
        }
      });
    } else if constexpr (HasMassDiagonal<System, X>) {
      for_each_pair(system, x,
                    [&](std::size_t position, std::size_t) { unit = unit && system.mass(position) == Real(1); });
    }
    return unit;
  }

  /// The accelerations of a new start: M a = f.
  template <class System, State X>
  [[nodiscard]] static int begin(System& system, const Scalar<X>& t, const X& x, Workspace<X>& work) {
    evaluate(system, t, x, work.a);
    divide_by_mass(system, work.a);
    for_each_pair(system, x, [&](std::size_t position, std::size_t) { work.a.data()[position] = Scalar<X>(0); });
    work.a_last = work.a;
    work.h_last = work.decomposed_for = work.offset = Scalar<X>(0);
    work.has_jacobian = work.is_current = false;
    work.memory = {};
    return 1;
  }

  template <class System, State X>
  [[nodiscard]] static int linearize(System& system, const Scalar<X>& t, const X& x, Workspace<X>& work) {
    evaluate(system, t, x, work.f);
    const int evaluations =
        work.linear.evaluate(system, t, x, work.f, LeastIncrements(work.tolerance, work.h, x, work.f, false));
    ++work.costs.jacobians;
    work.has_jacobian = work.is_current = true;
    work.decomposed_for = Scalar<X>(0);
    return evaluations + 1;
  }

  template <class System, State X>
  [[nodiscard]] static bool decompose(const System& system, const Scalar<X>& h, Workspace<X>& work) {
    using Real = Scalar<X>;
    const StructuralNumbers<Real> m = Derived::template numbers<Real>();
    ++work.costs.factorizations;
    const Real ahead = Real(1) - m.alpha_f;
    const bool done = work.effective.factor(
        system, work.linear, {Real(1) - m.alpha_m, Real(ahead * m.gamma * h), Real(ahead * m.beta * h * h)});
    work.decomposed_for = done ? h : Real(0);
    work.status = done ? StepStatus::done : work.linear.status_of_failure();
    return done;
  }

  /// In the middle of the steps of a long run accelerations belong to times (alpha_m - alpha_f) h beside the steps',
  /// and gamma is made for that. Where the run begins, and where h changes, the velocities get the weight that keeps
  /// them of order 2; the matrix, which only has to be near, keeps gamma.
  template <State X>
  static void place_accelerations(Workspace<X>& work) {
    using Real = Scalar<X>;
    const StructuralNumbers<Real> m = Derived::template numbers<Real>();
    const Real h = work.h;
    work.offset_new = ((Real(1) - m.alpha_f) * h - m.alpha_m * work.offset) / (Real(1) - m.alpha_m) - h;
    const Real weight = (Real(0.5) * h - work.offset) / (h + work.offset_new - work.offset);
    work.gamma = m.gamma + (weight - (Real(0.5) - m.alpha_m + m.alpha_f));
  }

  /// Newton's iteration for a_new, from a.
  template <class System, State X>
  [[nodiscard]] static bool solve(System& system, const Scalar<X>& t, const X& x, Workspace<X>& work,
                                  int& evaluations) {
    using Real = Scalar<X>;
    using std::max, std::min, std::sqrt;
    const StructuralNumbers<Real> m = Derived::template numbers<Real>();
    const Real rtol = relative_as_number(work.tolerance);
    const Real target = max(Real(10) * std::numeric_limits<Real>::epsilon() / rtol, min(Real(0.03), sqrt(rtol)));
    work.a_new = work.a;
    place_accelerations(work);
    const Real q_of_a = m.beta * work.h * work.h, v_of_a = work.gamma * work.h;
    return newton(work.memory, target, most_iterations, [&] {
      set_end(system, x, work, work.stage, Real(1) - m.alpha_f);
      evaluate(system, t + (Real(1) - m.alpha_f) * work.h, work.stage, work.f);
      ++evaluations;
      for (std::size_t i = 0; i < dimension(x); ++i)
        work.stage.data()[i] = (Real(1) - m.alpha_m) * work.a_new.data()[i] + m.alpha_m * work.a.data()[i];
      work.linear.multiply_mass(work.stage, work.correction);
      for (std::size_t i = 0; i < dimension(x); ++i)
        work.correction.data()[i] = work.f.data()[i] - work.correction.data()[i];
      work.effective.solve(system, work.correction);
      ++work.costs.linear_solves;
      for_each_pair(system, x, [&](std::size_t position, std::size_t velocity) {
        const Real change = work.correction.data()[velocity];
        work.a_new.data()[velocity] += change;
        work.correction.data()[position] = q_of_a * change;
        work.correction.data()[velocity] = v_of_a * change;
      });
      return weighted_norm(work.correction, x, x, work.tolerance);
    });
  }

  /// `part` of the way from x to the end that a_new gives.
  template <class System, State X>
  static void set_end(const System& system, const X& x, const Workspace<X>& work, X& to, const Scalar<X>& part) {
    using Real = Scalar<X>;
    const StructuralNumbers<Real> m = Derived::template numbers<Real>();
    const Real h = work.h;
    for_each_pair(system, x, [&](std::size_t q, std::size_t v) {
      const Real a = work.a.data()[v], more = work.a_new.data()[v] - a;
      to.data()[q] = x.data()[q] + part * h * (x.data()[v] + h * (Real(0.5) * a + m.beta * more));
      to.data()[v] = x.data()[v] + part * h * (a + work.gamma * more);
    });
  }
};

}  // namespace continuo
