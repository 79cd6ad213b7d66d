// continuo/studies/support/flow.cpp
// Integrates a parametric system, alone or with its variational equations.
#include <algorithm>
#include <span>
#include <utility>
#include <vector>

#include <continuo/studies/support/flow.hpp>
#include <continuo/studies/support/named_solve.hpp>

namespace continuo::studies {

Solution<std::vector<double>> run_flow(const ParametricSystem& system, Values p, std::vector<double> x0,
                                       Interval<double> interval, const Options<std::vector<double>>& options) {
  NamedSystem<double> named{.size = x0.size()};
  named.name = [&system](std::size_t i) { return system.name(i); };
  named.derivative = [&system, p](double t, Values x, std::span<double> dxdt) { system.derivative(t, x, p, dxdt); };
  named.given_jacobian = [&system, p](double t, Values x, std::span<double> rows) {
    std::ranges::copy(jacobian_of(system, t, x, p), rows.begin());
  };
  return named_solve(named, std::move(x0), interval, options);
}

ParametricSystem with_variations(const ParametricSystem& system, bool by_constants) {
  const std::size_t n = system.size, columns = n + (by_constants ? system.parameters() : 0);
  ParametricSystem result{.size = n * (1 + columns), .constants = system.constants};
  result.constant_names = system.constant_names;
  for (std::size_t i = 0; i < n; ++i) result.names.push_back(system.name(i));
  for (std::size_t j = 0; j < columns; ++j) {
    const std::string by = j < n ? system.name(j) + "(0)" : system.constant_name(j - n);
    for (std::size_t i = 0; i < n; ++i) result.names.push_back("d " + system.name(i) + " / d " + by);
  }
  result.derivative = [system, n, columns](double t, Values x, Values p, std::span<double> dxdt) {
    const Values state = x.first(n);
    system.derivative(t, state, p, dxdt.first(n));
    const std::vector<double> rows = jacobian_of(system, t, state, p);
    for (std::size_t c = 0; c < columns; ++c) {
      const Values column = x.subspan(n * (1 + c), n);
      for (std::size_t i = 0; i < n; ++i) {
        double sum = 0;
        for (std::size_t j = 0; j < n; ++j) sum += rows[i * n + j] * column[j];
        dxdt[n * (1 + c) + i] = sum;
      }
    }
    if (columns == n) return;
    const std::vector<double> by = constant_jacobian_of(system, t, state, p);
    const std::size_t m = columns - n;
    for (std::size_t c = 0; c < m; ++c)
      for (std::size_t i = 0; i < n; ++i) dxdt[n * (1 + n + c) + i] += by[i * m + c];
  };
  return result;
}

std::vector<double> variational_start(const ParametricSystem& system, Values x0, bool by_constants) {
  const std::size_t n = system.size, columns = n + (by_constants ? system.parameters() : 0);
  std::vector<double> start(n * (1 + columns));
  std::ranges::copy(x0, start.begin());
  for (std::size_t i = 0; i < n; ++i) start[n * (1 + i) + i] = 1;
  return start;
}

}  // namespace continuo::studies
