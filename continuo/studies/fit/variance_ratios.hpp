// Intervals where noise is of two kinds, constant and in proportion: few rows hardly tell the ratio of their variances.
//
// Student's t of the degrees at the estimated ratio takes that ratio for known; the expansion of Kenward and Roger is
// of first order in how far it may be off, which in columns of ten rows is anything between nothing and all. Given the
// ratio, the column has noise of one kind, and an unknown is distributed by Student's t as ever, about the estimate and
// with the deviation of that ratio. Over the ratios these are mixed in proportion to their restricted likelihood, times
// the reference prior, which is the root of the information about the ratio's logarithm and the same whatever else the
// ratio is measured by: J. O. Berger, J. M. Bernardo, "On the development of reference priors", Bayesian Statistics 4
// (1992); for variances K. Ye, "Bayesian reference prior analysis on the ratio of variances for the balanced one-way
// random effect model", J. Stat. Plan. Inference 41 (1994). Averaged over that prior 95 of 100 intervals hold the
// truth, exactly for linear models. Internal to fit.
#pragma once
#include <span>

#include <continuo/studies/fit/variance_components.hpp>

namespace continuo::studies::detail {

/// Student's t about `shift` times `deviation`, as likely as `weight` says.
struct ShiftedT {
  double weight, shift, deviation, degrees;
};

/// Half the interval about zero that holds 95 % of such a mixture; not a number where there is none. `guess` is
/// positive and about as large.
double half_width_of(std::span<const ShiftedT> mixture, double guess);

/// Sets the factors and the ratios of `sure`, or says that it failed, where columns have two components that are not
/// both known, and few enough rows for that to matter. Residuals are those of the fit, of squares, the variances those
/// of restricted likelihood.
void widen_by_ratios(Uncertainty& sure, const VarianceComponents& noise, std::span<const double> residuals,
                     std::span<const double> jacobian, std::span<const double> sizes, double accuracy);

}  // namespace continuo::studies::detail
