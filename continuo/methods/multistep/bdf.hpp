// continuo/methods/multistep/bdf.hpp
// Backward differentiation of variable order 1 to 5 and variable step, as numerical differentiation formulas (NDF).
// L. F. Shampine, M. W. Reichelt, "The MATLAB ODE suite", SIAM J. Sci. Comput. 18 (1997); E. Hairer, G. Wanner,
// "Solving Ordinary Differential Equations II", V.
//
// The past is kept as backward differences D_j of the last x at equal spacing h: x(t_n + s h) is the polynomial
// sum_j D_j s (s+1) ... (s+j-1) / j!. A new h moves the same polynomial to another spacing. With the predicted
// p = sum_{j<=k} D_j and the correction d = x_new - p, the formula of order k reads
//
//   M (alpha d + sum_{j=1..k} gamma_j D_j) = h f(t + h, p + d),   gamma_j = 1 + 1/2 + ... + 1/j,
//   alpha = (1 - kappa) gamma_k,   error = (kappa gamma_k + 1/(k+1)) d.
#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <string_view>
#include <type_traits>

#include <continuo/methods/implicit/direct_equations.hpp>
#include <continuo/methods/implicit/implicit_method.hpp>
#include <continuo/methods/implicit/newton.hpp>
#include <continuo/methods/support/slope_in_time.hpp>
#include <continuo/methods/support/tolerance_proportionality.hpp>
#include <continuo/methods/support/weighted_norm.hpp>
#include <continuo/numerics/finite.hpp>
#include <continuo/system/mass.hpp>

namespace continuo {

/// The numbers of the formulas, by order.
namespace ndf {

template <class Real>
[[nodiscard]] constexpr Real gamma(std::size_t k) {
  Real sum(0);
  for (std::size_t j = 1; j <= k; ++j) sum += Real(1) / Real(static_cast<double>(j));
  return sum;
}
// Shampine & Reichelt, table 1; order 5 keeps the formula of Gear.
template <class Real>
[[nodiscard]] constexpr Real kappa(std::size_t k) {
  constexpr std::array<double, 7> parts{0, -1850, 0, -823, -415, 0, 0};
  return k == 2 ? Real(-1) / Real(9) : Real(parts[k]) / Real(10000);
}
template <class Real>
[[nodiscard]] constexpr Real alpha(std::size_t k) {
  return (Real(1) - kappa<Real>(k)) * gamma<Real>(k);
}
template <class Real>
[[nodiscard]] constexpr Real error_constant(std::size_t k) {
  return kappa<Real>(k) * gamma<Real>(k) + Real(1) / Real(static_cast<double>(k) + 1);
}
/// The coefficients of (theta - 1) theta ... (theta + j - 2) / j!, which multiplies D_j of the end of the step, by
/// powers of theta.
template <class Real>
[[nodiscard]] constexpr std::array<Real, 7> basis(std::size_t j) {
  std::array<double, 7> product{1};
  double factorial = 1;
  for (std::size_t m = 1; m <= j; ++m) {
    factorial *= static_cast<double>(m);
    for (std::size_t p = m + 1; p-- > 0;)
      product[p] = (p > 0 ? product[p - 1] : 0) + (static_cast<double>(m) - 2) * product[p];
  }
  std::array<Real, 7> result{};
  for (std::size_t p = 0; p <= j; ++p) result[p] = Real(product[p]) / Real(factorial);
  return result;
}
/// (-1)^m times the binomial coefficient (j over m), by m.
[[nodiscard]] constexpr std::array<double, 7> alternating_binomials(std::size_t j) {
  std::array<double, 7> result{1};
  for (std::size_t m = 1; m <= j; ++m)
    result[m] = -result[m - 1] * static_cast<double>(j + 1 - m) / static_cast<double>(m);
  return result;
}

/// formula(k), k = 0..6. Where it computes with float, double or long double the compiler makes a table: its divisions
/// would take a fifth of the time of a step of a small system.
template <class Real, auto formula>
[[nodiscard]] decltype(auto) tabulated(std::size_t k) {
  if constexpr (std::is_floating_point_v<Real>) {
    static constexpr std::array table{formula(0), formula(1), formula(2), formula(3),
                                      formula(4), formula(5), formula(6)};
    return (table[k]);
  } else {
    return formula(k);
  }
}

}  // namespace ndf

/// The stepper. Equations<X> solves (c M - J) y = b: see direct_equations.hpp.
template <template <State> class Equations>
struct BackwardDifferentiation : ImplicitMethod<InEquations> {
  static constexpr int order = 5, error_order = 5, dense_order = 5, dense_degree = 5, order_of_fixed_steps = 2;
  static constexpr bool second_order = false;
  static constexpr std::size_t greatest_order = 5;

