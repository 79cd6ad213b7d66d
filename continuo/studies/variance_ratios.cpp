#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include <continuo/studies/decomposed_rows.hpp>
#include <continuo/studies/student_t.hpp>
#include <continuo/studies/variance_ratios.hpp>

namespace continuo::studies::detail {

namespace {

using Dense = Eigen::MatrixXd;
using Column = Eigen::VectorXd;
using Eigen::Index;

/// A column with two components; `unit` makes the second of the size of the first: the geometric mean of their factors'
/// ratio.
struct TwoKinds {
  std::size_t first, second;
  double unit, estimated;  // the part of the second, between 0 and 1
};

std::vector<TwoKinds> columns_of_two_kinds(const VarianceComponents& noise, const Uncertainty& sure) {
  // Degrees from which on the expansion is good: of 50 and 100 rows 95 of 100 of its intervals hold the truth.
  constexpr double enough = 45;
  std::vector<TwoKinds> columns;
  for (std::size_t g = 0; g < noise.groups; ++g) {
    double sum = 0, count = 0;
    std::size_t first = 0, second = 0;
    for (const VarianceRow& row : noise.rows) {
      const auto& [one, other] = row.shares;
      if (row.group != g || !row.counts || one.component == other.component || !(one.factor * other.factor > 0))
        continue;
      sum += std::log(one.factor / other.factor), count += 1;
      first = one.component, second = other.component;
    }
    if (count == 0 || sure.group_degrees[g] >= enough) continue;
    if (noise.components[first].known && noise.components[second].known) continue;
    const double unit = std::exp(sum / count), one = noise.components[first].variance;
    const double other = noise.components[second].variance / unit;
    columns.push_back({first, second, unit, one + other > 0 ? other / (one + other) : 0.5});
  }
  return columns;
}

/// What is known of the unknowns where the ratios are given.
struct AtRatios {
  double logarithm = -std::numeric_limits<double>::infinity();  // of the restricted likelihood
  std::vector<double> logarithms_of_prior;                      // of each ratio's logarithm
  Column shift, deviation, degrees;                             // of the unknowns from the estimate
};

class Ratios {
 public:
  Ratios(const VarianceComponents& noise, std::span<const double> residuals, std::span<const double> jacobian,
         std::span<const double> sizes, double accuracy, std::vector<TwoKinds> columns)
      : noise_(noise),
        residuals_(residuals),
        jacobian_(jacobian),
        sizes_(sizes),
        accuracy_(accuracy),
        columns_(std::move(columns)) {
    const Dense null = decomposed(noise, jacobian, accuracy, sizes).null;
    const auto m = static_cast<Index>(sizes.size());
    const Dense full = null.cols() == 0 ? Dense(Dense::Identity(m, m)) : Dense(null.householderQr().householderQ());
    determined_ = full.rightCols(m - null.cols());
  }

  AtRatios at(const std::vector<double>& parts) const {
    VarianceComponents given = noise_;
    for (std::size_t c = 0; c < columns_.size(); ++c) join(columns_[c], parts[c], given);
    AtRatios result;
    const auto m = static_cast<Index>(sizes_.size());
    std::vector<double> off(residuals_.begin(), residuals_.end());
    Column step = Column::Zero(m);
    // Of one column the unknowns do not depend on how large its noise is: two rounds, else until they do not.
    constexpr int most_rounds = 5;
    for (int round = 0; round < most_rounds; ++round) {
      const Column next = shift_of(given);
      const bool same = round > 0 && (next - step).norm() <= 1e-3 * next.norm();
      step = next;
      for (std::size_t r = 0; r < off.size(); ++r) {
        off[r] = residuals_[r];
        for (Index u = 0; u < m; ++u) off[r] += jacobian_[r * sizes_.size() + static_cast<std::size_t>(u)] * step[u];
      }
      if (same) break;
      estimate_variances(given, off, jacobian_, Loss::squares);
    }
    const Uncertainty sure = uncertainty(given, off, jacobian_, Loss::squares, sizes_, accuracy_);
    result.shift = step;
    result.deviation = result.degrees = Column::Zero(m);
    for (Index u = 0; u < m; ++u) {
      const auto i = static_cast<std::size_t>(u);
      result.deviation[u] = std::sqrt(sure.determined_covariance[i * (sizes_.size() + 1)]);
      result.degrees[u] = sure.degrees[i];
    }
    result.logarithm = likelihood_of(given, off);
    result.logarithms_of_prior = priors_of(parts, given);
    return result;
  }

  const std::vector<TwoKinds>& columns() const { return columns_; }

