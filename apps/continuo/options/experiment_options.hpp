// apps/continuo/options/experiment_options.hpp
// The options that change what the model's `run` statement asks for, shared by every verb that runs models.
#pragma once
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <CLI/App.hpp>
#include <apps/continuo/options/models.hpp>
#include <apps/continuo/options/sweep_words.hpp>
#include <apps/continuo/terminal/exit_codes.hpp>
#include <apps/continuo/terminal/progress.hpp>

#include <continuo/language/load.hpp>
#include <continuo/simulation/experiment.hpp>
#include <continuo/simulation/program/model_program.hpp>

namespace continuo::app {

struct ExperimentOptions {
  std::string file;
  std::vector<std::string> settings;  // "k=5"
  std::vector<std::string> initial;   // "x=3"
  std::string initial_from;           // "other.csv", "other.csv@2.5"
  std::optional<std::string> method;
  std::vector<std::string> tolerances, absolute_tolerances;  // "1e-8", "y2=1e-10"
  std::optional<double> step, until, output, max_step;
  std::optional<std::size_t> max_steps;
  std::string native = "auto";  // "auto", "always", "fused", "never"
  SweepWords sweep;

  /// The motion is the one that the model describes, by its own method: then its checks are meant for this run. Which
  /// rows of it are wanted makes no difference.
  bool as_written() const {
    return settings.empty() && initial.empty() && initial_from.empty() && !method && tolerances.empty() &&
           absolute_tolerances.empty() && !step && !until && !max_step && !max_steps;
  }
};

/// Whether fused operations were asked for, and some of the machine code could not be made, which has been said then.
[[nodiscard]] bool lacks_fused_code(const model::Model& model);

/// The model's file and --set.
void add_model(CLI::App& verb, ExperimentOptions& options);
/// These and --until and --output, for verbs with a run of their own.
void add_experiment(CLI::App& verb, ExperimentOptions& options);
/// --initial and --initial-from.
void add_initial(CLI::App& verb, ExperimentOptions& options);
/// An option that other verbs have and this one cannot: it says why, where the name alone would be called unknown.
void refuse_option(CLI::App& verb, const std::string& name, const std::string& why);
/// --tol and --atol, for all states or single ones.
void add_tolerances(CLI::App& verb, ExperimentOptions& options);
/// --method, --step, --tol and --atol.
void add_method(CLI::App& verb, ExperimentOptions& options);
/// --max-step and --max-steps, after those.
void add_limits(CLI::App& verb, ExperimentOptions& options);

/// A model made ready for a run, or how the verb ends without one; what is wrong has been said.
struct Prepared {
  ExitCode exit = done;
  model::Loaded loaded;
  std::shared_ptr<const model::ModelProgram> program;
  model::Experiment experiment;
  bool decides_size = false;  // the parameters that were set
};
/// Verbs that study equations refuse a world of bodies.
enum class Worlds { refused, welcome };
Prepared prepare(const ExperimentOptions& options, Worlds worlds = Worlds::refused);

/// "spring.sim:3": where something of the model stands.
std::string place_text(const Prepared& prepared, const model::Span& span);

/// Whether its conditions stand at several times: for verbs that follow motions from a start, who then say so.
bool has_no_start(const Prepared& prepared);

/// What the experiment calls on its way, with the time that is left.
std::function<void(double)> watcher_of(const Prepared& prepared, Progress& progress);

}  // namespace continuo::app
