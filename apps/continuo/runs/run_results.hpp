// What every verb does with a run that it has: files, pictures, a summary, how it ended.
#pragma once
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <CLI/App.hpp>
#include <apps/continuo/options/experiment_options.hpp>
#include <apps/continuo/runs/motion_table.hpp>
#include <apps/continuo/terminal/exit_codes.hpp>

#include <continuo/results/figure.hpp>
#include <continuo/results/motion_curves.hpp>
#include <continuo/simulation/simulate.hpp>

namespace continuo::app {

struct RunOutputs {
  std::string motion{}, events{}, plot{}, manifest{};  // files; empty: not wanted
  std::vector<std::string> plot_texts{};               // what --plot says besides: plot_text.hpp
  results::PictureSize size{};                         // of the plot
  bool json = false, no_sketch = false;

  /// How many of them are for standard output.
  int to_standard_output() const { return json + (motion == "-") + (events == "-") + (manifest == "-"); }
  bool data_to_standard_output() const { return to_standard_output() > 0; }
};
/// -o, --events, --plot, --size, --no-sketch, --manifest and --json.
void add_outputs(CLI::App& verb, RunOutputs& outputs);
/// Whether a picture moves, by its ending.
bool moves(const std::string& picture);
/// Whether a picture of the motion is wanted: in a file, or small in the terminal.
bool wants_picture(const RunOutputs& outputs);
/// The curves of the picture that is wanted; null where none is, nothing where the text of --plot is wrong.
std::optional<std::unique_ptr<results::MotionCurves>> curves_for(const RunOutputs& outputs, const Prepared& prepared);
/// Said before a long run, not after it.
bool can_be_written(const RunOutputs& outputs);
/// The files of a run that was ended before its time have the names of unfinished ones; the table is not among these.
RunOutputs unfinished(RunOutputs outputs);
/// Where the manifest goes: as asked, or beside the table; empty for nowhere.
std::string manifest_file(const RunOutputs& outputs);
/// Whether something is asked for that is made of all rows together.
bool needs_rows(const RunOutputs& outputs);

/// Writes and prints what is wanted. Checks are meant for a run as its model is written.
/// `motion`: the table of -o as it was written during the run. `curves`: those of the motion, where somebody has
/// followed them; else the picture shows the rows.
ExitCode tell(const model::Simulated& simulated, const model::Source& source, const model::ModelProgram& program,
              const RunOutputs& outputs, bool as_written, MotionTable& motion, results::MotionCurves* curves = nullptr);

}  // namespace continuo::app