 private:
  /// The column's noise as one component, of which the part `part` is of the second kind.
  static void join(const TwoKinds& column, double part, VarianceComponents& noise) {
    VarianceComponent& first = noise.components[column.first];
    VarianceComponent& second = noise.components[column.second];
    const double one = first.variance / (1 - part), other = second.variance / (column.unit * part);
    for (VarianceRow& row : noise.rows) {
      auto& [constant, relative] = row.shares;
      if (row.group == prior_group || constant.component != column.first || relative.component != column.second)
        continue;
      constant.factor = (1 - part) * constant.factor + part * column.unit * relative.factor;
      relative.factor = 0;
    }
    const bool known = first.known || second.known;
    first = {.variance = first.known    ? one
                         : second.known ? other
                                        : first.variance + second.variance / column.unit,
             .known = known,
             .least = std::max(first.least, second.least / column.unit)};
    first.variance = std::max(first.variance, first.least);
    second.known = true;
  }

  /// Where the least squares with these variances are, from where the fit is.
  Column shift_of(const VarianceComponents& given) const {
    const Decomposed parts = decomposed(given, jacobian_, accuracy_, sizes_);
    Column over(static_cast<Index>(residuals_.size()));
    for (std::size_t r = 0; r < residuals_.size(); ++r)
      over[static_cast<Index>(r)] = residuals_[r] / std::sqrt(given.variance(r));
    return -(parts.back * (parts.q.transpose() * over));
  }

  /// -1/2 [sum log v + log det J^T V^-1 J + sum r^2/v], the determinant on the moves that have an effect.
  double likelihood_of(const VarianceComponents& given, std::span<const double> off) const {
    const Decomposed parts = decomposed(given, jacobian_, accuracy_, sizes_);
    double sum = 0;
    for (std::size_t r = 0; r < off.size(); ++r) {
      if (!given.rows[r].counts) continue;
      const double variance = given.variance(r);
      sum += std::log(variance) + off[r] * off[r] / variance;
    }
    if (parts.back.cols() != determined_.cols()) return -std::numeric_limits<double>::infinity();
    const Dense back = determined_.transpose() * parts.back;
    return std::log(std::abs(back.determinant())) - sum / 2;
  }

  /// The root of the information about each ratio's logarithm: one over its deviation, with all other variances
  /// unknown.
  std::vector<double> priors_of(const std::vector<double>& parts, const VarianceComponents& given) const {
    VarianceComponents both = noise_;
    for (std::size_t k = 0; k < both.components.size(); ++k) both.components[k].variance = given.components[k].variance;
    for (std::size_t c = 0; c < columns_.size(); ++c) {
      const double all = given.components[columns_[c].first].variance;
      both.components[columns_[c].first].variance = all * (1 - parts[c]);
      both.components[columns_[c].second].variance = all * parts[c] * columns_[c].unit;
    }
    const std::vector<double> covariance =
        uncertainty(both, residuals_, jacobian_, Loss::squares, sizes_, accuracy_).logarithms_covariance;
    std::vector<std::size_t> place(both.components.size(), prior_group);
    std::size_t count = 0;
    for (std::size_t k = 0; k < place.size(); ++k)
      if (!both.components[k].known) place[k] = count++;
    std::vector<double> result;
    for (const TwoKinds& column : columns_) {
      const std::size_t a = place[column.first], b = place[column.second];
      double variance = 0;
      if (a != prior_group) variance += covariance[a * count + a];
      if (b != prior_group) variance += covariance[b * count + b];
      if (a != prior_group && b != prior_group) variance -= covariance[a * count + b] + covariance[b * count + a];
      result.push_back(variance > 0 ? -std::log(variance) / 2 : -std::numeric_limits<double>::infinity());
    }
    return result;
  }

