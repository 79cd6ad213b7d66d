// Draws weighted points over the ratios of variances, spread by a lattice.
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <continuo/studies/fit/ratio_draws.hpp>

namespace continuo::studies::detail {

namespace {

struct RatioPlace {
  double ratio, logarithm_of_density;
};

/// Places at even steps of the mean of (2/pi) arctan e^((ratio - center)/(2 width)). Of one center of width 1 these are
/// even angles, by whose sin^2 the second kind takes part: close to either end a kind of noise has no say, and its part
/// is seen by its root.
std::vector<RatioPlace> places(const RatioAxis& axis, std::size_t count_of_one) {
  const auto& centers = axis.centers;
  const auto share = [&](double ratio) {
    double sum = 0;
    for (const auto& [center, width] : centers)
      sum += 2 / std::numbers::pi * std::atan(std::exp((ratio - center) / (2 * width)));
    return sum / static_cast<double>(centers.size());
  };
  const std::size_t count = centers.size() == 1 ? count_of_one : count_of_one * centers.size() / 2;
  const auto [first, last] = std::ranges::minmax(centers, {}, &RatioAxis::Center::at);
  std::vector<RatioPlace> result;
  for (std::size_t k = 0; k < count; ++k) {
    const double wanted = (static_cast<double>(k) + 0.5) / static_cast<double>(count);
    constexpr double beyond = 40;
    double low = first.at - beyond, high = last.at + beyond;
    constexpr int halvings = 60;
    for (int i = 0; i < halvings; ++i) (share((low + high) / 2) < wanted ? low : high) = (low + high) / 2;
    double density = 0;
    for (const auto& [center, width] : centers) density += 1 / std::cosh((low - center) / (2 * width)) / width;
    result.push_back({low, std::log(density)});
  }
  return result;
}

/// The lattice of one irrational step each, powers of the root of x^(d+1) = x + 1.
class Lattice {
 public:
  explicit Lattice(std::size_t axes) {
    double root = 1;
    for (int k = 0; k < 50; ++k) root = std::pow(1 + root, 1 / static_cast<double>(axes + 1));
    for (std::size_t a = 0; a < axes; ++a) steps_.push_back(std::pow(root, -static_cast<double>(a + 1)));
  }
  double at(std::size_t draw, std::size_t axis) const {
    return std::fmod(0.5 + static_cast<double>(draw + 1) * steps_[axis], 1);
  }

 private:
  std::vector<double> steps_;
};

/// Points are drawn axis by axis from places with probabilities of their own, and weighted by what they have together.
class Sampler {
 public:
  explicit Sampler(const NoiseRatios& ratios) : ratios_(ratios), lattice_(ratios.axes().size()) {
    constexpr std::size_t places_of_one = 48, places_of_each = 32;
    for (const RatioAxis& axis : ratios.axes()) {
      places_.push_back(places(axis, ratios.axes().size() == 1 ? places_of_one : places_of_each));
      const auto far = [&](const RatioPlace& place) { return std::abs(place.ratio - axis.estimated); };
      estimated_.push_back(std::ranges::min_element(places_.back(), {}, far)->ratio);
    }
  }

  /// All places of one axis, with the others at their estimates.
  RatioDraws along(std::size_t axis) const {
    RatioDraws result;
    std::vector<double> logarithms, point = estimated_;
    for (const RatioPlace& place : places_[axis]) {
      point[axis] = place.ratio;
      result.points.push_back(point);
      logarithms.push_back(ratios_.logarithm_at(point) - place.logarithm_of_density);
    }
    return weighed(std::move(result), std::move(logarithms));
  }

  /// Probabilities of the places are those of one axis at a time.
  void start() {
    constexpr double elsewhere = 0.2;
    for (std::size_t a = 0; a < places_.size(); ++a) set(a, along(a).weights, elsewhere);
  }

