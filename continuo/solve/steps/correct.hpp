// Corrections of a state: its projection onto invariants, and the signs of its components.
#pragma once
#include <algorithm>
#include <cstddef>
#include <limits>
#include <string>

#include <continuo/methods/method.hpp>
#include <continuo/methods/support/weighted_norm.hpp>
#include <continuo/numerics/finite.hpp>
#include <continuo/solve/options.hpp>
#include <continuo/system/system.hpp>

namespace continuo {

/// The weights by which the options measure errors. They refer to the options.
template <State X>
[[nodiscard]] Tolerance<Scalar<X>> tolerance_of(const Options<X>& options) {
  return {options.rtol, options.atol, options.rtol_each.empty() ? nullptr : options.rtol_each.data(),
          options.atol_each.empty() ? nullptr : options.atol_each.data()};
}

/// Whether the options hold states to anything.
template <State X>
[[nodiscard]] bool corrects(const Options<X>& options) {
  return static_cast<bool>(options.projection) || !options.signs.empty();
}

/// Sets every component of a wrong sign to the nearest value that is allowed, in tolerances.
template <State X>
void keep_signs(const Options<X>& options, X& x) {
  using Real = Scalar<X>;
  using std::max;
  for (std::size_t i = 0; i < std::min(options.signs.size(), dimension(x)); ++i) {
    const Sign sign = options.signs[i];
    Real& value = x.data()[i];
    if (detail::has_sign(sign, value)) [[likely]]
      continue;
    const Real scale = tolerance_of(options).scale(i, value, value);
    const Real least = max(Real(scale / Real(10)), std::numeric_limits<Real>::min());
    value = sign == Sign::positive ? least : sign == Sign::negative ? -least : Real(0);
  }
}

/// Projects x. False where there is no state on the invariants of the size of x and finite: then x stays.
template <State X>
[[nodiscard]] bool project(const Options<X>& options, const Scalar<X>& t, X& x, X& scratch) {
  scratch = x;
  if (options.projection(t, scratch) && dimension(scratch) == dimension(x) && detail::is_finite_state(scratch)) {
    x = scratch;
    return true;
  }
  return false;
}

namespace detail {

/// Why the signs and the projection of the options cannot be those of a run from x; empty where they can.
template <class System, State X>
[[nodiscard]] std::string problem_of_corrections(const System& system, const Scalar<X>& t, const X& x,
                                                 const Options<X>& options) {
  using Real = Scalar<X>;
  if (!corrects(options)) return {};
  if (options.projection && !options.signs.empty())
    return "signs and a projection are both given: one would undo the other; let the projection keep the signs";
  if (!options.signs.empty()) {
    if (options.signs.size() != dimension(x))
      return "signs need one for each component: " + std::to_string(options.signs.size()) + " are given for " +
             std::to_string(dimension(x)) + " components";
    if (options.step > Real(0))
      return "a sign is kept by shorter steps, and steps of a fixed size are given: leave out the step or the signs";
    for (std::size_t i = 0; i < dimension(x); ++i)
      if (!has_sign(options.signs[i], x.data()[i]))
        return component_name(system, i) + " is to be " + words_for(options.signs[i]) + ", and is not at the start";
    return {};
  }
  X moved = x, scratch = x;
  if (!project(options, t, moved, scratch)) {
    if (dimension(scratch) != dimension(x)) return "the projection changes the number of components";
    return "the projection finds no state on the invariants near the initial one";
  }
  if (options.step > Real(0)) return {};
  for (std::size_t i = 0; i < dimension(x); ++i) moved.data()[i] -= x.data()[i];
  if (!(weighted_norm(moved, x, x, tolerance_of(options)) <= Real(1)))
    return "the initial state is not on the invariants: the projection moves it by more than the tolerance";
  return {};
}

}  // namespace detail

}  // namespace continuo
