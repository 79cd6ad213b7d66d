// The variance of measurements, and the resulting uncertainty of the fitted unknowns.
//
// Residuals r with derivatives J by the unknowns have variances that are sums of components, v_i = sum_k theta_k d_ik:
// one for each column of constant noise, d = y^2 for noise in proportion to y, two of them for both. Those that are not
// known are estimated by restricted maximum likelihood: every column pays for the degrees of freedom that the unknowns
// take from it, and no more. Of one component it is the familiar s^2 = r^T r/(n - m).
//
//   VarianceComponents noise{.rows = ..., .components = {{.variance = 1}}};
//   estimate_variances(noise, residuals, jacobian, Loss::squares);
//   const Uncertainty sure = uncertainty(noise, residuals, jacobian, Loss::squares);
//   fmt::print("+- {}\n", std::sqrt(sure.covariance[0]) * student_t_quantile(0.95, sure.degrees[0]));
#pragma once
#include <array>
#include <cstddef>
#include <limits>
#include <span>
#include <string_view>
#include <vector>

#include <continuo/studies/fit/robust_loss.hpp>

namespace continuo::studies {

struct VarianceComponent {
  double variance = 1;  // theta
  bool known = false;
  double least = 0;  // below which it is not taken
};

struct VarianceRow {
  struct Share {
    std::size_t component;
    double factor;  // d
  };
  std::array<Share, 2> shares{{{0, 1}, {0, 0}}};
  std::size_t group = 0;  // the column; prior_group for what is no measurement
  bool counts = true;     // false: it has no noise, and says nothing of any
};
inline constexpr std::size_t prior_group = std::numeric_limits<std::size_t>::max();

struct VarianceComponents {
  std::vector<VarianceRow> rows;
  std::vector<VarianceComponent> components;
  std::size_t groups = 1;

  [[nodiscard]] double variance(std::size_t row) const {
    double sum = 0;
    for (const auto& share : rows[row].shares) sum += components[share.component].variance * share.factor;
    return sum;
  }
};

/// Restricted: unbiased by the unknowns that were fitted. Plain maximum likelihood is what AIC and BIC are of.
enum class Likelihood { restricted, plain };
inline constexpr std::string_view likelihood_names[] = {"restricted", "plain"};

/// Sets the variances of the components that are not known. With a loss other than squares outliers count little.
void estimate_variances(VarianceComponents& noise, std::span<const double> residuals, std::span<const double> jacobian,
                        Loss loss, Likelihood likelihood = Likelihood::restricted);

inline constexpr double interval_confidence = 0.95;

/// Half an interval of that confidence over a deviation with so many degrees of freedom; infinite without any.
[[nodiscard]] double interval_factor(double degrees);

/// What is known where the ratios of the unknown variances are given, and how likely these ratios are. Covariance and
/// variances are those of the overall size that is estimated with them, where all noise has one.
struct GivenRatios {
  double weight = 0;                       // of all that were looked at
  std::vector<double> shift, covariance;   // of the unknowns, from the estimate
  std::vector<std::vector<double>> parts;  // of the covariance, by the source of noise that it comes from
  std::vector<double> variances_of_components;
};

/// The distribution of the ratios of the variances, as variance_ratios.hpp integrates over it.
struct MixedRatios {
  std::vector<GivenRatios> given;
  double degrees = std::numeric_limits<double>::infinity();  // of the overall size; infinite where there is none
  std::vector<double> powers;                                // of each source of noise, in the prior
  std::vector<std::size_t> source_of;                        // of each column; no_source where its noise is known
  [[nodiscard]] bool empty() const { return given.empty(); }
};
inline constexpr std::size_t no_source = std::numeric_limits<std::size_t>::max();

struct Uncertainty {
  std::vector<double> covariance;  // row by row; of what the data do not determine: infinite on the diagonal, else 0
  std::vector<double> determined_covariance;  // along the moves that are determined: for what depends on these alone
  std::vector<double> degrees;  // of freedom of each unknown's deviation; infinite where all noise is known
  /// Half an interval of 95 % over the deviation: Student's t of so many degrees, unless variance_ratios.hpp says more.
  std::vector<double> factors;
  std::vector<double> logarithms_covariance;  // of the logarithms of the variances that are not known, row by row
  std::vector<char> undetermined;
  /// Moves of the unknowns that change no residual, each with its largest entry 1, in units of |p| (or of 1 where p =
  /// 0).
  std::vector<std::vector<double>> directions;
  std::vector<double> group_degrees;  // n - leverage of each column
  std::vector<double> group_ratio;    // of each column: the deviation that is seen over the one that the noise has
  MixedRatios ratios;                 // that factors were integrated over; empty: none is to be, or columns are long
  bool ratios_failed = false;         // they had to be, and could not: factors take the estimated ratios for known
  /// What a robust loss makes of variances that were those of squares; 2 (cost - least cost) over `rise` is chi
  /// squared.
  double dispersion = 1, rise = 1;
};

/// `sizes` of the unknowns say in which units `directions` are; `accuracy` is that of the Jacobian: what its columns
/// differ by less than that from a linear combination of the others is no information.
[[nodiscard]] Uncertainty uncertainty(const VarianceComponents& noise, std::span<const double> residuals,
                                      std::span<const double> jacobian, Loss loss, std::span<const double> sizes,
                                      double accuracy = 1e-12);

}  // namespace continuo::studies