  template <State X>
  struct Workspace {
    using Real = Scalar<X>;
    std::array<X, greatest_order + 3> D;
    X d, end, f, correction;  // of the last step: x_new - predicted, x_new; f and a scratch
    X rounding;               // how far a step is off because t is rounded
    Equations<X> equations;
    NewtonMemory<Real> memory{};
    Real h{}, decomposed_for{};                     // the spacing of D; the c of lu, 0 for none
    Real asked{}, strict{};                         // a tolerance as one number, and its strictness
    std::size_t order = 1;                          // k of this step
    std::size_t next_order = 0;                     // 0: nobody asked, the steps are fixed
    std::size_t equal_steps = 0;                    // accepted ones of this h and order
    std::size_t rejections = 0;                     // since the last accepted
    std::size_t jacobian_age = 0;                   // steps
    bool has_jacobian = false, is_current = false;  // current: evaluated in this step

    /// For checkpoints: what the next step depends on.
    template <class Archive>
    void transfer(Archive& archive) {
      archive(D, d, end, rounding, equations, memory, h, decomposed_for);
      archive.index(order, greatest_order);
      archive.index(next_order, greatest_order);
      archive(equal_steps, rejections, jacobian_age, has_jacobian, is_current);
    }
  };

  template <State X>
  [[nodiscard]] static Workspace<X> workspace(const X& x) {
    Workspace<X> work{{x, x, x, x, x, x, x, x}, x, x, x, x, x, Equations<X>(x)};
    for (std::size_t i = 0; i < dimension(x); ++i) work.rounding.data()[i] = Scalar<X>(0);
    return work;
  }

  template <State X>
  [[nodiscard]] static int error_order_of(const Workspace<X>& work) {
    return static_cast<int>(work.order);
  }

  template <class System, State X>
  static int step(System& system, const Scalar<X>& t, const X& x, const Scalar<X>& h, bool discontinuity,
                  Workspace<X>& work, X& x_new) {
    if (!work.equations.prepared()) work.equations.prepare(system, x);
    if (const Scalar<X> asked = tolerance_as_number(work.equations.tolerance); asked != work.asked) {
      work.asked = asked;
      work.strict = strictness(work.equations.tolerance, order, order + 1);
    }
    int evaluations = 0;
    if (discontinuity) {
      evaluations += begin(system, t, x, h, work);
    } else if (h != work.h) {
      respace(work, h / work.h);
      work.equal_steps = 0;
    }
    work.h = h;
    work.is_current = work.equations.is_always_current(system);
    for (;;) {
      predict(work, x_new);
      const bool linearized = !work.has_jacobian || work.jacobian_age >= oldest_jacobian;
      if (linearized) evaluations += linearize(system, t + h, x_new, work);
      const Scalar<X> c = Scalar<X>(ndf::tabulated<Scalar<X>, ndf::alpha<Scalar<X>>>(work.order)) / h;
      if (c != work.decomposed_for && !decompose(system, work, c)) {
        if (work.is_current) break;
        work.has_jacobian = false;
        continue;
      }
      if (linearized && work.equations.has_mass()) evaluations += measure_rounding(system, t + h, h, x_new, work);
      const bool converged = solve(system, t + h, c, work, x_new, evaluations);
      work.equations.status = work.memory.status(converged);
      if (converged || work.is_current) break;
      work.has_jacobian = false;  // once more, with the matrix of here
    }
    work.end = x_new;
    return evaluations;
  }

  template <State X>
  [[nodiscard]] static Scalar<X> error_norm(const Workspace<X>& work, const Scalar<X>&, const X& x, const X& x_new,
                                            const Tolerance<Scalar<X>>& tolerance) {
    return ndf::tabulated<Scalar<X>, ndf::error_constant<Scalar<X>>>(work.order) *
               strict_norm(work, work.d, x, x_new, tolerance) +
           detail::zero_if_all_finite(x_new);
  }
  template <State X>
  [[nodiscard]] static Scalar<X> error_of(const Workspace<X>& work, const Scalar<X>&, std::size_t i) {
    return ndf::tabulated<Scalar<X>, ndf::error_constant<Scalar<X>>>(work.order) * work.d.data()[i];
  }

