// continuo/methods/with_norm.hpp
// A method that measures its errors by a norm of your own, as a type: methods without one pay nothing.
//
//   solve(f, x0, {0, 10}, with_norm(Dop853{}, MaximumNorm{}), {.rtol = 1e-9});
#pragma once
#include <cmath>
#include <concepts>
#include <cstddef>
#include <span>
#include <string_view>
#include <type_traits>

#include <continuo/methods/check_method.hpp>
#include <continuo/methods/method.hpp>
#include <continuo/methods/support/weighted_norm.hpp>
#include <continuo/numerics/finite.hpp>

namespace continuo {

/// A norm of errors: an empty type, called with the errors of the components, each in units of its tolerance. A step is
/// good where it is <= 1. It may leave out components; it is 0 where all errors are.
template <class N, class Real>
concept ErrorNorm =
    std::is_empty_v<N> && std::default_initializable<N> && requires(const N& norm, std::span<const Real> errors) {
      { norm(errors) } -> detail::RealResult<Real>;
    };

/// The greatest error of all components: each is below its tolerance. The root mean square, which methods have of their
/// own, lets a single one of n components be sqrt(n) times as large.
struct MaximumNorm {
  /// The greatest of |errors_i|; not a number where one of them is none.
  template <class Real>
  [[nodiscard]] Real operator()(std::span<const Real> errors) const {
    using std::abs;
    Real greatest(0);
    for (const Real& error : errors) greatest = detail::greater(greatest, Real(abs(error)));
    return greatest;
  }
};

/// The method M with errors measured by the norm N. Each method has factors in its error norm by which the errors of a
/// run stay in proportion to the tolerance; they are kept: the norm of M is multiplied by N / R, where R is the root
/// mean square of the same errors. Orders and tolerances inside of M follow by tolerances divided by N / R. Unless the
/// options give the first step, its estimate is by the root mean square. It has the static functions of the concept
/// Method.
template <class M, class N>
struct WithNorm : M {
  static_assert(detail::estimates_error<M>(), "the method has no error estimate that a norm could measure");

  /// The workspace of M, and the errors.
  template <State X>
  struct Workspace : M::template Workspace<X> {
    mutable X errors, rtol_each, atol_each;
    mutable Scalar<X> ratio{1};  // N / R of the last step
    mutable bool is_norm = true;
  };

  /// Refuses, by a sentence, a norm that is none for states X; true where it is one.
  template <State X>
  [[nodiscard]] static consteval bool check_for_states() {
    constexpr bool norm = ErrorNorm<N, Scalar<X>>;
    static_assert(norm,
                  "a norm is an empty type that is called as norm(std::span<const Real> errors) and returns a Real");
    if constexpr (requires { M::template check_for_states<X>(); }) return M::template check_for_states<X>();
    return norm;
  }

  /// Allocates for M and for the errors.
  template <State X>
  [[nodiscard]] static Workspace<X> workspace(const X& x) {
    static_assert(check_for_states<X>());
    return {M::workspace(x), x, x, x};
  }

  /// The tolerance of the equations of a step, whose errors count as they did in the step before.
  template <State X>
  static void set_tolerance(Workspace<X>& work, const Tolerance<Scalar<X>>& tolerance) {
    if constexpr (detail::HasSetTolerance<M, X, typename M::template Workspace<X>>)
      M::set_tolerance(work, work.ratio > Scalar<X>(1) ? scaled(work, tolerance) : tolerance);
  }

  /// The norm of the error of the last step: good where it is <= 1.
  template <State X>
  [[nodiscard]] static Scalar<X> error_norm(const Workspace<X>& work, const Scalar<X>& h, const X& x, const X& x_new,
                                            const Tolerance<Scalar<X>>& tolerance) {
    using std::sqrt;
    return sqrt(error_square<X>(work, h, x, x_new, tolerance));
  }
  /// Its square.
  template <State X>
  [[nodiscard]] static Scalar<X> error_square(const Workspace<X>& work, const Scalar<X>& h, const X& x, const X& x_new,
                                              const Tolerance<Scalar<X>>& tolerance) {
    using Real = Scalar<X>;
    const Real plain = M::error_norm(work, h, x, x_new, tolerance) + detail::zero_if_all_finite(x_new);
    const std::size_t n = dimension(x);
    for (std::size_t i = 0; i < n; ++i)
      work.errors.data()[i] = M::error_of(work, h, i) / tolerance.scale_of_step(i, x.data()[i], x_new.data()[i]);
    const Real mean = root_mean_square<Real>(n, [&](std::size_t i) { return work.errors.data()[i]; });
    if (!detail::is_finite(plain) || !detail::is_finite(mean)) return plain - plain;  // not a number
    const Real norm = N{}(std::span<const Real>(work.errors.data(), n));
    work.is_norm = norm >= Real(0) && detail::is_finite(norm) && (mean > Real(0) || norm == Real(0));
    if (!work.is_norm) return plain * plain;
    work.ratio = mean > Real(0) ? Real(norm / mean) : Real(1);
    return plain * work.ratio * plain * work.ratio;
  }

  /// As that of M, for tolerances that give the error this norm.
  template <State X>
  [[nodiscard]] static Scalar<X> next_factor(Workspace<X>& work, const Scalar<X>& factor, const Scalar<X>& h,
                                             const X& x, const X& x_new, const Tolerance<Scalar<X>>& tolerance) {
    if constexpr (detail::HasNextFactor<M, X, typename M::template Workspace<X>>) {
      return M::next_factor(work, factor, h, x, x_new, work.ratio > Scalar<X>(0) ? scaled(work, tolerance) : tolerance);
    } else {
      return factor;
    }
  }

  /// What is wrong with the norm, as the last step has shown; empty where nothing is.
  template <State X>
  [[nodiscard]] static std::string_view fault(const Workspace<X>& work) {
    if (work.is_norm) return {};
    return "the norm of the errors of a step is negative or not finite, or not 0 where all errors are: it is no norm";
  }

 private:
  template <State X>
  [[nodiscard]] static Tolerance<Scalar<X>> scaled(const Workspace<X>& work, const Tolerance<Scalar<X>>& tolerance) {
    const Scalar<X> part = Scalar<X>(1) / work.ratio;
    Tolerance<Scalar<X>> result = tolerance.of_error_times(part);
    result.rtol *= part;
    result.atol *= part;
    for (std::size_t i = 0; i < dimension(work.errors); ++i) {
      if (tolerance.rtol_each) work.rtol_each.data()[i] = part * tolerance.rtol_each[i];
      if (tolerance.atol_each) work.atol_each.data()[i] = part * tolerance.atol_each[i];
    }
    if (tolerance.rtol_each) result.rtol_each = work.rtol_each.data();
    if (tolerance.atol_each) result.atol_each = work.atol_each.data();
    return result;
  }
};

/// The method with this norm of its errors.
template <class M, class N>
[[nodiscard]] constexpr WithNorm<M, N> with_norm(M, N) {
  return {};
}

}  // namespace continuo
