// Newton's iteration on one mesh after the other, until residual and error are below the tolerance.
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <string>
#include <utility>

#include <fmt/format.h>

#include <continuo/boundary/boundary_accuracy.hpp>
#include <continuo/boundary/boundary_mesh.hpp>
#include <continuo/boundary/boundary_nature.hpp>
#include <continuo/boundary/boundary_value.hpp>
#include <continuo/boundary/collocation_system.hpp>

namespace continuo::boundary {

namespace {

constexpr std::size_t most_meshes = 60;
constexpr std::size_t enough_intervals = 4000;  // then a small error will do, whatever the residual
constexpr std::size_t most_stuck = 3;           // meshes that did not halve the residual; the same
constexpr double more_each_time = 1.3;          // intervals, for each of them
constexpr double undetermined_part = 1e-3;      // of a component, that rounding may move
constexpr double most_by_differences = 1e6;     // condition, where df/dx is known to 1e-8 of itself
constexpr std::size_t most_in_vain = 3;         // meshes that did not halve the error

std::string name_of(const ParametricSystem& system, std::size_t i) {
  return i < system.size ? system.name(i) : system.constant_name(i - system.size);
}

class Search {
 public:
  Search(const BoundaryValueProblem& problem, const BoundaryValueOptions& options)
      : problem_(problem), options_(options) {}

  BoundaryValueSolution operator()(const BoundaryValueGuess& guess) {
    solution_.size = problem_.system.size;
    solution_.parameters = problem_.system.constants;
    std::vector<double> mesh = first_mesh(problem_, options_);
    const OpenEnds open = open_ends(problem_, guess);
    std::size_t failures = 0;
    for (std::size_t count = 0; count < most_meshes && mesh.size() <= options_.most_intervals + 1; ++count) {
      CollocationSystem system(problem_, mesh, open);
      set_unknowns(system, guess);
      const double target = std::clamp(1e-3 * options_.tolerance, 1e-12, 1e-5);
      NewtonEnding ending = system.iterate(target, options_);
      if (ending == NewtonEnding::converged && has_shrunk(system)) {
        std::ranges::fill(system.unknowns(), 0.0);
        ending = system.iterate(target, options_);
      }
      ++solution_.meshes;
      solution_.iterations += system.iterations();
      solution_.evaluations += system.evaluations();
      if (ending != NewtonEnding::converged) {
        if (is_undetermined(ending, system)) return std::move(solution_);
        if (!may_refine(ending) || ++failures > options_.most_refinements) return failed(ending, system);
        mesh = remeshed(mesh, std::vector<double>(mesh.size() - 1, 2.0), problem_.times);
        continue;
      }
      any_ = true;
      keep(system, mesh);
      const Residuals residuals = residuals_of(problem_, solution_, system, options_.tolerance);
      solution_.residual = std::ranges::max(residuals.of_intervals);
      if (options_.progress) options_.progress(residuals.of_intervals.size(), solution_.residual);
      if (!(solution_.residual < std::numeric_limits<double>::infinity()))
        return failed(NewtonEnding::not_finite, system);
      if (is_done(system, residuals)) return std::move(solution_);
      mesh = remeshed(mesh, wanted(residuals), fixed_times(mesh, residuals));
    }
    return too_fine(mesh.size() - 1);
  }

 private:
  static bool may_refine(NewtonEnding ending) {
    return ending == NewtonEnding::no_descent || ending == NewtonEnding::too_many || ending == NewtonEnding::singular;
  }

  /// What is left of a guess that leads to nought is rounding, which may well be nought itself.
  bool has_shrunk(CollocationSystem& system) const {
    constexpr double little = 1e-6;
    const auto size = [](double most, double x) { return std::max(most, std::abs(x)); };
    const auto z = system.unknowns();
    const double now = std::accumulate(z.begin(), z.end(), 0.0, size);
    return now > 0 && now < little * guessed_;
  }

