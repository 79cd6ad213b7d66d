// apps/continuo/experiment_options.hpp
// The options that change what the model's `run` statement asks for, shared by every verb that runs models.
#pragma once
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <CLI/App.hpp>
#include <apps/continuo/exit_codes.hpp>

#include <continuo/model/experiment.hpp>
#include <continuo/model/load.hpp>
#include <continuo/model/model_program.hpp>

namespace continuo::app {

struct ExperimentOptions {
  std::string file;
  std::vector<std::string> settings;  // "k=5"
  std::optional<std::string> method;
  std::vector<std::string> tolerances, absolute_tolerances;  // "1e-8", "y2=1e-10"
  std::optional<double> step, until, output;

  /// Nothing differs from what the model says: then its checks are meant for this run.
  bool as_written() const {
    return settings.empty() && !method && tolerances.empty() && absolute_tolerances.empty() && !step && !until &&
           !output;
  }
};

/// --set, --until and --output, which every such verb takes.
void add_experiment(CLI::App& verb, ExperimentOptions& options);
/// --tol and --atol, for all states or single ones.
void add_tolerances(CLI::App& verb, ExperimentOptions& options);
/// --method, --step, --tol and --atol.
void add_method(CLI::App& verb, ExperimentOptions& options);

/// A model made ready for a run, or how the verb ends without one; what is wrong has been said.
struct Prepared {
  ExitCode exit = done;
  model::Loaded loaded;
  std::shared_ptr<const model::ModelProgram> program;
  model::Experiment experiment;
};
Prepared prepare(const ExperimentOptions& options);

/// Messages of a run as people read them, on standard error.
void show(std::span<const model::Diagnostic> diagnostics, const model::Source& source);

}  // namespace continuo::app
