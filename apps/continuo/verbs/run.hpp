// The verb run, whose families of solutions only one of the two programs can compute.
#pragma once
#include <cstdint>
#include <functional>
#include <string>

#include <CLI/App.hpp>
#include <apps/continuo/options/experiment_options.hpp>
#include <apps/continuo/runs/run_results.hpp>
#include <apps/continuo/terminal/exit_codes.hpp>

#include <continuo/boundary/boundary_of_model.hpp>

namespace continuo::app {

/// Shows the families of solutions over a range of a parameter: studies/boundary_families.hpp.
using ShowFamilies =
    std::function<ExitCode(const Prepared&, const boundary::BoundaryRequest&,
                           const boundary::BoundaryRequest::Along& range, const std::string& of, const RunOutputs&)>;

/// Writes the scene of a model as a film.
using WriteFilm = std::function<ExitCode(const ExperimentOptions&, const std::string& path)>;

/// That of the view: view.cpp.
ExitCode film(const ExperimentOptions& experiment, const std::string& path);

/// Gives the experiment the values of one run of the model's sweep: studies/run_of_sweep.hpp.
using TakeSweepRun = std::function<ExitCode(Prepared& prepared, std::uint64_t run)>;

/// What only one of the two programs can do is empty in the other one, which never parses the words for it
/// (program_for).
struct RunParts {
  ShowFamilies show_families{};
  WriteFilm write_film{};
  TakeSweepRun take_sweep_run{};
};
void add_run(CLI::App& app, ExitCode& exit, RunParts parts);

}  // namespace continuo::app
