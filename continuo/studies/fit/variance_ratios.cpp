// Averages over the ratio of two kinds of noise, and widens intervals accordingly.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include <boost/math/tools/toms748_solve.hpp>

#include <continuo/studies/fit/noise_ratios.hpp>
#include <continuo/studies/fit/ratio_draws.hpp>
#include <continuo/studies/fit/student_t.hpp>
#include <continuo/studies/fit/variance_ratios.hpp>

namespace continuo::studies::detail {

namespace {

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

/// What part of a variance comes from each source, over the ratios.
std::vector<double> mean_parts(const MixedRatios& ratios, std::span<const Seen> seen) {
  std::vector<double> result(ratios.powers.size(), 0);
  for (std::size_t i = 0; i < seen.size(); ++i)
    for (std::size_t s = 0; s < result.size(); ++s)
      result[s] += ratios.given[i].weight * seen[i].parts[s] / seen[i].variance;
  return result;
}

/// The power of each source's V_s in the prior, and that of V.
struct Powers {
  std::vector<double> of_sources;
  double of_all = 0;
  double of_size() const {
    double sum = -of_all;
    for (const double power : of_sources) sum += power;
    return sum;
  }
};

Powers powers_of(const MixedRatios& ratios, std::span<const Seen> seen) {
  // What a source adds that has less of the variance is not seen.
  constexpr double no_part = 0.02;
  const std::vector<double> parts = mean_parts(ratios, seen);
  Powers result{.of_sources = std::vector<double>(parts.size(), 0)};
  double sum = 0;
  for (std::size_t s = 0; s < parts.size(); ++s) {
    if (!(parts[s] > no_part)) continue;
    result.of_sources[s] = ratios.powers[s];
    result.of_all += parts[s] * ratios.powers[s];
    sum += parts[s];
  }
  if (sum > 0) result.of_all /= sum;
  // The overall size keeps a third of its degrees of freedom.
  const double most = ratios.degrees / 3, used = result.of_size();
  if (used > most) {
    for (double& power : result.of_sources) power *= most / used;
    result.of_all *= most / used;
  }
  return result;
}

double logarithm_of_prior(const Powers& powers, const Seen& seen) {
  double result = -powers.of_all * std::log(seen.variance);
  for (std::size_t s = 0; s < seen.parts.size(); ++s)
    if (powers.of_sources[s] > 0)
      result += powers.of_sources[s] * (2 * std::log(seen.variance) - std::log(seen.parts[s]));
  return result;
}

/// Those that have a say.
MixedRatios likely(const NoiseRatios& ratios) {
  constexpr double nothing = 1e-9;
  const RatioDraws draws = draws_of(ratios);
  MixedRatios result = ratios.frame();
  // Of fewer the integral is chance.
  constexpr double fewest = 20;
  if (ratios.axes().size() > 1 && !(draws.effective >= fewest)) return result;
  for (std::size_t k = 0; k < draws.points.size(); ++k) {
    if (!(draws.weights[k] > nothing)) continue;
    result.given.push_back(ratios.given_at(draws.points[k]));
    result.given.back().weight = draws.weights[k];
  }
  return result;
}

/// x^T C x of a matrix that is stored by rows.
double square_along(std::span<const double> slopes, const std::vector<double>& matrix) {
  double sum = 0;
  for (std::size_t i = 0; i < slopes.size(); ++i)
    for (std::size_t j = 0; j < slopes.size(); ++j) sum += slopes[i] * matrix[i * slopes.size() + j] * slopes[j];
  return sum;
}

/// Whether what is not known of ratios matters: expansions about their estimates are good for longer columns.
bool are_short(const VarianceComponents& noise, const Uncertainty& sure, const std::vector<TwoKinds>& columns) {
  // Degrees of two kinds: of 50 and 100 rows 95 of 100 intervals of the expansion hold the truth.
  constexpr double enough_of_two = 45;
  return !noise.rows.empty() &&
         std::ranges::any_of(columns, [&](const TwoKinds& c) { return sure.group_degrees[c.group] < enough_of_two; });
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

Seen seen_along(const GivenRatios& given, std::span<const double> slopes) {
  Seen result{.shift = 0, .variance = square_along(slopes, given.covariance), .parts = {}};
  for (std::size_t u = 0; u < slopes.size(); ++u) result.shift += slopes[u] * given.shift[u];
  for (const auto& part : given.parts) result.parts.push_back(square_along(slopes, part));
  return result;
}

std::vector<ShiftedT> mixture_of(const MixedRatios& ratios, std::span<const Seen> seen) {
  const Powers powers = powers_of(ratios, seen);
  // Each power of the overall size takes two of its degrees.
  const double degrees = ratios.degrees - 2 * powers.of_size();
  const double wider = std::isfinite(degrees) ? ratios.degrees / degrees : 1;
  std::vector<double> logarithms;
  for (std::size_t i = 0; i < seen.size(); ++i)
    logarithms.push_back(std::log(ratios.given[i].weight) + logarithm_of_prior(powers, seen[i]));
  const std::vector<double> weights = normalized(std::move(logarithms));
  std::vector<ShiftedT> mixture;
  for (std::size_t i = 0; i < seen.size(); ++i)
    mixture.push_back({weights[i], seen[i].shift, std::sqrt(wider * seen[i].variance), degrees});
  return mixture;
}

void widen_by_ratios(Uncertainty& sure, const VarianceComponents& noise, std::span<const double> residuals,
                     std::span<const double> jacobian, std::span<const double> sizes, double accuracy) {
  std::vector<TwoKinds> columns = columns_of_two_kinds(noise);
  if (!are_short(noise, sure, columns)) return;
  const NoiseRatios ratios(noise, sure, residuals, jacobian, sizes, accuracy, std::move(columns));
  if (ratios.axes().empty()) return;
  sure.ratios = likely(ratios);
  sure.ratios_failed = sure.ratios.empty();
  for (std::size_t u = 0; u < sizes.size() && !sure.ratios_failed; ++u) {
    const double deviation = std::sqrt(sure.determined_covariance[u * (sizes.size() + 1)]);
    if (!(deviation > 0) || !std::isfinite(sure.factors[u])) continue;
    std::vector<double> slopes(sizes.size(), 0);
    slopes[u] = 1;
    std::vector<Seen> seen;
    for (const GivenRatios& given : sure.ratios.given) seen.push_back(seen_along(given, slopes));
    const double half = half_width_of(mixture_of(sure.ratios, seen), sure.factors[u] * deviation);
    sure.ratios_failed = std::isnan(half);
    if (!sure.ratios_failed) sure.factors[u] = half / deviation;
  }
}

}  // namespace continuo::studies::detail
