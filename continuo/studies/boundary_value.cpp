// continuo/studies/boundary_value.cpp
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>

#include <fmt/format.h>

#include <continuo/studies/boundary_value.hpp>
#include <continuo/studies/collocation_system.hpp>

namespace continuo::studies {

namespace {

using detail::CollocationSystem;
using detail::NewtonEnding;

constexpr std::size_t stages = lobatto4.stages, per_interval = stages - 1;
constexpr std::size_t intervals_at_first = 8;  // of each part between two times of conditions
constexpr std::size_t most_meshes = 40, most_failures = 5;
constexpr double most_refined = 6, most_coarsened = 0.25;  // intervals made of one
constexpr double wanted_part = 0.3;                        // of the tolerance, that a new mesh aims at

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

std::string name_of(const ParametricSystem& system, std::size_t i) {
  return i < system.size ? system.name(i) : system.constant_name(i - system.size);
}

Outcome<double> invalid(std::string hint) {
  Outcome<double> outcome;
  outcome.ending = Ending::invalid_input;
  outcome.hint = std::move(hint);
  return outcome;
}

/// The mesh with every time of a condition in it.
std::vector<double> first_mesh(const BoundaryValueProblem& problem, const BoundaryValueOptions& options) {
  std::vector<double> mesh(options.mesh);
  std::erase_if(mesh, [&](double t) { return !(t > problem.times.front() && t < problem.times.back()); });
  const bool even = mesh.empty();
  mesh.insert(mesh.end(), problem.times.begin(), problem.times.end());
  for (std::size_t i = 0; even && i + 1 < problem.times.size(); ++i) {
    const double from = problem.times[i], h = (problem.times[i + 1] - from) / double(intervals_at_first);
    for (std::size_t k = 1; k < intervals_at_first; ++k) mesh.push_back(from + h * static_cast<double>(k));
  }
  std::ranges::sort(mesh);
  mesh.erase(std::ranges::unique(mesh).begin(), mesh.end());
  return mesh;
}

/// A new mesh whose density is, over the interval k of the old one, wanted[k] / h. Times of conditions stay.
std::vector<double> remeshed(const std::vector<double>& mesh, const std::vector<double>& wanted,
                             const std::vector<double>& fixed) {
  std::vector<double> result{mesh.front()};
  std::size_t k = 0;
  for (std::size_t part = 0; part + 1 < fixed.size(); ++part) {
    const std::size_t first = k;
    double total = 0;
    for (; k < wanted.size() && mesh[k] < fixed[part + 1]; ++k) total += wanted[k];
    const double count = std::max(2.0, std::ceil(total));
    double sum = 0;
    double next = 1;
    for (std::size_t i = first; i < k; ++i) {
      const double share = wanted[i] * count / total;
      for (; next <= sum + share && next < count - 0.5; ++next)
        result.push_back(mesh[i] + (next - sum) / share * (mesh[i + 1] - mesh[i]));
      sum += share;
    }
    result.push_back(fixed[part + 1]);
  }
  return result;
}

class Search {
 public:
  Search(const BoundaryValueProblem& problem, const BoundaryValueOptions& options)
      : problem_(problem), options_(options) {}

