// The screening of Morris: designs by the number of the run, and elementary effects.
#include <cmath>
#include <limits>
#include <vector>

#include <fmt/format.h>

#include <continuo/studies/fit/student_t.hpp>
#include <continuo/studies/sweep/counter_random.hpp>
#include <continuo/studies/sweep/morris.hpp>

namespace continuo::studies {
namespace {

using detail::Purpose;
using detail::random_bits;

/// After how many changes of other factors this one changes.
std::uint64_t place_in_order(const MorrisDesign& design, std::uint64_t trajectory, std::size_t factor) {
  return detail::permuted(factor, design.factors, random_bits(design.seed, Purpose::order, 0, trajectory)[0]);
}

ElementaryEffects effects_of(const std::vector<double>& effects) {
  ElementaryEffects result;
  result.count = effects.size();
  const auto n = static_cast<double>(effects.size());
  double sum = 0, absolute = 0;
  for (const double e : effects) sum += e, absolute += std::abs(e);
  result.mean = sum / n;
  const double middle = absolute / n;
  double squares = 0, squares_of_absolute = 0;
  for (const double e : effects) {
    squares += (e - result.mean) * (e - result.mean);
    squares_of_absolute += (std::abs(e) - middle) * (std::abs(e) - middle);
  }
  result.deviation = std::sqrt(squares / (n - 1));
  const double reach = student_t_quantile(0.95, n - 1) * std::sqrt(squares_of_absolute / (n - 1) / n);
  result.mean_absolute = {middle, middle - reach, middle + reach};
  return result;
}

}  // namespace

Status check(const MorrisDesign& design) {
  if (design.factors == 0) return invalid_input("nothing is varied; name at least one quantity");
  if (design.trajectories < 2)
    return invalid_input("the screening of Morris needs 2 trajectories at least; 10 to 50 are usual");
  if (design.levels < 2 || design.levels % 2 != 0)
    return invalid_input(
        fmt::format("the screening of Morris needs an even number of levels, not {}; 4 is usual", design.levels));
  return check(SamplingPlan{.runs = design.trajectories, .dimensions = design.factors + 1});
}

double coordinate(const MorrisDesign& design, std::uint64_t run, std::size_t factor) {
  const std::uint64_t trajectory = run / (design.factors + 1), changes = run % (design.factors + 1);
  const auto bits = random_bits(design.seed, Purpose::levels, static_cast<std::uint32_t>(factor), trajectory);
  const std::uint64_t lower = detail::below(design.levels / 2, bits[0]);
  const bool begins_above = (bits[1] & 1) != 0, has_changed = place_in_order(design, trajectory, factor) < changes;
  const std::uint64_t level = lower + (begins_above != has_changed ? design.levels / 2 : 0);
  return (static_cast<double>(level) + 0.5) / design.levels;
}

MorrisScreening morris_screening(const MorrisDesign& design, std::span<const double> outcomes) {
  MorrisScreening result;
  const std::size_t width = design.factors + 1;
  for (std::size_t factor = 0; factor < design.factors; ++factor) {
    std::vector<double> effects;
    std::uint64_t missing = 0;
    for (std::uint64_t trajectory = 0; trajectory < design.trajectories; ++trajectory) {
      const std::uint64_t before = trajectory * width + place_in_order(design, trajectory, factor);
      if (before + 1 >= outcomes.size()) continue;
      const double change = coordinate(design, before + 1, factor) - coordinate(design, before, factor);
      const double effect = (outcomes[before + 1] - outcomes[before]) / change;
      if (std::isfinite(effect)) {
        effects.push_back(effect);
      } else {
        ++missing;
      }
    }
    result.effects.push_back(effects_of(effects));
    result.effects.back().missing = missing;
  }
  return result;
}

}  // namespace continuo::studies