  void set_unknowns(CollocationSystem& system, const BoundaryValueGuess& guess) {
    for (std::size_t q = 0; q < system.point_count(); ++q) {
      if (any_) {
        solution_.at(system.time(q), system.point(q));
      } else if (guess) {
        guess(system.time(q), system.point(q));
      }
      for (const double x : system.point(q)) guessed_ = std::max(guessed_, std::abs(x));
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

  /// The times of conditions, and the ends of intervals in which f has been found to jump.
  std::vector<double> fixed_times(const std::vector<double>& mesh, const Residuals& residuals) const {
    std::vector<double> fixed(problem_.times);
    for (const std::size_t k : residuals.jumps) fixed.insert(fixed.end(), {mesh[k], mesh[k + 1]});
    std::ranges::sort(fixed);
    fixed.erase(std::ranges::unique(fixed).begin(), fixed.end());
    return fixed;
  }

  std::vector<double> wanted(const Residuals& residuals) const {
    if (error_factor_ > 0) return wanted_for_error(residuals.shares, error_factor_);
    std::vector<double> counts = wanted_intervals(residuals.of_intervals, options_.tolerance);
    for (double& count : counts) count *= std::pow(more_each_time, static_cast<double>(stuck_));
    return counts;
  }

  /// Whether the residual is small enough, or smaller ones do not pay: it is so where x' = f is zero, against which the
  /// residual is measured, and where it is all rounding. Then a small error will do.
  bool is_resolved(std::size_t intervals) {
    if (solution_.residual <= options_.tolerance) return true;
    stuck_ = solution_.residual > least_residual_ / 2 ? stuck_ + 1 : 0;
    least_residual_ = std::min(least_residual_, solution_.residual);
    return options_.check_error && (intervals > enough_intervals || stuck_ > most_stuck);
  }

  /// The solution is there, or it is known why there is none; else `error_factor_` says what the next mesh aims at.
  bool is_done(CollocationSystem& system, const Residuals& residuals) {
    error_factor_ = 0;
    if (!is_resolved(residuals.of_intervals.size())) return false;
    if (!options_.check_error) return true;
    ErrorBounds bounds = error_bounds(system, residuals);
    for (std::size_t i = 0; i < bounds.of_mesh.size(); ++i) bounds.of_mesh[i] += system.held_at() * bounds.sizes[i];
    note(bounds);
    const auto [of_mesh, worst] = bounds.worst(bounds.of_mesh);
    const auto [of_rounding, rounded] = bounds.worst(bounds.of_rounding);
    const bool beyond_differences = !problem_.system.jacobian && bounds.condition > most_by_differences;
    if (bounds.worst(bounds.undetermined).part > undetermined_part || beyond_differences) {
      undetermined(bounds);
      return true;
    }
    const bool known = condition_is_known(bounds.condition);
    if (of_rounding > options_.tolerance && known) {
      limited_by_rounding(of_rounding, rounded);
      return true;
    }
    // Between the points that the error is estimated at it may be half as large again.
    const bool fine = 2 * of_mesh + of_rounding <= options_.tolerance;
    if (fine && known) {
      doubt_zero();
      return true;
    }
    in_vain_ = of_mesh > last_error_ / 2 && !fine && known ? in_vain_ + 1 : 0;
    last_error_ = std::min(of_mesh, last_error_);
    if (in_vain_ > most_in_vain) {
      does_not_fall(of_mesh, worst);
      return true;
    }
    error_factor_ = fine || !known ? 0.03 : std::clamp(options_.tolerance / (2 * of_mesh), 1e-3, 0.5);
    return false;
  }

  /// An error of the size of the tolerance in f could be a large part of the motion: then the condition has to be that
  /// of the problem, which finer meshes leave as it is.
  bool condition_is_known(double condition) {
    const double before = std::exchange(last_condition_, condition);
    const double harmless = std::min(1 / options_.tolerance, std::max(1e-3 / options_.tolerance, 1e4));
    return condition < harmless || (before > 0 && condition < 2 * before && before < 2 * condition);
  }

  void note(const ErrorBounds& bounds) {
    solution_.error = bounds.of_mesh;
    for (std::size_t i = 0; i < solution_.error.size(); ++i) solution_.error[i] += bounds.of_rounding[i];
    solution_.condition = bounds.condition;
  }

  /// A linear problem of which Newton's iteration does not converge in one step is held by rounding.
  bool is_undetermined(NewtonEnding ending, CollocationSystem& system) {
    if (ending == NewtonEnding::interrupted || !system.is_factored() || !is_linear(problem_)) return false;
    const ErrorBounds bounds = rounding_bounds(system);
    if (!(bounds.worst(bounds.undetermined).part > undetermined_part)) return false;
    note(bounds);
    undetermined(bounds);
    return true;
  }

  /// Where all is zero, so may another motion be a solution; of a linear problem that is determined there is none.
  void doubt_zero() {
    if (std::ranges::any_of(solution_.points, [](double x) { return x != 0; }) || is_linear(problem_)) return;
    solution_.outcome.hint = "all is zero, which these conditions allow; another `guess` may lead to other motions";
  }

  void end(BoundaryValueFailure failure, Ending ending, std::size_t component, std::string hint) {
    solution_.failure = failure;
    solution_.outcome.ending = ending;
    solution_.outcome.t = problem_.times.front();
    solution_.outcome.component = name_of(problem_.system, component);
    solution_.outcome.error = solution_.residual / options_.tolerance;
    solution_.outcome.hint = std::move(hint);
  }

  void undetermined(const ErrorBounds& bounds) {
    const auto [part, component] = bounds.worst(bounds.undetermined);
    end(BoundaryValueFailure::undetermined, Ending::nonlinear_solve_failed, component,
        fmt::format("to the digits of a double, a multiple of another motion, in which `{}` moves most, can be added: "
                    "there are many solutions, or none (condition about {:.0e})",
                    name_of(problem_.system, component), solution_.condition));
  }
  void limited_by_rounding(double part, std::size_t component) {
    end(BoundaryValueFailure::rounding, Ending::too_many_steps, component,
        fmt::format("rounding alone moves `{}` by {:.0e} of its size (condition about {:.0e}); a tolerance above that "
                    "can be met",
                    name_of(problem_.system, component), part, solution_.condition));
  }
  void does_not_fall(double part, std::size_t component) {
    end(BoundaryValueFailure::too_fine, Ending::too_many_steps, component,
        fmt::format(
            "with {} intervals `{}` is still known to {:.0e} of its size only, and more of them do not help: "
            "the equations may jump where the state does, or hardly determine the motion (condition about {:.0e})",
            solution_.mesh.size() - 1, name_of(problem_.system, component), part, solution_.condition));
  }

  /// An interval so short that its points are hardly different numbers.
  static bool beyond_digits(const CollocationSystem& system) {
    constexpr double few_digits = 1e3;
    constexpr std::size_t per = CollocationSystem::per_interval;
    for (std::size_t q = per; q < system.point_count(); q += per) {
      const double t = system.time(q), h = t - system.time(q - per);
      if (h < few_digits * std::numeric_limits<double>::epsilon() * std::abs(t)) return true;
    }
    return false;
  }

  BoundaryValueSolution failed(NewtonEnding ending, CollocationSystem& system) {
    using enum BoundaryValueFailure;
    const std::size_t worst = system.worst();
    if (ending == NewtonEnding::interrupted) {
      end(other, Ending::interrupted, worst, "");
    } else if (ending == NewtonEnding::not_finite) {
      end(not_finite, Ending::not_finite, worst,
          "f or a condition is not a number on the way; a guess nearer to the solution may help");
    } else if (ending == NewtonEnding::singular) {
      end(not_found, Ending::nonlinear_solve_failed, worst,
          "the conditions do not determine a solution near the guess (their matrix is singular); another guess may do, "
          "of "
          "zero often does not");
    } else {
      end(not_found, Ending::nonlinear_solve_failed, worst,
          beyond_digits(system)
              ? "it turns within a few digits of t, nearer than which a double cannot tell times apart; a time that "
                "runs from there, or another scale of it, may do"
          : any_ ? "the solution of a coarser mesh leads to none of a finer one; it may not be a solution"
                 : "no solution was found near the guess; give another guess, or there is none");
    }
    return std::move(solution_);
  }
  BoundaryValueSolution too_fine(std::size_t intervals) {
    end(BoundaryValueFailure::too_fine, Ending::too_many_steps, 0,
        intervals > options_.most_intervals
            ? fmt::format("the mesh would need more than {} intervals; a greater tolerance may do",
                          options_.most_intervals)
            : fmt::format("the residual stays at {:.0e}, of whatever mesh; the equations may jump where the state does",
                          solution_.residual));
    solution_.outcome.component.clear();
    return std::move(solution_);
  }

  const BoundaryValueProblem& problem_;
  const BoundaryValueOptions& options_;
  BoundaryValueSolution solution_;
  double guessed_ = 0;       // the greatest number to begin from
  bool any_ = false;         // there is a solution of a coarser mesh
  double error_factor_ = 0;  // what the next mesh is to make of the error; 0: it has to resolve the motion first
  double last_condition_ = 0;
  double last_error_ = std::numeric_limits<double>::infinity();
  std::size_t in_vain_ = 0;
  double least_residual_ = std::numeric_limits<double>::infinity();
  std::size_t stuck_ = 0;
};

}  // namespace

BoundaryValueSolution solve_boundary_values(const BoundaryValueProblem& problem, const BoundaryValueGuess& guess,
                                            const BoundaryValueOptions& options) {
  Status valid = validate(problem);
  if (valid && !(options.tolerance > 0)) valid = invalid_input("the tolerance must be greater than zero");
  if (!valid) {
    BoundaryValueSolution none;
    none.outcome.ending = valid.ending;
    none.outcome.hint = std::move(valid.message);
    return none;
  }
  return Search(problem, options)(guess);
}

}  // namespace continuo::boundary