  /// The order whose error estimate allows the longest step, looked for when order + 1 steps were equal.
  template <State X>
  [[nodiscard]] static Scalar<X> next_factor(Workspace<X>& work, const Scalar<X>&, const Scalar<X>&, const X& x,
                                             const X& x_new, const Tolerance<Scalar<X>>& tolerance) {
    using Real = Scalar<X>;
    using std::max, std::min, std::pow;
    const std::size_t k = work.order;
    work.next_order = k;
    if (++work.equal_steps < k + 1) return Real(1);
    const auto factor_of = [&](std::size_t order, const Real& error) {
      return pow(max(error, Real(1e-10)), Real(-1) / Real(static_cast<double>(order) + 1));
    };
    const auto norm_of = [&](std::size_t order, auto&& component) {
      for (std::size_t i = 0; i < dimension(x); ++i) work.correction.data()[i] = component(i);
      return ndf::tabulated<Real, ndf::error_constant<Real>>(order) *
             strict_norm(work, work.correction, x, x_new, tolerance);
    };
    Real best = factor_of(
        k, ndf::tabulated<Real, ndf::error_constant<Real>>(k) * strict_norm(work, work.d, x, x_new, tolerance));
    // A factor is greater than the best one where error * best^(order + 1) < 1: roots are taken where that is not
    // clearly false.
    const auto consider = [&](std::size_t order, const Real& error) {
      Real product = max(error, Real(1e-10));
      for (std::size_t power = 0; power <= order; ++power) product *= best;
      if (product > Real(1.001)) return;
      if (const Real factor = factor_of(order, error); factor > best) best = factor, work.next_order = order;
    };
    // The difference of order k after this step, and that of order k + 2.
    if (k > 1) consider(k - 1, norm_of(k - 1, [&](std::size_t i) { return work.D[k].data()[i] + work.d.data()[i]; }));
    if (k < greatest_order)
      consider(k + 1, norm_of(k + 1, [&](std::size_t i) { return work.d.data()[i] - work.D[k + 1].data()[i]; }));
    // Slow convergence makes a longer step less worth wishing for (Hairer & Wanner II, IV.8).
    const Real patience = Real(2 * most_iterations + 1) / Real(2 * most_iterations + work.memory.iterations);
    const Real factor = min(Real(10), Real(0.9) * patience * best);
    if (work.next_order == k && factor >= Real(1) && factor < least_worthwhile) return Real(1);
    work.equal_steps = 0;
    return max(factor, Real(0.2));
  }

  template <State X>
  static void rejected(Workspace<X>& work, const Scalar<X>&) {
    retaken(work);
    // The higher differences are the first to be spoilt where the solution is not smooth.
    if (++work.rejections >= 2 && work.order > 1) --work.order;
  }
  template <State X>
  static void retaken(Workspace<X>& work) {
    work.equal_steps = 0;
    // A Jacobian of where the prediction went, far from the solution: a diode that conducts there by exp(400) lets no
    // correction through, and whatever the next try begins with would pass for solved.
    if (work.equations.has_mass()) work.has_jacobian = false;
  }

  template <class System, State X>
  static int interpolate(System&, const Scalar<X>&, const X& x, const Scalar<X>&, const X&, Workspace<X>& work,
                         Interpolant<X, dense_degree>& interpolant) {
    using Real = Scalar<X>;
    const std::size_t k = work.order;
    for (std::size_t i = 0; i < dimension(x); ++i) {
      std::array<Real, greatest_order + 1> powers{};
      Real difference = work.d.data()[i];
      for (std::size_t j = k; j >= 1; --j) {
        difference += work.D[j].data()[i];
        const auto& basis = ndf::tabulated<Real, ndf::basis<Real>>(j);
        // All powers, although those above j are zero: so they stay in registers.
#pragma GCC unroll 8
        for (std::size_t power = 0; power <= greatest_order; ++power) powers[power] += difference * basis[power];
      }
      powers[0] = x.data()[i];  // which is x_new - D_1: the only other basis without a zero at theta = 0
      for (std::size_t power = 0; power <= greatest_order; ++power) interpolant.c[power].data()[i] = powers[power];
    }
    return 0;
  }

