// What one mesh leaves of the equations, and how far that and rounding move the solution.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>

#include <continuo/boundary/boundary_accuracy.hpp>

namespace continuo::boundary {

namespace {

constexpr std::size_t points_after_first = CollocationSystem::per_interval;
/// An interval too short to matter: where f jumps, the residual does not fall with it, but its share of the motion
/// does.
constexpr double shortest_part = 1e-6, negligible = 0.01;
constexpr double far_above = 100;
constexpr std::size_t probes = 3;  // the norm is then underestimated tenfold in one of some thousand cases

/// The residual is a polynomial that is zero at the four collocation points, of degree 4 where f is smooth: five points
/// of Gauss integrate its square exactly.
struct GaussPoint {
  double theta, weight;
};
constexpr std::array<GaussPoint, 5> gauss5{{{0.04691007703066800, 0.11846344252809454},
                                            {0.23076534494715845, 0.23931433524968324},
                                            {0.5, 0.28444444444444444},
                                            {0.76923465505284155, 0.23931433524968324},
                                            {0.95308992296933200, 0.11846344252809454}}};

/// weights[i][g]: the integral from 0 to c_(i+1) of a function of which the values at Gauss's points are known. It is
/// zero at the collocation points, so the polynomial through all nine is taken; not at the ends of an interval where f
/// has no value (`zeros` is false): there those through Gauss's points.
using IntegralWeights = std::array<std::array<double, gauss5.size()>, points_after_first>;
IntegralWeights integral_weights(bool zeros) {
  const auto product = [&](double theta) {
    double value = 1;
    for (const double c : lobatto4.c) value *= zeros ? theta - c : 1;
    return value;
  };
  IntegralWeights weights{};
  for (std::size_t i = 0; i < points_after_first; ++i) {
    const double end = lobatto4.c[i + 1];
    for (const GaussPoint& at : gauss5) {  // a polynomial of degree 8: exact
      const double theta = end * at.theta;
      for (std::size_t g = 0; g < gauss5.size(); ++g) {
        double basis = product(theta) / product(gauss5[g].theta);
        for (std::size_t other = 0; other < gauss5.size(); ++other)
          if (other != g) basis *= (theta - gauss5[other].theta) / (gauss5[g].theta - gauss5[other].theta);
        weights[i][g] += end * at.weight * basis;
      }
    }
  }
  return weights;
}

/// How large the components and the constants are: at most, and on the average over the points, each counted by the
/// length of its interval.
struct Sizes {
  std::vector<double> greatest, mean;
};
Sizes sizes_of(CollocationSystem& system) {
  const std::size_t n = system.components(), m = system.constants().size(), last = system.point_count() - 1;
  Sizes sizes{std::vector<double>(n + m), std::vector<double>(n + m)};
  const double length = system.time(last) - system.time(0);
  for (std::size_t q = 0; q <= last; ++q) {
    const double part = (system.time(std::min(q + 1, last)) - system.time(q == 0 ? 0 : q - 1)) / (2 * length);
    for (std::size_t i = 0; i < n; ++i) {
      const double size = std::abs(system.point(q)[i]);
      sizes.greatest[i] = std::max(sizes.greatest[i], size);
      sizes.mean[i] += part * size;
    }
  }
  for (std::size_t p = 0; p < m; ++p) sizes.greatest[n + p] = sizes.mean[n + p] = std::abs(system.constants()[p]);
  if (std::ranges::max(sizes.greatest) == 0) {  // what would become of a motion of size 1
    std::ranges::fill(sizes.greatest, 1.0);
    std::ranges::fill(sizes.mean, 1.0);
  }
  return sizes;
}

/// Random numbers that are the same each time.
class Signs {
 public:
  double operator()() {
    state_ ^= state_ << 13, state_ ^= state_ >> 7, state_ ^= state_ << 17;
    return (state_ >> 63) != 0 ? 1 : -1;
  }

