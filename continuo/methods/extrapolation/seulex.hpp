// The linearly implicit Euler method, extrapolated, of variable order 1 to 10 and variable step, for M x' = f(t, x), M
// possibly singular (index 1). P. Deuflhard, "Recent progress in extrapolation methods for ordinary differential
// equations", SIAM Review 27 (1985); P. Deuflhard, E. Hairer, J. Zugck, "One-step and extrapolation methods for
// differential-algebraic systems", Numer. Math. 51 (1987); E. Hairer, G. Wanner, "Solving Ordinary Differential
// Equations II", IV.9 and VI.5, with the name of their program.
//
// With H = h / n and J = df/dx where the step begins, a substep solves
//
//   (1/H M - J) (y_(i+1) - y_i) = f(t + (i + 1) H, y_i).
//
// The error of y_n is a series in H for any J; for a stiff system its terms are small only if J is accurate. Each row
// of the table decomposes one matrix. In the first substep a second correction of Newton's iteration,
//
//   (1/H M - J) d = f(t + H, y_1) - 1/H M (y_1 - x),
//
// is compared with the first: if the ratio is above 1 the step is rejected, if it is small the next step reuses J.
//
// Dense output (E. Hairer, A. Ostermann, "Dense output for extrapolation methods", Numer. Math. 58 (1990)): backward
// differences where the step ends, H^-q nabla^q y_n, approximate derivatives there and are series in H too. The
// polynomial of degree k with these derivatives, of orders 0 to k - 1, and the value where the step begins has order k.
#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <string_view>

#include <continuo/methods/extrapolation/extrapolation_method.hpp>
#include <continuo/methods/implicit/implicit_method.hpp>
#include <continuo/methods/implicit/jacobian_of_step.hpp>
#include <continuo/methods/implicit/linearization.hpp>
#include <continuo/methods/implicit/newton.hpp>
#include <continuo/methods/implicit/unknowns_between.hpp>
#include <continuo/methods/support/tolerance_proportionality.hpp>
#include <continuo/methods/support/weighted_norm.hpp>

namespace continuo {

/// For stiff systems whose factorizations are cheap beside f. Steps of a fixed size have order 4.
struct Seulex : ImplicitMethod<>, ExtrapolationMethod<Seulex> {
  static constexpr std::array<int, 10> numbers{2, 3, 4, 6, 8, 12, 16, 24, 32, 48};
  static constexpr int power = 1;
  static constexpr std::size_t starting_rows = 4;
  static constexpr std::string_view name = "seulex";
  static constexpr int order = 10, error_order = 9, starting_order = 4, dense_degree = 10, dense_order = 10;
  static constexpr int order_of_fixed_steps = 4;
  static constexpr std::array safety{0.6, 0.93};
  static constexpr double patience = 4;
  static constexpr double dense_looseness = 50;  // tolerances of the error within a step

  template <State X>
  struct Workspace : StepEquations<Scalar<X>>, ExtrapolationTable<X, numbers.size()> {
    using Real = Scalar<X>;
    std::array<X, 55> changes;                // the last j changes y_(i+1) - y_i of each row j, the last one first
    X slope;                                  // f at the start of the step
    X argument, change, correction, product;  // y_i; y_i - x; y_(i+1) - y_i; M (y_1 - x)
    Linearization<X> linear;
    Factorization<X> lu;
    UnknownsBetween<Seulex, X> unknowns{};
    Real rate{};                // ratio of the second correction to the first
    bool has_slope = false;     // slope is f at the start of this step
    bool has_jacobian = false;  // J may be used in this step
    bool is_current = false;    // J was evaluated at the start of this step

    /// For checkpoints: what the next step depends on.
    template <class Archive>
    void transfer(Archive& archive) {
      ExtrapolationTable<X, numbers.size()>::transfer(archive);
      archive(this->costs, this->status, slope, linear);
      lu.transfer(archive, linear);
      archive(rate, has_slope, has_jacobian, is_current);
    }

