#pragma once
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <string_view>
#include <utility>

#include <continuo/methods/explicit_rk/stabilized_runge_kutta.hpp>

namespace continuo {

/// Runge-Kutta-Chebyshev of order 2, for equations of diffusion. The stages follow the recurrence of the Chebyshev
/// polynomials T_j, so that the stability polynomial of s stages is a_s + b_s T_s(w0 + w1 z): it stays below 1 - 2/39
/// along the real axis down to about -2/3 (s^2 - 1).
/// B. P. Sommeijer, L. F. Shampine, J. G. Verwer, "RKC: an explicit solver for parabolic PDEs", J. Comp. Appl. Math. 88
/// (1997), sections 2 and 3.
struct Rkc2 : StabilizedRungeKutta<Rkc2> {
  static constexpr std::string_view name = "rkc2";
  static constexpr int order = 2, error_order = 2, dense_order = 2;

  /// The boundary is 0.653 (s + 1)^2 for large s; the slope here is a little less, for every s from 2.
  template <class Real>
  [[nodiscard]] static std::size_t stages_for(const Real& z, std::size_t greatest) {
    using std::min, std::sqrt;
    const Real wanted = sqrt(Real(1.54) * z + 1);
    if (!(wanted < Real(static_cast<double>(greatest)))) return greatest;
    return std::max(std::size_t{2}, static_cast<std::size_t>(wanted) + 1);
  }
  template <class Real>
  [[nodiscard]] static Real reach(std::size_t s) {
    const Real stages = Real(static_cast<double>(s));
    return (stages * stages - 1) / Real(1.54);
  }
  /// Rounding errors grow like s^2 epsilon within a step.
  template <class Real>
  [[nodiscard]] static std::size_t most_stages(const Real& rtol) {
    using std::min, std::sqrt;
    const Real wanted = min(sqrt(rtol / (10 * std::numeric_limits<Real>::epsilon())), Real(1e6));
    return std::max(std::size_t{2}, static_cast<std::size_t>(wanted));
  }

  template <class System, State X>
  static int advance(System& system, const Scalar<X>& t, const X& x, const Scalar<X>& h, std::size_t stages,
                     Workspace<X>& work, X& x_new) {
    using Real = Scalar<X>;
    const std::size_t n = dimension(x);
    const Real s = Real(static_cast<double>(stages));
    Chebyshev<Real> last{.w0 = 1 + Real(2) / (13 * s * s)};
    const Real w1 = w1_of(last.w0, stages);
    last.to_one();
    // A stage lies at t + c h and is a + b T_j(w0 + w1 z) of x, a = 1 - b T_j(w0).
    Real b_last = 1 / (4 * last.w0 * last.w0), b_before = b_last, c_last = b_last * w1, c_before(0);
    X &now = x_new, &before = work.before;
    before = x;
    for (std::size_t i = 0; i < n; ++i) now.data()[i] = x.data()[i] + h * c_last * work.start.data()[i];
    for (std::size_t j = 2; j <= stages; ++j) {
      const Real a_last = 1 - b_last * last.value;
      last.advance();
      const Real b = last.second / (last.first * last.first);
      const Real mu = 2 * b * last.w0 / b_last, nu = -b / b_before, mu_f = 2 * b * w1 / b_last;
      evaluate(system, Real(t + c_last * h), now, work.slope);
      for (std::size_t i = 0; i < n; ++i) {
        before.data()[i] = (1 - mu - nu) * x.data()[i] + mu * now.data()[i] + nu * before.data()[i] +
                           h * mu_f * (work.slope.data()[i] - a_last * work.start.data()[i]);
      }
      std::swap(before, now);
      const Real c = mu * c_last + nu * c_before + mu_f * (1 - a_last);
      c_before = c_last, c_last = c;
      b_before = b_last, b_last = b;
    }
    return static_cast<int>(stages) - 1;
  }

  /// Section 3.1: third derivatives from both ends of the step.
  template <State X>
  static void set_error(const X& x, const Scalar<X>& h, const X& x_new, Workspace<X>& work) {
    using Real = Scalar<X>;
    for (std::size_t i = 0; i < dimension(x); ++i) {
      work.error.data()[i] = Real(4) / Real(5) * (x.data()[i] - x_new.data()[i]) +
                             Real(2) / Real(5) * h * (work.start.data()[i] + work.end.data()[i]);
    }
  }

 private:
  // T_j(w0) with its first two derivatives, by the recurrence T_j = 2 w T_{j-1} - T_{j-2}.
  template <class Real>
  struct Chebyshev {
    Real w0;
    Real value = 1, first = 0, second = 0, value_before = 0, first_before = 0, second_before = 0;

    void to_one() {
      value_before = value, first_before = first, second_before = second;
      value = w0, first = 1, second = 0;
    }
    void advance() {
      const Real v = 2 * w0 * value - value_before;
      const Real f = 2 * (w0 * first + value) - first_before;
      const Real g = 2 * (w0 * second + 2 * first) - second_before;
      value_before = value, first_before = first, second_before = second;
      value = v, first = f, second = g;
    }
  };
  template <class Real>
  [[nodiscard]] static Real w1_of(const Real& w0, std::size_t stages) {
    Chebyshev<Real> polynomial{.w0 = w0};
    polynomial.to_one();
    for (std::size_t j = 2; j <= stages; ++j) polynomial.advance();
    return polynomial.first / polynomial.second;
  }
};

}  // namespace continuo
