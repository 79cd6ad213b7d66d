// continuo/studies/equilibria/hopf_point.cpp
// Solves for the constant at which a pair of eigenvalues is imaginary.
#include <cmath>
#include <limits>
#include <utility>

#include <continuo/numerics/eigenvalues.hpp>
#include <continuo/studies/equilibria/hopf_point.hpp>
#include <continuo/studies/equilibrium.hpp>

namespace continuo::studies {

namespace {

constexpr int most_hopf_iterations = 40;
constexpr double on_axis = 1e-12;  // of the real part, relative to the frequency: what differences leave of it is more

/// The equilibrium at one value of the constant, with the pair that is watched.
struct Oscillating {
  HopfPoint point;
  double growth = 0;  // the pair's real part
};

std::optional<Oscillating> oscillating_at(const ParametricSystem& system, std::size_t constant, double value,
                                          const HopfPoint& near, double t) {
  std::vector<double> p = system.constants;
  p[constant] = value;
  auto search = find_equilibrium(system, near.x, p, t);
  if (search.ending != EquilibriumEnding::found) return std::nullopt;
  const auto linear = linearize(system, search.x, p, t);
  auto spectrum = eigenvalues(linear.a, linear.states);
  if (!linear.undetermined.equations.empty() || !spectrum.found) return std::nullopt;
  double least = std::numeric_limits<double>::infinity();
  std::size_t nearest = 0;
  for (std::size_t k = 0; k < spectrum.values.size(); ++k) {
    const std::complex<double> value_k = spectrum.values[k];
    if (value_k.imag() <= 0) continue;
    const double distance = std::abs(value_k - std::complex<double>(0, near.angular_frequency));
    if (distance < least) least = distance, nearest = k;
  }
  if (!std::isfinite(least)) return std::nullopt;
  const std::complex<double> pair = spectrum.values[nearest];
  return Oscillating{
      {value, std::move(search.x), pair.imag(), std::move(spectrum.vectors[nearest]), std::move(spectrum.values)},
      pair.real()};
}

}  // namespace

std::optional<HopfPoint> find_hopf_point(const ParametricSystem& system, const HopfGuess& guess, double t) {
  const double range = guess.high - guess.low;
  HopfPoint near{.constant = guess.value, .x = guess.x, .angular_frequency = guess.angular_frequency, .vector = {}};
  auto before = oscillating_at(system, guess.constant, guess.value, near, t);
  if (!before) return std::nullopt;
  double step = guess.value + 1e-4 * range <= guess.high ? 1e-4 * range : -1e-4 * range;
  for (int k = 0; k < most_hopf_iterations; ++k) {
    if (std::abs(before->growth) <= on_axis * before->point.angular_frequency) return std::move(before->point);
    const double value = before->point.constant + step;
    if (!(value >= guess.low && value <= guess.high)) return std::nullopt;
    auto now = oscillating_at(system, guess.constant, value, before->point, t);
    if (!now) return std::nullopt;
    const double slope = (now->growth - before->growth) / step;
    if (std::abs(step) <= 1e-13 * range) return std::move(now->point);
    step = -now->growth / slope;
    if (!std::isfinite(step)) return std::nullopt;
    before = std::move(now);
  }
  return std::nullopt;
}

}  // namespace continuo::studies
