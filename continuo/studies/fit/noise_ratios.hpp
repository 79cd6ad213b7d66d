// Restricted likelihood and prior as a function of the ratios of unknown variances, and what the unknowns are where
// these are given.
//
// A source of noise is a column with its two components, of which at least one is not known, or one unknown component
// of one or of several columns. Axes are first the logarithms of the ratios of the columns with two kinds, then those
// of the sizes of the sources, over what they are estimated to be at that ratio. Where no variance at all is known, the
// size of one source is left out: it is the overall size that Student's t has integrated over. Internal to fit.
#pragma once
#include <Eigen/Dense>
#include <limits>
#include <span>
#include <vector>

#include <continuo/studies/fit/variance_components.hpp>

namespace continuo::studies::detail {

/// A column with two components. Ratios are logarithms of the second's size over the first's: 0 where they are as large
/// for a row in the midst of the column, whose factors have the ratio `unit`.
struct TwoKinds {
  std::size_t group, first, second;
  double unit, estimated;
  std::vector<double> centers;  // of the ratios that data can tell apart
};

/// The columns with two components that are not both known.
[[nodiscard]] std::vector<TwoKinds> columns_of_two_kinds(const VarianceComponents& noise);

/// An axis to integrate over: centers of where the integrand may be, and how far it changes about each.
struct RatioAxis {
  struct Center {
    double at, width;
  };
  std::vector<Center> centers;
  double estimated;
};

class NoiseRatios {
 public:
  NoiseRatios(const VarianceComponents& noise, const Uncertainty& sure, std::span<const double> residuals,
              std::span<const double> jacobian, std::span<const double> sizes, double accuracy,
              std::vector<TwoKinds> columns);

  [[nodiscard]] const std::vector<RatioAxis>& axes() const { return axes_; }
  [[nodiscard]] std::size_t sources() const { return sources_.size(); }

  /// Of restricted likelihood times prior, but for a constant.
  [[nodiscard]] double logarithm_at(std::span<const double> point) const;
  [[nodiscard]] GivenRatios given_at(std::span<const double> point) const;
  /// Without any ratios yet.
  [[nodiscard]] MixedRatios frame() const;

 private:
  struct Source {
    std::vector<std::size_t> components;
    double degrees = 0;
    double rows = 0;
  };
  /// Of the rows over their deviations.
  struct Solved {
    std::vector<double> variances;  // of the components
    Eigen::VectorXd of_rows;        // the variances of the rows
    Eigen::MatrixXd inverse, q;     // R^-1 and Q of the derivatives
    Eigen::VectorXd step;           // Q^T r
    double squares;                 // that are left
    double logarithm;               // of the determinant of R
  };

  void find_sources(const Uncertainty& sure);
  void add_source(std::vector<std::size_t> components, const Uncertainty& sure);
  void find_axes();
  [[nodiscard]] double size_of(const TwoKinds& column, double ratio) const;
  [[nodiscard]] std::vector<double> variances_at(std::span<const double> point) const;
  [[nodiscard]] Solved solved_at(std::span<const double> point) const;
  [[nodiscard]] double logarithm_of_prior(const Solved& solved) const;
  [[nodiscard]] double degrees() const { return static_cast<double>(augmented_.rows() - back_.cols()); }

  const VarianceComponents& noise_;
  std::vector<TwoKinds> columns_;
  std::vector<VarianceRow> rows_;  // that count
  Eigen::MatrixXd back_;           // from coordinates along which the rows are solved to unknowns
  Eigen::MatrixXd augmented_;      // derivatives of the rows along these, and residuals
  std::vector<Source> sources_;
  std::vector<std::size_t> source_of_;  // of each component
  std::vector<std::size_t> sizes_;      // the sources whose sizes are axes
  std::vector<RatioAxis> axes_;
  bool absolute_ = false;  // some variance is known: sizes are not relative to each other
};

}  // namespace continuo::studies::detail
