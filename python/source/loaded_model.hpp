// A model that was loaded, as Python holds it, and its run.
#pragma once
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <pybind11/pybind11.h>

#include <continuo/simulation/native.hpp>
#include <continuo/simulation/program/model_program.hpp>
#include <continuo/simulation/run.hpp>

namespace continuo::python {

/// A checked model with its text, ready to run. Nothing of it changes, so that threads may share it.
struct LoadedModel {
  model::Source source;
  std::shared_ptr<const model::ModelProgram> program;
  model::NativeUse native;

  [[nodiscard]] const model::Model& model() const { return program->model; }
};

/// A run with what it takes to evaluate more of the model along it.
struct ModelRun {
  std::shared_ptr<const model::ModelProgram> program;
  model::Run run;
};

/// The class of runs: model_run.cpp.
void add_model_run(pybind11::module_& module);
/// Adds `run` to the class of models: run_model.cpp.
void add_run_of_model(pybind11::class_<LoadedModel, std::shared_ptr<LoadedModel>>& model);

}  // namespace continuo::python
