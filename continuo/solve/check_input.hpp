// continuo/solve/check_input.hpp
// What a run cannot begin with.
#pragma once
#include <cstddef>
#include <string>
#include <string_view>

#include <continuo/methods/method.hpp>
#include <continuo/solve/options.hpp>
#include <continuo/system/mass.hpp>

namespace continuo {

/// Why M cannot begin a run of this system from x with these options, as a hint; empty where it can.
template <class M, class System, State X>
std::string wrong_input(const System& system, const X& x, const Interval<Scalar<X>>& interval,
                        const Options<X>& options) {
  using Real = Scalar<X>;
  for (std::size_t i = 0; i < dimension(x); ++i)
    if (!(Real(0) * x.data()[i] == Real(0))) return component_name(system, i) + " is not finite at the start";
  if (!(Real(0) * (interval.to - interval.from) == Real(0))) return "the interval of time is not finite";
  if (has_mass<X>(system) && !detail::is_implicit<M>())
    return std::string(M::name) + " cannot integrate M x' = f(t, x): take an implicit method, such as rodas5p";
  if constexpr (requires { M::why_not(system, x); }) {
    if (const std::string_view why = M::why_not(system, x); !why.empty())
      return std::string(M::name) + ' ' + std::string(why);
  }
  if (M::error_order == 0 && !(options.step > 0))
    return std::string(M::name) + " has no error estimate: give it a step";
  for (const auto* each : {&options.rtol_each, &options.atol_each})
    if (!each->empty() && each->size() != dimension(x)) return "a tolerance per component needs one for each";
  if (!(options.rtol >= 0) || !(options.atol >= 0) || !(options.rtol + options.atol > 0))
    return "rtol and atol must not be negative, and not both zero";
  return {};
}

}  // namespace continuo
