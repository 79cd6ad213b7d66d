// What every verb does with a run that it has: files, pictures, a summary, how it ended.
#pragma once
#include <string>

#include <CLI/App.hpp>
#include <apps/continuo/runs/motion_table.hpp>
#include <apps/continuo/terminal/exit_codes.hpp>

#include <continuo/simulation/simulate.hpp>

namespace continuo::app {

struct RunOutputs {
  std::string motion{}, events{}, plot{}, manifest{};  // files; empty: not wanted
  bool json = false;

  /// How many of them are for standard output.
  int to_standard_output() const { return json + (motion == "-") + (events == "-") + (manifest == "-"); }
  bool data_to_standard_output() const { return to_standard_output() > 0; }
};
/// -o, --events, --plot, --manifest and --json.
void add_outputs(CLI::App& verb, RunOutputs& outputs);
/// Said before a long run, not after it.
bool can_be_written(const RunOutputs& outputs);
/// Where the manifest goes: as asked, or beside the table; empty for nowhere.
std::string manifest_file(const RunOutputs& outputs);
/// Whether something is asked for that is made of all rows together.
bool needs_rows(const RunOutputs& outputs);

/// Writes and prints what is wanted. Checks are meant for a run as its model is written.
ExitCode tell(const model::Simulated& simulated, const model::Source& source, const model::ModelProgram& program,
              const RunOutputs& outputs, bool as_written);

/// The same, with the table of -o as it was written during the run.
ExitCode tell(const model::Simulated& simulated, const model::Source& source, const model::ModelProgram& program,
              const RunOutputs& outputs, bool as_written, MotionTable& motion);

}  // namespace continuo::app
