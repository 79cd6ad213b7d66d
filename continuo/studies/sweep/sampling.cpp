// Points of the unit cube by the number of the run: independent ones, Latin hypercubes, scrambled Sobol' sequences.
#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include <boost/random/sobol.hpp>
#include <fmt/format.h>

#include <continuo/studies/sweep/counter_random.hpp>
#include <continuo/studies/sweep/sampling.hpp>

namespace continuo::studies {
namespace {

using detail::Purpose;
using detail::random_bits;

// A coordinate is the middle of one of 2^52 equal parts of (0, 1): the middle has 53 binary digits, which a double has.
constexpr unsigned digits_of_point = 52;
constexpr std::uint64_t most_runs = std::uint64_t{1} << 40;
constexpr std::size_t most_sobol_dimensions = 3667;  // of the tables of Boost

double middle_of_part(std::uint64_t part, unsigned digits) {
  return (static_cast<double>(part) + 0.5) * std::ldexp(1.0, -static_cast<int>(digits));
}

double monte_carlo_at(std::uint64_t seed, std::uint64_t run, std::size_t dimension) {
  const auto bits = random_bits(seed, Purpose::point, static_cast<std::uint32_t>(dimension / 2), run);
  return middle_of_part(bits[dimension % 2] >> (64 - digits_of_point), digits_of_point);
}

/// Somewhere in the part of (0, 1) that a permutation gives to this point.
double latin_hypercube_at(std::uint64_t seed, std::uint64_t replicate, std::uint64_t point, std::uint64_t points,
                          std::size_t dimension) {
  const auto place = static_cast<std::uint32_t>(dimension);
  const auto key = random_bits(seed, Purpose::permutation, place, replicate);
  const std::uint64_t part = detail::permuted(point, points, key[0]);
  // So many digits that rounding leaves the point within its part.
  const auto digits = digits_of_point - 2 - static_cast<unsigned>(std::bit_width(points));
  const double within = middle_of_part(detail::mixed(key[1], part + 1) >> (64 - digits), digits);
  return (static_cast<double>(part) + within) / static_cast<double>(points);
}

/// A point of the sequence after a random permutation of the two halves of (0, 1), of the two halves of each of these,
/// and so on: whether two halves change places is one bit for each. A. B. Owen, "Randomly permuted (t, m, s)-nets and
/// (t, s)-sequences" (1995).
std::uint64_t scrambled(std::uint64_t point, std::uint64_t key) {
  std::uint64_t changes = 0;
  for (unsigned digit = 0; digit < digits_of_point; ++digit) {
    // The part of the digits before this one, with a 1 in front, so that parts of all sizes have different numbers.
    const std::uint64_t part = std::uint64_t{1} << digit | point >> (digits_of_point - digit);
    changes = changes << 1 | detail::mixed(key, part) >> 63;
  }
  return point ^ changes;
}

/// The direction numbers of S. Joe, F. Y. Kuo, "Constructing Sobol sequences with better two-dimensional projections",
/// SIAM J. Sci. Comput. 30 (2008), from Boost's engine: its point number 2^(k+1) - 1, in the order of Gray's code, is
/// the direction of bit k alone. The engine leaves the point 0 out.
std::vector<std::uint64_t> sobol_directions(std::size_t dimensions) {
  boost::random::sobol_engine<std::uint64_t, digits_of_point> engine(dimensions);
  std::vector<std::uint64_t> directions(digits_of_point * dimensions);
  for (unsigned bit = 0; bit < digits_of_point; ++bit) {
    engine.seed((std::uint64_t{2} << bit) - 2);
    for (std::size_t d = 0; d < dimensions; ++d) directions[d * digits_of_point + bit] = engine();
  }
  return directions;
}

double sobol_at(std::uint64_t seed, std::uint64_t replicate, std::uint64_t point, std::size_t dimension,
                const std::uint64_t* directions) {
  std::uint64_t digits = 0;
  for (std::uint64_t rest = point; rest != 0; rest &= rest - 1) digits ^= directions[std::countr_zero(rest)];
  const auto key = random_bits(seed, Purpose::scrambling, static_cast<std::uint32_t>(dimension), replicate);
  return middle_of_part(scrambled(digits, key[0]), digits_of_point);
}

}  // namespace

std::string_view to_string(Sampling sampling) {
  return sampling_names[static_cast<std::size_t>(sampling)];
}

std::optional<Sampling> sampling_of(std::string_view name) {
  for (std::size_t i = 0; i < sampling_names.size(); ++i)
    if (sampling_names[i] == name) return static_cast<Sampling>(i);
  return std::nullopt;
}

Status check(const SamplingPlan& plan) {
  if (plan.runs == 0) return invalid_input("there are no runs; ask for at least one");
  if (plan.runs > most_runs) return invalid_input(fmt::format("{} runs are more than {} (2^40)", plan.runs, most_runs));
  if (plan.dimensions == 0) return invalid_input("nothing is varied; name at least one quantity");
  if (plan.dimensions > std::numeric_limits<std::uint32_t>::max())
    return invalid_input(fmt::format("{} quantities are too many", plan.dimensions));
  if (plan.sampling == Sampling::sobol && plan.dimensions > most_sobol_dimensions)
    return invalid_input(fmt::format("sobol has directions for {} quantities, not for {}; take latin_hypercube",
                                     most_sobol_dimensions, plan.dimensions));
  if (plan.replicates == 0 || plan.runs % plan.replicates != 0)
    return invalid_input(fmt::format("{} runs cannot be divided into {} equal samples", plan.runs, plan.replicates));
  return {};
}

std::string advice(const SamplingPlan& plan) {
  const std::uint64_t points = plan.runs / std::max<std::uint64_t>(plan.replicates, 1);
  if (plan.sampling != Sampling::sobol || points == 0 || std::has_single_bit(points)) return {};
  return fmt::format("{} is no power of two: {} or {} points of the Sobol' sequence are spread more evenly", points,
                     std::bit_floor(points), std::bit_floor(points) * 2);
}

Sampler::Sampler(const SamplingPlan& plan) : plan_(plan) {
  if (plan.sampling == Sampling::sobol) directions_ = sobol_directions(plan.dimensions);
}

Result<Sampler> Sampler::create(const SamplingPlan& plan) {
  if (Status status = check(plan); !status) return status;
  return Sampler(plan);
}

double Sampler::at(std::uint64_t run, std::size_t dimension) const {
  const std::uint64_t replicate = run % plan_.replicates, point = run / plan_.replicates;
  switch (plan_.sampling) {
    case Sampling::latin_hypercube:
      return latin_hypercube_at(plan_.seed, replicate, point, plan_.runs / plan_.replicates, dimension);
    case Sampling::sobol:
      return sobol_at(plan_.seed, replicate, point, dimension, &directions_[dimension * digits_of_point]);
    case Sampling::monte_carlo:
      break;
  }
  return monte_carlo_at(plan_.seed, run, dimension);
}

void Sampler::point(std::uint64_t run, std::span<double> point) const {
  for (std::size_t d = 0; d < point.size(); ++d) point[d] = at(run, d);
}

}  // namespace continuo::studies