  template <State X>
  static void accept(Workspace<X>& work) {
    const std::size_t k = work.order;
    for (std::size_t i = 0; i < dimension(work.d); ++i) {
      work.D[k + 2].data()[i] = work.d.data()[i] - work.D[k + 1].data()[i];
      work.D[k + 1].data()[i] = work.d.data()[i];
      for (std::size_t j = k; j >= 1; --j) work.D[j].data()[i] += work.D[j + 1].data()[i];
      work.D[0].data()[i] = work.end.data()[i];
    }
    // Without error control nobody chooses an order.
    if (work.next_order == 0) work.next_order = std::min(k + 1, greatest_of_fixed_steps);
    work.order = work.next_order;
    work.next_order = 0;
    work.rejections = 0;
    ++work.jacobian_age;
  }

  /// The whole history is moved: differences stay, and with them what the polynomial says of x'. A difference to the
  /// past that had the way of the end alone would be taken for a motion.
  template <State X>
  static void moved(Workspace<X>& work, const X&, const X& to) {
    work.D[0] = to;
  }

  template <State X>
  [[nodiscard]] static X derivative(const Workspace<X>& work) {
    X slope = work.D[1];
    for (std::size_t i = 0; i < dimension(slope); ++i) {
      slope.data()[i] = Scalar<X>(0);
      for (std::size_t j = 1; j <= work.order; ++j)
        slope.data()[i] += work.D[j].data()[i] / Scalar<X>(static_cast<double>(j));
      slope.data()[i] /= work.h;
    }
    return slope;
  }

 private:
  static constexpr int most_iterations = 4;
  static constexpr std::size_t oldest_jacobian = 50;
  static constexpr double least_worthwhile = 1.2;
  // The root mean square of the rounding of t, and of a product with it, is 0.4 spacings; differences of order 6 have
  // 30 times that, and their part in the estimate is a sixth. Three times that is rare.
  static constexpr double times_rounded = 6;
  // The first step has order 1 and leaves an error of the size of h^2: what the higher orders would gain is lost there,
  // and of order 2 the formula is still A-stable.
  static constexpr std::size_t greatest_of_fixed_steps = order_of_fixed_steps;

  // Whatever the order of the step: strict tolerances are met by the greatest.
  template <State X>
  [[nodiscard]] static Scalar<X> strict_norm(const Workspace<X>& work, const X& v, const X& x, const X& x_new,
                                             const Tolerance<Scalar<X>>& tolerance) {
    using Real = Scalar<X>;
    const Real strict =
        tolerance_as_number(tolerance) == work.asked ? work.strict : strictness(tolerance, order, order + 1);
    // Of steps of a few spacings of t alone: the error of a state adds up.
    const Real of_few = tolerance.rounding_of_time / Real(greatest_rounding_of_time);
    const Tolerance<Real> weights = tolerance.of_error_times(strict * of_few);
    const auto part = [&](std::size_t i) {
      const Real scale = weights.scale_of_step(i, x.data()[i], x_new.data()[i]);
      return Real(v.data()[i] / (scale + strict * work.rounding.data()[i]));
    };
    return strict * root_mean_square<Real>(dimension(x), part);
  }

  // Where t is rounded by dt, the solution of the step's equations is off by dt (c M - J)^-1 f_t: of 0 = g(t, x) by
  // dt g_t / g_x, whatever the step. Differences of order k show that multiplied, and a shorter step does not make them
  // less: the order would fall, and h with it, until nothing is left of it. An unknown is off as well by what the
  // iteration leaves the states off that it depends on, which is little against their tolerances and may be much
  // against its own.
  template <class System, State X>
  [[nodiscard]] static int measure_rounding(System& system, const Scalar<X>& t, const Scalar<X>& h, const X& x,
                                            Workspace<X>& work) {
    using Real = Scalar<X>;
    using std::abs, std::max;
    int evaluations = 0;
    for (std::size_t i = 0; i < dimension(x); ++i) work.rounding.data()[i] = Real(0);
    if (!is_autonomous(system)) {
      evaluations += detail::slope_in_time(system, t, h, x, work.f, work.correction);
      evaluations += work.equations.solve(system, t, x, work.f, Real(1e-2), work.correction);
      const Real spacing = std::numeric_limits<Real>::epsilon() * abs(t);
      for (std::size_t i = 0; i < dimension(x); ++i)
        work.rounding.data()[i] = Real(times_rounded) * spacing * abs(work.correction.data()[i]);
    }
    bool any = false;
    for (std::size_t i = 0; i < dimension(x); ++i) any = any || is_algebraic<X>(system, i);
    if (!any) return evaluations;
    // The states moved by what is left of them, many times over lest rounding hide it, in two patterns of signs.
    const Real many(1000), left = target_of(work) * many;
    X& moved = work.end;
    for (std::size_t pattern = 1; pattern <= 2; ++pattern) {
      for (std::size_t i = 0; i < dimension(x); ++i) {
        const Real& value = x.data()[i];
        const Real part = is_algebraic<X>(system, i) ? Real(0) : left * work.equations.tolerance.scale(i, value, value);
        moved.data()[i] = i % pattern == 0 ? value + part : value - part;
      }
      evaluate(system, t, x, work.f);
      evaluate(system, t, moved, work.correction);
      for (std::size_t i = 0; i < dimension(x); ++i)
        work.correction.data()[i] = is_algebraic<X>(system, i) ? work.correction.data()[i] - work.f.data()[i] : Real(0);
      evaluations += 2 + work.equations.solve(system, t, x, work.f, Real(1e-2), work.correction);
      for (std::size_t i = 0; i < dimension(x); ++i) {
        if (!is_algebraic<X>(system, i)) continue;
        Real& rounding = work.rounding.data()[i];
        rounding = max(rounding, Real(times_rounded) / many * abs(work.correction.data()[i]));
      }
    }
    return evaluations;
  }

