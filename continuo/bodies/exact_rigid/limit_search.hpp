// When a joint reaches a limit within a step of a flight.
#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include <continuo/bodies/exact_rigid/rigid_flight.hpp>
#include <continuo/bodies/exact_rigid/safe_time.hpp>

namespace continuo {

/// The gaps of limits that a flight does not keep closed, followed by steps that cannot pass their zeros: the third
/// derivative of a gap is bounded by the differences of the second one between samples of the step.
template <class Real, int Dim>
class LimitSearch {
 public:
  using Flight = RigidFlight<Real, Dim>;
  using System = RigidSystem<Real, Dim>;

  /// Rooms of a gap: at most `near`, a joint is at its limit; within `band`, rounding hides the gap.
  struct Size {
    Real near{}, band{};
  };
  /// Those of joint j of a system. Of lengths they grow with the `reach` of the bodies of the world.
  [[nodiscard]] static Size size_of(const System& system, std::size_t j, std::span<const Real> reach) {
    const auto& joint = system.joints()[j];
    constexpr Real rounding = std::numeric_limits<Real>::epsilon();
    const bool is_angle = joint.joint.kind == JointKind::hinge;
    Real size(is_angle ? 1 : 0), place(is_angle ? 1 : 0);
    for (const std::uint32_t k : {joint.a, joint.b}) {
      const auto& body = system.bodies()[k];
      place += is_angle ? angle_of(body.orientation) : length(body.x);
      const std::uint32_t number = system.numbers()[k];
      if (!is_angle && number < reach.size()) size = std::max(size, reach[number]);
    }
    return {std::sqrt(rounding) / 100 * size, 1000 * rounding * (place + size)};
  }

  /// The first time in the present step of the flight at which a limit is reached.
  [[nodiscard]] static std::optional<Real> first_reached(Flight& flight, std::span<const Real> reach) {
    std::optional<Real> first;
    for (std::uint32_t j = 0; j < flight.system().joints().size(); ++j) {
      const auto& joint = flight.system().joints()[j];
      for (const LimitSide side : {LimitSide::lower, LimitSide::upper}) {
        if (joint.held == side || joint.held == LimitSide::both || !has_limit(joint.joint, side)) continue;
        const auto at = reached(flight, {j, side}, size_of(flight.system(), j, reach).band);
        if (at && (!first || *at < *first)) first = at;
      }
    }
    return first;
  }

 private:
  struct Gap {
    Real value{}, rate{}, bend{};
  };
  [[nodiscard]] static Real angle_of(const Vector<Real, 1>& angle) { return std::abs(angle[0]); }
  [[nodiscard]] static Real angle_of(const Vector<Real, 4>&) { return Real(1); }

  [[nodiscard]] static Gap gap_at(Flight& flight, const JointLimit& of, const Real& t) {
    std::vector<Real> state;
    flight.at(t, state);
    System& system = flight.system();
    system.unpack(t, state);
    const auto row = system.limit_row(of);
    const auto& a = system.bodies()[row.a];
    const auto& b = system.bodies()[row.b];
    const auto accelerations = [&](std::uint32_t k, const ExactBody<Real, Dim>& body) {
      return k < system.moving() ? flight.accelerations_at(k, t, body) : Accelerations<Real, Dim>{};
    };
    const auto of_a = accelerations(row.a, a), of_b = accelerations(row.b, b);
    return {row.error, row.rate_of(a, b),
            dot(row.direction, of_b.linear - of_a.linear) + dot(row.lever_b, of_b.angular) -
                dot(row.lever_a, of_a.angular) + row.drift};
  }
  [[nodiscard]] static std::optional<Real> reached(Flight& flight, const JointLimit& of, const Real& band) {
    constexpr int samples = 8, most_rounds = 10'000;
    const Real begin = flight.begin(), end = flight.end(), apart = (end - begin) / samples;
    const Gap at_begin = gap_at(flight, of, begin);
    Real jerk(0), before = at_begin.bend;
    for (int sample = 1; sample <= samples; ++sample) {
      const Real bend = gap_at(flight, of, sample == samples ? end : begin + apart * static_cast<Real>(sample)).bend;
      jerk = std::max(jerk, Real(Real(1.5) * std::abs(bend - before) / apart));
      before = bend;
    }
    const Real level = at_begin.value > band ? Real(0) : std::min(at_begin.value, Real(0)) - band;
    Gap gap = at_begin;
    Real t = begin;
    for (int round = 0; round < most_rounds; ++round) {
      const Real left = end - t, safe = time_above(gap.value - level, gap.rate, gap.bend, jerk, left);
      if (safe >= left) return {};
      constexpr Real rounding = std::numeric_limits<Real>::epsilon();
      if (safe <= 4 * rounding * std::abs(t) || gap.value - level <= band / 250) return t;
      t += safe;
      gap = gap_at(flight, of, t);
    }
    return t;
  }
};

}  // namespace continuo
