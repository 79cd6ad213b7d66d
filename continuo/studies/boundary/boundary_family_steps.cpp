// continuo/studies/boundary/boundary_family_steps.cpp
// Predictor and corrector on a family of solutions.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <numeric>
#include <utility>

#include <continuo/boundary/boundary_nature.hpp>
#include <continuo/numerics/finite.hpp>
#include <continuo/studies/boundary/boundary_family_steps.hpp>
#include <continuo/studies/support/vector_algebra.hpp>

namespace continuo::studies::detail {

using boundary::BoundaryValueGuess;
using boundary::BoundaryValueOptions;
using boundary::BoundaryValueProblem;
using boundary::BoundaryValueSolution;
using boundary::CollocationSystem;
using boundary::lobatto4;

namespace {

constexpr std::size_t sample_times = 12;
constexpr std::size_t stages_of_family = lobatto4.stages;

/// Numbers between -1 and 1 that are the same each time.
double scattered(std::uint64_t number) {
  std::uint64_t state = (number + 1) * 0x9e3779b97f4a7c15u;
  state = (state ^ (state >> 30)) * 0xbf58476d1ce4e5b9u;
  state = (state ^ (state >> 27)) * 0x94d049bb133111ebu;
  return static_cast<double>((state ^ (state >> 31)) >> 11) * 0x1p-52 - 1;
}

std::vector<double> times_with_samples(const std::vector<double>& times) {
  std::vector<double> all(times);
  const double from = times.front(), length = times.back() - from;
  for (std::size_t k = 0; k < sample_times; ++k)
    all.push_back(from + (static_cast<double>(k) + 0.5) / sample_times * length);
  std::ranges::sort(all);
  all.erase(std::ranges::unique(all).begin(), all.end());
  return all;
}

}  // namespace

void FamilyDirection::at(double t, std::span<double> x) const {
  const auto above = std::upper_bound(mesh.begin() + 1, mesh.end() - 1, t);
  const auto k = static_cast<std::size_t>(above - mesh.begin()) - 1;
  const auto weights = lobatto4.slopes((t - mesh[k]) / (mesh[k + 1] - mesh[k]));
  const double* first = points.data() + k * (stages_of_family - 1) * x.size();
  for (std::size_t i = 0; i < x.size(); ++i) {
    x[i] = 0;
    for (std::size_t j = 0; j < stages_of_family; ++j) x[i] += weights[j] * first[j * x.size() + i];
  }
}

FamilySteps::FamilySteps(const BoundaryValueProblem& problem, const FamilyOptions& options)
    : problem_(problem),
      n_(problem.system.size),
      options_(options),
      tolerance_(options.tolerance),
      range_(options.high - options.low),
      sizes_(n_),
      step_(std::make_shared<Step>()) {
  problem_.times = times_with_samples(problem.times);
  const std::size_t n = n_;
  std::vector<std::size_t> old_places;
  for (std::size_t k = 0; k < problem_.times.size(); ++k) {
    if (std::ranges::binary_search(problem.times, problem_.times[k])) old_places.push_back(k);
    sample_places_.push_back(k);
  }
  problem_.conditions = [=, this, inner = problem.conditions, step = step_](Values x, Values p,
                                                                            std::span<double> residuals) {
    std::vector<double> old;
    for (const std::size_t place : old_places)
      old.insert(old.end(), x.begin() + static_cast<std::ptrdiff_t>(place * n),
                 x.begin() + static_cast<std::ptrdiff_t>((place + 1) * n));
    inner(old, p, residuals.first(n));
    const double weight = 1 / std::sqrt(static_cast<double>(problem_.times.size() * n));
    double sum = -step->target + step->row.back() * p[0] / range_;
    for (std::size_t i = 0; i < x.size(); ++i) sum += step->row[i] * weight * x[i] / sizes_[i % n];
    residuals[n] = sum;
  };
  std::vector<MatrixPlace> places;
  const auto columns = static_cast<std::uint32_t>(problem_.times.size() * n);
  const auto moved = [&](std::uint32_t column) {
    return static_cast<std::uint32_t>(old_places[column / n] * n + column % n);
  };
  if (problem.condition_places.empty()) {
    for (std::uint32_t i = 0; i < n; ++i)
      for (std::uint32_t j = 0; j < problem.times.size() * n; ++j) places.push_back({i, moved(j)});
  }
  for (const MatrixPlace& place : problem.condition_places) places.push_back({place.row, moved(place.column)});
  for (std::uint32_t i = 0; i < n; ++i) places.push_back({i, columns});
  for (std::uint32_t j = 0; j <= columns; ++j) places.push_back({static_cast<std::uint32_t>(n), j});
  problem_.condition_places = std::move(places);
}

void FamilySteps::measure(const BoundaryValueSolution& solution) {
  std::vector<double> now(n_);
  for (std::size_t i = 0; i < solution.points.size(); ++i)
    now[i % n_] = std::max(now[i % n_], std::abs(solution.points[i]));
  // What is zero throughout has no size of its own.
  const double greatest = std::ranges::max(now);
  for (std::size_t i = 0; i < n_; ++i)
    if (!(now[i] > 1e-9 * greatest) && sizes_[i] == 0) now[i] = 1;
  for (std::size_t i = 0; i < n_; ++i) sizes_[i] = std::max(sizes_[i], now[i]);
  if (first_sizes_.empty()) first_sizes_ = sizes_;
}

template <class At>
std::vector<double> FamilySteps::samples_of(const At& at, double constant) const {
  const double weight = 1 / std::sqrt(static_cast<double>(problem_.times.size() * n_));
  std::vector<double> z, x(n_);
  for (const double t : problem_.times) {
    at(t, x);
    for (std::size_t i = 0; i < n_; ++i) z.push_back(weight * x[i] / sizes_[i]);
  }
  z.push_back(constant / range_);
  return z;
}
std::vector<double> FamilySteps::sampled(const BoundaryValueSolution& solution) const {
  return samples_of([&](double t, std::span<double> x) { solution.at(t, x); }, solution.parameters[0]);
}
std::vector<double> FamilySteps::sampled(const FamilyDirection& direction) const {
  return samples_of([&](double t, std::span<double> x) { direction.at(t, x); }, direction.constant);
}

double FamilySteps::distance(const BoundaryValueSolution& a, const BoundaryValueSolution& b) const {
  std::vector<double> difference = sampled(a);
  const std::vector<double> other = sampled(b);
  for (std::size_t i = 0; i < difference.size(); ++i) difference[i] -= other[i];
  return length(difference);
}

double FamilySteps::cosine(const FamilySteps& steps, const FamilyDirection& a, const FamilyDirection& b) {
  const std::vector<double> u = steps.sampled(a), v = steps.sampled(b);
  return product(u, v) / (length(u) * length(v));
}

void FamilySteps::scale(FamilyDirection& direction) const {
  const double size = length(sampled(direction));
  for (double& x : direction.points) x /= size;
  direction.constant /= size;
}

/// With the condition of the step as it stands.
std::optional<FamilyPlace> FamilySteps::solved(const BoundaryValueGuess& guess, const std::vector<double>& mesh,
                                               double constant) {
  problem_.system.constants = {constant};
  BoundaryValueOptions how{
      .tolerance = tolerance_, .check_error = false, .most_intervals = 5000, .most_iterations = 15};
  how.most_refinements = 1;
  how.mesh = mesh;
  how.interrupt = options_.interrupt;
  FamilyPlace place{.solution = solve_boundary_values(problem_, guess, how), .tangent = {}, .other = {}};
  if (!place.solution.outcome) return std::nullopt;
  return place;
}

/// The tangent and what tells of other families, by Newton's matrix at the solution.
bool FamilySteps::describe(FamilyPlace& place) {
  const BoundaryValueSolution& solution = place.solution;
  const BoundaryValueGuess here = [&](double t, std::span<double> x) { solution.at(t, x); };
  CollocationSystem system(problem_, solution.mesh, open_ends(problem_, here));
  std::ranges::copy(solution.points, system.unknowns().begin());
  system.constants()[0] = place.constant();
  const BoundaryValueOptions once{.check_error = false, .most_iterations = 1};
  system.iterate(1e-5, once);
  if (!system.is_factored()) return false;
  std::vector<double> z(system.unknowns().size());
  z.back() = 1;
  system.solve(z);
  if (!all_finite(z)) return false;
  place.tangent = direction_of(system, solution, z);
  scale(place.tangent);
  place.slope = place.tangent.constant / range_;
  for (std::size_t test = 0; test < FamilyPlace::tests; ++test) {
    z = disturbance(system, test);
    system.solve(z);
    FamilyDirection moved = direction_of(system, solution, z);
    place.crossing[test] = 1 / seen(moved, test);
    if (test > 0) continue;
    scale(moved);
    place.other = std::move(moved);
  }
  return true;
}

FamilyDirection FamilySteps::direction_of(const CollocationSystem& system, const BoundaryValueSolution& solution,
                                          std::span<const double> z) const {
  const std::size_t of_points = system.point_count() * n_;
  return {solution.mesh, std::vector<double>(z.begin(), z.begin() + static_cast<std::ptrdiff_t>(of_points)),
          z[of_points]};
}

/// A right-hand side of the equations that knows nothing of them: f moved by parabolas over time, the conditions by
/// numbers, the step by nothing. M z = b, c . z: by Cramer's rule 1 / (c . z) is det M by that of M bordered by b and
/// c, which is zero only elsewhere, so that the sign of det M changes with it (W. Govaerts, "Numerical Methods for
/// Bifurcations of Dynamical Equilibria" (2000), 4.1).
std::vector<double> FamilySteps::disturbance(const CollocationSystem& system, std::size_t test) const {
  const std::size_t points = system.point_count(), per = CollocationSystem::per_interval;
  std::vector<double> b(points * n_ + 1);
  const double from = system.time(0), whole = system.time(points - 1) - from;
  const std::uint64_t seed = 1000 * (test + 1);
  for (std::size_t i = 0; i < n_; ++i) b[i] = scattered(seed + i) * first_sizes_[i];
  for (std::size_t q = 1; q < points; ++q) {
    const double a = (system.time((q - 1) / per * per) - from) / whole, e = (system.time(q) - from) / whole;
    for (std::size_t i = 0; i < n_; ++i) {
      const auto rise = [&](double s) {
        return s * (scattered(seed + 100 + i) + s * (scattered(seed + 200 + i) + s * scattered(seed + 300 + i)));
      };
      b[q * n_ + i] = first_sizes_[i] * (rise(e) - rise(a));
    }
  }
  return b;
}
double FamilySteps::seen(const FamilyDirection& direction, std::size_t test) const {
  const std::uint64_t seed = 1000 * (test + 1) + 500;
  std::vector<double> x(n_);
  double sum = scattered(seed) * direction.constant / range_;
  for (std::size_t k = 0; k < problem_.times.size(); ++k) {
    direction.at(problem_.times[k], x);
    for (std::size_t i = 0; i < n_; ++i) sum += scattered(seed + 1 + k * n_ + i) * x[i] / first_sizes_[i];
  }
  return sum;
}

std::optional<FamilyPlace> FamilySteps::at_constant(const BoundaryValueGuess& guess, const std::vector<double>& mesh,
                                                    double value) {
  if (sizes_[0] == 0) std::ranges::fill(sizes_, 1.0);
  step_->row.assign(problem_.times.size() * n_ + 1, 0.0);
  step_->row.back() = 1;
  step_->target = value / range_;
  auto place = solved(guess, mesh, value);
  if (!place) return std::nullopt;
  if (first_sizes_.empty()) {
    std::ranges::fill(sizes_, 0.0);
    measure(place->solution);
  }
  if (!describe(*place)) return std::nullopt;
  return place;
}

std::optional<FamilyPlace> FamilySteps::stepped(const BoundaryValueSolution& from, const FamilyDirection& direction,
                                                double step, double farthest) {
  step_->row = sampled(direction);
  const std::vector<double> z = sampled(from);
  step_->target = product(step_->row, z) + step * product(step_->row, step_->row);
  std::vector<double> moved(n_);
  const BoundaryValueGuess guess = [&, moved](double t, std::span<double> x) mutable {
    from.at(t, x);
    direction.at(t, moved);
    for (std::size_t i = 0; i < x.size(); ++i) x[i] += step * moved[i];
  };
  auto place = solved(guess, from.mesh, from.parameters[0] + step * direction.constant);
  if (!place) return std::nullopt;
  std::vector<double> off = sampled(place->solution);
  for (std::size_t i = 0; i < off.size(); ++i) off[i] -= z[i] + step * step_->row[i];
  if (length(off) > farthest * std::abs(step) || !describe(*place)) return std::nullopt;
  return place;
}

std::optional<FamilyPlace> FamilySteps::on_halved_mesh(const FamilyPlace& place) {
  const BoundaryValueSolution& solution = place.solution;
  std::vector<double> mesh;
  for (std::size_t k = 0; k + 1 < solution.mesh.size(); ++k)
    mesh.insert(mesh.end(), {solution.mesh[k], (solution.mesh[k] + solution.mesh[k + 1]) / 2});
  mesh.push_back(solution.mesh.back());
  step_->row = sampled(place.tangent);
  step_->target = product(step_->row, sampled(solution));
  auto finer = solved([&](double t, std::span<double> x) { solution.at(t, x); }, mesh, place.constant());
  if (!finer || !describe(*finer)) return std::nullopt;
  return finer;
}

std::optional<FamilyPlace> FamilySteps::across(const BoundaryValueSolution& guess, const BoundaryValueSolution& towards,
                                               const BoundaryValueSolution& through) {
  const std::vector<double> a = sampled(guess), b = sampled(towards), z = sampled(through);
  std::vector<double> way(a.size());
  double part = 0;
  for (std::size_t i = 0; i < a.size(); ++i) way[i] = b[i] - a[i];
  const double square = product(way, way);
  for (std::size_t i = 0; i < a.size(); ++i) part += way[i] * (z[i] - a[i]) / square;
  if (!(square > 0) || part < -0.1 || part > 1.1) return std::nullopt;
  step_->row = way;
  normalize(step_->row);
  step_->target = product(step_->row, z);
  std::vector<double> there(n_);
  const BoundaryValueGuess between = [&, there](double t, std::span<double> x) mutable {
    guess.at(t, x);
    towards.at(t, there);
    for (std::size_t i = 0; i < x.size(); ++i) x[i] += part * (there[i] - x[i]);
  };
  return solved(between, guess.mesh, guess.parameters[0] + part * (towards.parameters[0] - guess.parameters[0]));
}

}  // namespace continuo::studies::detail
