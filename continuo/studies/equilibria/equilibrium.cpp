// continuo/studies/equilibria/equilibrium.cpp
// Finds equilibria by damped Newton iterations from many starts, and describes their stability.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <span>
#include <utility>

#include <continuo/numerics/dense_lu.hpp>
#include <continuo/numerics/eigenvalues.hpp>
#include <continuo/numerics/finite.hpp>
#include <continuo/numerics/newton_iteration.hpp>
#include <continuo/studies/conservation_laws.hpp>
#include <continuo/studies/equilibrium.hpp>
#include <continuo/studies/support/vector_algebra.hpp>

namespace continuo::studies {

namespace {

using detail::length;

constexpr std::size_t most_search_iterations = 200;
constexpr double epsilon = std::numeric_limits<double>::epsilon();
constexpr double singular_part = 1e-10;  // of |f| at the start: with a singular df/dx, so small is zero
constexpr double same_part = 1e-6;       // equilibria closer than this, relative to the box, are one

double largest(Values values) {
  double size = 0;
  for (const double value : values) size = std::abs(value) > size || std::isnan(value) ? std::abs(value) : size;
  return size;
}

/// (J^T J + mu I) step = -J^T f: toward the least squares where J is singular, Newton's step for mu = 0.
std::vector<double> least_squares_step(const std::vector<double>& rows, Values f, double mu) {
  const std::size_t n = f.size();
  DenseLU<double, run_time_size> lu(n);
  auto&& matrix = lu.matrix();
  std::vector<double> step(n);
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = 0; j < n; ++j) {
      double sum = i == j ? mu : 0;
      for (std::size_t k = 0; k < n; ++k) sum += rows[k * n + i] * rows[k * n + j];
      matrix[i * n + j] = sum;
    }
    for (std::size_t k = 0; k < n; ++k) step[i] -= rows[k * n + i] * f[k];
  }
  if (!lu.factor()) return {};
  lu.solve(step.data());
  return step;
}
std::vector<double> newton_step(const std::vector<double>& rows, Values f) {
  const std::size_t n = f.size();
  DenseLU<double, run_time_size> lu(n);
  std::ranges::copy(rows, lu.matrix().begin());
  std::vector<double> step(n);
  for (std::size_t i = 0; i < n; ++i) step[i] = -f[i];
  if (!lu.factor()) return {};
  lu.solve(step.data());
  return std::isfinite(length(step)) ? step : std::vector<double>();
}

/// The sum 1/base, 1/base^2 ... of the digits of `index`, turned round: evenly in 0..1.
double halton(std::size_t index, std::size_t base) {
  double result = 0, part = 1;
  for (std::size_t i = index; i > 0; i /= base) {
    part /= static_cast<double>(base);
    result += part * static_cast<double>(i % base);
  }
  return result;
}
std::size_t prime(std::size_t k) {
  std::size_t candidate = 2;
  for (;; ++candidate) {
    bool is_prime = true;
    for (std::size_t d = 2; d * d <= candidate; ++d) is_prime = is_prime && candidate % d != 0;
    if (is_prime && k-- == 0) return candidate;
  }
}

/// Of df/dx and df/dp, with the unknowns of algebraic equations taken out.
Linearization reduced(const ParametricSystem& system, std::vector<double> by_x, std::vector<double> by_p) {
  const std::size_t size = system.size, n = system.differential(), m = system.algebraic, inputs = by_p.size() / size;
  if (m == 0) return {.states = n, .inputs = inputs, .a = std::move(by_x), .b = std::move(by_p)};
  const LinearColumns columns{.states = n, .unknowns = m, .inputs = inputs};
  std::vector<double> rows, square;
  for (std::size_t i = 0; i < size; ++i) {
    const auto x = std::span(by_x).subspan(i * size, size), p = std::span(by_p).subspan(i * inputs, inputs);
    rows.insert(rows.end(), x.begin(), x.end());
    rows.insert(rows.end(), p.begin(), p.end());
    if (i >= n) square.insert(square.end(), x.begin() + static_cast<std::ptrdiff_t>(n), x.end());
  }
  Linearization linear{.states = n, .inputs = inputs, .a = {}, .b = {}, .undetermined = undetermined_by(square, m)};
  if (!linear.undetermined.equations.empty()) return linear;
  const std::size_t split = n * columns.all();
  const auto left = without_unknowns(std::span(rows).first(split), std::span(rows).subspan(split), columns);
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = 0; j < n + inputs; ++j) (j < n ? linear.a : linear.b).push_back(left[i * (n + inputs) + j]);
  return linear;
}

/// The largest eigenvalue a little beside an equilibrium. Where all of them vanish at the place, as of x' = -x^2, what
/// is found of them is the rounding of the place, and says nothing beside what they are next to it.
double size_nearby(const ParametricSystem& system, std::vector<double> x, Values p, double t) {
  constexpr double beside = 1e-6;
  for (double& value : x) value += beside * std::max(std::abs(value), 1.0);
  auto rows = jacobian_of(system, t, x, p);
  if (!all_finite(rows)) return 0;
  const auto linear = reduced(system, std::move(rows), {});
  if (!linear.undetermined.equations.empty()) return 0;
  auto found = eigenvalues(linear.a, linear.states).values;
  leave_out_conserved(system, -system.conserved_rate, found);
  double size = 0;
  for (const auto& value : found) size = std::max(size, std::abs(value));
  return size;
}

}  // namespace