  template <class System, State X>
  [[nodiscard]] static int begin(System& system, const Scalar<X>& t, const X& x, const Scalar<X>& h,
                                 Workspace<X>& work) {
    work.decomposed_for = Scalar<X>(0);
    evaluate(system, t, x, work.f);
    divide_by_mass(system, work.f);
    work.D[0] = x;
    for (std::size_t i = 0; i < dimension(x); ++i) work.D[1].data()[i] = h * work.f.data()[i];
    for (std::size_t j = 2; j < work.D.size(); ++j)
      for (std::size_t i = 0; i < dimension(x); ++i) work.D[j].data()[i] = Scalar<X>(0);
    work.order = 1;
    work.next_order = work.equal_steps = work.rejections = 0;
    work.has_jacobian = false;
    work.memory = {};
    return 1 + (work.equations.has_mass() ? add_slope_of_unknowns(system, t, x, h, work) : 0);
  }

  // Of an unknown of 0 = g it is what keeps g at 0, g_x x' = -g_t: a prediction that lets it stand still would be off
  // by h times that, and where it moves fast no h is short enough. (c M - J) x' = c M x' + f_t says the same for a c so
  // large that x' of the others stays.
  template <class System, State X>
  [[nodiscard]] static int add_slope_of_unknowns(System& system, const Scalar<X>& t, const X& x, const Scalar<X>& h,
                                                 Workspace<X>& work) {
    using Real = Scalar<X>;
    const Real c = 1 / (h * detail::sqrt_of_epsilon<Real>());
    X& slope = work.correction;
    slope = work.f;
    int evaluations = work.equations.linearize(system, t, x, h, work.f);
    if (!work.equations.decompose(system, c)) return evaluations;
    work.equations.multiply_mass(slope, work.end);
    slope = work.end;
    for (std::size_t i = 0; i < dimension(x); ++i) slope.data()[i] *= c;
    if (!is_autonomous(system)) {
      evaluations += detail::slope_in_time(system, t, h, x, work.f, work.end);
      for (std::size_t i = 0; i < dimension(x); ++i) slope.data()[i] += work.end.data()[i];
    }
    evaluations += work.equations.solve(system, t, x, work.f, Real(1e-2), slope);
    for (std::size_t i = 0; i < dimension(x); ++i)
      if (is_algebraic<X>(system, i)) work.D[1].data()[i] = h * slope.data()[i];
    return evaluations;
  }

  // The same polynomial at `ratio` times the spacing: D_new = (R(ratio) U)^T D with U = R(1), R_ij = product over
  // m = 1..i of (m - 1 - ratio j) / m (Shampine & Reichelt, section 2.2).
  template <State X>
  static void respace(Workspace<X>& work, const Scalar<X>& ratio) {
    using Real = Scalar<X>;
    const std::size_t k = work.order;
    std::array<std::array<Real, greatest_order + 1>, greatest_order + 1> r{}, product{};
    for (std::size_t j = 1; j <= k; ++j) {
      r[0][j] = Real(1);
      for (std::size_t i = 1; i <= k; ++i)
        r[i][j] = r[i - 1][j] * (Real(static_cast<double>(i) - 1) - ratio * Real(static_cast<double>(j))) /
                  Real(static_cast<double>(i));
    }
    for (std::size_t j = 1; j <= k; ++j) {
      const auto& u = ndf::tabulated<double, ndf::alternating_binomials>(j);
      for (std::size_t i = 1; i <= k; ++i)
        for (std::size_t m = 1; m <= j; ++m) product[i][j] += r[i][m] * Real(u[m]);
    }
    for (std::size_t c = 0; c < dimension(work.d); ++c) {
      std::array<Real, greatest_order + 1> moved{};
      for (std::size_t j = 1; j <= k; ++j)
        for (std::size_t i = 1; i <= k; ++i) moved[j] += product[i][j] * work.D[i].data()[c];
      for (std::size_t j = 1; j <= k; ++j) work.D[j].data()[c] = moved[j];
    }
  }

