// Averages over the ratio of two kinds of noise, and widens intervals accordingly.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <vector>

#include <boost/math/tools/toms748_solve.hpp>

#include <continuo/studies/fit/decomposed_rows.hpp>
#include <continuo/studies/fit/student_t.hpp>
#include <continuo/studies/fit/variance_ratios.hpp>

namespace continuo::studies::detail {

namespace {

using Dense = Eigen::MatrixXd;
using Column = Eigen::VectorXd;
using Eigen::Index;

/// A column with two components. Ratios are logarithms of the second's size over the first's: 0 where they are as large
/// for a row in the midst of the column, whose factors have the ratio `unit`.
struct TwoKinds {
  std::size_t first, second;
  double unit, estimated;
  std::vector<double> centers;  // of the ratios that data can tell apart
};

/// Ratios at which one row's two parts are as large. Beyond the last to either side one kind of noise has no say and
/// the likelihood changes no more, unless the variance of the smaller is known: then the other may be larger by any
/// number, and about its estimate is where to look.
std::vector<double> centers_of(std::vector<double> logarithms, const TwoKinds& column,
                               const VarianceComponents& noise) {
  constexpr double apart = 4, most = 12;
  const auto [least, greatest] = std::ranges::minmax(logarithms);
  const double middle = std::log(column.unit), span = greatest - least;
  const double count = std::min(1 + std::floor(span / apart), most);
  std::vector<double> centers;
  for (double c = 0; c < count; ++c) centers.push_back(count == 1 ? 0 : least - middle + (c + 0.5) / count * span);
  const bool first_known = noise.components[column.first].known, second_known = noise.components[column.second].known;
  if ((first_known && column.estimated > centers.back() + apart) ||
      (second_known && column.estimated < centers.front() - apart))
    centers.push_back(column.estimated);
  return centers;
}

std::vector<TwoKinds> columns_of_two_kinds(const VarianceComponents& noise, const Uncertainty& sure) {
  // Degrees from which on the expansion is good: of 50 and 100 rows 95 of 100 of its intervals hold the truth.
  constexpr double enough = 45;
  std::vector<TwoKinds> columns;
  for (std::size_t g = 0; g < noise.groups; ++g) {
    std::vector<double> logarithms;
    TwoKinds column{};
    double sum = 0;
    for (const VarianceRow& row : noise.rows) {
      const auto& [one, other] = row.shares;
      if (row.group != g || !row.counts || one.component == other.component || !(one.factor * other.factor > 0))
        continue;
      logarithms.push_back(std::log(one.factor / other.factor));
      sum += logarithms.back();
      column.first = one.component, column.second = other.component;
    }
    if (logarithms.empty() || sure.group_degrees[g] >= enough) continue;
    const VarianceComponent &first = noise.components[column.first], &second = noise.components[column.second];
    if (first.known && second.known) continue;
    column.unit = std::exp(sum / static_cast<double>(logarithms.size()));
    constexpr double farthest = 650;  // a number, where one of them is none
    const double ratio = std::log(second.variance) - std::log(first.variance) - std::log(column.unit);
    column.estimated = std::isnan(ratio) ? 0 : std::clamp(ratio, -farthest, farthest);
    column.centers = centers_of(std::move(logarithms), column, noise);
    columns.push_back(std::move(column));
  }
  return columns;
}

/// The parts of the first and of the second of a ratio's logarithm.
std::pair<double, double> parts_of(double ratio) {
  return {1 / (1 + std::exp(ratio)), 1 / (1 + std::exp(-ratio))};
}

/// What is known of the unknowns where the ratios are given.
struct AtRatios {
  double logarithm = -std::numeric_limits<double>::infinity();  // of the restricted likelihood
  std::vector<double> logarithms_of_prior;                      // of each ratio's logarithm
  GivenRatios known;
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

  AtRatios at(const std::vector<double>& ratios) const {
    VarianceComponents given = noise_;
    for (std::size_t c = 0; c < columns_.size(); ++c) join(columns_[c], ratios[c], given);
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
    Uncertainty sure = uncertainty(given, off, jacobian_, Loss::squares, sizes_, accuracy_);
    const VarianceComponents both = split(ratios, given);
    AtRatios result{.logarithm = likelihood_of(given, off),
                    .logarithms_of_prior = priors_of(both),
                    .known = {.shift = {step.begin(), step.end()},
                              .covariance = std::move(sure.determined_covariance),
                              .degrees = std::move(sure.degrees),
                              .group_degrees = std::move(sure.group_degrees),
                              .variances_of_components = {}}};
    for (const VarianceComponent& component : both.components)
      result.known.variances_of_components.push_back(component.variance);
    return result;
  }

