// A fit as least squares: the runs of a model along its measurements, residuals over their deviations, and derivatives
// on the scale on which each unknown is looked for. Internal to fit.
#pragma once
#include <cmath>
#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include <continuo/studies/fit.hpp>
#include <continuo/studies/sensitivity.hpp>

namespace continuo::studies::detail {

/// One set of measurements and the model's runs along it.
class FitPart {
 public:
  FitPart(const FitRequest& request, const FitData& data);

  /// The values of every column, then their derivatives by the unknowns, at each of `times`.
  struct Values {
    std::vector<double> times;
    std::vector<double> numbers;
    bool good = false;
  };
  [[nodiscard]] Values at(std::span<const double> unknowns, const std::vector<double>& times,
                          const std::vector<double>& increments, SensitivityRun* whole = nullptr) const;

  [[nodiscard]] const std::vector<double>& times() const { return times_; }
  [[nodiscard]] const FitData& data() const { return data_; }
  /// A quantity that jumps at impacts; empty: none.
  [[nodiscard]] std::string jumping_quantity() const;

 private:
  const FitRequest& request_;
  const FitData& data_;
  SensitivityStudy study_;
  std::vector<std::size_t> states_, places_;
  std::size_t quantities_ = 0;
  SensitivityStudy::Along along_;
  std::vector<double> times_;
};

/// A measured value: its row among the run's, and its column, counted within its set and over all sets.
struct Measured {
  std::size_t part, row, column, group;
  double value;
  double deviation;  // where a column of the data gives it
};

class FitProblem {
 public:
  explicit FitProblem(const FitRequest& request);

  /// Residuals over their deviations, at unknowns on the scale of the search.
  [[nodiscard]] bool evaluate(std::span<const double> p, std::span<double> residuals, std::span<double> rows);
  /// All that is to be least, but for where it starts: that is `start`, from the model where the request has none.
  [[nodiscard]] LeastSquares least_squares(std::span<const double> start);

  [[nodiscard]] std::size_t size() const { return measured_.size() + priors_.size(); }
  [[nodiscard]] const std::vector<Measured>& measured() const { return measured_; }
  [[nodiscard]] const std::vector<FitPart>& parts() const { return parts_; }
  [[nodiscard]] const VarianceComponents& noise() const { return noise_; }
  /// Shapes of the deviations (in proportion to what the model says) and their sizes, from residuals as `evaluate` gave
  /// them last. The answer is by what factor the deviations changed, at most; a factor common to all changes no weight
  /// where nothing is known beforehand, and is left out.
  [[nodiscard]] double update_noise(std::span<const double> residuals, std::span<const double> rows, Loss loss);
  /// As a fit has left it.
  void take_noise(VarianceComponents noise) {
    noise_ = std::move(noise);
    take_deviations();
  }
  /// Residuals and derivatives that were over the deviations of the search, in the units of the measurements.
  [[nodiscard]] std::vector<double> raw(std::span<const double> over_deviations, std::size_t width) const;
  /// What `raw` residuals say the model's value is; of lognormal noise its logarithm is compared.
  [[nodiscard]] double fitted(std::size_t measured, double raw_residual) const;
  /// The deviation of one measurement of a group where the model says `value` and components have these variances.
  [[nodiscard]] double deviation_at(std::size_t group, double value, std::span<const double> variances) const;
  [[nodiscard]] std::vector<double> noise_variances() const;
  [[nodiscard]] const FitColumn& column_of(std::size_t group) const { return *columns_[group].column; }
  /// The deviation of a group: its constant part, or the one in proportion to the value.
  [[nodiscard]] double constant_deviation(std::size_t group) const {
    const Column& column = columns_[group];
    return std::sqrt(noise_.components[column.components[0]].variance * column.pooled);
  }
  [[nodiscard]] double relative_deviation(std::size_t group) const {
    return std::sqrt(noise_.components[columns_[group].components[1]].variance);
  }

  [[nodiscard]] double to_search(std::size_t unknown, double value) const;
  [[nodiscard]] double from_search(std::size_t unknown, double p) const;
  [[nodiscard]] std::vector<double> from_search(std::span<const double> p) const;
  [[nodiscard]] FitPart::Values values(std::size_t part, std::span<const double> p, const std::vector<double>& times,
                                       SensitivityRun* whole = nullptr) const;
  /// Of a world, on the scale of the search.
  void set_increments(std::vector<double> increments) { increments_ = std::move(increments); }

 private:
  struct Column {
    const FitColumn* column;
    std::size_t components[2];
    double largest = 0;  // |value|
    double pooled = 1;   // the factor of its share in the deviation that short columns have in common
  };
  struct PriorRow {
    std::size_t unknown;
    FitPrior prior;
  };
  void add_column(const FitData& data, const FitColumn& column);
  void add_components();
  void shape(std::size_t measured, double value);
  void take_deviations();
  [[nodiscard]] bool prior_residual(const PriorRow& row, double p, double& residual, double& slope) const;

  const FitRequest& request_;
  std::vector<FitPart> parts_;
  std::vector<Column> columns_;
  std::vector<Measured> measured_;
  std::vector<PriorRow> priors_;
  VarianceComponents noise_;
  std::vector<double> deviations_;  // of each residual, as the search has them
  std::vector<double> increments_;
  std::vector<FitPart::Values> values_;
};

/// The model's quantity of this name, where it is no state.
[[nodiscard]] std::optional<model::NodeId> quantity_node(const model::Model& model, const std::string& name);

}  // namespace continuo::studies::detail