 private:
  std::uint64_t state_ = 0x9e3779b97f4a7c15u;
};

/// errors[i] is raised to the greatest |z| of component i.
void raise(std::vector<double>& errors, const std::vector<double>& z, std::size_t n, std::size_t points) {
  for (std::size_t i = 0; i < z.size(); ++i) {
    const std::size_t component = i < points * n ? i % n : n + i - points * n;
    const double here = std::isfinite(z[i]) ? std::abs(z[i]) : std::numeric_limits<double>::infinity();
    errors[component] = std::max(errors[component], here);
  }
}

}  // namespace

Residuals residuals_of(const BoundaryValueProblem& problem, BoundaryValueSolution& solution,
                       const CollocationSystem& system, double tolerance) {
  static const IntegralWeights with_zeros = integral_weights(true), without_zeros = integral_weights(false);
  const std::size_t n = problem.system.size, intervals = solution.mesh.size() - 1;
  Residuals result{std::vector<double>(intervals),
                   {},
                   std::vector<double>(intervals),
                   std::vector<double>(intervals * points_after_first * n)};
  std::vector<double> sizes(n), x(n), slope(n), f(n), local(n);
  for (std::size_t i = 0; i < solution.points.size(); ++i)
    sizes[i % n] = std::max(sizes[i % n], std::abs(solution.points[i]));
  const double length = solution.mesh.back() - solution.mesh.front();
  for (std::size_t k = 0; k < intervals; ++k) {
    const double from = solution.mesh[k], h = solution.mesh[k + 1] - from;
    const IntegralWeights& weights = system.has_open_end(k) ? without_zeros : with_zeros;
    double mean = 0;
    std::ranges::fill(local, 0.0);
    for (std::size_t g = 0; g < gauss5.size(); ++g) {
      const double t = from + gauss5[g].theta * h;
      solution.at(t, x);
      solution.slope_at(t, slope);
      problem.system.derivative(t, x, solution.parameters, f);
      for (std::size_t i = 0; i < n; ++i) {
        const double left = slope[i] - f[i], part = left / (1 + std::abs(f[i]));
        mean += gauss5[g].weight * part * part;
        local[i] += gauss5[g].weight * std::abs(left) * h;
        for (std::size_t j = 0; j < points_after_first; ++j)
          result.integrals[(k * points_after_first + j) * n + i] += h * weights[j][g] * left;
      }
    }
    solution.evaluations += gauss5.size();
    double share = 0;
    for (std::size_t i = 0; i < n; ++i) share = std::max(share, local[i] / std::max(sizes[i], 1e-300));
    const double residual = std::sqrt(mean);
    if (residual > far_above * tolerance)
      for (std::size_t j = 0; j < points_after_first * n; ++j)
        result.integrals[k * points_after_first * n + j] = local[j % n];
    const bool short_enough = h < shortest_part * length && share / negligible < residual;
    for (std::size_t j = 0; j < points_after_first * n; ++j)
      result.shares[k] = std::max(result.shares[k], std::abs(result.integrals[k * points_after_first * n + j]) /
                                                        std::max(sizes[j % n], 1e-300));
    if (short_enough) result.jumps.push_back(k);
    result.of_intervals[k] = short_enough ? share / negligible : residual;
  }
  return result;
}

/// A component that is zero but for rounding is compared with the greatest of all.
ErrorBounds::Worst ErrorBounds::worst(const std::vector<double>& errors) const {
  constexpr double least_size = 1e-12;
  const double greatest = sizes.empty() ? 0 : std::ranges::max(sizes);
  Worst result;
  for (std::size_t i = 0; i < errors.size(); ++i) {
    if (errors[i] == 0) continue;
    const double part = errors[i] / std::max({sizes[i], least_size * greatest, 1e-300});
    if (part > result.part) result = {part, i};
  }
  return result;
}

namespace {

/// How far rounding of these magnitudes moves each component. Each operation rounds by anything between plus and minus
/// half of the last digit: half of that on the average.
std::vector<double> moved_by_rounding(CollocationSystem& system, const std::vector<double>& magnitudes) {
  const std::size_t n = system.components();
  std::vector<double> moved(n + system.constants().size()), z(magnitudes.size());
  Signs sign;
  for (std::size_t probe = 0; probe < probes; ++probe) {
    for (std::size_t i = 0; i < z.size(); ++i)
      z[i] = sign() * std::numeric_limits<double>::epsilon() / 4 * magnitudes[i];
    system.solve(z);
    raise(moved, z, n, system.point_count());
  }
  return moved;
}

/// How far the motion moves, relative to its size, when f is moved by the mean size of each component over the whole
/// interval, in a straight line over t so that no symmetry hides it, and the conditions by the sizes of their terms.
double condition_of(CollocationSystem& system, const Sizes& sizes, const std::vector<double>& magnitudes) {
  const std::size_t n = system.components(), points = system.point_count();
  const double from = system.time(0), length = system.time(points - 1) - from;
  double condition = 0;
  Signs sign;
  for (std::size_t probe = 0; probe < probes; ++probe) {
    std::vector<double> z(magnitudes.size()), signs(n), moved(n + system.constants().size());
    for (double& s : signs) s = sign();
    for (std::size_t i = 0; i < z.size(); ++i) {
      if (i < n || i >= points * n) {
        z[i] = sign() * magnitudes[i];
        continue;
      }
      const std::size_t q = i / n, start = (q - 1) / points_after_first * points_after_first;
      const double slope = signs[i % n] * sizes.mean[i % n] / length;
      const double middle = ((system.time(q) + system.time(start)) / 2 - from) / length;
      z[i] = (system.time(q) - system.time(start)) * slope * (0.3 + 1.4 * middle);
    }
    system.solve(z);
    raise(moved, z, n, points);
    for (std::size_t i = 0; i < moved.size(); ++i)
      if (sizes.greatest[i] > 0) condition = std::max(condition, moved[i] / sizes.greatest[i]);
  }
  return condition;
}

}  // namespace

ErrorBounds rounding_bounds(CollocationSystem& system) {
  const std::size_t n = system.components(), points = system.point_count();
  const Sizes sizes = sizes_of(system);
  ErrorBounds bounds{.of_mesh = std::vector<double>(sizes.greatest.size()),
                     .of_rounding = moved_by_rounding(system, system.magnitudes(system.unknowns())),
                     .sizes = sizes.greatest,
                     .undetermined = {}};
  std::vector<double> z(system.unknowns().begin(), system.unknowns().end());
  for (std::size_t i = 0; i < z.size(); ++i)
    z[i] = std::max(std::abs(z[i]), sizes.mean[i < points * n ? i % n : n + i - points * n]);
  const std::vector<double> magnitudes = system.magnitudes(z);
  bounds.undetermined = moved_by_rounding(system, magnitudes);
  bounds.condition = condition_of(system, sizes, magnitudes);
  return bounds;
}

ErrorBounds error_bounds(CollocationSystem& system, const Residuals& residuals) {
  ErrorBounds bounds = rounding_bounds(system);
  const std::size_t n = system.components();
  std::vector<double> z(system.unknowns().size());  // rows of the conditions: zero
  for (std::size_t i = 0; i < residuals.integrals.size(); ++i) z[n + i] = -residuals.integrals[i];
  system.solve(z);
  raise(bounds.of_mesh, z, n, system.point_count());
  return bounds;
}

}  // namespace continuo::boundary
