// continuo/solve/automatic.hpp
// `solve` without a method: a method is chosen by the tolerance, the size and the kind of the system, and switches to a
// stiff one where needed.
//
//   auto solution = solve(f, std::array{1.0, 0.0}, {0, 10}, {.rtol = 1e-7});
#pragma once
#include <algorithm>
#include <cstddef>
#include <string_view>
#include <type_traits>
#include <utility>

#include <continuo/methods/automatic.hpp>
#include <continuo/solve/choice.hpp>
#include <continuo/solve/solve.hpp>
#include <continuo/system/mass.hpp>
#include <continuo/system/second_order.hpp>

namespace continuo {

/// The properties of a system, at a state, on which `choose_method` depends.
template <class System, State X>
[[nodiscard]] SystemTraits traits_of(System& system, const X& x, double rtol) {
  SystemTraits traits{.size = dimension(x), .rtol = rtol, .algebraic = has_mass<X>(system)};
  if constexpr (SecondOrder<System>) {
    traits.accelerations = 2 * system.pair_count(traits.size) == traits.size && ignores_velocity(system, x);
  }
  if constexpr (HasJacobianPattern<System>) {
    constexpr std::size_t entries_of_sparse = 10;  // one in so many
    const SparsePattern& pattern = system.jacobian_pattern();
    traits.sparse = entries_of_sparse * pattern.entries() < traits.size * traits.size;
    traits.banded = traits.sparse && pattern.is_banded();
  }
  return traits;
}

/// Integrates dx/dt = f(t, x) from x(from) = x0 by a method that `choose_method` chooses. A failure on the way does not
/// throw: see Solution::outcome.
template <class System, class X>
[[nodiscard]] typename detail::TypesOfRun<X>::Result solve(System system, X x0,
                                                           Interval<typename detail::TypesOfRun<X>::Real> interval,
                                                           typename detail::TypesOfRun<X>::Settings options = {}) {
  if constexpr (detail::check_call<HeldSystem<System>, X, Tsitouras5Rodas5P>()) {
    HeldSystem<System> held(std::move(system));
    const auto rtol = options.rtol_each.empty() ? options.rtol : *std::ranges::min_element(options.rtol_each);
    const std::string_view method = choose_method(traits_of(held, x0, static_cast<double>(rtol))).method;
    const auto by = [&](auto chosen) { return solve(std::move(held), x0, interval, chosen, options); };
    if constexpr (SecondOrder<HeldSystem<System>>) {
      if (method == DormandPrinceNystrom8Radau::name) return by(DormandPrinceNystrom8Radau{});
      if (method == DormandPrinceNystrom12Radau::name) return by(DormandPrinceNystrom12Radau{});
    }
    // With algebraic equations, each of these uses its stiff half from the beginning to the end.
    if (method == Dop853Radau::name || method == Radau::name) return by(Dop853Radau{});
    if (method == Tsitouras5Bdf::name || method == Bdf::name) return by(Tsitouras5Bdf{});
    return by(Tsitouras5Rodas5P{});
  } else {
    return {};
  }
}

}  // namespace continuo