std::string_view to_string(Stability stability) {
  constexpr std::array<std::string_view, 4> names{"stable", "unstable", "saddle", "undecided by the linear part"};
  return names[static_cast<std::size_t>(stability)];
}
std::string_view to_string(EquilibriumEnding ending) {
  constexpr std::array<std::string_view, 4> names{"found", "f does not become smaller", "f is not finite",
                                                  "too many iterations"};
  return names[static_cast<std::size_t>(ending)];
}

Stability stability_of(const std::vector<std::complex<double>>& eigenvalues, double slack, double size) {
  for (const auto& value : eigenvalues) size = std::max(size, std::abs(value));
  bool left = false, right = false, axis = false;
  for (const auto& value : eigenvalues) {
    left = left || value.real() < -slack * size;
    right = right || value.real() > slack * size;
    axis = axis || std::abs(value.real()) <= slack * size;
  }
  if (right) return left ? Stability::saddle : Stability::unstable;
  return axis ? Stability::undecided : Stability::asymptotically_stable;
}

EquilibriumSearch find_equilibrium(const ParametricSystem& system, std::vector<double> x, Values p, double t) {
  const std::size_t n = system.size;
  EquilibriumSearch search;
  std::vector<double> f(n), trial(n), f_trial(n);
  system.derivative(t, x, p, f);
  double size = length(f);
  const double first_size = size;
  const auto ended = [&](EquilibriumEnding ending) {
    search.ending = ending;
    search.residual = largest(f);
    for (std::size_t i = 0; i < n; ++i)
      if (std::abs(f[i]) >= std::abs(f[search.worst])) search.worst = i;
    search.x = std::move(x);
    return std::move(search);
  };
  if (!std::isfinite(size)) return ended(EquilibriumEnding::not_finite);
  double mu = 0, moved = 0;
  bool gone = false;
  std::vector<double> rows, step;
  const auto correct = [&]() -> NewtonCorrection {
    if (size == 0) return NewtonEnding::converged;
    rows = jacobian_of(system, t, x, p);
    if (!all_finite(rows)) return NewtonEnding::not_finite;
    step = mu == 0 ? newton_step(rows, f) : std::vector<double>();
    if (step.empty()) {
      if (mu == 0) mu = 1e-6 * std::pow(largest(rows), 2);
      step = least_squares_step(rows, f, mu);
      if (step.empty()) return NewtonEnding::singular;
    }
    moved = 0;
    for (std::size_t i = 0; i < n; ++i) moved = std::max(moved, std::abs(step[i]) / std::max(std::abs(x[i]), 1e-8));
    // Where df/dx is singular a short step says nothing: f itself must be gone.
    gone = mu == 0 || size <= singular_part * first_size;
    return moved;
  };
  const auto attempt = [&](double part, double) {
    for (std::size_t i = 0; i < n; ++i) trial[i] = x[i] + part * step[i];
    system.derivative(t, trial, p, f_trial);
    if (!(length(f_trial) <= (1 - 1e-4 * part) * size)) return NewtonAttempt::refused;
    if (part == 1) mu = 0;
    x.swap(trial);
    f.swap(f_trial);
    size = length(f);
    return moved <= 1e4 * epsilon && gone ? NewtonAttempt::solved : NewtonAttempt::taken;
  };
  for (;;) {
    const NewtonOutcome outcome = damped_newton(
        {.most_iterations = most_search_iterations - search.iterations, .least_damping = 1e-8}, correct, attempt);
    search.iterations += outcome.iterations;
    if (outcome.ending == NewtonEnding::too_many) return ended(EquilibriumEnding::too_many);
    if (outcome.ending == NewtonEnding::no_descent && !(moved <= 1e-10 && gone) && mu == 0) {
      mu = 1e-6 * std::pow(largest(rows), 2);  // toward the least squares from here
      continue;
    }
    --search.iterations;  // those before the one in which it ended
    // What rounding leaves of f: no step makes it smaller.
    const bool at_rest = outcome.ending == NewtonEnding::no_descent && moved <= 1e-10 && gone;
    return ended(outcome || at_rest                           ? EquilibriumEnding::found
                 : outcome.ending == NewtonEnding::not_finite ? EquilibriumEnding::not_finite
                                                              : EquilibriumEnding::no_descent);
  }
}

