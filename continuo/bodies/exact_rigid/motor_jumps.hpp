// Where the speed of a motor, a function of time, jumps.
#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <span>

#include <continuo/bodies/exact_options.hpp>

namespace continuo {

/// The last time before a jump and the first one after it, which are neighbours.
template <class Real>
struct MotorJump {
  Real before{}, after{};
};

/// The first jump of a law between two times that sampling finds, to neighbouring numbers. Between two samples a speed
/// that does not jump changes as its derivative says, by Simpson's rule; where it does not, samples are added halfway.
template <class Real>
[[nodiscard]] std::optional<MotorJump<Real>> first_jump_between(const MotorLaw<Real>& law, const Real& begin,
                                                                const Real& end, const MotorSpeed<Real>& at_begin,
                                                                const MotorSpeed<Real>& at_end) {
  constexpr Real most = std::is_same_v<Real, float> ? Real(1e-3) : Real(1e-8);
  const Real middle = begin + (end - begin) / 2;
  const bool are_neighbours = !(begin < middle && middle < end);
  const MotorSpeed<Real> between = are_neighbours ? at_begin : law.speed(middle);
  const auto differs = [&](const MotorSpeed<Real>& from, const MotorSpeed<Real>& to, const Real& change) {
    return std::abs(to.speed - from.speed - change) > most * std::max(Real(1), std::abs(to.speed));
  };
  const Real change = (end - begin) / 6 * (at_begin.change + 4 * between.change + at_end.change);
  const Real half = (end - begin) / 24 * (5 * at_begin.change + 8 * between.change - at_end.change);
  if (!differs(at_begin, at_end, change) && !differs(at_begin, between, half)) return {};
  if (are_neighbours) return MotorJump<Real>{begin, end};
  if (const auto found = first_jump_between(law, begin, middle, at_begin, between)) return found;
  return first_jump_between(law, middle, end, between, at_end);
}
/// The first jump of any of these laws.
template <class Real>
[[nodiscard]] std::optional<MotorJump<Real>> first_jump(std::span<const MotorLaw<Real>> laws, const Real& begin,
                                                        const Real& end) {
  constexpr int samples = 64;
  std::optional<MotorJump<Real>> first;
  for (const MotorLaw<Real>& law : laws) {
    Real near = begin;
    MotorSpeed<Real> at_near = law.speed(near);
    for (int sample = 1; sample <= samples && !(first && first->after <= near); ++sample) {
      const Real far = sample == samples ? end : begin + (end - begin) * static_cast<Real>(sample) / samples;
      const MotorSpeed<Real> at_far = law.speed(far);
      const auto found = near < far ? first_jump_between(law, near, far, at_near, at_far) : std::nullopt;
      if (found && (!first || found->before < first->before)) first = found;
      if (found) break;
      near = far, at_near = at_far;
    }
  }
  return first;
}

}  // namespace continuo
