// continuo/methods/multistep/adams.hpp
// Adams-Bashforth-Moulton of variable order and step, PECE: two evaluations a step at any order, for smooth problems
// whose f is costly. L. F. Shampine, M. K. Gordon, "Computer Solution of Ordinary Differential Equations" (1975); E.
// Hairer, S. P. Norsett, G. Wanner, "Solving Ordinary Differential Equations I", III.5.
//
// The past is kept as divided differences of f, scaled by the distances they were taken over,
//
//   phi_i = psi_1 ... psi_(i-1) f[t_n, ..., t_(n-i+1)],   psi_i = t_n - t_(n-i),
//
// so at equal steps they are backward differences. With psi'_i = h + psi_(i-1) of the next point and
// phi*_i = phi_i (psi'_1 ... psi'_(i-1)) / (psi_1 ... psi_(i-1)) the polynomial through the last k values of f is
//
//   P(t_n + s h) = sum_(i<=k) b_i(s) phi*_i,   b_1 = 1,   b_(i+1)(s) = b_i(s) (s h + psi_(i-1)) / psi'_i.
//
// Its integral predicts x_p; with d = f(t_n + h, x_p) - P(t_n + h), which the polynomial misses there, the corrected
// x_new adds h g_(k+1) d, g_i the integral of b_i from 0 to 1. Adding h g_k d instead is the formula of one order less:
// the difference is the error estimate.
#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <string_view>

#include <continuo/methods/method.hpp>
#include <continuo/methods/support/weighted_norm.hpp>
#include <continuo/numerics/finite.hpp>

namespace continuo {

/// For smooth problems with a costly f, and for dense output at every step, which costs no evaluation. Steps of a fixed
/// size rise to order 4, and have order 3 for what the first of them lose.
struct Adams {
  static constexpr std::size_t greatest_order = 12;  // of the prediction
  static constexpr std::string_view name = "adams";
  static constexpr int order = 13, error_order = 12, starting_order = 1, dense_degree = 13, dense_order = 12;
  static constexpr int order_of_fixed_steps = 3;  // what the first of them lose, at lower orders, stays
  static constexpr bool second_order = false;

  template <State X>
  struct Workspace {
    using Real = Scalar<X>;
    using Powers = std::array<Real, greatest_order + 1>;
    std::array<X, greatest_order + 2> phi;  // phi[i - 1] is phi_i
    X f, d;                                 // f where it was last evaluated
    std::array<Powers, greatest_order + 1> b{};
    Powers psi{}, beta{}, g{};
    Real h{}, h_last{};          // of this step and of the last accepted
    std::size_t order = 1;       // k of this step
    std::size_t next_order = 0;  // 0: nobody asked, the steps are fixed
    std::size_t known = 0;       // how many phi there are
    std::size_t equal_steps = 0, rejections = 0;
    bool starting = true;        // the order rises with every step, the step doubles
    bool has_new_point = false;  // the step was accepted, f at its end is not yet among the differences

    /// For checkpoints: what the next step depends on.
    template <class Archive>
    void transfer(Archive& archive) {
      archive(phi, f, d, b, psi, beta, g, h, h_last);
      archive.index(order, greatest_order);
      archive.index(next_order, greatest_order);
      archive.index(known, greatest_order + 2);
      archive(equal_steps, rejections, starting, has_new_point);
    }
  };

  template <State X>
  [[nodiscard]] static Workspace<X> workspace(const X& x) {
    return {{x, x, x, x, x, x, x, x, x, x, x, x, x, x}, x, x};
  }

  template <State X>
  [[nodiscard]] static int error_order_of(const Workspace<X>& work) {
    return static_cast<int>(work.order);
  }

  template <class System, State X>
  static int step(System& system, const Scalar<X>& t, const X& x, const Scalar<X>& h, bool discontinuity,
                  Workspace<X>& work, X& x_new) {
    using Real = Scalar<X>;
    int evaluations = 1;
    if (discontinuity || work.has_new_point) {
      evaluate(system, t, x, work.f);
      ++evaluations;
      if (discontinuity) {
        begin(work);
      } else {
        add_point(work);
      }
    }
    work.h = h;
    set_coefficients(work);
    const std::size_t k = work.order;
    for (std::size_t i = 0; i < dimension(x); ++i) {
      Real integral(0);
      work.d.data()[i] = Real(0);
      for (std::size_t j = k; j-- > 0;) {
        const Real star = work.beta[j] * work.phi[j].data()[i];
        integral += work.g[j] * star;
        work.d.data()[i] += star;
      }
      x_new.data()[i] = x.data()[i] + h * integral;
    }
    evaluate(system, t + h, x_new, work.f);
    for (std::size_t i = 0; i < dimension(x); ++i) {
      work.d.data()[i] = work.f.data()[i] - work.d.data()[i];
      x_new.data()[i] += h * work.g[k] * work.d.data()[i];
    }
    return evaluations;
  }

