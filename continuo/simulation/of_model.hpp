// A model as a system with constants: x' = f(t, x, p) in one of its modes, with chosen parameters as constants that a
// study may move.
//
//   const ParametricSystem system = of_model(program, {.constants = {"k", "c"}});
#pragma once
#include <memory>
#include <string>
#include <vector>

#include <continuo/simulation/experiment.hpp>
#include <continuo/simulation/program/model_program.hpp>
#include <continuo/system/parametric_system.hpp>

namespace continuo::model {

/// Which parameters become constants, and in which mode.
struct OfModel {
  std::vector<std::string> constants{};  // names of parameters, each one of the model's
  Overrides parameters{};                // values that stand for those in the text
  std::size_t mode = 0;                  // one of the model's
};

/// Derivatives are exact, by the model's graph; sparse where the model is. Each call of the system's functions changes
/// registers that its copies share: one thread at a time.
[[nodiscard]] ParametricSystem of_model(const std::shared_ptr<const ModelProgram>& program, const OfModel& what = {});

/// The initial state of the model with these parameters.
[[nodiscard]] std::vector<double> start_of(const Model& model, const Overrides& parameters = {});

}  // namespace continuo::model
