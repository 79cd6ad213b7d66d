// Intervals where noise is of two kinds, constant and in proportion: few rows hardly tell the ratio of their variances,
// and those of several columns hardly tell which column is the better one.
//
// Student's t of the degrees at the estimated ratios takes these for known; the expansion of Kenward and Roger is of
// first order in how far they may be off, which in columns of ten rows is anything between nothing and all. Given the
// ratios of all unknown variances to each other, one size is not known, and an unknown is distributed by Student's t of
// N - m degrees, about the estimate and with the deviation of these ratios; where some variance is known, sizes are
// integrated over like ratios, and it is normal. These are mixed in proportion to restricted likelihood times a prior.
//
// Of one column the prior is the reference prior, the root of the information about the ratio's logarithm, of several
// the root of the determinant of the information about all of them: it is the same whatever else ratios are measured
// by. J. O. Berger, J. M. Bernardo, "On the development of reference priors", Bayesian Statistics 4 (1992); for
// variances K. Ye, "Bayesian reference prior analysis on the ratio of variances for the balanced one-way random effect
// model", J. Stat. Plan. Inference 41 (1994). Averaged over it 95 of 100 intervals hold the truth.
//
// Of several columns that is an average over ratios of sizes that are mostly extreme; where columns are as good as each
// other fewer hold it. For estimates of one unknown from several sources with variances V_s of d_s degrees, weighted by
// their estimates, V = 1/sum 1/V_s and e_s = V/V_s: they vary by V + L, L = 2 V sum e_s (1 - e_s)/d_s, while V at the
// estimates has the mean V - L (R. N. Kackar, D. A. Harville, J. Am. Stat. Assoc. 79 (1984); Kenward and Roger). The
// posterior variance with a prior pi is V at the estimates, plus 2 V sum e_s (d log pi/d log V_s + 1)/d_s by skewness
// and prior, less L by the bend of V, plus L by the estimate's moving with the weights; of that the effect of V's own
// variance on Student's t, 2 V sum e_s^2/d_s, is to remain over. The means agree where
//
//   sum e_s (d log pi/d log V_s - (1 - e_s))/d_s = 0,   as for pi = (prod V_s)/V,
//
// that is V_1 + V_2 for two. In other designs V_s is V^2 over the part of V that comes from the source, which here is
// the same. Terms of second order in 1/d are not derived: V_s has the power 1 + 2/d_s, whose 2 was chosen for coverage
// (bench/RESULTS.md). The prior depends on what is asked about. Internal to fit.
#pragma once
#include <span>
#include <vector>

#include <continuo/studies/fit/variance_components.hpp>

namespace continuo::studies::detail {

/// Student's t about `shift` times `deviation`, as likely as `weight` says.
struct ShiftedT {
  double weight, shift, deviation, degrees;
};

/// Half the interval about zero that holds 95 % of such a mixture; not a number where there is none. `guess` is
/// positive and about as large.
[[nodiscard]] double half_width_of(std::span<const ShiftedT> mixture, double guess);

/// What is asked about where ratios are given: an unknown, a combination of them, a measurement.
struct Seen {
  double shift, variance;
  std::vector<double> parts;  // of the variance, by the source of noise
};

/// Of a combination of the unknowns with these slopes.
[[nodiscard]] Seen seen_along(const GivenRatios& given, std::span<const double> slopes);

/// One of each of the ratios.
[[nodiscard]] std::vector<ShiftedT> mixture_of(const MixedRatios& ratios, std::span<const Seen> seen);

/// Sets the factors and the ratios of `sure`, or says that it failed, where columns have two components that are not
/// both known, and few enough rows for that to matter. Residuals are those of the fit, of squares, the variances those
/// of restricted likelihood.
void widen_by_ratios(Uncertainty& sure, const VarianceComponents& noise, std::span<const double> residuals,
                     std::span<const double> jacobian, std::span<const double> sizes, double accuracy);

}  // namespace continuo::studies::detail
