// continuo/simulation/experiment.cpp
// Makes a plan of a model's `run` statement and a caller's experiment, and the times of its rows.
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <continuo/language/world.hpp>
#include <continuo/simulation/drive/planner.hpp>
#include <continuo/simulation/experiment.hpp>

namespace continuo::model {

namespace {

/// E321 or E323 for a model that no integration from the start can run.
std::optional<Diagnostic> no_integration(const Model& model) {
  if (model.has_world()) return no_study_of_worlds(model);
  if (!model.needs_boundary_solver()) return std::nullopt;
  return error("E321", model.boundary.front().span, "conditions at different times cannot be integrated from the start",
               "this makes it a boundary-value problem",
               "`continuo run` solves it; or give all conditions at the start");
}

}  // namespace

Diagnostic no_study_of_worlds(const Model& model) {
  return error("E323", model.world->span, "a world of bodies is not integrated like equations",
               "its bodies collide, and no study of equations can see that",
               "`continuo run`, `verify`, `compare`, `converge`, `sense` and `fit` move it");
}

std::optional<Plan> plan(const Model& model, const Experiment& experiment, std::vector<Diagnostic>& problems) {
  if (auto problem = no_integration(model)) {
    problems.push_back(std::move(*problem));
    return std::nullopt;
  }
  Planner planner(model, experiment, problems);
  planner.begin();
  planner.set_integration();
  return planner.finish();
}

std::size_t max_steps_of(const Plan& plan) {
  constexpr double most = 1e18;
  const double given = plan.step > 0 ? std::min((plan.to - plan.from) / plan.step, most) : 0;
  return usual_max_steps + (given > 0 ? static_cast<std::size_t>(given) : 0);
}

double OutputTimes::operator[](std::size_t k) const {
  constexpr double none = std::numeric_limits<double>::infinity();
  // One part in a million of an interval is rounding, not another row.
  constexpr double slack = 1e-6;
  const auto within = [this](double t, double room) {
    return t <= plan_.to ? t : t < none && t <= plan_.to + slack * room ? plan_.to : none;
  };
  if (plan_.output == OutputPlan::Kind::every) {
    return within(plan_.from + static_cast<double>(k) * plan_.interval, plan_.interval);
  }
  if (plan_.output == OutputPlan::Kind::logarithmic) {
    if (k == 0) return plan_.from;
    const double decades = static_cast<double>(k - 1) / plan_.per_decade;
    const double elapsed = plan_.first * std::pow(10, decades);
    return within(plan_.from + elapsed, elapsed);
  }
  return none;
}

}  // namespace continuo::model
