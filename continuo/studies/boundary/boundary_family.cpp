// continuo/studies/boundary/boundary_family.cpp
// Follows families of solutions of a boundary-value problem, and those that cross them.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <limits>
#include <utility>

#include <continuo/boundary/boundary_continuation.hpp>
#include <continuo/studies/boundary/boundary_family.hpp>
#include <continuo/studies/boundary/boundary_family_marks.hpp>
#include <continuo/studies/boundary/boundary_family_steps.hpp>
#include <continuo/studies/support/arclength.hpp>
#include <continuo/studies/support/both_ways.hpp>
#include <continuo/studies/support/ranges_of_constants.hpp>

namespace continuo::studies {

using boundary::BoundaryValueGuess;
using boundary::BoundaryValueProblem;
using boundary::BoundaryValueSolution;

namespace {

using detail::FamilyDirection;
using detail::FamilyPlace;
using detail::FamilySteps;

constexpr double close_tolerance = 1e-9;
constexpr double beyond_measure = 1e6;
constexpr double doubtful_part = 0.02;  // of the first step: shorter ones are not made to part leaps from crossings

FamilyDirection reversed(FamilyDirection direction) {
  for (double& x : direction.points) x = -x;
  direction.constant = -direction.constant;
  return direction;
}

class FamilyFollower {
 public:
  FamilyFollower(const BoundaryValueProblem& problem, const FamilyOptions& options)
      : problem_(problem),
        options_(options),
        steps_(problem, options),
        covered_(options.low, options.high, options.progress) {}

  /// In both directions from a solution.
  Family from_solution(const BoundaryValueSolution& start) {
    Family family;
    const BoundaryValueGuess guess = [&](double t, std::span<double> x) { start.at(t, x); };
    const auto first = steps_.at_constant(guess, start.mesh, start.parameters[0]);
    if (!first) {
      family.status = detail::not_found("the solution at the start is not isolated");
      return family;
    }
    family.points.push_back(point_of(*first));
    FamilyPlace back = *first;
    back.tangent = reversed(std::move(back.tangent));
    back.slope = -back.slope;
    Family behind = followed(std::move(back));
    return joined(std::move(behind), std::move(family), followed(*first));
  }

  /// The family that crosses another one at a place, in the direction that is not this one's.
  Family through(const FamilyPlace& crossing) {
    Family family;
    family.points.push_back(point_of(crossing));
    steps_.measure(crossing.solution);
    return joined(beside(crossing, -1), std::move(family), beside(crossing, 1));
  }

  /// Whether the family passes through this solution.
  bool passes(const Family& family, const BoundaryValueSolution& solution) {
    constexpr double same = 1e-4;
    for (std::size_t k = 0; k + 1 < family.points.size(); ++k) {
      const BoundaryValueSolution &a = family.points[k].solution, &b = family.points[k + 1].solution;
      const double apart = steps_.distance(a, b), to_a = steps_.distance(a, solution),
                   to_b = steps_.distance(b, solution);
      if (std::min(to_a, to_b) > 2 * apart) continue;
      const auto there = steps_.across(a, b, solution);
      if (there && steps_.distance(there->solution, solution) < same) return true;
    }
    return false;
  }

  /// Where others cross the family, in the order of its marks.
  std::vector<FamilyPlace> crossings() { return std::exchange(crossings_, {}); }

 private:
  static FamilyPoint point_of(const FamilyPlace& place) { return {place.constant(), place.solution}; }

  static Family joined(Family back, Family middle, Family ahead) {
    Family family = std::move(back);
    detail::turn_round(family.points, family.marks);
    std::ranges::reverse(family.doubtful);
    for (Family* part : {&middle, &ahead}) {
      detail::append(family.points, family.marks, std::move(part->points), std::move(part->marks));
      std::ranges::copy(part->doubtful, std::back_inserter(family.doubtful));
    }
    family.status = first_failure(std::move(family.status), std::move(ahead.status));
    return family;
  }