  const std::vector<TwoKinds>& columns() const { return columns_; }

 private:
  /// The column's noise as one component that has both parts.
  static void join(const TwoKinds& column, double ratio, VarianceComponents& noise) {
    const auto [part, other_part] = parts_of(ratio);
    VarianceComponent& first = noise.components[column.first];
    VarianceComponent& second = noise.components[column.second];
    for (VarianceRow& row : noise.rows) {
      auto& [constant, relative] = row.shares;
      if (row.group == prior_group || constant.component != column.first || relative.component != column.second)
        continue;
      constant.factor = part * constant.factor + other_part * column.unit * relative.factor;
      relative.factor = 0;
    }
    const bool known = first.known || second.known;
    first = {.variance = first.known    ? first.variance / part
                         : second.known ? second.variance / (column.unit * other_part)
                                        : first.variance + second.variance / column.unit,
             .known = known,
             .least = std::max(first.least, second.least / column.unit)};
    first.variance = std::max(first.variance, first.least);
    second.known = true;
  }

  /// The variances that were joined, each by itself again.
  VarianceComponents split(const std::vector<double>& ratios, const VarianceComponents& given) const {
    VarianceComponents both = noise_;
    for (std::size_t k = 0; k < both.components.size(); ++k) both.components[k].variance = given.components[k].variance;
    for (std::size_t c = 0; c < columns_.size(); ++c) {
      const auto [part, other_part] = parts_of(ratios[c]);
      const double all = given.components[columns_[c].first].variance;
      both.components[columns_[c].first].variance = all * part;
      both.components[columns_[c].second].variance = all * other_part * columns_[c].unit;
    }
    return both;
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
  std::vector<double> priors_of(const VarianceComponents& both) const {
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
  std::vector<double> weights;  // not numbers where nothing is likely
};

/// Of logarithms, so that the sum is 1.
std::vector<double> normalized(std::vector<double> logarithms) {
  double most = -std::numeric_limits<double>::infinity(), sum = 0;
  for (const double x : logarithms)
    if (std::isfinite(x)) most = std::max(most, x);
  for (double& x : logarithms) sum += x = std::isfinite(x) ? std::exp(x - most) : 0;
  for (double& x : logarithms) x /= sum;
  return logarithms;
}

struct RatioPlace {
  double ratio, density;
};

/// Places at even steps of the mean of (2/pi) arctan e^((ratio - center)/2). Of one center these are even angles, by
/// whose sin^2 the second kind takes part: close to either end a kind of noise has no say, and its part is seen by its
/// root.
std::vector<RatioPlace> places(const TwoKinds& column, std::size_t count_of_one) {
  const auto& centers = column.centers;
  const auto share = [&](double ratio) {
    double sum = 0;
    for (const double center : centers) sum += 2 / std::numbers::pi * std::atan(std::exp((ratio - center) / 2));
    return sum / static_cast<double>(centers.size());
  };
  const std::size_t count = centers.size() == 1 ? count_of_one : count_of_one * centers.size() / 2;
  std::vector<RatioPlace> result;
  for (std::size_t k = 0; k < count; ++k) {
    const double wanted = (static_cast<double>(k) + 0.5) / static_cast<double>(count);
    constexpr double beyond = 40;
    double low = std::ranges::min(centers) - beyond, high = std::ranges::max(centers) + beyond;
    constexpr int halvings = 60;
    for (int i = 0; i < halvings; ++i) (share((low + high) / 2) < wanted ? low : high) = (low + high) / 2;
    double density = 0;
    for (const double center : centers) density += 1 / std::cosh((low - center) / 2);
    result.push_back({low, density});
  }
  return result;
}

/// One ratio is integrated over its places.
Mixed mixed_over(const Ratios& ratios, std::size_t column, const std::vector<RatioPlace>& places,
                 const std::vector<double>& at) {
  Mixed result;
  std::vector<double> logarithms;
  for (const RatioPlace& place : places) {
    std::vector<double> here = at;
    here[column] = place.ratio;
    result.at.push_back(ratios.at(here));
    logarithms.push_back(result.at.back().logarithm + result.at.back().logarithms_of_prior[column] -
                         std::log(place.density));
  }
  result.weights = normalized(std::move(logarithms));
  return result;
}

/// Several are drawn each by itself, evenly in the probability that it has with the others at their estimates, by a
/// lattice of one irrational step each (powers of the root of x^(d+1) = x + 1), and weighted by what they have
/// together.
Mixed mixed_over_all(const Ratios& ratios) {
  const std::size_t columns = ratios.columns().size();
  std::vector<std::vector<RatioPlace>> places_of;
  std::vector<double> estimated;
  for (const TwoKinds& column : ratios.columns()) {
    places_of.push_back(places(column, columns == 1 ? 48 : 16));
    const auto far = [&](const RatioPlace& place) { return std::abs(place.ratio - column.estimated); };
    estimated.push_back(std::ranges::min_element(places_of.back(), {}, far)->ratio);
  }
  if (columns == 1) return mixed_over(ratios, 0, places_of[0], estimated);
  std::vector<std::vector<double>> alone;
  for (std::size_t c = 0; c < columns; ++c) alone.push_back(mixed_over(ratios, c, places_of[c], estimated).weights);
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
      for (double sum = alone[c][0]; sum < share && k + 1 < alone[c].size(); sum += alone[c][k]) ++k;
      here[c] = places_of[c][k].ratio;
      logarithm -= std::log(alone[c][k]) + std::log(places_of[c][k].density);
    }
    result.at.push_back(ratios.at(here));
    for (const double prior : result.at.back().logarithms_of_prior) logarithm += prior;
    logarithms.push_back(logarithm + result.at.back().logarithm);
  }
  result.weights = normalized(std::move(logarithms));
  return result;
}

/// How likely it is within `half` of zero.
double probability_within(std::span<const ShiftedT> mixture, double half) {
  constexpr double many = 1e9;
  double sum = 0;
  for (const ShiftedT& t : mixture) {
    const double degrees = std::min(t.degrees, many);
    sum += t.weight * (student_t_probability((half - t.shift) / t.deviation, degrees) -
                       student_t_probability((-half - t.shift) / t.deviation, degrees));
  }
  return sum;
}

/// Those that have a say.
std::vector<GivenRatios> likely(Mixed mixed) {
  constexpr double nothing = 1e-9;
  std::vector<GivenRatios> result;
  for (std::size_t k = 0; k < mixed.at.size(); ++k) {
    if (!(mixed.weights[k] > nothing)) continue;
    result.push_back(std::move(mixed.at[k].known));
    result.back().weight = mixed.weights[k];
  }
  return result;
}

}  // namespace

double half_width_of(std::span<const ShiftedT> mixture, double guess) {
  namespace policies = boost::math::policies;
  using Quiet = policies::policy<policies::evaluation_error<policies::ignore_error>>;
  const auto lacking = [&](double half) { return probability_within(mixture, half) - interval_confidence; };
  constexpr double farthest = 1e18, widening = 1.5, exact = 1e-5;
  if (!(lacking(farthest * guess) >= 0)) return std::nan("");
  std::uintmax_t most_evaluations = 200;
  return boost::math::tools::bracket_and_solve_root(
             lacking, guess, widening, true, [](double low, double high) { return high - low <= exact * high; },
             most_evaluations, Quiet())
      .second;
}

void widen_by_ratios(Uncertainty& sure, const VarianceComponents& noise, std::span<const double> residuals,
                     std::span<const double> jacobian, std::span<const double> sizes, double accuracy) {
  std::vector<TwoKinds> columns = columns_of_two_kinds(noise, sure);
  if (columns.empty()) return;
  sure.ratios = likely(mixed_over_all(Ratios(noise, residuals, jacobian, sizes, accuracy, std::move(columns))));
  sure.ratios_failed = sure.ratios.empty();
  for (std::size_t u = 0; u < sizes.size() && !sure.ratios_failed; ++u) {
    const std::size_t diagonal = u * (sizes.size() + 1);
    const double deviation = std::sqrt(sure.determined_covariance[diagonal]);
    if (!(deviation > 0) || !std::isfinite(sure.factors[u])) continue;
    std::vector<ShiftedT> mixture;
    for (const GivenRatios& given : sure.ratios)
      mixture.push_back({given.weight, given.shift[u], std::sqrt(given.covariance[diagonal]), given.degrees[u]});
    const double half = half_width_of(mixture, sure.factors[u] * deviation);
    sure.ratios_failed = std::isnan(half);
    if (!sure.ratios_failed) sure.factors[u] = half / deviation;
  }
}

}  // namespace continuo::studies::detail