  BoundaryValueSolution operator()(const BoundaryValueGuess& guess) {
    solution_.size = problem_.system.size;
    solution_.parameters = problem_.system.constants;
    std::vector<double> mesh = first_mesh(problem_, options_);
    std::size_t failures = 0;
    bool any = false;
    for (std::size_t count = 0; count < most_meshes; ++count) {
      CollocationSystem system(problem_, mesh);
      set_unknowns(system, guess, any);
      const double target = std::clamp(1e-3 * options_.tolerance, 1e-12, 1e-5);
      const NewtonEnding ending = system.iterate(target, options_);
      ++solution_.meshes;
      solution_.iterations += system.iterations();
      solution_.evaluations += system.evaluations();
      if (ending != NewtonEnding::converged) {
        if (!may_refine(ending) || ++failures > most_failures) return failed(ending, system, any);
        mesh = remeshed(mesh, std::vector<double>(mesh.size() - 1, 2.0), problem_.times);
        continue;
      }
      any = true;
      keep(system, mesh);
      const std::vector<double> residuals = residuals_of_intervals();
      solution_.residual = std::ranges::max(residuals);
      if (options_.progress) options_.progress(residuals.size(), solution_.residual);
      if (solution_.residual <= options_.tolerance) return std::move(solution_);
      if (!(solution_.residual < std::numeric_limits<double>::infinity()))
        return failed(NewtonEnding::not_finite, system, any);
      std::vector<double> wanted(residuals.size());
      for (std::size_t k = 0; k < wanted.size(); ++k) {
        const double ratio = residuals[k] / (wanted_part * options_.tolerance);
        wanted[k] = std::clamp(std::pow(ratio, 1.0 / double(stages)), most_coarsened, most_refined);
      }
      mesh = remeshed(mesh, wanted, problem_.times);
      if (mesh.size() > options_.most_intervals + 1) break;
    }
    return too_fine();
  }

 private:
  static bool may_refine(NewtonEnding ending) {
    return ending == NewtonEnding::no_descent || ending == NewtonEnding::too_many || ending == NewtonEnding::singular;
  }

  void set_unknowns(CollocationSystem& system, const BoundaryValueGuess& guess, bool any) const {
    for (std::size_t q = 0; q < system.point_count(); ++q) {
      if (any) {
        solution_.at(system.time(q), system.point(q));
      } else if (guess) {
        guess(system.time(q), system.point(q));
      }
    }
    std::ranges::copy(solution_.parameters, system.constants().begin());
  }

  void keep(CollocationSystem& system, const std::vector<double>& mesh) {
    solution_.mesh = mesh;
    solution_.points.assign(system.unknowns().begin(),
                            system.unknowns().end() - static_cast<std::ptrdiff_t>(problem_.system.parameters()));
    solution_.slopes.assign(system.slopes().begin(), system.slopes().end());
    solution_.parameters.assign(system.constants().begin(), system.constants().end());
  }

  /// Root mean square of (x' - f) / (1 + |f|) over each interval, of all components together.
  std::vector<double> residuals_of_intervals() {
    const std::size_t n = problem_.system.size;
    std::vector<double> residuals, x(n), slope(n), f(n);
    for (std::size_t k = 0; k + 1 < solution_.mesh.size(); ++k) {
      const double from = solution_.mesh[k], h = solution_.mesh[k + 1] - from;
      double mean = 0;
      for (const GaussPoint& at : gauss5) {
        solution_.at(from + at.theta * h, x);
        solution_.slope_at(from + at.theta * h, slope);
        problem_.system.derivative(from + at.theta * h, x, solution_.parameters, f);
        for (std::size_t i = 0; i < n; ++i) {
          const double part = (slope[i] - f[i]) / (1 + std::abs(f[i]));
          mean += at.weight * part * part;
        }
      }
      residuals.push_back(std::sqrt(mean));
      solution_.evaluations += gauss5.size();
    }
    return residuals;
  }