  bool is_inside(double constant) const { return constant >= options_.low && constant <= options_.high; }

  /// With the part of the other direction held, which is zero throughout the family that is crossed but for the second
  /// order, only the crossing family is left (Keller 1977).
  Family beside(const FamilyPlace& crossing, double sign) {
    constexpr double may_lean = 20;  // steps along the family that is crossed, for one across
    Family family;
    const FamilyDirection direction = sign > 0 ? crossing.other : reversed(crossing.other);
    for (double step = options_.first_step; step > options_.least_step; step /= 4) {
      auto place = steps_.stepped(crossing.solution, direction, step, may_lean);
      if (!place) continue;
      if (!is_inside(place->constant())) return family;
      family.points.push_back(point_of(*place));
      return joined({}, std::move(family), followed(std::move(*place)));
    }
    family.status = detail::not_found("the family could not be followed from where it crosses the other");
    return family;
  }

  Family followed(FamilyPlace here) {
    Family family;
    const BoundaryValueSolution origin = here.solution;
    detail::StepLength step(options_);
    while (family.points.size() < options_.most_points) {
      if (options_.interrupt && options_.interrupt->load()) {
        family.status = {.ending = Ending::interrupted, .message = "interrupted"};
        return family;
      }
      auto next = steps_.stepped(here.solution, here.tangent, step);
      if (!next || FamilySteps::cosine(steps_, here.tangent, next->tangent) < detail::least_cosine_of_neighbours) {
        if (step.shorten()) continue;
        family.status = detail::not_found("the family could not be followed further");
        return family;
      }
      // A leap next to a crossing hides it: in shorter steps they part.
      if (detail::is_ambiguous(here, *next) && step > doubtful_part * options_.first_step) {
        (void)step.shorten();
        continue;
      }
      mark(family, here, *next, step);
      if (!is_inside(next->constant())) {
        if (auto last = at_bound(here, *next)) family.points.push_back(std::move(*last));
        return family;
      }
      const double moved = steps_.distance(here.solution, next->solution);
      here = std::move(*next);
      family.points.push_back(point_of(here));
      covered_.report(here.constant());
      if (family.points.size() > 20 && steps_.distance(here.solution, origin) < moved / 2) return family;
      if (std::ranges::any_of(here.solution.points, [](double x) { return std::abs(x) > beyond_measure; })) {
        family.status = {.ending = Ending::cannot_continue, .message = "it diverges to infinity"};
        return family;
      }
      steps_.measure(here.solution);
      steps_.scale(here.tangent);
      step.lengthen();
    }
    family.status = {.ending = Ending::too_many_steps, .message = "too many points"};
    return family;
  }

  /// Between a place inside of the range and one outside.
  std::optional<FamilyPoint> at_bound(const FamilyPlace& a, const FamilyPlace& b) {
    const double bound = std::clamp(b.constant(), options_.low, options_.high);
    const double part = (bound - a.constant()) / (b.constant() - a.constant());
    std::vector<double> there(problem_.system.size);
    const BoundaryValueGuess between = [&, there](double t, std::span<double> x) mutable {
      a.solution.at(t, x);
      b.solution.at(t, there);
      for (std::size_t i = 0; i < x.size(); ++i) x[i] += part * (there[i] - x[i]);
    };
    const auto place = steps_.at_constant(between, a.solution.mesh, bound);
    return place ? std::optional(point_of(*place)) : std::nullopt;
  }

  void mark(Family& family, const FamilyPlace& a, const FamilyPlace& b, double step) {
    steps_.set_tolerance(std::min(options_.tolerance, close_tolerance));
    auto event = detail::what_lies_between(steps_, a, b, step);
    steps_.set_tolerance(options_.tolerance);
    const double middle = (a.constant() + b.constant()) / 2;
    if (event.doubtful && is_inside(middle)) family.doubtful.push_back(middle);
    if (!event.place || !is_inside(event.place->constant())) return;
    family.marks.push_back({event.kind, point_of(*event.place), family.points.size()});
    if (event.kind == FamilyEvent::branch_point) crossings_.push_back(std::move(*event.place));
  }

