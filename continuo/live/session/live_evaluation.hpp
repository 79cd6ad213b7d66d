// continuo/live/session/live_evaluation.hpp
// Expressions of the model that is shown, under parameters and inputs that change while it moves.
#pragma once
#include <cstddef>
#include <memory>
#include <span>
#include <vector>

#include <continuo/live/live_model.hpp>
#include <continuo/simulation/program/evaluation.hpp>

namespace continuo::live {

class LiveEvaluation {
 public:
  LiveEvaluation() = default;
  LiveEvaluation(const LiveModel& shown, std::span<const model::NodeId> nodes, Variables variables);

  /// From here on with these parameters and inputs.
  void use(const Variables& variables);
  /// Inputs that follow a file in steps get their value at t.
  void set_step_inputs(double t);
  void operator()(double t, std::span<const double> x, std::span<double> values) { evaluation_(t, x, values); }
  /// The values at t, behind those in `to`; inputs in steps included.
  void append(double t, std::span<const double> x, std::vector<float>& to);
  model::Evaluation& evaluation() { return evaluation_; }

 private:
  std::shared_ptr<const model::ModelProgram> program_;
  model::Evaluation evaluation_;
  Variables variables_;  // those of the evaluation
};

}  // namespace continuo::live
