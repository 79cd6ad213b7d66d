// The body of named_solve; included only by the named_solve_*.cpp, one for each kind of number.
#pragma once
#include <utility>

#include <continuo/methods/all.hpp>
#include <continuo/solve/solve.hpp>
#include <continuo/solve/with_method.hpp>
#include <continuo/studies/support/named_solve.hpp>

namespace continuo::studies {

template <class Real>
[[nodiscard]] Solution<std::vector<Real>> named_solve(std::string_view method, const NamedSystem<Real>& system,
                                                      std::type_identity_t<std::vector<Real>> x0,
                                                      std::type_identity_t<Interval<Real>> interval,
                                                      const std::type_identity_t<Options<std::vector<Real>>>& options) {
  Solution<std::vector<Real>> solution;
  solution.outcome.ending = Ending::invalid_input;
  solution.outcome.hint = "there is no method of this name";
  const MethodInfo* info = find_method(method);
  if (info != nullptr && info->second_order && system.pairs.empty()) {
    solution.outcome.hint = std::string(method) + " needs x'' = a(t, x): pairs of a position and its velocity";
    return solution;
  }
  if (info != nullptr && info->needs_series) {
    solution.outcome.hint =
        std::string(method) + " needs the Taylor series of the equations, which is not known here: take dop853";
    return solution;
  }
  with_method(method, [&](auto chosen) {
    const auto any = any_method<decltype(chosen), NamedSystem<Real>, std::vector<Real>>();
    solution = solve(system, std::move(x0), interval, any, options);
  });
  return solution;
}

}  // namespace continuo::studies
