// df/dx and df/dp of x' = f(t, x, p) at one point, and products with them from the left, from the best there is:
// members of f, else one traced evaluation, else differences.
#pragma once
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include <continuo/sensitivities/parametric_function.hpp>

namespace continuo {

namespace detail {

/// A central difference of order 4: (8 (g(h) - g(-h)) - (g(2h) - g(-2h))) / 12 h. With h = eps^(1/5) of the variable
/// its error is some eps^(4/5) of g over the variable's size, 3e-13 in double precision.
template <class Real>
struct FourPointDifference {
  static constexpr int places[4] = {1, -1, 2, -2};
  static constexpr int weights[4] = {8, -8, -1, 1};
  [[nodiscard]] static Real increment(const Real& at, const Real& size) {
    using std::ilogb, std::ldexp, std::log2, std::pow;
    const Real wanted = pow(std::numeric_limits<Real>::epsilon(), Real(1) / 5) * size;
    const Real step = ldexp(Real(1), static_cast<int>(ilogb(wanted)));  // so that the sums are all but exact
    return (at + step) - at;
  }
};

}  // namespace detail

/// f at one point after another, with its derivatives. Allocates for states like x and parameters like p; nothing is
/// allocated afterwards but for a longer trace.
template <class F, State X, State P>
class ParameterDerivatives {
 public:
  using Real = Scalar<X>;
  /// Whether df/dx is known without differences.
  static constexpr bool knows_jacobian =
      detail::HasParametricJacobian<F, X, P> || detail::HasVectorJacobian<F, X, P> || detail::Traceable<F, X, P>;

  /// sizes[j] > 0 is how large component j of x is at least, and sizes_of_p[k] parameter k, for differences.
  ParameterDerivatives(F f, const X& x, const P& p, std::vector<Real> sizes, std::vector<Real> sizes_of_p)
      : f_(std::move(f)),
        x_(x),
        p_(p),
        slope_(x),
        moved_slope_(x),
        sizes_(std::move(sizes)),
        sizes_of_p_(std::move(sizes_of_p)) {
    if constexpr (by_trace) {
      if constexpr (requires { traced_x_.resize(dimension(x)); }) {
        traced_x_.resize(dimension(x));
        traced_slope_.resize(dimension(x));
      }
      if constexpr (requires { traced_p_.resize(dimension(p)); }) traced_p_.resize(dimension(p));
    }
  }

  /// Goes to (t, x, p); evaluates f there, traced where that gives derivatives. f must be the same as long as this
  /// point is asked for derivatives.
  void go_to(const Real& t, const X& x, const P& p) {
    t_ = t;
    x_ = x;
    p_ = p;
    ++costs_.evaluations;
    if constexpr (by_trace) {
      trace();
    } else {
      evaluate(f_, t_, x_, p_, slope_);
    }
  }
  /// f alone.
  void derivative(const Real& t, const X& x, const P& p, X& dxdt) {
    ++costs_.evaluations;
    evaluate(f_, t, x, p, dxdt);
  }

  /// f at the point.
  [[nodiscard]] const X& slope() const { return slope_; }

  /// df/dx, n * n row by row, and df/dp, n * m row by row.
  void rows(std::span<Real> by_x, std::span<Real> by_p) {
    if constexpr (by_trace && !x_by_member && !p_by_member) {
      const std::size_t n = dimension(x_), m = dimension(p_);
      for (std::size_t i = 0; i < n; ++i) {
        const std::span<const Real> slopes = trace_.slopes_of(traced_slope_.data()[i]);
        std::copy_n(slopes.begin(), n, by_x.begin() + static_cast<std::ptrdiff_t>(i * n));
        std::copy_n(slopes.begin() + static_cast<std::ptrdiff_t>(n), m,
                    by_p.begin() + static_cast<std::ptrdiff_t>(i * m));
      }
    } else {
      rows_by_x(by_x);
      rows_by_p(by_p);
    }
  }