    explicit Workspace(const X& x)
        : ExtrapolationTable<X, numbers.size()>(x, starting_rows),
          slope(x),
          argument(x),
          change(x),
          correction(x),
          product(x),
          linear(x),
          lu(x) {
      changes.fill(x);
    }
  };

  template <State X>
  [[nodiscard]] static Workspace<X> workspace(const X& x) {
    return Workspace<X>(x);
  }
  [[nodiscard]] static constexpr double caution(std::size_t) { return 3; }
  /// A Jacobian is counted as five evaluations, a decomposition and the solution of a system as one (SEULEX).
  [[nodiscard]] static constexpr double cost(std::size_t j) {
    double sum = 5;
    for (std::size_t row = 0; row < j; ++row) sum += 1 + 2 * numbers[row];
    return sum;
  }

  /// Where the error of a stiff system falls with h more slowly than its order, the estimates of a few rows show no
  /// gain from further ones, and steps would stay as short as a low order requires.
  template <State X>
  [[nodiscard]] static std::size_t least_rows(const Workspace<X>& work) {
    using std::log10;
    const double digits = -static_cast<double>(log10(relative_as_number(work.tolerance)));
    return static_cast<std::size_t>(std::clamp(0.6 * digits - 0.5, 2.0, 7.0));
  }

  template <class System, State X>
  static int begin(System& system, const Scalar<X>& t, const X& x, const Scalar<X>& h, bool discontinuity,
                   Workspace<X>& work) {
    if (!work.linear.prepared()) work.linear.prepare(system, x);
    work.linear.bind(system);
    work.status = StepStatus::done;
    if (discontinuity) work.has_slope = work.has_jacobian = work.is_current = false;
    int evaluations = 0;
    if (!work.has_slope) {
      evaluate(system, t, x, work.slope);
      work.has_slope = true;
      evaluations = 1;
    }
    return work.has_jacobian ? evaluations : evaluations + linearize(system, t, x, h, work);
  }

  template <class System, State X>
  static int row(System& system, const Scalar<X>& t, const X& x, const Scalar<X>& h, std::size_t j,
                 Workspace<X>& work) {
    using Real = Scalar<X>;
    const std::size_t n = static_cast<std::size_t>(numbers[j - 1]), size = dimension(x);
    const Real substep = h / Real(static_cast<double>(n));
    int evaluations = 0;
    if (!decompose(Real(1 / substep), work)) {
      if (work.is_current || work.status != StepStatus::singular_matrix) return evaluations;
      evaluations += linearize(system, t, x, h, work);
      if (!decompose(Real(1 / substep), work)) return evaluations;
    }
    for (std::size_t i = 0; i < size; ++i) work.change.data()[i] = Real(0);
    for (std::size_t k = 1; k <= n; ++k) {
      for (std::size_t i = 0; i < size; ++i) work.argument.data()[i] = x.data()[i] + work.change.data()[i];
      evaluations += solve(system, Real(t + Real(static_cast<double>(k)) * substep), k == 1, work);
      if (n - k < j) work.changes[first_of(j) + n - k] = work.correction;
      for (std::size_t i = 0; i < size; ++i) work.change.data()[i] += work.correction.data()[i];
      if (j > 1 || k > 1) continue;
      evaluations += measure_rate(system, t, x, substep, work);
      if (!work.is_current && !(work.rate <= 10 * keeping_rate(work)))
        return evaluations + linearize(system, t, x, h, work) + row(system, t, x, h, j, work);
      // Steps of a fixed size cannot be made smaller.
      if (!work.controlled || work.rate <= Real(1)) continue;
      work.status = work.rate > Real(1) ? StepStatus::newton_diverged : StepStatus::not_finite;
      return evaluations;
    }
    work.table[j - 1] = work.change;
    return evaluations;
  }