  /// From here on they are those that the draws have seen, smoothed as these are few.
  void learn(const RatioDraws& draws) {
    constexpr double elsewhere = 0.1;
    for (std::size_t a = 0; a < places_.size(); ++a) {
      std::vector<double> seen(places_[a].size(), 0);
      for (std::size_t i = 0; i < draws.weights.size(); ++i) seen[place_of(a, i)] += draws.weights[i];
      constexpr int times = 2;
      for (int k = 0; k < times; ++k) seen = smoothed(seen);
      next_.push_back(std::move(seen));
    }
    for (std::size_t a = 0; a < places_.size(); ++a) set(a, std::move(next_[a]), elsewhere);
    next_.clear();
  }

  RatioDraws draws(std::size_t count) const {
    RatioDraws result;
    std::vector<double> logarithms;
    for (std::size_t i = 0; i < count; ++i) {
      std::vector<double> point;
      double logarithm = 0;
      for (std::size_t a = 0; a < places_.size(); ++a) {
        const std::size_t k = place_of(a, i);
        point.push_back(places_[a][k].ratio);
        logarithm -= std::log(probabilities_[a][k]) + places_[a][k].logarithm_of_density;
      }
      logarithms.push_back(logarithm + ratios_.logarithm_at(point));
      result.points.push_back(std::move(point));
    }
    return weighed(std::move(result), std::move(logarithms));
  }

 private:
  static RatioDraws weighed(RatioDraws draws, std::vector<double> logarithms) {
    draws.weights = normalized(std::move(logarithms));
    double squares = 0;
    for (const double weight : draws.weights) squares += weight * weight;
    draws.effective = 1 / squares;
    return draws;
  }

  static std::vector<double> smoothed(const std::vector<double>& values) {
    std::vector<double> result;
    for (std::size_t k = 0; k < values.size(); ++k)
      result.push_back(values[k] / 2 + (values[k > 0 ? k - 1 : k] + values[k + 1 < values.size() ? k + 1 : k]) / 4);
    return result;
  }

  std::size_t place_of(std::size_t axis, std::size_t draw) const {
    const double share = lattice_.at(draw, axis);
    const std::vector<double>& probabilities = probabilities_[axis];
    std::size_t k = 0;
    for (double sum = probabilities[0]; sum < share && k + 1 < probabilities.size(); sum += probabilities[k]) ++k;
    return k;
  }

  /// No place is without any, so that no weight is without bound.
  void set(std::size_t axis, std::vector<double> probabilities, double elsewhere) {
    for (double& p : probabilities) p = (1 - elsewhere) * p + elsewhere / static_cast<double>(probabilities.size());
    probabilities_.resize(places_.size());
    probabilities_[axis] = std::move(probabilities);
  }

  const NoiseRatios& ratios_;
  Lattice lattice_;
  std::vector<std::vector<RatioPlace>> places_;
  std::vector<double> estimated_;
  std::vector<std::vector<double>> probabilities_, next_;
};

}  // namespace

std::vector<double> normalized(std::vector<double> logarithms) {
  double most = -std::numeric_limits<double>::infinity(), sum = 0;
  for (const double x : logarithms)
    if (std::isfinite(x)) most = std::max(most, x);
  for (double& x : logarithms) sum += x = std::isfinite(x) ? std::exp(x - most) : 0;
  for (double& x : logarithms) x /= sum;
  return logarithms;
}

// Importance sampling whose density is a product that is learned from the draws before: G. P. Lepage, "A new algorithm
// for adaptive multidimensional integration", J. Comp. Phys. 27 (1978).
RatioDraws draws_of(const NoiseRatios& ratios) {
  Sampler sampler(ratios);
  if (ratios.axes().size() == 1) return sampler.along(0);
  constexpr std::size_t first = 256, last = 512, most = 8192;
  constexpr double enough = 200;
  sampler.start();
  RatioDraws draws = sampler.draws(first);
  for (std::size_t count = last; count <= most; count *= 4) {
    if (!(draws.effective > 0)) break;
    sampler.learn(draws);
    draws = sampler.draws(count);
    if (draws.effective >= enough) break;
  }
  return draws;
}

}  // namespace continuo::studies::detail