  /// df/dx alone.
  void rows_by_x(std::span<Real> rows) {
    const std::size_t n = dimension(x_);
    if constexpr (detail::HasParametricJacobian<F, X, P>) {
      std::ranges::fill(rows, Real(0));
      ++costs_.jacobians;
      f_.jacobian(t_, x_, p_, rows);
    } else if constexpr (detail::HasVectorJacobian<F, X, P>) {
      X unit = x_, row = x_;
      for (std::size_t i = 0; i < n; ++i) {
        for (std::size_t j = 0; j < n; ++j) unit.data()[j] = Real(i == j ? 1 : 0);
        f_.vector_jacobian(t_, x_, p_, unit, row);
        std::copy_n(row.data(), n, rows.begin() + static_cast<std::ptrdiff_t>(i * n));
      }
    } else if constexpr (by_trace) {
      for (std::size_t i = 0; i < n; ++i) {
        const std::span<const Real> slopes = trace_.slopes_of(traced_slope_.data()[i]);
        std::copy_n(slopes.begin(), n, rows.begin() + static_cast<std::ptrdiff_t>(i * n));
      }
    } else {
      for (std::size_t j = 0; j < n; ++j) difference(x_.data()[j], size_of(j), rows, j, n);
    }
  }

  /// product_x = lambda^T df/dx, product_p += lambda^T df/dp, and lambda^T df/dt is returned where `with_time`, else 0.
  [[nodiscard]] Real multiply_left(const X& lambda, X& product_x, std::span<Real> product_p, bool with_time) {
    ++costs_.vector_jacobian_products;
    const std::size_t n = dimension(x_), m = dimension(p_);
    if constexpr (by_trace) {
      const std::span<const Real> slopes =
          trace_.slopes_of(std::span<const Traced<Real>>(traced_slope_.data(), n), components(lambda));
      if constexpr (!x_by_member) std::copy_n(slopes.begin(), n, product_x.data());
      if constexpr (!p_by_member)
        for (std::size_t k = 0; k < m; ++k) product_p[k] += slopes[n + k];
    }
    if constexpr (!by_trace || x_by_member) multiply_left_by_x(lambda, product_x);
    if constexpr (!by_trace || p_by_member) multiply_left_by_p(lambda, product_p);
    if (!with_time) return Real(0);
    if constexpr (by_trace && traces_time) {
      return trace_.slope_of_variable(n + m);
    } else {
      return multiply_left_by_time(lambda);
    }
  }

  [[nodiscard]] const DerivativeCosts& costs() const { return costs_; }
  [[nodiscard]] F& function() { return f_; }
  [[nodiscard]] const F& function() const { return f_; }

 private:
  static constexpr bool x_by_member = detail::HasParametricJacobian<F, X, P> || detail::HasVectorJacobian<F, X, P>;
  static constexpr bool p_by_member =
      detail::HasParameterJacobian<F, X, P> || detail::HasVectorParameterJacobian<F, X, P>;
  static constexpr bool by_trace = detail::Traceable<F, X, P> && !(x_by_member && p_by_member);
  static constexpr bool traces_time = detail::TraceableWithTime<F, X, P>;

  void trace() {
    const std::size_t n = dimension(x_), m = dimension(p_);
    trace_.clear();
    for (std::size_t j = 0; j < n; ++j) traced_x_.data()[j] = trace_.variable(x_.data()[j]);
    for (std::size_t k = 0; k < m; ++k) traced_p_.data()[k] = trace_.variable(p_.data()[k]);
    if constexpr (traces_time) {
      evaluate(f_, trace_.variable(t_), traced_x_, traced_p_, traced_slope_);
    } else {
      evaluate(f_, t_, traced_x_, traced_p_, traced_slope_);
    }
    for (std::size_t i = 0; i < n; ++i) slope_.data()[i] = traced_slope_.data()[i].value();
  }