  template <State X>
  [[nodiscard]] static Scalar<X> error_norm(const Workspace<X>& work, const Scalar<X>& h, const X& x, const X& x_new,
                                            const Tolerance<Scalar<X>>& tolerance) {
    return detail::zero_if_all_finite(x_new) +
           Scalar<X>(strictness) * norm(x, x_new, tolerance, [&](std::size_t i) { return error_of(work, h, i); });
  }
  template <State X>
  [[nodiscard]] static Scalar<X> error_of(const Workspace<X>& work, const Scalar<X>& h, std::size_t i) {
    return h * (work.g[work.order] - work.g[work.order - 1]) * work.d.data()[i];
  }

  /// The order whose error, as if all steps had been h, is least, and a step that is worth a change (Shampine & Gordon,
  /// chapter 7): twice as long, the same, or from half to nine tenths.
  template <State X>
  [[nodiscard]] static Scalar<X> next_factor(Workspace<X>& work, const Scalar<X>&, const Scalar<X>& h, const X& x,
                                             const X& x_new, const Tolerance<Scalar<X>>& tolerance) {
    using Real = Scalar<X>;
    using std::abs, std::max, std::min, std::pow;
    const std::size_t k = work.order;
    const auto star = [&](std::size_t j, std::size_t i) { return work.beta[j - 1] * work.phi[j - 1].data()[i]; };
    const auto error = [&](std::size_t order, auto&& difference) {
      return Real(strictness) * abs(h) * sigma(work, order) * Real(moulton(order)) *
             norm(x, x_new, tolerance, difference);
    };
    Real here = error(k, [&](std::size_t i) { return work.d.data()[i]; });
    Real lower(0), lowest(0);
    if (k >= 2) lower = error(k - 1, [&](std::size_t i) { return star(k, i) + work.d.data()[i]; });
    if (k >= 3) lowest = error(k - 2, [&](std::size_t i) { return star(k - 1, i) + star(k, i) + work.d.data()[i]; });
    const bool falls = (k == 2 && lower <= here / 2) || (k > 2 && max(lower, lowest) <= here);
    if (falls || k == greatest_order) work.starting = false;
    work.next_order = k;
    if (work.starting) {
      work.next_order = k + 1;
      return Real(2);
    }
    if (falls) {
      work.next_order = k - 1;
      here = lower;
    } else if (k < greatest_order && work.known > k && h == work.h_last && work.equal_steps >= k) {
      const Real higher = Real(strictness) * abs(h) * Real(moulton(k + 1)) *
                          norm(x, x_new, tolerance, [&](std::size_t i) { return work.d.data()[i] - star(k + 1, i); });
      if (k > 1 && lower <= min(here, higher)) {
        work.next_order = k - 1;
        here = lower;
      } else if (higher < (k == 1 ? here / 2 : here)) {
        work.next_order = k + 1;
        here = higher;
      }
    }
    const Real one_more = Real(static_cast<double>(work.next_order) + 1);
    if (here * pow(Real(2), one_more) <= Real(0.5)) return Real(2);
    if (here <= Real(0.5)) return Real(1);
    return max(Real(0.5), min(Real(0.9), Real(pow(Real(0.5) / here, Real(1) / one_more))));
  }

  template <State X>
  static void rejected(Workspace<X>& work, const Scalar<X>&) {
    work.starting = false;
    work.equal_steps = 0;
    // The higher differences are the first to be spoilt where the solution is not smooth.
    if (++work.rejections >= 2 && work.order > 1) --work.order;
    if (work.rejections >= 4) work.order = 1;
  }

  /// The polynomial that made x_new, from x on: its ends are x and x_new.
  template <class System, State X>
  static int interpolate(System&, const Scalar<X>&, const X& x, const Scalar<X>& h, const X&, Workspace<X>& work,
                         Interpolant<X, dense_degree>& interpolant) {
    using Real = Scalar<X>;
    const std::size_t k = work.order;
    for (std::size_t i = 0; i < dimension(x); ++i) {
      interpolant.c[0].data()[i] = x.data()[i];
      for (std::size_t power = 0; power <= greatest_order; ++power) {
        Real sum = power <= k ? Real(work.b[k][power] * work.d.data()[i]) : Real(0);
        for (std::size_t j = power; j < k; ++j) sum += work.b[j][power] * work.beta[j] * work.phi[j].data()[i];
        interpolant.c[power + 1].data()[i] = h * sum / Real(static_cast<double>(power) + 1);
      }
    }
    return 0;
  }

