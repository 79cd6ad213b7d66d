// continuo/solve/automatic.hpp
// `solve` without a method: one is chosen by tolerance and size, and hands over to a stiff one where that is due.
//
//   auto solution = solve(f, std::array{1.0, 0.0}, {0, 10}, {.rtol = 1e-7});
#pragma once
#include <type_traits>
#include <utility>

#include <continuo/methods/automatic.hpp>
#include <continuo/solve/choice.hpp>
#include <continuo/solve/solve.hpp>
#include <continuo/system/mass.hpp>

namespace continuo {

template <class System, State X>
auto solve(System system, const X& x0, Interval<std::type_identity_t<Scalar<X>>> interval,
           const std::type_identity_t<Options<X>>& options = {}) {
  const Choice choice = choose_method(
      {.size = dimension(x0), .rtol = static_cast<double>(options.rtol), .algebraic = has_mass<X>(system)});
  const auto by = [&](auto method) { return solve(std::move(system), x0, interval, method, options); };
  if (choice.method == Dop853Radau::name || choice.method == Radau::name) return by(Dop853Radau{});
  if (choice.method == Tsitouras5Bdf::name || choice.method == Bdf::name) return by(Tsitouras5Bdf{});
  return by(Tsitouras5Rodas5P{});  // with algebraic equations each of them begins, and stays, with its stiff half
}

}  // namespace continuo
