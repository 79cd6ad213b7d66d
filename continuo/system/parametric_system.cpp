// Names and derivatives of a system with constants; what it does not give is taken by central differences.
#include <algorithm>
#include <string>
#include <vector>

#include <continuo/numerics/central_difference.hpp>
#include <continuo/system/parametric_system.hpp>

namespace continuo {

std::string ParametricSystem::name(std::size_t i) const {
  return i < names.size() ? names[i] : "x[" + std::to_string(i) + "]";
}
std::string ParametricSystem::constant_name(std::size_t i) const {
  return i < constant_names.size() ? constant_names[i] : "p[" + std::to_string(i) + "]";
}

std::vector<double> jacobian_of(const ParametricSystem& system, double t, Values x, Values p, Values scale) {
  const std::size_t n = system.size;
  std::vector<double> rows(n * n);
  if (system.jacobian && system.pattern.size() == 0) {
    system.jacobian(t, x, p, rows);
  } else if (system.jacobian) {
    std::vector<double> entries(system.pattern.entries());
    system.jacobian(t, x, p, entries);
    for (std::size_t j = 0; j < n; ++j)
      for (std::size_t e = system.pattern.begin(j); e < system.pattern.end(j); ++e)
        rows[system.pattern.row(e) * n + j] = entries[e];
  } else {
    difference_jacobian(
        std::vector(x.begin(), x.end()),
        [&](std::size_t j) { return central_increment(x[j], scale.empty() ? 1.0 : scale[j]); },
        [&](Values moved, std::span<double> f) { system.derivative(t, moved, p, f); }, std::span(rows));
  }
  return rows;
}

std::vector<double> constant_jacobian_of(const ParametricSystem& system, double t, Values x, Values p, Values scale) {
  const std::size_t n = system.size, m = p.size();
  std::vector<double> rows(n * m);
  if (system.constant_jacobian) {
    system.constant_jacobian(t, x, p, rows);
    return rows;
  }
  difference_jacobian(
      std::vector(p.begin(), p.end()),
      [&](std::size_t j) {
        return central_increment(p[j], !scale.empty() ? scale[j] : p[j] == 0 ? 1.0 : 0.0);
      },
      [&](Values moved, std::span<double> f) { system.derivative(t, x, moved, f); }, std::span(rows));
  return rows;
}

}  // namespace continuo
