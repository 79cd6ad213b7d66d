// Sobol' indices and their intervals.
#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include <continuo/studies/fit/student_t.hpp>
#include <continuo/studies/sweep/sobol_indices.hpp>

namespace continuo::studies {
namespace {

constexpr std::uint64_t independent_samples = 16;  // independent of each other; their spread tells the error
constexpr double confidence = 0.95;
constexpr Estimate no_estimate{NAN, NAN, NAN};

/// Rows whose outcomes are all finite.
struct Rows {
  std::size_t width = 0;                // of a row: factors + 2
  std::vector<const double*> starts{};  // of their outcomes
  std::vector<std::uint64_t> numbers{};
};

Rows complete_rows(const SobolDesign& design, std::span<const double> outcomes) {
  Rows rows{.width = design.factors + 2};
  for (std::uint64_t row = 0; row < std::min<std::uint64_t>(design.rows, outcomes.size() / rows.width); ++row) {
    const auto own = outcomes.subspan(static_cast<std::size_t>(row) * rows.width, rows.width);
    bool finite = true;
    for (const double y : own) finite = finite && std::isfinite(y);
    if (!finite) continue;
    rows.starts.push_back(own.data());
    rows.numbers.push_back(row);
  }
  return rows;
}

/// The quotient of two means, each over all rows. Its error is that of the mean of numerator - quotient * denominator,
/// whose spread between independent samples is known.
Estimate ratio(const Rows& rows, std::uint64_t replicates, std::span<const double> numerators,
               std::span<const double> denominators) {
  double top = 0, bottom = 0;
  for (std::size_t i = 0; i < numerators.size(); ++i) top += numerators[i], bottom += denominators[i];
  if (!(bottom > 0)) return no_estimate;
  const double value = top / bottom;
  std::vector<double> deviations(static_cast<std::size_t>(replicates));
  std::vector<bool> has_rows(deviations.size());
  for (std::size_t i = 0; i < numerators.size(); ++i) {
    const auto sample = static_cast<std::size_t>(rows.numbers[i] % replicates);
    deviations[sample] += numerators[i] - value * denominators[i];
    has_rows[sample] = true;
  }
  double squares = 0, count = 0;
  for (std::size_t k = 0; k < deviations.size(); ++k)
    if (has_rows[k]) squares += deviations[k] * deviations[k], count += 1;
  if (count < 2) return {value, NAN, NAN};
  const double error = std::sqrt(squares * count / (count - 1)) / bottom;
  const double reach = student_t_quantile(confidence, count - 1) * error;
  return {value, value - reach, value + reach};
}

double mean_of_a_and_b(const Rows& rows) {
  double sum = 0;
  for (const double* y : rows.starts) sum += y[0] / 2 + y[1] / 2;
  return sum / static_cast<double>(rows.starts.size());
}

}  // namespace

std::uint64_t SobolDesign::replicates() const {
  return sampling == Sampling::monte_carlo ? rows : independent_samples;
}

std::uint64_t sobol_rows(Sampling sampling, std::size_t factors, std::uint64_t runs) {
  const std::uint64_t rows = runs / (factors + 2);
  if (sampling == Sampling::monte_carlo) return rows;
  const std::uint64_t each = rows / independent_samples;
  return independent_samples * (sampling == Sampling::sobol ? std::bit_floor(each) : each);
}

Status check(const SobolDesign& design) {
  const std::uint64_t least = design.sampling == Sampling::monte_carlo ? 2 : independent_samples;
  if (design.factors == 0) return invalid_input("nothing is varied; name at least one quantity");
  if (design.rows < least || design.rows % (design.sampling == Sampling::monte_carlo ? 1 : independent_samples) != 0)
    return invalid_input(fmt::format(
        "Sobol' indices of {0} quantities by {1} need a multiple of {2} runs; ask for {3} or more", design.factors,
        to_string(design.sampling), least * (design.factors + 2), 64 * independent_samples * (design.factors + 2)));
  return check(SamplingPlan{design.sampling, design.rows, 2 * design.factors, design.seed, design.replicates()});
}

Result<SobolPoints> SobolPoints::create(const SobolDesign& design) {
  if (Status status = check(design); !status) return status;
  auto sampler = Sampler::create({design.sampling, design.rows, 2 * design.factors, design.seed, design.replicates()});
  if (!sampler) return sampler.status();
  return SobolPoints(design, *std::move(sampler));
}

double SobolPoints::at(std::uint64_t run, std::size_t factor) const {
  const std::uint64_t row = run / (design_.factors + 2), member = run % (design_.factors + 2);
  const bool is_of_b = member == 1 || member == factor + 2;
  return sampler_.at(row, is_of_b ? design_.factors + factor : factor);
}

// With f of A, of B, and of A with coordinate i from B, and the mean m of f:
// first order: mean of (fB - m) (fAB - fA) / variance: A. Saltelli et al., "Variance based sensitivity analysis of
// model output", Comput. Phys. Commun. 181 (2010), table 2 (b); total: mean of (fA - fAB)^2 / 2 / variance: M. J. W.
// Jansen, "Analysis of variance designs for model output", Comput. Phys. Commun. 117 (1999). Both are 0 to the bit for
// a factor on which f does not depend.
SobolIndices sobol_indices(const SobolDesign& design, std::span<const double> outcomes) {
  const Rows rows = complete_rows(design, outcomes);
  const std::size_t count = rows.starts.size();
  SobolIndices result;
  result.rows = count;
  result.missing = std::min<std::uint64_t>(design.rows, outcomes.size() / rows.width) - count;
  const double m = mean_of_a_and_b(rows);
  std::vector<double> variances(count), numerators(count);
  double sum = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const double a = rows.starts[i][0] - m, b = rows.starts[i][1] - m;
    sum += variances[i] = (a * a + b * b) / 2;
  }
  result.mean = m;
  result.variance = sum / static_cast<double>(count);
  for (std::size_t factor = 0; factor < design.factors; ++factor) {
    for (std::size_t i = 0; i < count; ++i) {
      const double* y = rows.starts[i];
      numerators[i] = (y[1] - m) * (y[factor + 2] - y[0]);
    }
    result.first.push_back(ratio(rows, design.replicates(), numerators, variances));
    for (std::size_t i = 0; i < count; ++i) {
      const double change = rows.starts[i][0] - rows.starts[i][factor + 2];
      numerators[i] = change * change / 2;
    }
    result.total.push_back(ratio(rows, design.replicates(), numerators, variances));
  }
  return result;
}

}  // namespace continuo::studies
