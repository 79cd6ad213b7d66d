// The time after a step.
#pragma once
#include <cmath>
#include <limits>

namespace continuo {

/// After steps of equal length from 0 the time is their number times the step, without a sum of rounding errors.
template <class Real>
[[nodiscard]] Real time_after_step(const Real& time, const Real& step) {
  using std::abs, std::round;
  const Real steps = round(time / step), distance = time - steps * step;
  const bool is_multiple = abs(distance) <= 4 * std::numeric_limits<Real>::epsilon() * abs(time);
  return is_multiple ? (steps + 1) * step : time + step;
}

}  // namespace continuo
