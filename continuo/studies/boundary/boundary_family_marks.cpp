// continuo/studies/boundary/boundary_family_marks.cpp
// Locates folds and crossings between two places of a family.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>

#include <continuo/studies/boundary/boundary_family_marks.hpp>

namespace continuo::studies::detail {

namespace {

/// How many measures of crossings have other signs.
std::size_t changed_signs(const FamilyPlace& a, const FamilyPlace& b) {
  std::size_t count = 0;
  for (std::size_t k = 0; k < FamilyPlace::tests; ++k) count += a.crossing[k] * b.crossing[k] < 0 ? 1 : 0;
  return count;
}

/// Where the test, which has different signs at both, is zero: by the Illinois variant of the false position. Next to a
/// crossing the equations lose their hold; what has been reached by then will do.
template <class Test>
std::optional<FamilyPlace> located(FamilySteps& steps, const FamilyPlace& a, const FamilyPlace& b, double step,
                                   const Test& test) {
  constexpr int most_trials = 40;
  constexpr double narrow = 1e-9, nought = 1e-10;
  const double size = std::min(std::abs(test(a)), std::abs(test(b)));
  double low = 0, high = step, at_low = test(a), at_high = test(b), least = std::numeric_limits<double>::infinity();
  int side = 0;
  std::optional<FamilyPlace> best;
  for (int k = 0; k < most_trials && high - low > narrow * step && !(least <= nought * size); ++k) {
    double s = low + (high - low) * at_low / (at_low - at_high);
    if (!(s > low && s < high)) s = (low + high) / 2;
    auto place = steps.stepped(a.solution, a.tangent, s);
    if (!place) break;
    const double value = test(*place);
    if (std::abs(value) < least) {
      least = std::abs(value);
      best = std::move(place);
    }
    if (value * at_low > 0) {
      low = s, at_low = value;
      if (side > 0) at_high /= 2;
      side = 1;
    } else {
      high = s, at_high = value;
      if (side < 0) at_low /= 2;
      side = -1;
    }
  }
  return best;
}

/// A mesh that serves the solution need not serve the direction in which the other family leaves it: the motion of a
/// rod that is straight needs no mesh at all. It is halved until that makes no difference.
template <class Test>
FamilyPlace on_finer_meshes(FamilySteps& steps, FamilyPlace best, FamilyPlace from, double step, const Test& test) {
  constexpr double alike = 1e-9, least_size = 1e-3;
  constexpr int most_halvings = 6;
  for (int halving = 0; halving < most_halvings; ++halving) {
    auto finer = steps.on_halved_mesh(from);
    if (!finer) break;
    from = std::move(*finer);
    const auto end = steps.stepped(from.solution, from.tangent, step);
    if (!end || test(from) * test(*end) > 0) break;
    auto there = located(steps, from, *end, step, test);
    if (!there) break;
    const double change = std::abs(there->constant() - best.constant());
    best = std::move(*there);
    if (change < alike * std::max(std::abs(best.constant()), least_size * steps.range())) break;
  }
  return best;
}

}  // namespace

bool is_ambiguous(const FamilyPlace& a, const FamilyPlace& b) {
  const std::size_t changed = changed_signs(a, b);
  return std::min(changed, FamilyPlace::tests - changed) > FamilyPlace::tests / 4;
}

BetweenPlaces what_lies_between(FamilySteps& steps, const FamilyPlace& a, const FamilyPlace& b, double step) {
  constexpr double small = 1e-2;
  BetweenPlaces found;
  if (2 * changed_signs(a, b) > FamilyPlace::tests) {
    // The first of the measures that goes through zero: one that leaps has not become small.
    found.doubtful = true;
    for (std::size_t k = 0; k < FamilyPlace::tests; ++k) {
      const auto test = [k](const FamilyPlace& place) { return place.crossing[k]; };
      if (test(a) * test(b) > 0) continue;
      auto place = located(steps, a, b, step, test);
      if (!place || std::abs(test(*place)) > small * std::min(std::abs(test(a)), std::abs(test(b)))) continue;
      found = {FamilyEvent::branch_point, on_finer_meshes(steps, std::move(*place), a, step, test)};
      return found;
    }
  }
  if (a.slope * b.slope < 0) {
    found.kind = FamilyEvent::fold;
    found.place = located(steps, a, b, step, [](const FamilyPlace& place) { return place.slope; });
    found.doubtful = found.doubtful || !found.place;
  }
  return found;
}

}  // namespace continuo::studies::detail
