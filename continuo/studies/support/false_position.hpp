// Where a test of a branch's places is zero, between two of them. Internal to what follows orbits.
#pragma once
#include <optional>
#include <utility>

namespace continuo::studies::detail {

/// Illinois false position, with a bisection where it is slow. `place_at(s)`: the place so far along the branch,
/// optional; `test` is `at_low` at s = 0 and `at_high` at s = high, of other signs. `found_at`: the last s.
template <class PlaceAt, class Test>
[[nodiscard]] auto located_zero(const PlaceAt& place_at, const Test& test, double high, double at_low, double at_high,
                                double& found_at) {
  constexpr int most = 60;
  constexpr double exact = 1e-10;
  const double step = high;
  double low = 0;
  decltype(place_at(low)) best;
  int last_side = 0;
  for (int k = 0; k < most && high - low > exact * step; ++k) {
    const double secant = high - at_high * (high - low) / (at_high - at_low);
    const double s = k % 4 == 3 || !(secant > low && secant < high) ? (low + high) / 2 : secant;
    auto place = place_at(s);
    if (!place) break;
    const double value = test(*place);
    best = std::move(place);
    found_at = s;
    if (value < exact && value > -exact) break;
    const int side = (value < 0) == (at_low < 0) ? -1 : 1;
    if (side < 0) {
      low = s, at_low = value;
      if (last_side < 0) at_high /= 2;
    } else {
      high = s, at_high = value;
      if (last_side > 0) at_low /= 2;
    }
    last_side = side;
  }
  return best;
}

}  // namespace continuo::studies::detail