  template <State X>
  static void accept(Workspace<X>& work) {
    work.equal_steps = work.h == work.h_last ? work.equal_steps + 1 : 1;
    work.h_last = work.h;
    work.rejections = 0;
    work.has_new_point = true;
    // Without error control nobody chooses an order.
    if (work.next_order == 0) work.next_order = std::min(work.order + 1, greatest_of_fixed_steps);
  }

  template <State X>
  [[nodiscard]] static const X& derivative(const Workspace<X>& work) {
    return work.phi[0];
  }

 private:
  // The order grows with the strictness of the tolerance, so that hundreds of short steps make a run at any: as many
  // errors add up. With p of the order of log(1 / tolerance) the factor of tolerance_proportionality.hpp is constant.
  static constexpr double strictness = 300;
  static constexpr std::size_t greatest_of_fixed_steps = 4;

  /// The size of the coefficient of Adams-Moulton formulas: gamma*_0 = 1, sum_j gamma*_j / (m + 1 - j) = 0 (Hairer,
  /// Norsett & Wanner, eq. III.1.10).
  [[nodiscard]] static double moulton(std::size_t m) {
    static constexpr auto sizes = [] {
      std::array<double, greatest_order + 2> gamma{1};
      for (std::size_t n = 1; n < gamma.size(); ++n)
        for (std::size_t j = 0; j < n; ++j) gamma[n] -= gamma[j] / static_cast<double>(n + 1 - j);
      for (double& each : gamma) each = each < 0 ? -each : each;
      return gamma;
    }();
    return sizes[m];
  }

  /// k! h^k / (psi'_1 ... psi'_k): what makes a difference of k + 1 values one of equal steps h.
  template <State X>
  [[nodiscard]] static Scalar<X> sigma(const Workspace<X>& work, std::size_t k) {
    using Real = Scalar<X>;
    Real product(1), distance = work.h;
    for (std::size_t i = 1; i <= k; ++i) {
      product *= Real(static_cast<double>(i)) * work.h / distance;
      distance = work.h + work.psi[i - 1];
    }
    return product;
  }

  template <State X>
  static void begin(Workspace<X>& work) {
    work.phi[0] = work.f;
    work.known = work.order = 1;
    work.next_order = work.equal_steps = work.rejections = 0;
    work.h_last = Scalar<X>(0);
    work.starting = true;
    work.has_new_point = false;
  }

  /// f at the end of the last step becomes phi_1: phi_(i+1) = phi_i - phi*_i of before.
  template <State X>
  static void add_point(Workspace<X>& work) {
    using Real = Scalar<X>;
    const std::size_t used = std::min({work.known, work.order + 1, greatest_order + 1});
    for (std::size_t i = 0; i < dimension(work.f); ++i) {
      Real newest = work.f.data()[i];
      for (std::size_t j = 0; j < used; ++j) {
        const Real star = work.beta[j] * work.phi[j].data()[i];
        work.phi[j].data()[i] = newest;
        newest -= star;
      }
      work.phi[used].data()[i] = newest;
    }
    work.known = used + 1;
    for (std::size_t j = greatest_order; j >= 1; --j) work.psi[j] = work.psi[j - 1] + work.h;
    work.psi[0] = work.h;
    work.order = std::min(work.next_order, work.known);
    work.next_order = 0;
    work.has_new_point = false;
  }

  /// b, g and beta for a step of h. psi[i - 1] is psi_i.
  template <State X>
  static void set_coefficients(Workspace<X>& work) {
    using Real = Scalar<X>;
    const Real h = work.h;
    work.b[0] = {Real(1)};
    work.g[0] = work.beta[0] = Real(1);
    Real before(0);  // psi_(i-1)
    for (std::size_t i = 1; i <= work.order; ++i) {
      const Real distance = h + before;  // psi'_i
      work.b[i] = {};
      work.g[i] = Real(0);
      for (std::size_t power = 0; power < i; ++power) {
        work.b[i][power] += before / distance * work.b[i - 1][power];
        work.b[i][power + 1] += h / distance * work.b[i - 1][power];
      }
      for (std::size_t power = 0; power <= i; ++power)
        work.g[i] += work.b[i][power] / Real(static_cast<double>(power) + 1);
      if (i < work.known) work.beta[i] = work.beta[i - 1] * distance / work.psi[i - 1];
      before = work.psi[i - 1];
    }
  }

  template <State X, class Component>
  [[nodiscard]] static Scalar<X> norm(const X& x, const X& x_new, const Tolerance<Scalar<X>>& tolerance,
                                      const Component& component) {
    return root_mean_square<Scalar<X>>(dimension(x), [&](std::size_t i) {
      return Scalar<X>(component(i) / tolerance.scale(i, x.data()[i], x_new.data()[i]));
    });
  }
};

}  // namespace continuo
