// continuo/solve/in_library/runs_in_library.hpp
// What the library's runs of type-erased systems are made of. Included where they are instantiated, and nowhere else.
#pragma once
#include <optional>
#include <string_view>
#include <tuple>
#include <utility>

#include <continuo/methods/automatic.hpp>
#include <continuo/methods/explicit_rk/dop853.hpp>
#include <continuo/methods/explicit_rk/dormand_prince5.hpp>
#include <continuo/methods/explicit_rk/rk4.hpp>
#include <continuo/methods/explicit_rk/tsitouras5.hpp>
#include <continuo/solve/erased_system.hpp>
#include <continuo/solve/solve.hpp>

namespace continuo::detail {

template <State X>
Solution<X> RunsInLibrary<X>::run(ErasedSystem<X> f, X x0, Interval<Scalar<X>> interval, std::string_view method,
                                  Options<X> options) {
  std::optional<Solution<X>> solution;
  const auto by = [&]<class M>(M chosen) {
    if (solution || method != M::name) return;
    Integrator<ErasedSystem<X>, X, M> integrator(std::move(f), std::move(x0), interval, chosen, std::move(options));
    solution = continuo::run(integrator);
  };
  std::apply([&](auto... chosen) { (by(chosen), ...); }, MethodsInLibrary{});
  return *std::move(solution);
}

}  // namespace continuo::detail
