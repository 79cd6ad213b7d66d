// Where a model's motion goes from an instant in some time, with all that happens in it, and what becomes of
// neighbours: the derivative by the initial state, through events with their saltation (sensitive_program.hpp).
// Internal to closed orbits.
#pragma once
#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include <continuo/simulation/experiment.hpp>
#include <continuo/simulation/stepping.hpp>
#include <continuo/status/status.hpp>
#include <continuo/studies/sensitivity.hpp>
#include <continuo/system/parametric_system.hpp>

namespace continuo::studies::detail {

struct FlowImage {
  Status status;  // a failure where there is none: then of the rest, the run alone
  std::vector<double> x;
  std::size_t mode = 0;
  std::vector<double> by_start;       // d x / d x(0), n by n, row by row
  std::vector<double> by_parameters;  // n by the number of parameters, row by row
  SensitivityRun run;                 // every step and event
};

class ReturnFlow {
 public:
  /// `exact`: the experiment that the motion belongs to, with its tolerances; `parameters`: indices into the model's.
  ReturnFlow(std::shared_ptr<const model::ModelProgram> program, const std::vector<std::size_t>& parameters,
             model::Experiment exact);

  /// Of the parameters, the k-th.
  void set(std::size_t k, double value);

  FlowImage operator()(const model::Instant& start, double duration) const;
  /// x' at an instant at which nothing happens.
  [[nodiscard]] std::vector<double> rates(const model::Instant& start) const;
  [[nodiscard]] const model::ModelProgram& program() const { return *program_; }
  [[nodiscard]] std::size_t size() const { return n_; }

 private:
  std::shared_ptr<const model::ModelProgram> program_;
  model::Experiment exact_;
  std::vector<std::string> names_;  // of the parameters
  std::size_t n_, count_;
  SensitivityStudy study_;
  std::vector<ParametricSystem> modes_;
};

}  // namespace continuo::studies::detail
