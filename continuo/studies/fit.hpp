// Parameters and initial values of a model from measurements: least squares, or a loss that forgives outliers, with the
// model's exact sensitivities as derivatives.
//
//   const Fit result = fit({.program = program,
//                           .data = {{.measurements = read.measurements, .columns = {{0, "x"}}}},
//                           .unknowns = {{{.index = model::find_parameter(program->model, "k")}}}});
//   if (result.found()) fmt::print("{} +- {}\n", result.least.p[0], result.half_width(0));
#pragma once
#include <cstddef>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <continuo/model/experiment.hpp>
#include <continuo/model/model_program.hpp>
#include <continuo/studies/influence.hpp>
#include <continuo/studies/least_squares.hpp>
#include <continuo/studies/measurements.hpp>

namespace continuo::studies {

/// Which quantity of the model (a state, output, let or energy) a column measures.
struct FitColumn {
  std::size_t column;  // of the measurements
  std::string quantity;
  std::optional<double> deviation{};  // of one measurement; else it is estimated, for each column
};

struct FitData {
  Measurements measurements;
  std::vector<FitColumn> columns;
  model::Overrides parameters{};  // in this set only
};

struct FitUnknown {
  Influence influence;
  std::optional<double> start{};  // else as the model has it
  double low = -std::numeric_limits<double>::infinity(), high = std::numeric_limits<double>::infinity();
};

struct FitRequest {
  std::shared_ptr<const model::ModelProgram> program;
  std::vector<FitData> data;
  std::vector<FitUnknown> unknowns;
  model::Experiment experiment{};
  LeastSquaresOptions options{};
};

/// One quantity of one set along time, with the band in which 95 % of new measurements are expected.
struct FitCurve {
  std::size_t data, column;
  std::vector<double> t, y, half_width;
};

struct Fit {
  LeastSquaresResult least;
  std::vector<double> scales;    // the residual deviation of each column of each set, one set after the other
  double confidence_factor = 0;  // Student's t for 95 %
  std::vector<model::Diagnostic> diagnostics;
  std::string problem;  // why there is no fit, or "file:line: ..."; else empty

  bool found() const { return least.found; }
  /// Of the 95 % confidence interval.
  double half_width(std::size_t unknown) const { return confidence_factor * least.deviation(unknown); }
};

/// The method of the runs is chosen by size and tolerance, which is at most this: the steps of the search are small,
/// and the runs must not be noise to it.
inline constexpr double greatest_rtol_of_fit = 1e-8;

Fit fit(const FitRequest& request);

/// The fitted model along time. `points` per curve.
std::vector<FitCurve> curves_of(const FitRequest& request, const Fit& fit, std::size_t points = 400);

/// Names a column may have: states, outputs, lets and energies.
std::vector<std::string> quantities_of(const model::Model& model);

}  // namespace continuo::studies
