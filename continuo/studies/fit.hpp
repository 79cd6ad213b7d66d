// Parameters and initial values of a model from measurements: least squares, or a loss that forgives outliers, with the
// model's exact sensitivities as derivatives.
//
//   const Fit result = fit({.program = program,
//                           .data = {{.measurements = *read, .columns = {{0, "x"}}}},
//                           .unknowns = {{{.index = model::find_parameter(program->model, "k")}}}});
//   if (result.found()) fmt::print("{} +- {}\n", result.estimates[0].value, result.half_width(0));
#pragma once
#include <cstddef>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <continuo/results/measurements.hpp>
#include <continuo/simulation/experiment.hpp>
#include <continuo/simulation/program/model_program.hpp>
#include <continuo/status/status.hpp>
#include <continuo/studies/fit/variance_components.hpp>
#include <continuo/studies/least_squares.hpp>
#include <continuo/studies/sensitivity/influence.hpp>

namespace continuo::studies {

/// How measurements of a column scatter about the model's value y: by one deviation; in proportion to y; both (the
/// squares add); as counts do, by the root of y; or in the logarithm, y times e^(normal noise).
enum class ErrorModel { constant, proportional, both, poisson, lognormal };
inline constexpr std::string_view error_model_names[] = {"constant", "proportional", "both", "poisson", "lognormal"};

/// Which quantity of the model (a state, output, let or energy) a column measures. Deviations that are not given are
/// estimated for each column of each file by itself; columns of fewer than `fewest_of_own_deviation` values share one
/// with the others that are as short, in proportion to the largest value of their quantity.
struct FitColumn {
  std::size_t column;  // of the measurements
  std::string quantity;
  std::optional<double> deviation{};  // of one measurement; of its logarithm where noise is lognormal
  ErrorModel error = ErrorModel::constant;
  std::optional<double> relative{};            // deviation over y, of proportional noise
  std::optional<std::size_t> deviations_in{};  // the column of the measurements with the deviation of each
};
inline constexpr std::size_t fewest_of_own_deviation = 5;

/// One set of measurements: a run of its own in the search.
struct FitData {
  results::Measurements measurements;
  std::vector<FitColumn> columns;
  model::Overrides parameters{};  // in this set only
};

/// What was known of an unknown before: normal about `center`, or with a normal logarithm about that of `center`.
struct FitPrior {
  /// The distribution of the prior.
  enum class Kind { normal, lognormal };
  Kind kind = Kind::normal;
  double center = 0, deviation = 1;
};

/// A parameter or an initial value that is searched for.
struct FitUnknown {
  Influence influence;
  std::optional<double> start{};  // else as the model has it
  double low = -std::numeric_limits<double>::infinity(), high = std::numeric_limits<double>::infinity();
  bool logarithmic = false;  // looked for in its logarithm: positive, with an interval of factors
  std::optional<FitPrior> prior{};
};

/// A model, its data, and its unknowns.
struct FitRequest {
  std::shared_ptr<const model::ModelProgram> program;
  std::vector<FitData> data;
  std::vector<FitUnknown> unknowns;
  model::Experiment experiment{};
  LeastSquaresOptions options{};
  /// By which unknown deviations are estimated: plain likelihood, as many programs do, makes them too small.
  Likelihood likelihood = Likelihood::restricted;
  /// Columns of one quantity have one deviation in all sets, unless it is given.
  bool one_deviation = false;
  /// Where one start was asked for and its end is doubtful, so many others are tried.
  std::size_t starts_in_doubt = 10;
};

/// The estimate of one unknown, in its unit.
struct FitEstimate {
  double value = 0;
  double deviation = 0;      // infinite where the data do not determine it, 0 at a bound
  double low = 0, high = 0;  // the 95 % interval
  double degrees = 0;  // of freedom of the deviation at the estimated variances; infinite where all noise is known
  bool at_bound = false, undetermined = false;
};

/// How one column of one set is met.
struct FitColumnResult {
  std::size_t data = 0, column = 0, values = 0;
  double degrees = 0;  // its values less what the unknowns take of them
  /// What the residuals scatter by, whatever was given: constant and relative part. NaN without degrees of freedom.
  double residual_deviation = 0, residual_deviation_relative = 0;
  bool given = false;             // the deviations were
  double ratio = 0;               // of what was met to what was given
  double chi_squared = 0, p = 0;  // where they were given
  double sum_of_squares = 0;      // in its unit; of logarithms where noise is lognormal
  double signs_p = 1;             // how likely residuals keep their sign for so long by chance
  std::vector<double> times{}, measured{}, fitted{}, deviations{}, residuals{}, weights{};
};

/// Numbers for the whole fit.
struct FitStatistics {
  std::size_t values = 0, free_unknowns = 0, estimated_variances = 0;
  double degrees = 0;
  std::optional<double> sum_of_squares{};                        // of columns of one quantity
  std::optional<double> chi_squared{}, chi_squared_p{};          // where all deviations were given
  std::optional<double> log_likelihood{}, aic{}, aicc{}, bic{};  // of squares: other losses have none
};

/// Why an end is to be doubted.
struct FitDoubt {
  /// What is doubtful.
  enum class Kind { not_converged, at_bound, residuals_too_large, signs, weights, better_start, undetermined };
  Kind kind;
  std::string text;
};
inline constexpr std::string_view doubt_names[] = {"not converged", "at bound",     "residuals too large", "signs",
                                                   "weights",       "better start", "undetermined"};

/// One quantity of one set along time, with the band in which 95 % of new measurements are expected.
struct FitCurve {
  std::size_t data, column;
  std::vector<double> t, y, low, high;
};

/// The result of a fit.
struct Fit {
  LeastSquaresResult least;  // on the scale of the search: in logarithms where an unknown is looked for in its own
  Uncertainty sure;          // on that scale
  VarianceComponents noise;  // of the measurements, one after the other, and of priors
  std::vector<FitEstimate> estimates;
  std::vector<FitColumnResult> columns;  // one set after the other
  FitStatistics statistics;
  std::vector<FitDoubt> doubts;
  std::size_t runs = 0;
  std::vector<model::Diagnostic> diagnostics;
  Status status;  // a failure where there is no fit; of data, the message begins with "file:line: "

