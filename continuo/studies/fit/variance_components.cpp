// Estimates components of variance from residuals, and the uncertainty that they leave.
#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <vector>

#include <continuo/studies/fit/decomposed_rows.hpp>
#include <continuo/studies/fit/student_t.hpp>
#include <continuo/studies/fit/variance_components.hpp>

namespace continuo::studies {

namespace {

using Dense = Eigen::MatrixXd;
using Column = Eigen::VectorXd;
using Index = Eigen::Index;
using detail::Decomposed;
using detail::decomposed;

/// A row as a column. A matrix without columns has no data to point to.
Column row_of(const Dense& matrix, std::size_t row) {
  return matrix.cols() == 0 ? Column(0) : Column(matrix.row(static_cast<Index>(row)).transpose());
}

/// What part of a row's variance is a component's.
double share_of(const VarianceComponents& noise, std::size_t row, const VarianceRow::Share& share) {
  return noise.components[share.component].variance * share.factor / noise.variance(row);
}

/// Of the residuals in units of their deviation, outliers counted as in Huber's proposal 2, which is unbiased on normal
/// noise: psi^2 with psi cut off at 1.5, over the mean of that. P. J. Huber, "Robust Statistics" (1981), 6.7.
double counted_square(double u, bool robust) {
  constexpr double cut = 1.5, mean = 0.778465;  // E min(u^2, cut^2) of a normal u
  return robust ? std::min(u * u, cut * cut) / mean : u * u;
}

/// The median of a group's |r| over its shape, as the deviation of normal noise with that median. Where proposal 2
/// starts.
void start_robustly(VarianceComponents& noise, std::span<const double> residuals, std::span<const double> leverage) {
  for (std::size_t k = 0; k < noise.components.size(); ++k) {
    if (noise.components[k].known) continue;
    std::vector<double> sizes;
    double free = 0;
    for (std::size_t r = 0; r < noise.rows.size(); ++r) {
      const VarianceRow& row = noise.rows[r];
      if (!row.counts) continue;
      if (std::ranges::none_of(row.shares, [&](const auto& s) { return s.component == k && s.factor != 0; })) continue;
      sizes.push_back(std::abs(residuals[r]) / std::sqrt(noise.variance(r)));
      free += 1 - leverage[r];
    }
    if (sizes.empty()) continue;
    const auto middle = sizes.begin() + static_cast<std::ptrdiff_t>(sizes.size() / 2);
    std::ranges::nth_element(sizes, middle);
    const double count = static_cast<double>(sizes.size());
    const double deviation = 1.4826 * *middle * std::sqrt(count / std::max(free, 1.0));
    if (deviation > 0) noise.components[k].variance *= deviation * deviation;
  }
}

}  // namespace

// The equation of restricted maximum likelihood for theta_k, sum_i u_ik r_i^2/v_i = sum_i u_ik (1 - h_i), u_ik being
// the component's part of v_i and h_i the leverage of the row: the ratio of its sides is what theta_k is multiplied by.
// Of rows with one component that is the answer at once but for the leverages; of rows with two its square root
// converges: H. Zhou, L. Hu, J. Zhou, K. Lange, "MM algorithms for variance components models", J. Comp. Graph. Stat.
// 28 (2019).
void estimate_variances(VarianceComponents& noise, std::span<const double> residuals, std::span<const double> jacobian,
                        Loss loss, Likelihood likelihood) {
  const std::size_t n = noise.rows.size(), count = noise.components.size();
  if (std::ranges::all_of(noise.components, &VarianceComponent::known)) return;
  std::vector<char> mixed(count, 0);
  for (const VarianceRow& row : noise.rows)
    if (row.shares[1].factor != 0 && row.group != prior_group)
      for (const auto& share : row.shares) mixed[share.component] = 1;
  const bool restricted = likelihood == Likelihood::restricted, robust = loss != Loss::squares;
  std::vector<double> leverage(n, 0);
  const auto find_leverage = [&] {
    if (!restricted) return;
    const Column found = decomposed(noise, jacobian, 1e-12).leverage;
    leverage.assign(found.begin(), found.end());
  };
  find_leverage();
  if (robust) start_robustly(noise, residuals, leverage);
  constexpr int most_rounds = 500;
  for (int round = 0; round < most_rounds; ++round) {
    std::vector<double> seen(count, 0), expected(count, 0);
    for (std::size_t r = 0; r < n; ++r) {
      if (!noise.rows[r].counts) continue;
      const double square = counted_square(residuals[r] / std::sqrt(noise.variance(r)), robust);
      for (const auto& share : noise.rows[r].shares) {
        const double part = share_of(noise, r, share);
        seen[share.component] += part * square;
        expected[share.component] += part * (1 - leverage[r]);
      }
    }
    double change = 0;
    for (std::size_t k = 0; k < count; ++k) {
      VarianceComponent& component = noise.components[k];
      // A column that the unknowns take up whole says nothing of its noise.
      constexpr double nothing = 1e-6;
      if (component.known || !(expected[k] > nothing)) continue;
      const double ratio = seen[k] / expected[k], before = component.variance;
      component.variance = std::max(before * (mixed[k] ? std::sqrt(ratio) : ratio), component.least);
      if (component.variance > 0) change = std::max(change, std::abs(component.variance - before) / component.variance);
    }
    if (change < 1e-6) break;
    find_leverage();
  }
}

double interval_factor(double degrees) {
  // With fewer, Student's t has no width that says anything.
  constexpr double fewest = 0.5, many = 1e9;
  return degrees < fewest ? std::numeric_limits<double>::infinity()
                          : student_t_quantile(interval_confidence, std::min(degrees, many));
}

namespace {

/// By how much a robust loss widens what least squares would give for variances of 1: Huber's estimate with its
/// correction for few rows, K^2 [sum psi^2/(n - m)]/[mean psi']^2, K = 1 + m/n var(psi')/(mean psi')^2.
/// P. J. Huber, "Robust Statistics" (1981), eq. 7.6.
struct Dispersion {
  std::vector<double> slope, square;  // of each group: the mean of psi', sum psi^2/(n - h)
  double correction = 1;              // K
  double mean_slope = 1;              // of all
};

Dispersion dispersion_of(const VarianceComponents& noise, std::span<const double> residuals,
                         const std::vector<double>& group_degrees, Loss loss, double rank) {
  Dispersion result{.slope = std::vector<double>(noise.groups, 0), .square = std::vector<double>(noise.groups, 0)};
  std::vector<double> count(noise.groups, 0);
  double slope = 0, slope_square = 0, square = 0, all = 0, degrees = 0;
  for (std::size_t r = 0; r < noise.rows.size(); ++r) {
    const std::size_t g = noise.rows[r].group;
    if (g == prior_group || !noise.rows[r].counts) continue;
    const double u = residuals[r] / std::sqrt(noise.variance(r));
    const double bend = slope_of(loss, u), psi = weight_of(loss, u) * u;
    result.slope[g] += bend, result.square[g] += psi * psi, count[g] += 1;
    slope += bend, slope_square += bend * bend, square += psi * psi, all += 1;
  }
  for (const double d : group_degrees) degrees += d;
  slope /= all;
  result.mean_slope = slope;
  result.correction = 1 + rank / all * std::max(slope_square / all - slope * slope, 0.0) / (slope * slope);
  for (std::size_t g = 0; g < noise.groups; ++g) {
    // Short columns cannot tell their own; all together they can.
    constexpr double enough = 10;
    const bool alone = group_degrees[g] >= enough && result.slope[g] > 0;
    result.square[g] = alone ? result.square[g] / group_degrees[g] : square / std::max(degrees, 1e-9);
    result.slope[g] = alone ? result.slope[g] / count[g] : slope;
  }
  return result;
}

/// The information of restricted likelihood on the logarithms of the unknown components' variances, and with it how far
/// the variances being estimates widens and blurs the deviations of the unknowns.
struct Estimated {
  std::vector<Dense> moments;  // M_k = sum_i u_ik q_i q_i^T, of the components that are not known
  Dense widths;                // W, the covariance of log theta
  Dense widening;              // of the covariance along q
};

// M. G. Kenward, J. H. Roger, "Small sample inference for fixed effects from restricted maximum likelihood", Biometrics
// 53 (1997), for diagonal components, in coordinates in which the covariance of the unknowns is 1: P_k = -M_k, Q_kl =
// sum_i u_ik u_il q_i q_i^T, and the information (1/2) [sum_i u_ik u_il (1 - 2 h_i) + tr(M_k M_l)].
Estimated estimated(const VarianceComponents& noise, const Decomposed& parts) {
  std::vector<std::size_t> place(noise.components.size(), 0);
  std::size_t count = 0;
  for (std::size_t k = 0; k < place.size(); ++k) place[k] = noise.components[k].known ? prior_group : count++;
  const Index rank = parts.q.cols(), size = static_cast<Index>(count);
  Estimated result{.moments = std::vector<Dense>(count, Dense::Zero(rank, rank)),
                   .widths = Dense::Zero(size, size),
                   .widening = Dense::Zero(rank, rank)};
  if (count == 0) return result;
  std::vector<Dense> pairs(count * count, Dense::Zero(rank, rank));
  Dense information = Dense::Zero(size, size);
  for (std::size_t r = 0; r < noise.rows.size(); ++r) {
    if (!noise.rows[r].counts) continue;
    const Column row = row_of(parts.q, r);
    const double h = parts.leverage[static_cast<Index>(r)];
    for (const auto& a : noise.rows[r].shares) {
      const std::size_t k = place[a.component];
      if (k == prior_group || a.factor == 0) continue;
      const double u = share_of(noise, r, a);
      result.moments[k].noalias() += u * row * row.transpose();
      for (const auto& b : noise.rows[r].shares) {
        const std::size_t l = place[b.component];
        if (l == prior_group || b.factor == 0) continue;
        const double both = u * share_of(noise, r, b);
        pairs[k * count + l].noalias() += both * row * row.transpose();
        information(static_cast<Index>(k), static_cast<Index>(l)) += both * (1 - 2 * h);
      }
    }
  }
  for (std::size_t k = 0; k < count; ++k)
    for (std::size_t l = 0; l < count; ++l)
      information(static_cast<Index>(k), static_cast<Index>(l)) +=
          result.moments[k].cwiseProduct(result.moments[l]).sum();
  // What nothing is known of is not known, and no division by zero.
  constexpr double nothing = 1e-9;
  information.diagonal().array() += nothing;
  result.widths = 2 * information.ldlt().solve(Dense::Identity(size, size));
  for (std::size_t k = 0; k < count; ++k)
    for (std::size_t l = 0; l < count; ++l)
      result.widening += 2 * result.widths(static_cast<Index>(k), static_cast<Index>(l)) *
                         (pairs[k * count + l] - result.moments[k] * result.moments[l]);
  return result;
}

/// Each of the moves over the unknowns' sizes, its largest entry 1.
std::vector<std::vector<double>> null_directions(const Dense& null, std::span<const double> sizes) {
  if (null.cols() == 0) return {};
  Dense moves = null;
  for (Index i = 0; i < moves.rows(); ++i) {
    const double size = std::abs(sizes[static_cast<std::size_t>(i)]);
    if (size > 0) moves.row(i) /= size;
  }
  // Of several, as few unknowns in each as can be: reduced by their largest entries in turn.
  for (Index c = 0; c < moves.cols(); ++c) {
    Index pivot = 0;
    moves.col(c).cwiseAbs().maxCoeff(&pivot);
    moves.col(c) /= moves(pivot, c);
    for (Index other = 0; other < moves.cols(); ++other)
      if (other != c) moves.col(other) -= moves(pivot, other) * Column(moves.col(c));
  }
  std::vector<std::vector<double>> result;
  for (Index c = 0; c < moves.cols(); ++c) result.emplace_back(moves.col(c).begin(), moves.col(c).end());
  return result;
}

}  // namespace

Uncertainty uncertainty(const VarianceComponents& noise, std::span<const double> residuals,
                        std::span<const double> jacobian, Loss loss, std::span<const double> sizes, double accuracy) {
  const std::size_t m = sizes.size();
  const Decomposed parts = decomposed(noise, jacobian, accuracy, sizes);
  const Index rank = parts.q.cols();
  Uncertainty result;
  result.group_degrees.assign(noise.groups, 0);
  result.group_ratio.assign(noise.groups, 0);
  for (std::size_t r = 0; r < noise.rows.size(); ++r) {
    const std::size_t g = noise.rows[r].group;
    if (g == prior_group || !noise.rows[r].counts) continue;
    result.group_degrees[g] += 1 - parts.leverage[static_cast<Index>(r)];
    result.group_ratio[g] += counted_square(residuals[r] / std::sqrt(noise.variance(r)), loss != Loss::squares);
  }
  for (std::size_t g = 0; g < noise.groups; ++g) {
    constexpr double rounding = 1e-9;
    if (result.group_degrees[g] < rounding) result.group_degrees[g] = 0;
    result.group_ratio[g] = std::sqrt(result.group_ratio[g] / result.group_degrees[g]);
  }

  const Estimated variances = estimated(noise, parts);
  Dense along = Dense::Identity(rank, rank) + variances.widening;  // the covariance along q
  if (loss != Loss::squares) {
    const Dispersion robust = dispersion_of(noise, residuals, result.group_degrees, loss, static_cast<double>(rank));
    Dense slope = Dense::Zero(rank, rank), square = slope;
    for (std::size_t r = 0; r < noise.rows.size(); ++r) {
      const std::size_t g = noise.rows[r].group;
      const Column row = row_of(parts.q, r);
      const Dense outer = row * row.transpose();
      slope += (g == prior_group ? 1 : robust.slope[g]) * outer;
      square += (g == prior_group ? 1 : robust.square[g]) * outer;
    }
    const Dense inverse = slope.inverse();
    const Dense sandwich = robust.correction * robust.correction * inverse * square * inverse;
    result.dispersion = rank > 0 ? sandwich.trace() / static_cast<double>(rank) : 1;
    result.rise = result.dispersion * robust.mean_slope;
    along = sandwich + variances.widening * result.dispersion;
  }
  const Dense covariance = parts.back * along * parts.back.transpose();
  constexpr double part_of_a_move = 1e-4;
  result.directions = null_directions(parts.null, sizes);
  result.covariance.assign(m * m, 0);
  for (std::size_t i = 0; i < m; ++i) {
    const bool moves = std::ranges::any_of(
        result.directions, [&](const auto& direction) { return std::abs(direction[i]) > part_of_a_move; });
    const Column b = row_of(parts.back, i);
    // Satterthwaite: 2 var^2 over the variance of that estimate.
    Column pull = Column::Zero(variances.widths.rows());
    for (Index k = 0; k < pull.size(); ++k) pull[k] = b.dot(variances.moments[static_cast<std::size_t>(k)] * b);
    const double blur = pull.dot(variances.widths * pull), plain = b.squaredNorm();
    result.degrees.push_back(blur > 0 ? 2 * plain * plain / blur : std::numeric_limits<double>::infinity());
    result.factors.push_back(interval_factor(result.degrees.back()));
    result.undetermined.push_back(moves);
    for (std::size_t j = 0; j < m; ++j)
      result.covariance[i * m + j] = covariance(static_cast<Index>(i), static_cast<Index>(j));
  }
  result.determined_covariance = result.covariance;
  for (Index k = 0; k < variances.widths.rows(); ++k)
    for (Index l = 0; l < variances.widths.cols(); ++l) result.logarithms_covariance.push_back(variances.widths(k, l));
  for (std::size_t i = 0; i < m; ++i) {
    if (!result.undetermined[i]) continue;
    for (std::size_t j = 0; j < m; ++j) result.covariance[i * m + j] = result.covariance[j * m + i] = 0;
    result.covariance[i * m + i] = std::numeric_limits<double>::infinity();
  }
  return result;
}

}  // namespace continuo::studies