  const VarianceComponents& noise_;
  std::span<const double> residuals_, jacobian_, sizes_;
  double accuracy_;
  std::vector<TwoKinds> columns_;
  Dense determined_;  // an orthonormal basis of the moves that have an effect
};

struct Mixed {
  std::vector<AtRatios> at;
  std::vector<double> weights;
};

/// Of logarithms, so that the sum is 1.
std::vector<double> normalized(std::vector<double> logarithms) {
  const double most = *std::ranges::max_element(logarithms);
  double sum = 0;
  for (double& x : logarithms) sum += x = std::isfinite(x) ? std::exp(x - most) : 0;
  for (double& x : logarithms) x /= sum;
  return logarithms;
}

/// sin^2 of even angles: close to either end a kind of noise has no say, and the part of it is seen by its root.
std::vector<double> places(std::size_t count) {
  std::vector<double> result;
  for (std::size_t k = 0; k < count; ++k)
    result.push_back(
        std::pow(std::sin(std::numbers::pi / 2 * (static_cast<double>(k) + 0.5) / static_cast<double>(count)), 2));
  return result;
}

/// One ratio is integrated over its places.
Mixed mixed_over(const Ratios& ratios, std::size_t column, const std::vector<double>& parts,
                 const std::vector<double>& at) {
  Mixed result;
  std::vector<double> logarithms;
  for (const double part : parts) {
    std::vector<double> here = at;
    here[column] = part;
    result.at.push_back(ratios.at(here));
    // d log(part/(1 - part)) = 2 d angle/root(part (1 - part))
    logarithms.push_back(result.at.back().logarithm + result.at.back().logarithms_of_prior[column] -
                         std::log(part * (1 - part)) / 2);
  }
  result.weights = normalized(std::move(logarithms));
  return result;
}

/// Several are drawn each by itself, evenly in the probability that it has with the others at their estimates, by a
/// lattice of one irrational step each (powers of the root of x^(d+1) = x + 1), and weighted by what they have
/// together.
Mixed mixed_over_all(const Ratios& ratios) {
  const std::size_t columns = ratios.columns().size();
  const std::vector<double> parts = places(columns == 1 ? 48 : 16);
  std::vector<double> estimated;
  for (const TwoKinds& column : ratios.columns())
    estimated.push_back(
        *std::ranges::min_element(parts, {}, [&](double part) { return std::abs(part - column.estimated); }));
  if (columns == 1) return mixed_over(ratios, 0, parts, estimated);
  std::vector<std::vector<double>> alone;
  for (std::size_t c = 0; c < columns; ++c) alone.push_back(mixed_over(ratios, c, parts, estimated).weights);
  double root = 1;
  for (int k = 0; k < 50; ++k) root = std::pow(1 + root, 1 / static_cast<double>(columns + 1));
  constexpr std::size_t draws = 128;
  Mixed result;
  std::vector<double> logarithms;
  for (std::size_t i = 0; i < draws; ++i) {
    std::vector<double> here(columns);
    double logarithm = 0, step = 1;
    for (std::size_t c = 0; c < columns; ++c) {
      step /= root;
      const double share = std::fmod(0.5 + static_cast<double>(i + 1) * step, 1);
      std::size_t k = 0;
      for (double sum = alone[c][0]; sum < share && k + 1 < parts.size(); sum += alone[c][k]) ++k;
      here[c] = parts[k];
      logarithm -= std::log(alone[c][k]) + std::log(parts[k] * (1 - parts[k])) / 2;
    }
    result.at.push_back(ratios.at(here));
    for (const double prior : result.at.back().logarithms_of_prior) logarithm += prior;
    logarithms.push_back(logarithm + result.at.back().logarithm);
  }
  result.weights = normalized(std::move(logarithms));
  return result;
}

/// How likely the unknown is within `half` of the estimate.
double probability_within(const Mixed& mixed, Index unknown, double half) {
  constexpr double many = 1e9;
  double sum = 0;
  for (std::size_t k = 0; k < mixed.at.size(); ++k) {
    const AtRatios& at = mixed.at[k];
    if (!(mixed.weights[k] > 0)) continue;
    const double degrees = std::min(at.degrees[unknown], many), s = at.deviation[unknown], off = at.shift[unknown];
    sum += mixed.weights[k] *
           (student_t_probability((half - off) / s, degrees) - student_t_probability((-half - off) / s, degrees));
  }
  return sum;
}

}  // namespace

void widen_by_ratios(Uncertainty& sure, const VarianceComponents& noise, std::span<const double> residuals,
                     std::span<const double> jacobian, std::span<const double> sizes, double accuracy) {
  std::vector<TwoKinds> columns = columns_of_two_kinds(noise, sure);
  if (columns.empty()) return;
  const Mixed mixed = mixed_over_all(Ratios(noise, residuals, jacobian, sizes, accuracy, std::move(columns)));
  for (std::size_t u = 0; u < sizes.size(); ++u) {
    const auto i = static_cast<Index>(u);
    const double deviation = std::sqrt(sure.determined_covariance[u * (sizes.size() + 1)]);
    if (!(deviation > 0) || !std::isfinite(sure.factors[u])) continue;
    double low = 0, high = sure.factors[u] * deviation;
    constexpr int most_doublings = 60;
    for (int k = 0; k < most_doublings && probability_within(mixed, i, high) < interval_confidence; ++k) high *= 2;
    if (!(probability_within(mixed, i, high) >= interval_confidence)) continue;
    constexpr double exact = 1e-5;
    while (high - low > exact * high) {
      const double middle = (low + high) / 2;
      (probability_within(mixed, i, middle) < interval_confidence ? low : high) = middle;
    }
    sure.factors[u] = high / deviation;
  }
}

}  // namespace continuo::studies::detail
