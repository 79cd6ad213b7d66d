// The terms of what an adjoint run differentiates: a number that depends on the motion and on the parameters.
#pragma once
#include <concepts>
#include <cstddef>

#include <continuo/sensitivities/parametric_function.hpp>

namespace continuo {

/// A term g(t, x, p) at the end of the run. It takes any number type, since it is differentiated by tracing:
///
///   run.gradient(AtEnd{[](auto, const auto& x, const auto&) { return x[0] * x[0]; }});
template <class G>
struct AtEnd {
  G term;
};
/// A sum of g(j, t_j, x(t_j), p) over the times t_j that the run saves.
template <class G>
struct AtTimes {
  G term;
};
/// The integral of g(t, x, p) dt over the run.
template <class G>
struct Integral {
  G term;
};

namespace detail {

/// In the place of a term that an objective does not have.
struct NoTerm {};

/// The terms of an objective, of which each may be NoTerm.
template <class End, class Times, class Integrand>
struct Objective {
  End at_end;
  Times at_times;
  Integrand integrand;
};

template <template <class> class Kind, class T>
inline constexpr bool is_term_of = false;
template <template <class> class Kind, class G>
inline constexpr bool is_term_of<Kind, Kind<G>> = true;
template <class T>
inline constexpr bool is_term = is_term_of<AtEnd, T> || is_term_of<AtTimes, T> || is_term_of<Integral, T>;

/// The term of this kind.
template <template <class> class Kind>
[[nodiscard]] NoTerm term_of() {
  return {};
}
template <template <class> class Kind, class First, class... Rest>
[[nodiscard]] auto term_of(const First& first, const Rest&... rest) {
  if constexpr (is_term_of<Kind, First>) {
    return first.term;
  } else {
    return term_of<Kind>(rest...);
  }
}

/// Refuses, at compile time, what are no terms of an objective; true where they are.
template <class... Terms>
[[nodiscard]] consteval bool check_terms() {
  constexpr bool terms = sizeof...(Terms) > 0 && (is_term<Terms> && ...);
  constexpr bool once = (std::size_t{is_term_of<AtEnd, Terms>} + ... + std::size_t{0}) <= 1 &&
                        (std::size_t{is_term_of<AtTimes, Terms>} + ... + std::size_t{0}) <= 1 &&
                        (std::size_t{is_term_of<Integral, Terms>} + ... + std::size_t{0}) <= 1;
  static_assert(terms, "an objective has the terms AtEnd{g}, AtTimes{g} and Integral{g}, at least one of them");
  static_assert(once, "an objective has each of AtEnd, AtTimes and Integral once at most: add the functions up");
  return terms && once;
}

template <class Term, class X, class P>
concept TraceableTerm = std::same_as<Term, NoTerm> || requires(const Term& g, const Traced<Scalar<X>>& t,
                                                               const TracedState<X>& x, const TracedState<P>& p) {
  { g(t, x, p) } -> std::convertible_to<Traced<Scalar<X>>>;
};
template <class Term, class X, class P>
concept TraceableTermOfTimes =
    std::same_as<Term, NoTerm> || requires(const Term& g, std::size_t j, const Traced<Scalar<X>>& t,
                                           const TracedState<X>& x, const TracedState<P>& p) {
      { g(j, t, x, p) } -> std::convertible_to<Traced<Scalar<X>>>;
    };

/// A term at one point, with its derivatives by x, p and t.
template <State X, State P>
class TracedTerm {
 public:
  using Real = Scalar<X>;

  /// g(t, x, p); `slopes` begins with zeros and gets its derivatives by x, by p and by t, side by side.
  template <class G>
  [[nodiscard]] Real operator()(G&& g, const Real& t, const X& x, const P& p, std::vector<Real>& slopes) {
    const std::size_t n = dimension(x), m = dimension(p);
    if constexpr (requires { x_.resize(n); }) x_.resize(n);
    if constexpr (requires { p_.resize(m); }) p_.resize(m);
    trace_.clear();
    for (std::size_t j = 0; j < n; ++j) x_.data()[j] = trace_.variable(x.data()[j]);
    for (std::size_t k = 0; k < m; ++k) p_.data()[k] = trace_.variable(p.data()[k]);
    const Traced<Real> time = trace_.variable(t);
    const Traced<Real> value = g(time, x_, p_);
    const auto found = trace_.slopes_of(value);
    slopes.assign(found.begin(), found.end());
    return value.value();
  }

 private:
  Trace<Real> trace_;
  TracedState<X> x_{};
  TracedState<P> p_{};
};

}  // namespace detail
}  // namespace continuo
