// Runs a model with its sensitivities from an instant on, for the image of a state and its derivative.
#include <utility>

#include <fmt/format.h>

#include <continuo/simulation/of_model.hpp>
#include <continuo/studies/orbits/hybrid/return_flow.hpp>

namespace continuo::studies::detail {

namespace {

std::vector<Influence> all_states_and(const model::Model& model, const std::vector<std::size_t>& parameters) {
  std::vector<Influence> influences;
  for (std::size_t i = 0; i < model.states.size(); ++i)
    influences.push_back({.kind = Influence::Kind::initial, .index = i});
  for (const std::size_t p : parameters) influences.push_back({.kind = Influence::Kind::parameter, .index = p});
  return influences;
}

}  // namespace

ReturnFlow::ReturnFlow(std::shared_ptr<const model::ModelProgram> program, const std::vector<std::size_t>& parameters,
                       model::Experiment exact)
    : program_(std::move(program)),
      exact_(std::move(exact)),
      n_(program_->model.states.size()),
      count_(parameters.size()),
      study_(program_, all_states_and(program_->model, parameters), exact_.parameters, true) {
  for (const std::size_t p : parameters) names_.push_back(program_->model.parameters[p].name);
  for (std::size_t mode = 0; mode < program_->model.modes.size(); ++mode)
    modes_.push_back(of_model(program_, {.constants = names_, .parameters = exact_.parameters, .mode = mode}));
}

void ReturnFlow::set(std::size_t k, double value) {
  exact_.parameters.insert_or_assign(names_[k], value);
  for (ParametricSystem& system : modes_) system.constants[k] = value;
}

FlowImage ReturnFlow::operator()(const model::Instant& start, double duration) const {
  FlowImage image;
  SensitivityRequest request{.experiment = exact_, .begin = start};
  request.experiment.to = start.t + duration;
  request.experiment.output_steps = true;
  image.run = study_.run(request);
  const SensitivityRun& run = image.run;
  image.status = run.status;
  if (run.status.ending == Ending::stopped_by_event) {
    image.status = {.ending = Ending::cannot_continue, .message = fmt::format("`{}` ends the run", run.outcome.event)};
  } else if (run.status.ending == Ending::events_accumulate) {
    image.status.message =
        fmt::format("the times of `{}` close in on a limit, beyond which there is no derivative", run.outcome.event);
  }
  if (!image.status) return image;
  const std::size_t last = run.rows() - 1;
  image.mode = run.mode;
  for (std::size_t i = 0; i < n_; ++i) {
    image.x.push_back(run.value(last, i));
    for (std::size_t k = 0; k < n_; ++k) image.by_start.push_back(run.sensitivity(last, i, k));
    for (std::size_t k = 0; k < count_; ++k) image.by_parameters.push_back(run.sensitivity(last, i, n_ + k));
  }
  return image;
}

std::vector<double> ReturnFlow::rates(const model::Instant& start) const {
  std::vector<double> rates(n_);
  const ParametricSystem& system = modes_[start.mode];
  system.derivative(start.t, start.x, system.constants, rates);
  return rates;
}

}  // namespace continuo::studies::detail
