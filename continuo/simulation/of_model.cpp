// The equations of one mode of a model, as functions of t, x and the constants that a study moves.
#include <algorithm>
#include <optional>
#include <utility>

#include <continuo/simulation/of_model.hpp>
#include <continuo/simulation/program/evaluation.hpp>
#include <continuo/simulation/program/model_derivatives.hpp>

namespace continuo::model {

namespace {

/// The model, the constants as last set, and the tapes; made once, shared by the functions of the system.
class Tapes {
 public:
  Tapes(std::shared_ptr<const ModelProgram> program, const OfModel& what)
      : program_(std::move(program)),
        mode_(what.mode),
        variables_(start_values(program_->model, what.parameters)),
        overrides_(what.parameters) {
    const Model& model = program_->model;
    rates_ = Evaluation(program_->derivatives[mode_], variables_);
    for (const std::string& name : what.constants) {
      const Parameter& parameter = model.parameters[find_parameter(model, name)];
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
  ModelDerivatives& derivatives() {
    if (!derivatives_) derivatives_.emplace(*program_, variables_);
    return *derivatives_;
  }
  /// Other parameters may follow from those that move.
  void set(Values p) {
    if (std::ranges::equal(p, values_)) return;
    values_.assign(p.begin(), p.end());
    for (std::size_t i = 0; i < names_.size(); ++i) overrides_[names_[i]] = values_[i];
    const Model& model = program_->model;
    const std::vector<double> now = start_values(model, overrides_);
    for (const Parameter& parameter : model.parameters) {
      if (now[parameter.variable] == variables_[parameter.variable]) continue;
      variables_[parameter.variable] = now[parameter.variable];
      rates_.set(parameter.variable, now[parameter.variable]);
      if (derivatives_) derivatives_->set(parameter.variable, now[parameter.variable]);
    }
  }

  std::shared_ptr<const ModelProgram> program_;
  std::size_t mode_;
  std::vector<double> variables_;
  Overrides overrides_;
  std::vector<std::string> names_;
  std::vector<double> values_;
  Evaluation rates_;
  std::optional<ModelDerivatives> derivatives_;
};

}  // namespace

ParametricSystem of_model(const std::shared_ptr<const ModelProgram>& program, const OfModel& what) {
  const auto tapes = std::make_shared<Tapes>(program, what);
  ParametricSystem system{.size = program->model.states.size(), .constants = tapes->values()};
  system.derivative = [tapes](double t, Values x, Values p, std::span<double> dxdt) {
    tapes->derivative(t, x, p, dxdt);
  };
  system.pattern = tapes->pattern();
  system.jacobian = [tapes](double t, Values x, Values p, std::span<double> entries) {
    tapes->jacobian(t, x, p, entries);
  };
  for (const State& state : program->model.states) {
    system.names.push_back(state.column);
    if (state.algebraic) ++system.algebraic;
  }
  system.constant_names = what.constants;
  return system;
}

std::vector<double> start_of(const Model& model, const Overrides& parameters) {
  const std::vector<double> variables = start_values(model, parameters);
  const auto first = variables.begin() + model.layout.states;
  return {first, first + static_cast<std::ptrdiff_t>(model.states.size())};
}

}  // namespace continuo::model
