// continuo/studies/boundary/boundary_family_of_model.cpp
// Poses a model's boundary-value problem for each value of a parameter, and follows it.
#include <algorithm>
#include <cstddef>
#include <limits>
#include <utility>

#include <fmt/format.h>

#include <continuo/boundary/boundary_problem_of_model.hpp>
#include <continuo/simulation/of_model.hpp>
#include <continuo/studies/boundary_family_of_model.hpp>

namespace continuo::studies {

using boundary::BoundaryValueGuess;
using boundary::BoundaryValueProblem;

namespace {

using model::Diagnostic;

/// The conditions for each value of the parameter. They are made of the model's text anew where it has another one:
/// what follows from the parameter moves with it. The last few are kept, since each place is asked for many times.
class MovingConditions {
 public:
  MovingConditions(std::shared_ptr<const model::ModelProgram> program, model::Experiment experiment,
                   std::string parameter)
      : program_(std::move(program)), experiment_(std::move(experiment)), parameter_(std::move(parameter)) {}

  void operator()(Values x, Values p, std::span<double> residuals) {
    boundary::BoundaryConditions* conditions = at(p[0]);
    if (conditions)
      (*conditions)(x, residuals);
    else
      std::ranges::fill(residuals, std::numeric_limits<double>::quiet_NaN());
  }
  /// Nothing where the model does not allow this value.
  boundary::BoundaryConditions* at(double value) {
    const auto known = std::ranges::find(kept_, value, &Kept::value);
    if (known != kept_.end()) return known->conditions.get();
    experiment_.parameters[parameter_] = value;
    std::vector<Diagnostic> ignored;
    const auto planned = boundary::plan_boundary(program_->model, experiment_, ignored);
    if (kept_.size() == most_kept) kept_.erase(kept_.begin());
    kept_.push_back({value, planned ? std::make_shared<boundary::BoundaryConditions>(*program_, *planned) : nullptr});
    return kept_.back().conditions.get();
  }

 private:
  static constexpr std::size_t most_kept = 4;
  struct Kept {
    double value;
    std::shared_ptr<boundary::BoundaryConditions> conditions;
  };
  std::shared_ptr<const model::ModelProgram> program_;
  model::Experiment experiment_;
  std::string parameter_;
  std::vector<Kept> kept_;
};

}  // namespace

ModelFamilies families_of_model(const std::shared_ptr<const model::ModelProgram>& program,
                                const model::Experiment& asked, const FamilyRequest& request) {
  ModelFamilies result;
  const model::Model& model = program->model;
  model::Experiment experiment = asked;
  auto posed = boundary::pose_boundary(program, experiment, result.diagnostics);
  if (!posed) return result;
  const std::size_t index = model::find_parameter(model, request.parameter);
  result.start = std::clamp(posed->plan.variables[model.parameters[index].variable], request.low, request.high);
  experiment.parameters[request.parameter] = result.start;
  posed = boundary::pose_boundary(program, experiment, result.diagnostics);
  if (!posed) return result;
  const auto conditions = std::make_shared<MovingConditions>(program, experiment, request.parameter);
  for (const double end : {request.low, request.high}) {
    const boundary::BoundaryConditions* there = conditions->at(end);
    if (there && there->times() == posed->conditions->times()) continue;
    result.diagnostics.push_back(model::error(
        "E321", model.boundary.front().span,
        there ? fmt::format("`{}` moves the times of these conditions", request.parameter)
              : fmt::format("`{}` cannot be {:g}", request.parameter, end),
        {},
        there ? "let the time be a part of the interval, from 0 to 1, and its length a factor of the equations"
              : "ask for a smaller range"));
    return result;
  }
  const BoundaryValueProblem problem{
      of_model(program, {.constants = {request.parameter}, .parameters = experiment.parameters}),
      posed->conditions->times(),
      [conditions](Values x, Values p, std::span<double> residuals) { (*conditions)(x, p, residuals); },
      posed->conditions->places()};
  std::vector<BoundaryValueGuess> guesses;
  if (request.guess) {
    auto guess = boundary::guess_from(*posed, *request.guess, result.diagnostics);
    if (!guess) return result;
    guesses.push_back(std::move(*guess));
  } else {
    for (std::size_t k = 0; k < boundary::guess_count(model); ++k) guesses.push_back(boundary::guess_of(*posed, k));
  }
  result.families = follow_families(problem, guesses,
                                    {.low = request.low,
                                     .high = request.high,
                                     .tolerance = posed->options.tolerance,
                                     .interrupt = experiment.interrupt,
                                     .progress = request.progress});
  const auto is_empty = [](const Family& family) { return family.points.empty(); };
  if (std::ranges::all_of(result.families, is_empty)) {
    result.diagnostics.push_back(model::error(
        "E322", model.boundary.front().span,
        fmt::format("no motion meets these conditions near the guess for {} = {:g}", request.parameter, result.start),
        {}, result.families.empty() ? "" : result.families.front().status.message));
    result.families.clear();
  }
  std::erase_if(result.families, is_empty);
  return result;
}

}  // namespace continuo::studies
