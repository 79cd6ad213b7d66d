// continuo/solve/steps/check_input.hpp
// The check of a run's input.
#pragma once
#include <cstddef>
#include <string>
#include <string_view>

#include <continuo/methods/method.hpp>
#include <continuo/solve/options.hpp>
#include <continuo/system/mass.hpp>

namespace continuo {

/// The properties of a method that decide whether it can begin a run.
struct MethodNeeds {
  std::string_view name;
  bool implicit, estimates_error;
  std::string_view
      unsupported_reason;  // why it does not support the system, to be read after its name; empty if it does
};

template <class M, class System, State X>
[[nodiscard]] MethodNeeds needs_of(const System& system, const X& x) {
  MethodNeeds needs{M::name, detail::is_implicit<M>(), M::error_order > 0, {}};
  if constexpr (detail::HasUnsupportedReason<M, X, System>) needs.unsupported_reason = M::unsupported_reason(system, x);
  return needs;
}

/// Why the method cannot begin a run of this system from x with these options, as a hint; empty where it can.
template <class System, State X>
[[nodiscard]] std::string wrong_input(const MethodNeeds& method, const System& system, const X& x,
                                      const Interval<Scalar<X>>& interval, const Options<X>& options) {
  using Real = Scalar<X>;
  for (std::size_t i = 0; i < dimension(x); ++i)
    if (!(Real(0) * x.data()[i] == Real(0))) return component_name(system, i) + " is not finite at the start";
  if (!(Real(0) * (interval.to - interval.from) == Real(0))) return "the interval of time is not finite";
  const auto hint = [&](std::string_view text) { return std::string(method.name).append(text); };
  if (has_mass<X>(system) && !method.implicit)
    return hint(" cannot integrate M x' = f(t, x): take an implicit method, such as rodas5p");
  if (!method.unsupported_reason.empty()) return hint(" ").append(method.unsupported_reason);
  if (!method.estimates_error && !(options.step > 0)) return hint(" has no error estimate: give it a step");
  for (const auto* each : {&options.rtol_each, &options.atol_each})
    if (!each->empty() && each->size() != dimension(x)) return "a tolerance per component needs one for each";
  if (!(options.rtol >= 0) || !(options.atol >= 0) || !(options.rtol + options.atol > 0))
    return "rtol and atol must not be negative, and not both zero";
  return {};
}

}  // namespace continuo
