// continuo/studies/support/parametric_system.cpp
// Names, and Jacobians by central differences where a system gives none.
#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include <continuo/studies/parametric_system.hpp>

namespace continuo::studies {

std::string ParametricSystem::name(std::size_t i) const {
  return i < names.size() ? names[i] : fmt::format("x[{}]", i);
}
std::string ParametricSystem::constant_name(std::size_t i) const {
  return i < constant_names.size() ? constant_names[i] : fmt::format("p[{}]", i);
}

double central_increment(double x, double scale) {
  static const double relative = std::cbrt(std::numeric_limits<double>::epsilon());
  const double moved = x + relative * std::max(std::abs(x), scale);
  return moved - x;
}

namespace {

/// Column j of a matrix of `columns` columns, by central differences of call(moved, out).
template <class Call>
void set_column(std::vector<double>& rows, std::size_t n, std::size_t columns, std::size_t j, double increment,
                std::vector<double>& moved, std::vector<double>& above, std::vector<double>& below, const Call& call) {
  const double here = moved[j];
  moved[j] = here + increment;
  call(above);
  moved[j] = here - increment;
  call(below);
  moved[j] = here;
  for (std::size_t i = 0; i < n; ++i) rows[i * columns + j] = (above[i] - below[i]) / (2 * increment);
}

}  // namespace

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
    std::vector<double> moved(x.begin(), x.end()), above(n), below(n);
    for (std::size_t j = 0; j < n; ++j) {
      const double increment = central_increment(x[j], scale.empty() ? 1 : scale[j]);
      set_column(rows, n, n, j, increment, moved, above, below,
                 [&](std::vector<double>& out) { system.derivative(t, moved, p, out); });
    }
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
  std::vector<double> moved(p.begin(), p.end()), above(n), below(n);
  for (std::size_t j = 0; j < m; ++j) {
    const double increment = central_increment(p[j], !scale.empty() ? scale[j] : p[j] == 0 ? 1 : 0);
    set_column(rows, n, m, j, increment, moved, above, below,
               [&](std::vector<double>& out) { system.derivative(t, x, moved, out); });
  }
  return rows;
}

void leave_out_conserved(const ParametricSystem& system, std::complex<double> own,
                         std::vector<std::complex<double>>& eigenvalues) {
  for (std::size_t k = 0; k < system.conserved && !eigenvalues.empty(); ++k)
    eigenvalues.erase(std::ranges::min_element(
        eigenvalues, {}, [&](const std::complex<double>& value) { return std::abs(value - own); }));
}

}  // namespace continuo::studies