  /// Estimates the error of the dense output. Unknowns that depend on t alone are exact at the ends of substeps for any
  /// h: see UnknownsBetween. Of a stiff system the same holds for the whole solution, nearly.
  template <class System, State X>
  static int finish(System& system, const Scalar<X>& t, const X& x, const Scalar<X>& h, const X& x_new,
                    Workspace<X>& work) {
    using Real = Scalar<X>;
    const std::size_t k = work.computed;
    if (k < 2) return 0;
    const Factors<Real>& factors = factors_of<Real>(k);
    // The greatest value of |s|^k (s + 1): times the next divided difference, the error. The last coefficient, a
    // divided difference too, replaces it.
    const auto rows = static_cast<Real>(static_cast<double>(k));
    Real nodes = 1 / (rows + 1);
    for (std::size_t i = 0; i < k; ++i) nodes *= rows / (rows + 1);
    const Real dense = root_mean_square<Real>(dimension(x), [&](std::size_t i) {
      const Real last = coefficients(work, factors, i)[k];
      return Real(nodes / Real(dense_looseness) * last / work.tolerance.scale_of_step(i, x.data()[i], x_new.data()[i]));
    });
    const int evaluations = work.unknowns.measure(system, t, h, x, work.linear, work.lu, [&](auto& interpolant) {
      interpolate(system, t, x, h, x_new, work, interpolant);
    });
    work.least_error = detail::greater(work.least_error, dense);
    work.least_error = detail::greater(work.least_error, work.unknowns.norm(x, x_new, work.tolerance));
    return evaluations;
  }
  template <class Work, class Real>
  [[nodiscard]] static Real error_of(const Work& work, const Real& h, std::size_t i) {
    using std::abs, std::max;
    return max(Real(abs(ExtrapolationMethod<Seulex>::error_of(work, h, i))), work.unknowns.error_of(i));
  }

  template <class System, State X>
  static int interpolate(System&, const Scalar<X>&, const X& x, const Scalar<X>&, const X&, Workspace<X>& work,
                         Interpolant<X, dense_degree>& interpolant) {
    using Real = Scalar<X>;
    const Factors<Real>& factors = factors_of<Real>(work.computed);
    for (std::size_t i = 0; i < dimension(x); ++i) {
      std::array<Real, dense_degree + 1> c = coefficients(work, factors, i);
      move_origin(c, work.computed, Real(1));
      interpolant.c[0].data()[i] = x.data()[i];
      for (std::size_t m = 1; m < c.size(); ++m) interpolant.c[m].data()[i] = c[m];
    }
    return 0;
  }

  template <State X>
  static void accept(Workspace<X>& work) {
    accept_rows(work);
    work.has_slope = work.is_current = false;
    work.has_jacobian = work.rate <= keeping_rate(work);
  }

  /// f at the start of the last step; with a mass matrix that is M x'.
  template <State X>
  [[nodiscard]] static const X& derivative(const Workspace<X>& work) {
    return work.slope;
  }

 private:
  /// A Jacobian costs little beside the decompositions. It is reused only if f is linear within the tolerance (SEULEX):
  /// otherwise the table of a stiff system converges so slowly that only short steps meet the tolerance, and short
  /// steps make the rate small.
  template <State X>
  [[nodiscard]] static Scalar<X> keeping_rate(const Workspace<X>& work) {
    using std::max, std::min, std::sqrt;
    const Scalar<X> of_differences = 10 * sqrt(std::numeric_limits<Scalar<X>>::epsilon());
    return min(Scalar<X>(1e-4), max(of_differences, relative_as_number(work.tolerance)));
  }

  /// The place of the last change of row j.
  [[nodiscard]] static constexpr std::size_t first_of(std::size_t j) { return j * (j - 1) / 2; }