  const BoundaryValueProblem& problem_;
  const FamilyOptions& options_;
  FamilySteps steps_;
  std::vector<FamilyPlace> crossings_;
  detail::CoveredRange covered_;
};

}  // namespace

std::string_view to_string(FamilyEvent kind) {
  return kind == FamilyEvent::fold ? "fold" : "branch point";
}

std::vector<Family> follow_families(const BoundaryValueProblem& problem, const std::vector<BoundaryValueGuess>& guesses,
                                    const FamilyOptions& options) {
  std::vector<Family> families;
  std::vector<std::vector<FamilyPlace>> crossings;
  FamilyFollower follower(problem, options);
  const auto is_known = [&](const BoundaryValueSolution& solution) {
    return std::ranges::any_of(families, [&](const Family& known) { return follower.passes(known, solution); });
  };
  const BoundaryValueProblem fixed = [&] {
    BoundaryValueProblem at_start(problem);
    const std::vector<double> constants(problem.system.constants);
    ParametricSystem& system = at_start.system;
    system.constants.clear();
    system.derivative = [&problem, constants](double t, Values x, Values, std::span<double> dxdt) {
      problem.system.derivative(t, x, constants, dxdt);
    };
    if (problem.system.jacobian)
      system.jacobian = [&problem, constants](double t, Values x, Values, std::span<double> entries) {
        problem.system.jacobian(t, x, constants, entries);
      };
    at_start.conditions = [&problem, constants](Values x, Values, std::span<double> residuals) {
      problem.conditions(x, constants, residuals);
    };
    return at_start;
  }();
  for (const BoundaryValueGuess& guess : guesses) {
    BoundaryValueSolution start =
        solve_with_continuation(fixed, guess, {.tolerance = options.tolerance, .interrupt = options.interrupt});
    if (!start.outcome) {
      families.push_back(
          {.points = {}, .marks = {}, .status = {.ending = start.outcome.ending, .message = start.outcome.hint}});
      crossings.emplace_back();
      continue;
    }
    start.parameters = problem.system.constants;
    if (is_known(start)) continue;
    families.push_back(follower.from_solution(start));
    crossings.push_back(follower.crossings());
  }
  for (std::size_t k = 0; k < families.size(); ++k) {
    for (std::size_t c = 0; c < crossings[k].size(); ++c) {
      if (families.size() >= options.most_families) {
        families[k].crossings_left = crossings[k].size() - c;
        break;
      }
      const FamilyPlace at = crossings[k][c];
      Family family = follower.through(at);
      std::vector<FamilyPlace> others = follower.crossings();
      const auto own = std::ranges::find_if(
          family.points, [&](const FamilyPoint& point) { return point.solution.points == at.solution.points; });
      // The solutions next to the crossing tell whether the family is known; the crossing itself lies on both.
      bool is_new = false;
      if (own + 1 < family.points.end()) is_new = is_new || !is_known((own + 1)->solution);
      if (own > family.points.begin()) is_new = is_new || !is_known((own - 1)->solution);
      if (!is_new) continue;
      family.crossed = k;
      families.push_back(std::move(family));
      crossings.push_back(std::move(others));
    }
  }
  return families;
}

double farthest_from_zero(const BoundaryValueSolution& solution, std::size_t component) {
  constexpr double alike = 1e-6;
  double most = 0;
  for (std::size_t i = component; i < solution.points.size(); i += solution.size)
    if (std::abs(solution.points[i]) > (1 + alike) * std::abs(most)) most = solution.points[i];
  return most;
}

}  // namespace continuo::studies