  /// Whether there is a fit.
  [[nodiscard]] bool found() const { return least.found; }
  /// Of the 95 % confidence interval.
  [[nodiscard]] double half_width(std::size_t unknown) const {
    return (estimates[unknown].high - estimates[unknown].low) / 2;
  }
  /// Whether there is a doubt of this kind.
  [[nodiscard]] bool doubts_of(FitDoubt::Kind kind) const {
    for (const FitDoubt& doubt : doubts)
      if (doubt.kind == kind) return true;
    return false;
  }
};

/// The method of the runs is chosen by size and tolerance, which is at most this: the steps of the search are small,
/// and the runs must not be noise to it.
inline constexpr double greatest_rtol_of_fit = 1e-8;
/// Some hundred roundings of a double: with less, steps become ever shorter and nothing more exact.
inline constexpr double least_rtol_of_fit = 1e-14;

/// Searches for the unknowns. Each evaluation is a run of the model with sensitivities for each set of data. Where
/// there is no fit, `status` or `diagnostics` has the reason.
[[nodiscard]] Fit fit(const FitRequest& request);

/// The fitted model along time. `points` per curve.
[[nodiscard]] std::vector<FitCurve> curves_of(const FitRequest& request, const Fit& fit, std::size_t points = 400);

/// How much worse the best fit becomes where one unknown is held elsewhere: chi squared's rise (of one degree, over the
/// deviations that the fit found), and the values at which it is as large as an interval of 95 % allows.
struct Profile {
  std::size_t unknown;
  double low, high;  // infinite where the data set no limit
  bool low_is_bound = false, high_is_bound = false;
  double threshold = 0;               // of the rise
  std::vector<double> values, rises;  // ascending
  bool better = false;                // somewhere the fit was better than the one that was found
};
/// The profiles of all unknowns. Each value of a profile is another fit of the other unknowns.
[[nodiscard]] std::vector<Profile> profiles_of(const FitRequest& request, const Fit& fit);

/// Names a column may have: states, outputs, lets and energies.
[[nodiscard]] std::vector<std::string> quantities_of(const model::Model& model);

}  // namespace continuo::studies
