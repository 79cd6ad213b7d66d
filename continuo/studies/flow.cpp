// continuo/studies/flow.cpp
#include <algorithm>
#include <memory>
#include <utility>

#include <continuo/solve/automatic.hpp>
#include <continuo/studies/flow.hpp>

namespace continuo::studies {

namespace {

using X = std::vector<double>;

/// As `solve` wants it.
struct WithConstants {
  const ParametricSystem* system;
  std::vector<double> p;

  void operator()(double t, const X& x, X& dxdt) const { system->derivative(t, x, p, dxdt); }
  void jacobian(double t, const X& x, std::span<double> rows) const {
    std::ranges::copy(jacobian_of(*system, t, x, p), rows.begin());
  }
  std::string component_name(std::size_t i) const { return system->name(i); }
};

}  // namespace

Solution<X> run_flow(const ParametricSystem& system, Values p, X x0, Interval<double> interval,
                     const Options<X>& options) {
  return solve(WithConstants{&system, {p.begin(), p.end()}}, x0, interval, options);
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
