// continuo/solve/steps/check_input.hpp
// The check of a run's input.
#pragma once
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <continuo/methods/method.hpp>
#include <continuo/numerics/finite.hpp>
#include <continuo/solve/options.hpp>
#include <continuo/solve/steps/correct.hpp>
#include <continuo/system/mass.hpp>
#include <continuo/system/second_order.hpp>

namespace continuo {

/// The properties of a method that decide whether it can begin a run.
struct MethodNeeds {
  std::string_view name;
  bool implicit, estimates_error;
  std::string_view
      unsupported_reason;        // why it does not support the system, to be read after its name; empty if it does
  bool has_own_control = false;  // a norm or a controller of its own: see WithNorm, WithController
};

template <class M, class System, State X>
[[nodiscard]] MethodNeeds needs_of(const System& system, const X& x) {
  MethodNeeds needs{M::name, detail::is_implicit<M>(), M::error_order > 0, {}, false};
  if constexpr (detail::HasUnsupportedReason<M, X, System>) needs.unsupported_reason = M::unsupported_reason(system, x);
  needs.has_own_control = detail::HasFault<M, typename M::template Workspace<X>>;
  return needs;
}

namespace detail {

template <class Real>
[[nodiscard]] bool is_positive(const Real& value) {
  return value > Real(0) && is_finite(value);
}

/// Why these tolerances cannot be meant; empty where they can. An absolute tolerance of a component may be infinite.
template <State X>
[[nodiscard]] std::string problem_of_tolerances(const X& x, const Options<X>& options) {
  using Real = Scalar<X>;
  const std::size_t n = dimension(x);
  for (const auto* each : {&options.rtol_each, &options.atol_each}) {
    if (each->empty() || each->size() == n) continue;
    return "a tolerance per component needs one for each: " + std::to_string(each->size()) + " are given for " +
           std::to_string(n) + " components";
  }
  const bool same = options.rtol_each.empty() && options.atol_each.empty();
  bool any_finite = n == 0;
  for (std::size_t i = 0; i < (same ? 1 : n); ++i) {
    const Real rtol = options.rtol_each.empty() ? options.rtol : options.rtol_each[i];
    const Real atol = options.atol_each.empty() ? options.atol : options.atol_each[i];
    const std::string of = same ? std::string() : " of component " + std::to_string(i);
    if (!(rtol >= Real(0)) || !(atol >= Real(0)) || !(rtol + atol > Real(0)))
      return "rtol and atol" + of + " must not be negative, and not both zero";
    if (!is_finite(rtol)) return "rtol" + of + " must be finite";
    any_finite = any_finite || is_finite(atol);
  }
  return any_finite ? std::string() : "atol is infinite, so that no error is too large: it must be finite";
}

template <State X>
[[nodiscard]] std::string problem_of_steps(const Options<X>& options) {
  using Real = Scalar<X>;
  if (!(options.step == Real(0)) && !is_positive(options.step))
    return "the fixed step must be greater than 0 and finite; a step of 0 leaves the size to the error control";
  if (!(options.first_step == Real(0)) && !is_positive(options.first_step))
    return "first_step must be greater than 0 and finite; with 0 it is estimated";
  if (!(options.max_step > Real(0))) return "max_step must be greater than 0";
  if (options.step > Real(0) && options.first_step > Real(0))
    return "step and first_step are both given: steps of a fixed size have no first step of another size";
  if (options.step > options.max_step) return "the fixed step is longer than max_step";
  if (options.max_steps == 0) return "max_steps is 0: the run must be allowed to take steps";
  const Controller& c = options.controller;
  if (!is_finite(c.beta1 + c.beta2 + c.beta3) || !(c.beta1 + c.beta2 + c.beta3 > 0))
    return "the exponents of the step controller must have a sum greater than 0";
  if (!(c.safety > 0 && c.safety <= 1)) return "the safety factor of the step controller must lie in 0..1, above 0";
  if (!(c.least_factor > 0 && c.least_factor <= 1 && c.greatest_factor >= 1))
    return "the step controller must be able to change steps by less than 1 and more than 1: least_factor must lie in "
           "0..1, above 0, and greatest_factor must be at least 1";
  return {};
}

template <State X>
[[nodiscard]] std::string problem_of_save(const Interval<Scalar<X>>& interval, const Save<X>& save) {
  using Real = Scalar<X>;
  using std::abs, std::max;
  using Kind = typename Save<X>::Kind;
  if (save.kind != Kind::times && !save.times.empty())
    return "times to save are given, and another kind of saving: give Save::at(times) alone";
  if (save.kind != Kind::grid && !(save.spacing == Real(0)))
    return "a spacing to save at is given, and another kind of saving: give Save::every(spacing) alone";
  const Real forward = interval.to < interval.from ? Real(-1) : Real(1),
             size = max(abs(interval.from), abs(interval.to));
  if (save.kind == Kind::grid) {
    if (!is_positive(save.spacing)) return "the spacing to save at must be greater than 0 and finite";
    if (interval.from != interval.to && !(size + save.spacing / 2 > size))
      return "the spacing to save at is below the spacing of numbers at the times of the run";
  }
  const Real slack = 16 * std::numeric_limits<Real>::epsilon() * size;
  for (std::size_t i = 0; i < save.times.size(); ++i) {
    const Real& t = save.times[i];
    const std::string which = "time " + std::to_string(i) + " to save at ";
    if (!is_finite(t)) return which + "is not finite";
    if (forward * (t - interval.from) < -slack || forward * (t - interval.to) > slack)
      return which + "lies outside of the run";
    if (i > 0 && forward * (t - save.times[i - 1]) < Real(0))
      return which + "is before the one before it: the times must be in the order of the run";
  }
  return {};
}

/// Why the structure that the system gives is not one of a state of this size; empty where it is.
template <class System, State X>
[[nodiscard]] std::string problem_of_structure(const System& system, const X& x) {
  using Real = Scalar<X>;
  const std::size_t n = dimension(x);
  if constexpr (requires { std::string(system.size_problem(n)); }) {
    if (std::string why = system.size_problem(n); !why.empty()) return why;
  }
  if constexpr (SecondOrder<System>) {
    std::vector<char> known(n, 0);
    for (std::size_t i = 0, count = system.pair_count(n); i < count; ++i) {
      const PositionVelocity pair = system.pair(i, n);
      for (const std::size_t component : {pair.position, pair.velocity}) {
        const std::string which = "component " + std::to_string(component) + " of pair " + std::to_string(i);
        if (component >= n) return which + " is not in the state, which has " + std::to_string(n) + " components";
        if (std::exchange(known[component], char{1}) != 0)
          return which + " is in a pair twice: a component is one position or one velocity";
      }
    }
  }
  if constexpr (HasMassDiagonal<System, X>) {
    if (has_mass<X>(system))
      for (std::size_t i = 0; i < n; ++i)
        if (!is_finite(Real(system.mass(i)))) return "the mass of " + component_name(system, i) + " is not finite";
  } else if constexpr (HasMassMatrix<System, X>) {
    if (has_mass<X>(system)) {
      std::vector<Real> rows(n * n, Real(0));
      system.mass_matrix(std::span<Real>(rows));
      for (const Real& entry : rows)
        if (!is_finite(entry)) return "the mass matrix is not finite";
    }
  }
  return {};
}

/// Why the pattern of the Jacobian is not one of a state of this size; empty where it is.
template <class System, State X>
[[nodiscard]] std::string problem_of_pattern(System& system, const X& x) {
  if constexpr (HasJacobianPattern<System>) {
    if (const std::size_t size = system.jacobian_pattern().size(); size != 0 && size != dimension(x))
      return "the pattern of the Jacobian is one of " + std::to_string(size) + " components, and the state has " +
             std::to_string(dimension(x));
  }
  return {};
}

}  // namespace detail

/// Why the method cannot begin a run of this system from x with these options, as a hint; empty where it can.
template <class System, State X>
[[nodiscard]] std::string wrong_input(const MethodNeeds& method, const System& system, const X& x,
                                      const Interval<Scalar<X>>& interval, const Options<X>& options) {
  using Real = Scalar<X>;
  for (std::size_t i = 0; i < dimension(x); ++i)
    if (!(Real(0) * x.data()[i] == Real(0))) return component_name(system, i) + " is not finite at the start";
  if (!(Real(0) * (interval.to - interval.from) == Real(0))) return "the interval of time is not finite";
  if constexpr (requires { std::string(system.start_problem(interval.from, x)); }) {
    if (std::string why = system.start_problem(interval.from, x); !why.empty()) return why;
  }
  const auto hint = [&](std::string_view text) { return std::string(method.name).append(text); };
  if (has_mass<X>(system) && !method.implicit)
    return hint(" cannot integrate M x' = f(t, x): take an implicit method, such as rodas5p");
  if (!method.unsupported_reason.empty()) return hint(" ").append(method.unsupported_reason);
  if (!method.estimates_error && !(options.step > 0)) return hint(" has no error estimate: give it a step");
  if (method.has_own_control && options.step > 0)
    return hint(" has a norm or a step controller, and steps of a fixed size are given: leave out one of them");
  if (std::string why = detail::problem_of_tolerances(x, options); !why.empty()) return why;
  if (std::string why = detail::problem_of_steps(options); !why.empty()) return why;
  if (std::string why = detail::problem_of_save(interval, options.save); !why.empty()) return why;
  return detail::problem_of_corrections(system, interval.from, x, options);
}

}  // namespace continuo