  BoundaryValueSolution failed(NewtonEnding ending, CollocationSystem& system, bool any) {
    Outcome<double>& outcome = solution_.outcome;
    outcome.t = problem_.times.front();
    outcome.component = name_of(problem_.system, system.worst());
    if (ending == NewtonEnding::interrupted) {
      outcome.ending = Ending::interrupted;
    } else if (ending == NewtonEnding::not_finite) {
      outcome.ending = Ending::not_finite;
      outcome.hint = "f or a condition is not a number on the way; a guess nearer to the solution may help";
    } else if (ending == NewtonEnding::singular) {
      outcome.ending = Ending::nonlinear_solve_failed;
      outcome.hint = "the conditions do not determine a solution near the guess (their matrix is singular)";
    } else {
      outcome.ending = Ending::nonlinear_solve_failed;
      outcome.hint = any ? "the solution of a coarser mesh leads to none of a finer one; it may not be a solution"
                         : "no solution was found near the guess; give another guess, or there is none";
    }
    return std::move(solution_);
  }
  BoundaryValueSolution too_fine() {
    solution_.outcome.ending = Ending::too_many_steps;
    solution_.outcome.t = problem_.times.front();
    solution_.outcome.error = solution_.residual / options_.tolerance;
    solution_.outcome.hint =
        fmt::format("the mesh would need more than {} intervals; a greater tolerance may do", options_.most_intervals);
    return std::move(solution_);
  }

  const BoundaryValueProblem& problem_;
  const BoundaryValueOptions& options_;
  BoundaryValueSolution solution_;
};

/// The interval of t and where t lies in it.
std::pair<std::size_t, double> place_of(const std::vector<double>& mesh, double t) {
  const auto above = std::upper_bound(mesh.begin() + 1, mesh.end() - 1, t);
  const auto k = static_cast<std::size_t>(above - mesh.begin()) - 1;
  return {k, (t - mesh[k]) / (mesh[k + 1] - mesh[k])};
}

}  // namespace

std::string what_is_wrong(const BoundaryValueProblem& problem) {
  if (problem.system.size == 0) return "a system of at least one component is needed";
  if (!problem.system.derivative || !problem.conditions) return "a derivative and conditions are needed";
  if (problem.times.size() < 2) return "conditions at two times at least are needed";
  for (std::size_t i = 0; i + 1 < problem.times.size(); ++i)
    if (!(problem.times[i] < problem.times[i + 1])) return "the times of the conditions must ascend";
  if (!std::isfinite(problem.times.front()) || !std::isfinite(problem.times.back()))
    return "the times of the conditions must be finite";
  for (const MatrixPlace& place : problem.condition_places)
    if (place.row >= problem.system.size + problem.system.parameters() ||
        place.column >= problem.times.size() * problem.system.size + problem.system.parameters())
      return "a place of the conditions lies outside their Jacobian";
  return "";
}

BoundaryValueSolution solve_boundary_values(const BoundaryValueProblem& problem, const BoundaryValueGuess& guess,
                                            const BoundaryValueOptions& options) {
  std::string wrong = what_is_wrong(problem);
  if (wrong.empty() && !(options.tolerance > 0)) wrong = "the tolerance must be greater than zero";
  if (!wrong.empty()) {
    BoundaryValueSolution none;
    none.outcome = invalid(std::move(wrong));
    return none;
  }
  return Search(problem, options)(guess);
}

void BoundaryValueSolution::at(double t, std::span<double> x) const {
  const auto [k, theta] = place_of(mesh, t);
  const double h = mesh[k + 1] - mesh[k];
  const auto weights = lobatto4.rises(theta);
  const std::size_t first = k * per_interval * size;
  for (std::size_t i = 0; i < size; ++i) {
    double sum = 0;
    for (std::size_t j = 0; j < stages; ++j) sum += weights[j] * slopes[first + j * size + i];
    x[i] = points[first + i] + h * sum;
  }
}

void BoundaryValueSolution::slope_at(double t, std::span<double> dxdt) const {
  const auto [k, theta] = place_of(mesh, t);
  const auto weights = lobatto4.slopes(theta);
  const std::size_t first = k * per_interval * size;
  for (std::size_t i = 0; i < size; ++i) {
    double sum = 0;
    for (std::size_t j = 0; j < stages; ++j) sum += weights[j] * slopes[first + j * size + i];
    dxdt[i] = sum;
  }
}

std::vector<double> BoundaryValueSolution::operator()(double t) const {
  std::vector<double> x(size);
  at(t, x);
  return x;
}

}  // namespace continuo::studies