  void rows_by_p(std::span<Real> rows) {
    const std::size_t m = dimension(p_);
    if constexpr (detail::HasParameterJacobian<F, X, P>) {
      std::ranges::fill(rows, Real(0));
      ++costs_.jacobians;
      f_.parameter_jacobian(t_, x_, p_, rows);
    } else if constexpr (detail::HasVectorParameterJacobian<F, X, P>) {
      const std::size_t n = dimension(x_);
      X unit = x_;
      P row = p_;
      for (std::size_t i = 0; i < n; ++i) {
        for (std::size_t j = 0; j < n; ++j) unit.data()[j] = Real(i == j ? 1 : 0);
        f_.vector_parameter_jacobian(t_, x_, p_, unit, row);
        std::copy_n(row.data(), m, rows.begin() + static_cast<std::ptrdiff_t>(i * m));
      }
    } else if constexpr (by_trace) {
      const std::size_t n = dimension(x_);
      for (std::size_t i = 0; i < n; ++i) {
        const std::span<const Real> slopes = trace_.slopes_of(traced_slope_.data()[i]);
        std::copy_n(slopes.begin() + static_cast<std::ptrdiff_t>(n), m,
                    rows.begin() + static_cast<std::ptrdiff_t>(i * m));
      }
    } else {
      for (std::size_t k = 0; k < m; ++k) difference(p_.data()[k], sizes_of_p_[k], rows, k, m);
    }
  }

  void multiply_left_by_x(const X& lambda, X& product) {
    if constexpr (detail::HasVectorJacobian<F, X, P>) {
      f_.vector_jacobian(t_, x_, p_, lambda, product);
    } else {
      const std::size_t n = dimension(x_);
      rows_.resize(n * n);
      rows_by_x(rows_);
      for (std::size_t j = 0; j < n; ++j) product.data()[j] = Real(0);
      for (std::size_t i = 0; i < n; ++i)
        for (std::size_t j = 0; j < n; ++j) product.data()[j] += lambda.data()[i] * rows_[i * n + j];
    }
  }
  void multiply_left_by_p(const X& lambda, std::span<Real> product) {
    if constexpr (detail::HasVectorParameterJacobian<F, X, P>) {
      P one = p_;
      f_.vector_parameter_jacobian(t_, x_, p_, lambda, one);
      for (std::size_t k = 0; k < dimension(p_); ++k) product[k] += one.data()[k];
    } else {
      const std::size_t n = dimension(x_), m = dimension(p_);
      rows_.resize(n * m);
      rows_by_p(rows_);
      for (std::size_t i = 0; i < n; ++i)
        for (std::size_t k = 0; k < m; ++k) product[k] += lambda.data()[i] * rows_[i * m + k];
    }
  }
  [[nodiscard]] Real multiply_left_by_time(const X& lambda) {
    using std::abs, std::max;
    if (is_autonomous(f_)) return Real(0);
    using Four = detail::FourPointDifference<Real>;
    const Real step = Four::increment(t_, max(abs(t_), Real(1)));
    Real sum(0);
    for (int place = 0; place < 4; ++place) {
      derivative(t_ + Real(Four::places[place]) * step, x_, p_, moved_slope_);
      for (std::size_t i = 0; i < dimension(x_); ++i)
        sum += Real(Four::weights[place]) * lambda.data()[i] * moved_slope_.data()[i];
    }
    return sum / (12 * step);
  }

  /// As large as it has been so far.
  [[nodiscard]] Real size_of(std::size_t j) {
    using std::abs, std::max;
    return sizes_[j] = max(sizes_[j], Real(abs(x_.data()[j])));
  }
  /// Column `column` of `width`: df by one component, which is moved for it.
  void difference(Real& component, const Real& size, std::span<Real> rows, std::size_t column, std::size_t width) {
    using Four = detail::FourPointDifference<Real>;
    const Real at = component, step = Four::increment(at, size);
    const std::size_t n = dimension(x_);
    for (std::size_t i = 0; i < n; ++i) rows[i * width + column] = Real(0);
    for (int place = 0; place < 4; ++place) {
      component = at + Real(Four::places[place]) * step;
      derivative(t_, x_, p_, moved_slope_);
      for (std::size_t i = 0; i < n; ++i)
        rows[i * width + column] += Real(Four::weights[place]) * moved_slope_.data()[i];
    }
    component = at;
    for (std::size_t i = 0; i < n; ++i) rows[i * width + column] /= 12 * step;
  }

  F f_;
  Real t_{};
  X x_;
  P p_;
  X slope_, moved_slope_;
  std::vector<Real> sizes_, sizes_of_p_, rows_;
  Trace<Real> trace_;
  detail::TracedState<X> traced_x_{}, traced_slope_{};
  detail::TracedState<P> traced_p_{};
  DerivativeCosts costs_;
};

}  // namespace continuo
