// A problem solved by a method selected by name, as in studies; compiled once for all problems.
#pragma once
#include <algorithm>
#include <span>
#include <vector>

#include <continuo/studies/support/named_solve.hpp>

namespace continuo::promises {

/// The state at the end of Problem by the method M.
template <class M, class Problem>
Solution<std::vector<double>> solved_by_name(double rtol, double atol) {
  using X = typename Problem::State;
  const auto state = [](std::span<const double> values) {
    X x{};
    std::ranges::copy(values, x.begin());
    return x;
  };
  auto system = studies::named_system<double>(Problem::size, [state](double t, std::span<const double> x, auto dxdt) {
    X slope{};
    Problem{}(t, state(x), slope);
    std::ranges::copy(slope, dxdt.begin());
  });
  system.given_jacobian = [state](double t, std::span<const double> x, std::span<double> rows) {
    Problem{}.jacobian(t, state(x), rows);
  };
  const auto start = Problem::start();
  return studies::named_solve<double>(M::name, system, {start.begin(), start.end()}, {0.0, Problem::duration},
                                      {.rtol = rtol, .atol = atol, .save = Save<std::vector<double>>::only_end()});
}

}  // namespace continuo::promises