  template <State X>
  static void predict(Workspace<X>& work, X& predicted) {
    predicted = work.D[work.order];  // the small ones first
    for (std::size_t j = work.order; j-- > 0;)
      for (std::size_t i = 0; i < dimension(predicted); ++i) predicted.data()[i] += work.D[j].data()[i];
  }

  template <class System, State X>
  [[nodiscard]] static int linearize(System& system, const Scalar<X>& t, const X& x, Workspace<X>& work) {
    const int evaluations = work.equations.linearize(system, t, x, work.h, work.f);
    work.has_jacobian = work.is_current = true;
    work.jacobian_age = 0;
    work.decomposed_for = Scalar<X>(0);
    return evaluations;
  }

  template <class System, State X>
  [[nodiscard]] static bool decompose(System& system, Workspace<X>& work, const Scalar<X>& c) {
    const bool done = work.equations.decompose(system, c);
    work.decomposed_for = done ? c : Scalar<X>(0);
    return done;
  }

  // How far the iteration goes, in tolerances.
  template <State X>
  [[nodiscard]] static Scalar<X> target_of(const Workspace<X>& work) {
    using Real = Scalar<X>;
    using std::max, std::min, std::sqrt;
    const Real asked = tolerance_as_number(work.equations.tolerance);
    return max(Real(10) * std::numeric_limits<Real>::epsilon() / asked, min(Real(0.03), sqrt(asked)));
  }

  // x comes in as the prediction and leaves as the solution; c = alpha / h, M c (d + sum_j gamma_j D_j / alpha) = f.
  template <class System, State X>
  [[nodiscard]] static bool solve(System& system, const Scalar<X>& t, const Scalar<X>& c, Workspace<X>& work, X& x,
                                  int& evaluations) {
    using Real = Scalar<X>;
    const std::size_t n = dimension(x), k = work.order;
    const Real one_over_alpha = Real(1) / ndf::tabulated<Real, ndf::alpha<Real>>(k);
    X& past = work.D[greatest_order + 2];  // free until the step is accepted
    for (std::size_t i = 0; i < n; ++i) past.data()[i] = work.d.data()[i] = Real(0);
    for (std::size_t j = 1; j <= k; ++j) {
      const Real weight = ndf::tabulated<Real, ndf::gamma<Real>>(j) * one_over_alpha;
      for (std::size_t i = 0; i < n; ++i) past.data()[i] += weight * work.D[j].data()[i];
    }
    if (work.equations.has_mass()) work.memory.measure_anew(work.equations.tolerance);
    work.memory.matrix_is_known = work.is_current || !work.memory.measures_anew;
    const Real target = target_of(work);
    return newton(work.memory, target, most_iterations, [&] {
      evaluate(system, t, x, work.f);
      ++evaluations;
      for (std::size_t i = 0; i < n; ++i) work.correction.data()[i] = c * (past.data()[i] + work.d.data()[i]);
      if (work.equations.has_mass()) {
        work.equations.multiply_mass(work.correction, work.end);
      } else {
        work.end = work.correction;
      }
      for (std::size_t i = 0; i < n; ++i) work.correction.data()[i] = work.f.data()[i] - work.end.data()[i];
      evaluations += work.equations.solve(system, t, x, work.f, target, work.correction);
      // Of where the step begins: a correction that leads to 1e20 and the one back would be small against what is
      // there.
      const Real size = weighted_norm(work.correction, work.D[0], work.D[0], work.equations.tolerance);
      for (std::size_t i = 0; i < n; ++i) {
        work.d.data()[i] += work.correction.data()[i];
        x.data()[i] += work.correction.data()[i];
      }
      return size;
    });
  }
};

/// The method for large stiff systems: one real matrix per step, and orders that follow the smoothness of the solution.
/// Steps of a fixed size rise to order 2.
struct Bdf : BackwardDifferentiation<DirectEquations> {
  static constexpr std::string_view name = "bdf";
};

}  // namespace continuo
