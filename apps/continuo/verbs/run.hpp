// The verb run, whose families of solutions only one of the two programs can compute.
#pragma once
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

/// `show_families` is empty in the program that never parses --family (program_for), and `write_film` in the other one.
void add_run(CLI::App& app, ExitCode& exit, ShowFamilies show_families, WriteFilm write_film);

}  // namespace continuo::app
