// Fits linear recurrences to the states of a method, and finds their greatest root.
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include <continuo/solve/catalogue.hpp>
#include <continuo/studies/accuracy/amplification.hpp>
#include <continuo/studies/support/named_solve.hpp>

namespace continuo::studies {

namespace {

constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

// A method of several steps raises its order one by one until it is settled; orders beyond 6 are not stable (BDF), or
// not taken with fixed steps.
constexpr std::size_t greatest_memory = 6, settling = 10;
// Of equations whose entries are at most 1: a thousand times what rounding leaves in them, and below what a root that
// could matter leaves.
constexpr double explained = 1e-11;

/// Least squares by modified Gram-Schmidt: coefficients with the smallest |A c - b|; rows of A, and b behind them.
std::optional<std::vector<Complex>> fit(std::vector<std::vector<Complex>> columns, std::vector<Complex> b) {
  const std::size_t k = columns.size();
  std::vector<std::vector<Complex>> r(k, std::vector<Complex>(k));
  std::vector<Complex> projection(k);
  const auto dot = [](const std::vector<Complex>& u, const std::vector<Complex>& v) {
    Complex sum = 0;
    for (std::size_t i = 0; i < u.size(); ++i) sum += std::conj(u[i]) * v[i];
    return sum;
  };
  const auto subtract = [](std::vector<Complex>& u, Complex factor, const std::vector<Complex>& v) {
    for (std::size_t i = 0; i < u.size(); ++i) u[i] -= factor * v[i];
  };
  for (std::size_t j = 0; j < k; ++j) {
    const double length = std::sqrt(dot(columns[j], columns[j]).real());
    if (!(length > 1e-14)) return std::nullopt;  // it depends on those before
    r[j][j] = length;
    for (Complex& entry : columns[j]) entry /= length;
    for (std::size_t l = j + 1; l < k; ++l) {
      r[j][l] = dot(columns[j], columns[l]);
      subtract(columns[l], r[j][l], columns[j]);
    }
    projection[j] = dot(columns[j], b);
    subtract(b, projection[j], columns[j]);
  }
  for (const Complex& rest : b)
    if (!(std::abs(rest) < explained)) return std::nullopt;
  std::vector<Complex> c(k);
  for (std::size_t j = k; j-- > 0;) {
    c[j] = projection[j];
    for (std::size_t l = j + 1; l < k; ++l) c[j] -= r[j][l] * c[l];
    c[j] /= r[j][j];
  }
  return c;
}

/// The coefficients of the recurrence of length k, if it explains the states.
std::optional<std::vector<Complex>> recurrence(std::span<const Complex> y, std::size_t k) {
  if (y.size() < 2 * k + 1) return std::nullopt;
  std::vector<std::vector<Complex>> columns(k);
  std::vector<Complex> b;
  for (std::size_t n = 0; n + k < y.size(); ++n) {
    double size = 0;
    for (std::size_t j = 0; j <= k; ++j) size = std::max(size, std::abs(y[n + j]));
    if (!(size > 1e-280)) continue;  // died out
    for (std::size_t j = 0; j < k; ++j) columns[j].push_back(y[n + j] / size);
    b.push_back(y[n + k] / size);
  }
  if (b.size() <= k) return std::nullopt;
  return fit(std::move(columns), std::move(b));
}

/// The greatest |zeta| with zeta^k = c_0 + ... + c_(k-1) zeta^(k-1), by the iteration of Durand and Kerner for all
/// roots at once.
double greatest_root(const std::vector<Complex>& c) {
  const std::size_t k = c.size();
  if (k == 1) return std::abs(c[0]);
  if (k == 2) {  // zeta^2 - c1 zeta - c0
    const Complex root = std::sqrt(c[1] * c[1] + 4.0 * c[0]);
    return std::max(std::abs(c[1] + root), std::abs(c[1] - root)) / 2;
  }
  double radius = 0;
  for (const Complex& entry : c) radius = std::max(radius, std::abs(entry));
  std::vector<Complex> roots(k);
  for (std::size_t j = 0; j < k; ++j) roots[j] = std::polar(1 + radius / 2, 0.4 + 2.4 * static_cast<double>(j));
  const auto value = [&](Complex zeta) {
    Complex sum = 1;
    for (std::size_t j = k; j-- > 0;) sum = sum * zeta - c[j];
    return sum;
  };
  for (int round = 0; round < 200; ++round) {
    double moved = 0;
    for (std::size_t j = 0; j < k; ++j) {
      Complex others = 1;
      for (std::size_t l = 0; l < k; ++l)
        if (l != j) others *= roots[j] - roots[l];
      if (others == 0.0) continue;
      const Complex correction = value(roots[j]) / others;
      roots[j] -= correction;
      moved = std::max(moved, std::abs(correction));
    }
    if (moved < 1e-15 * (1 + radius)) break;
  }
  double greatest = 0;
  for (const Complex& root : roots) greatest = std::max(greatest, std::abs(root));
  return greatest;
}

bool died_out(std::span<const Complex> y) {
  return !y.empty() && std::abs(y.back()) < 1e-280;
}

std::vector<Complex> first_components(const Solution<std::vector<double>>& solution, bool complex) {
  std::vector<Complex> states;
  if (solution.outcome.ending == Ending::invalid_input) return states;
  for (const auto& x : solution.x) states.emplace_back(x[0], complex ? x[1] : 0.0);
  return states;
}

/// The equations of a step are linear: Newton's iteration has them after one round, whatever the tolerance.
Options<std::vector<double>> unit_steps() {
  return {.rtol = 1e-10, .atol = 1e-10, .step = 1};
}

}  // namespace

std::function<std::vector<Complex>(Complex, Complex, std::size_t)> motion_steps_of(std::string_view method) {
  return [name = std::string(method)](Complex z1, Complex z2, std::size_t steps) {
    const double damping = (z1 + z2).real(), stiffness = (z1 * z2).real();
    auto system = named_motion<double>(
        2,
        [damping, stiffness](double, std::span<const double> x, std::span<double> dxdt) {
          dxdt[0] = x[1];
          dxdt[1] = damping * x[1] - stiffness * x[0];
        },
        damping == 0);
    system.given_jacobian = [damping, stiffness](double, std::span<const double>, std::span<double> rows) {
      rows[0] = 0, rows[1] = 1, rows[2] = -stiffness, rows[3] = damping;
    };
    const auto solution =  // both motions have a part in this start
        named_solve<double>(name, system, {1, 0.3 * std::abs(z1)}, {0, static_cast<double>(steps)}, unit_steps());
    return first_components(solution, false);
  };
}

StepSequence steps_of(std::string_view method) {
  const MethodInfo* info = find_method(method);
  if (info != nullptr && info->second_order)
    return [pair = motion_steps_of(method)](Complex z, std::size_t steps) { return pair(z, std::conj(z), steps); };
  return [name = std::string(method)](Complex z, std::size_t steps) {
    const double re = z.real(), im = z.imag();
    auto system = named_system<double>(2, [re, im](double, std::span<const double> x, std::span<double> dxdt) {
      dxdt[0] = re * x[0] - im * x[1];
      dxdt[1] = im * x[0] + re * x[1];
    });
    system.given_jacobian = [re, im](double, std::span<const double>, std::span<double> rows) {
      rows[0] = re, rows[1] = -im, rows[2] = im, rows[3] = re;
    };
    const auto solution = named_solve<double>(name, system, {1, 0}, {0, static_cast<double>(steps)}, unit_steps());
    return first_components(solution, true);
  };
}

double amplification(std::span<const Complex> states) {
  for (std::size_t k = 1; k <= greatest_memory; ++k)
    if (const auto c = recurrence(states, k)) return greatest_root(*c);
  return unknown;
}

double amplification(const StepSequence& sequence, Complex z) {
  const auto few = sequence(z, 8);
  if (few.size() < 2) return unknown;
  if (few.size() < 9 || std::abs(few.back()) > 1e200)  // overflow
    return std::abs(few.back() / few[few.size() - 2]);
  if (died_out(few)) return 0;
  for (std::size_t k = 1; k <= 2; ++k)
    if (const auto c = recurrence(few, k)) return greatest_root(*c);
  const auto many = sequence(z, settling + 4 * greatest_memory);
  if (many.size() <= settling + 2 * greatest_memory) return std::abs(many.back() / many[many.size() - 2]);
  if (died_out(many)) return 0;
  return amplification(std::span<const Complex>(many).subspan(settling));
}

}  // namespace continuo::studies