  /// By derivative q and row j - 1: the weight of nabla^q y_n in h^q x^(q) / q!.
  template <class Real>
  using Factors = std::array<std::array<Real, numbers.size()>, numbers.size()>;
  template <class Real>
  [[nodiscard]] static const Factors<Real>& factors_of(std::size_t rows) {
    static const std::array<Factors<Real>, numbers.size() + 1> all = [] {
      std::array<Factors<Real>, numbers.size() + 1> result{};
      for (std::size_t k = 2; k < result.size(); ++k) {
        Real factorial(1);
        for (std::size_t q = 1; q < k; ++q) {
          factorial *= Real(static_cast<double>(q));
          for (std::size_t j = q; j <= k; ++j) {
            Real factor = weight<Real>(j, q, k) / factorial;
            for (std::size_t p = 0; p < q; ++p) factor *= Real(numbers[j - 1]);
            result[k][q][j - 1] = factor;
          }
        }
      }
      return result;
    }();
    return all[rows];
  }

  /// Of component i of the dense output: of the powers of theta - 1, of the change since x.
  template <State X>
  [[nodiscard]] static std::array<Scalar<X>, dense_degree + 1> coefficients(const Workspace<X>& work,
                                                                            const Factors<Scalar<X>>& factors,
                                                                            std::size_t i) {
    using Real = Scalar<X>;
    const std::size_t k = work.computed;
    std::array<Real, dense_degree + 1> c{};
    c[0] = work.table[0].data()[i];
    for (std::size_t j = 1; j <= k; ++j) {
      std::array<Real, numbers.size()> differences{};  // nabla^(q - 1) of the changes
      for (std::size_t p = 0; p < j; ++p) differences[p] = work.changes[first_of(j) + p].data()[i];
      for (std::size_t q = 1; q <= j && q < k; ++q) {
        c[q] += factors[q][j - 1] * differences[0];
        for (std::size_t p = 0; p + q < j; ++p) differences[p] -= differences[p + 1];
      }
    }
    // At theta = 0 there is no change.
    Real sum(0);
    for (std::size_t q = 0; q < k; ++q) sum += q % 2 == 0 ? c[q] : Real(-c[q]);
    c[k] = k % 2 == 0 ? Real(-sum) : sum;
    return c;
  }

  template <class System, State X>
  [[nodiscard]] static int linearize(System& system, const Scalar<X>& t, const X& x, const Scalar<X>& h,
                                     Workspace<X>& work) {
    ++work.costs.jacobians;
    work.has_jacobian = work.is_current = true;
    return detail::evaluate_jacobian_of_step(system, t, x, work.slope, h, work.tolerance, work.linear);
  }

  template <State X>
  [[nodiscard]] static bool decompose(const Scalar<X>& shift, Workspace<X>& work) {
    ++work.costs.factorizations;
    const bool done = work.lu.factor(work.linear, shift);
    work.status = done ? StepStatus::done : work.linear.status_of_failure();
    return done;
  }

  /// The correction of a substep from work.argument that ends at t.
  template <class System, State X>
  [[nodiscard]] static int solve(System& system, const Scalar<X>& t, bool first, Workspace<X>& work) {
    const bool is_known = first && is_autonomous(system);
    if (is_known) {
      work.correction = work.slope;
    } else {
      evaluate(system, t, work.argument, work.correction);
    }
    work.lu.solve(work.linear, work.correction.data());
    ++work.costs.linear_solves;
    return is_known ? 0 : 1;
  }

  template <class System, State X>
  [[nodiscard]] static int measure_rate(System& system, const Scalar<X>& t, const X& x, const Scalar<X>& substep,
                                        Workspace<X>& work) {
    using Real = Scalar<X>;
    using std::max;
    const Real first = weighted_norm(work.change, x, x, work.tolerance);
    for (std::size_t i = 0; i < dimension(x); ++i) work.argument.data()[i] = x.data()[i] + work.change.data()[i];
    evaluate(system, Real(t + substep), work.argument, work.correction);
    work.linear.multiply_mass(work.change, work.product);
    for (std::size_t i = 0; i < dimension(x); ++i) work.correction.data()[i] -= work.product.data()[i] / substep;
    work.lu.solve(work.linear, work.correction.data());
    ++work.costs.linear_solves;
    // A first correction below the tolerance does not count.
    work.rate = weighted_norm(work.correction, x, x, work.tolerance) / max(first, Real(1));
    return 1;
  }
};

}  // namespace continuo
