// continuo/methods/implicit/stage_solver.hpp
// Solves the equation of one implicit stage, M z = gamma h f(t, base + z), by simplified Newton iterations, and looks
// after the Jacobian and its factorization from stage to stage and from step to step.
//
//   evaluations += solver.prepare(system, t, x, h, discontinuity);  // a Jacobian, if there is none or it has grown old
//   if (!solver.decompose(1 / (gamma * h))) return solver.status;
//   // z: the guess, then the solution
//   if (!solver.solve(system, t_stage, base, x, z, target, evaluations)) return solver.status;
#pragma once
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

#include <continuo/methods/implicit/implicit_method.hpp>
#include <continuo/methods/implicit/linearization.hpp>
#include <continuo/methods/implicit/newton.hpp>
#include <continuo/methods/method.hpp>
#include <continuo/methods/support/weighted_norm.hpp>

namespace continuo {

template <State X>
struct StageSolver : StepEquations<Scalar<X>> {
  using Real = Scalar<X>;
  using StepEquations<Real>::tolerance, StepEquations<Real>::costs, StepEquations<Real>::status;

  Linearization<X> linear;
  Factorization<X> lu;
  X argument, residual, product;
  NewtonMemory<Real> memory{};
  Real shift{};             // c of the decomposed c M - J; 0: there is none
  Real evaluated_for{};     // h of the step that J was evaluated for
  Real slowest{};           // rate of convergence of this step
  bool insists = false;     // a step that is not solved cannot be a smaller one: iterate with ever new Jacobians
  bool is_current = false;  // J is that of the start of this step
  bool grown_old = true;    // J is to be evaluated before the next step

  explicit StageSolver(const X& x) : linear(x), lu(x), argument(x), residual(x), product(x) {}

  /// For checkpoints: what the next step depends on.
  template <class Archive>
  void transfer(Archive& archive) {
    archive(costs, status, linear);
    lu.transfer(archive, linear);
    archive(memory, shift, evaluated_for, slowest, is_current, grown_old);
  }

  /// Above this rate of convergence a new Jacobian saves more iterations than it costs.
  static constexpr double worst_rate = 0.1;
  /// What a Jacobian misses counts in proportion to h, and may be masked in all rates that were measured so far: after
  /// a jump of the solution, when steps grow again, an old one would stop the iteration short unnoticed.
  static constexpr double most_growth = 2;
  static constexpr int most_iterations = 10;

  /// Where a step begins: J at (t, x) unless the one at hand will do.
  template <class System>
  [[nodiscard]] int prepare(System& system, const Real& t, const X& x, const Real& h, bool discontinuity) {
    linear.bind(system);
    status = StepStatus::done;
    slowest = Real(0);
    memory.matrix_is_known = is_current;
    using std::abs;
    const bool is_old = grown_old || abs(h) > Real(most_growth) * abs(evaluated_for);
    return discontinuity || (is_old && !is_current) ? evaluate_jacobian(system, t, x, h) : 0;
  }
  template <class System>
  [[nodiscard]] int evaluate_jacobian(System& system, const Real& t, const X& x, const Real& h) {
    if (!linear.prepared()) linear.prepare(system, x);
    int evaluations = 0;
    if constexpr (HasJacobian<System, X> && !HasJacobianPattern<System>) {
      evaluations = linear.evaluate(system, t, x, residual, [](std::size_t) { return Real(1); });
    } else {
      evaluate(system, t, x, residual);
      evaluations =
          1 + linear.evaluate(system, t, x, residual, LeastIncrements(tolerance, h, x, residual, linear.has_mass()));
    }
    ++costs.jacobians;
    is_current = memory.matrix_is_known = true;
    grown_old = false;
    evaluated_for = h;
    shift = Real(0);
    return evaluations;
  }

  /// c M - J. False where it is singular, or J is not finite.
  [[nodiscard]] bool decompose(const Real& c) {
    if (shift == c) return true;
    ++costs.factorizations;
    if (lu.factor(linear, c)) {
      shift = c;
      return true;
    }
    shift = Real(0);
    status = linear.status_of_failure();
    return false;
  }

  /// Iterates z. `weights_of` is the state that tolerances are relative to. False: status says why.
  template <class System>
  [[nodiscard]] bool solve(System& system, const Real& t, const X& base, const X& weights_of, X& z, const Real& target,
                           int& evaluations) {
    using std::max;
    const std::size_t n = dimension(base);
    const auto correct = [&] {
      set_argument(base, z);
      evaluate(system, t, argument, residual);
      ++evaluations;
      linear.multiply_mass(z, product);
      for (std::size_t i = 0; i < n; ++i) residual.data()[i] -= shift * product.data()[i];
      lu.solve(linear, residual.data());
      ++costs.linear_solves;
      for (std::size_t i = 0; i < n; ++i) z.data()[i] += residual.data()[i];
      return root_mean_square<Real>(n, [&](std::size_t i) {
        const Real& size = weights_of.data()[i];
        return Real(residual.data()[i] / tolerance.scale(i, size, size));
      });
    };
    if (linear.has_mass()) memory.measure_anew(tolerance);
    bool arrived = newton(memory, target, most_iterations, correct);
    slowest = max(slowest, memory.rate);
    if (!arrived && insists && memory.finite) {
      arrived = solve_fully(system, t, base, z, target, correct, evaluations);
      if (status != StepStatus::done) return false;
    }
    if (!arrived) status = memory.status(arrived);
    return arrived;
  }

  /// Where a stage was not solved: a new Jacobian would not help.
  [[nodiscard]] bool cannot_try_again() const {
    return insists || is_current || status == StepStatus::not_finite || status == StepStatus::singular_matrix;
  }

  /// The step stands.
  void accept() {
    grown_old = grown_old || slowest > Real(worst_rate);
    is_current = false;
  }
  /// Keeps h, and with it the factorization, where it would grow only little (E. Hairer, G. Wanner II, IV.8).
  [[nodiscard]] Real next_factor(const Real& factor) const {
    return factor >= 1 && factor <= Real(1.2) && slowest <= Real(worst_rate) ? Real(1) : factor;
  }

 private:
  void set_argument(const X& base, const X& z) {
    for (std::size_t i = 0; i < dimension(base); ++i) argument.data()[i] = base.data()[i] + z.data()[i];
  }

  /// Newton's iteration proper, from z = 0.
  template <class System, class Correct>
  [[nodiscard]] bool solve_fully(System& system, const Real& t, const X& base, X& z, const Real& target,
                                 const Correct& correct, int& evaluations) {
    const Real c = shift;
    for (std::size_t i = 0; i < dimension(z); ++i) z.data()[i] = Real(0);
    for (int k = 0; k < 5 * most_iterations; ++k) {
      set_argument(base, z);
      evaluations += evaluate_jacobian(system, t, argument, 1 / c);
      is_current = false;
      grown_old = true;
      if (!decompose(c)) return false;
      const Real size = correct();
      memory.finite = size < std::numeric_limits<Real>::infinity();
      if (!memory.finite) return false;
      if (size <= target) return true;
    }
    return false;
  }
};

/// Of a workspace that has a StageSolver: see ImplicitMethod.
struct InStageSolver {
  template <class Work>
  auto& operator()(Work& work) const {
    return work.solver;
  }
};

}  // namespace continuo