EquilibriumSearch find_unknowns(const ParametricSystem& system, const std::vector<double>& x, Values p, double t) {
  const std::size_t n = system.differential(), m = system.algebraic;
  const auto whole = [x, n](Values z) {
    std::vector<double> all(x);
    std::ranges::copy(z, all.begin() + static_cast<std::ptrdiff_t>(n));
    return all;
  };
  ParametricSystem alone{.size = m, .constants = {p.begin(), p.end()}};
  alone.derivative = [&](double at, Values z, Values q, std::span<double> g) {
    std::vector<double> f(n + m);
    system.derivative(at, whole(z), q, f);
    std::copy(f.begin() + static_cast<std::ptrdiff_t>(n), f.end(), g.begin());
  };
  alone.jacobian = [&](double at, Values z, Values q, std::span<double> rows) {
    const auto all = jacobian_of(system, at, whole(z), q);
    for (std::size_t i = 0; i < m; ++i)
      for (std::size_t j = 0; j < m; ++j) rows[i * m + j] = all[(n + i) * (n + m) + n + j];
  };
  auto search = find_equilibrium(alone, {x.begin() + static_cast<std::ptrdiff_t>(n), x.end()}, p, t);
  search.x = whole(search.x);
  search.worst += n;
  return search;
}

Equilibrium describe_equilibrium(const ParametricSystem& system, std::vector<double> x, Values p, double t) {
  Equilibrium equilibrium{.x = std::move(x), .eigenvalues = {}};
  const auto linear = reduced(system, jacobian_of(system, t, equilibrium.x, p), {});
  equilibrium.undetermined = linear.undetermined;
  if (!linear.undetermined.equations.empty()) {
    equilibrium.isolated = false;
    return equilibrium;
  }
  equilibrium.eigenvalues = eigenvalues(linear.a, linear.states).values;
  leave_out_conserved(system, -system.conserved_rate, equilibrium.eigenvalues);
  const double nearby = size_nearby(system, equilibrium.x, p, t);
  equilibrium.stability = stability_of(equilibrium.eigenvalues, 1e-9, nearby);
  double least = std::numeric_limits<double>::infinity(), greatest = nearby;
  for (const auto& value : equilibrium.eigenvalues) {
    least = std::min(least, std::abs(value));
    greatest = std::max(greatest, std::abs(value));
  }
  equilibrium.isolated = least > 1e-9 * greatest;
  return equilibrium;
}

Equilibria find_equilibria(const ParametricSystem& system, const EquilibriumBox& box) {
  Equilibria result;
  const std::size_t n = system.size;
  std::vector<std::size_t> bases(n);
  for (std::size_t i = 0; i < n; ++i) bases[i] = prime(i);
  std::vector<std::vector<double>> points;
  bool any = false;
  const auto is_known = [&](const std::vector<double>& x) {
    return std::ranges::any_of(points, [&](const std::vector<double>& y) {
      for (std::size_t i = 0; i < n; ++i)
        if (std::abs(x[i] - y[i]) > same_part * std::max(std::abs(box.high[i] - box.low[i]), std::abs(x[i])))
          return false;
      return true;
    });
  };
  const auto is_inside = [&](const std::vector<double>& x) {
    for (std::size_t i = 0; i < n; ++i) {
      const double slack = same_part * (box.high[i] - box.low[i]);
      if (x[i] < box.low[i] - slack || x[i] > box.high[i] + slack) return false;
    }
    return true;
  };
  for (std::size_t k = box.first.empty() ? 1 : 0; k <= box.starts; ++k) {
    if (box.interrupt && box.interrupt->load()) break;
    if (box.progress) box.progress(static_cast<double>(k) / static_cast<double>(box.starts));
    std::vector<double> start(box.first);
    if (k > 0) {
      start.resize(n);
      for (std::size_t i = 0; i < n; ++i) start[i] = box.low[i] + halton(k, bases[i]) * (box.high[i] - box.low[i]);
    }
    EquilibriumSearch search = find_equilibrium(system, std::move(start), system.constants, box.t);
    ++result.searches;
    if (search.ending == EquilibriumEnding::found) {
      ++result.arrived;
      if (k > 0 && !is_inside(search.x)) {
        ++result.outside;
        continue;
      }
      if (!is_known(search.x)) points.push_back(search.x);
    } else if (!any || search.residual < result.nearest.residual) {
      result.nearest = std::move(search);
      any = true;
    }
  }
  std::ranges::sort(points);
  for (std::vector<double>& x : points)
    result.equilibria.push_back(describe_equilibrium(system, std::move(x), system.constants, box.t));
  return result;
}

Linearization linearize(const ParametricSystem& system, Values x, Values p, double t) {
  return reduced(system, jacobian_of(system, t, x, p), constant_jacobian_of(system, t, x, p));
}

std::vector<MotionMode> modes_of(const std::vector<double>& a, std::size_t n) {
  std::vector<MotionMode> modes;
  const Eigenvalues found = eigenvalues(a, n);
  for (std::size_t k = 0; k < found.values.size(); ++k) {
    const std::complex<double> value = found.values[k];
    if (value.imag() < 0) continue;  // its conjugate was there
    const double size = std::abs(value);
    modes.push_back({.eigenvalue = value,
                     .frequency = value.imag() > 0 ? size / (2 * std::numbers::pi) : 0,
                     .damping = size > 0 ? -value.real() / size : 0,
                     .time_constant = -1 / value.real(),
                     .shape = found.vectors[k]});
  }
  return modes;
}

}  // namespace continuo::studies
