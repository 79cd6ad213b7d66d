// continuo/studies/support/of_model.cpp
// Makes a parametric system of one mode of a model, by tapes.
#include <algorithm>
#include <optional>
#include <utility>

#include <continuo/simulation/program/evaluation.hpp>
#include <continuo/simulation/program/model_derivatives.hpp>
#include <continuo/studies/of_model.hpp>

namespace continuo::studies {

namespace {

/// The model, the constants as last set, and the tapes; made once, shared by the functions of the system.
class Tapes {
 public:
  Tapes(std::shared_ptr<const model::ModelProgram> program, const OfModel& what)
      : program_(std::move(program)),
        mode_(what.mode),
        variables_(model::start_values(program_->model, what.parameters)),
        overrides_(what.parameters) {
    const model::Model& model = program_->model;
    rates_ = model::Evaluation(program_->derivatives[mode_], variables_);
    for (const std::string& name : what.constants) {
      const model::Parameter& parameter = model.parameters[model::find_parameter(model, name)];
      names_.push_back(name);
      values_.push_back(variables_[parameter.variable]);
    }
  }

  const std::vector<double>& values() const { return values_; }

  void derivative(double t, Values x, Values p, std::span<double> dxdt) {
    set(p);
    rates_(t, x, dxdt);
  }
  const SparsePattern& pattern() { return derivatives().pattern(); }
  void jacobian(double t, Values x, Values p, std::span<double> entries) {
    set(p);
    derivatives().jacobian_values(mode_, t, x, entries);
  }

 private:
  model::ModelDerivatives& derivatives() {
    if (!derivatives_) derivatives_.emplace(*program_, variables_);
    return *derivatives_;
  }
  /// Other parameters may follow from those that move.
  void set(Values p) {
    if (std::ranges::equal(p, values_)) return;
    values_.assign(p.begin(), p.end());
    for (std::size_t i = 0; i < names_.size(); ++i) overrides_[names_[i]] = values_[i];
    const model::Model& model = program_->model;
    const std::vector<double> now = model::start_values(model, overrides_);
    for (const model::Parameter& parameter : model.parameters) {
      if (now[parameter.variable] == variables_[parameter.variable]) continue;
      variables_[parameter.variable] = now[parameter.variable];
      rates_.set(parameter.variable, now[parameter.variable]);
      if (derivatives_) derivatives_->set(parameter.variable, now[parameter.variable]);
    }
  }

  std::shared_ptr<const model::ModelProgram> program_;
  std::size_t mode_;
  std::vector<double> variables_;
  model::Overrides overrides_;
  std::vector<std::string> names_;
  std::vector<double> values_;
  model::Evaluation rates_;
  std::optional<model::ModelDerivatives> derivatives_;
};

}  // namespace

ParametricSystem of_model(const std::shared_ptr<const model::ModelProgram>& program, const OfModel& what) {
  const auto tapes = std::make_shared<Tapes>(program, what);
  ParametricSystem system{.size = program->model.states.size(), .constants = tapes->values()};
  system.derivative = [tapes](double t, Values x, Values p, std::span<double> dxdt) {
    tapes->derivative(t, x, p, dxdt);
  };
  system.pattern = tapes->pattern();
  system.jacobian = [tapes](double t, Values x, Values p, std::span<double> entries) {
    tapes->jacobian(t, x, p, entries);
  };
  for (const model::State& state : program->model.states) {
    system.names.push_back(state.column);
    if (state.algebraic) ++system.algebraic;
  }
  system.constant_names = what.constants;
  return system;
}

std::vector<double> start_of(const model::Model& model, const model::Overrides& parameters) {
  const std::vector<double> variables = model::start_values(model, parameters);
  const auto first = variables.begin() + model.layout.states;
  return {first, first + static_cast<std::ptrdiff_t>(model.states.size())};
}

}  // namespace continuo::studies
