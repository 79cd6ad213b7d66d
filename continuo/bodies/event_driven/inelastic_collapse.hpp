// The rule of the event-driven motion against inelastic collapse, where collisions follow one another without end.
//
// Collisions of a body are in a row where each follows the one before within the contact time. Those that may end by
// themselves (endless_collisions.hpp) are treated as any other: a light ball between a wall and one of 10^8 times its
// mass has 31,000 of them, and keeps all its energy where e = 1. After them, without gravity, all bodies in contact are
// struck simultaneously (see simultaneous_impacts.hpp); bodies that rounding keeps approaching are caught after
// `most_strikes_at_once` strikes at one instant. Under gravity the two bodies no longer bounce, and after as many
// collisions again they continue in persistent contact.
#pragma once
#include <algorithm>
#include <cstdint>
#include <limits>

#include <continuo/bodies/contacts/endless_collisions.hpp>
#include <continuo/bodies/event_driven/flights.hpp>

namespace continuo {

inline constexpr int most_strikes_at_once = 64;

template <class Real>
[[nodiscard]] bool loses(const Material<Real>& material) {
  return material.restitution < Real(1) || material.friction > Real(0);
}

template <class Real, int Dim>
class InelasticCollapse {
 public:
  using BodyPlan = Plan<Real, Dim>;

  InelasticCollapse(bool is_heavy, const Real& contact_time) : is_heavy_(is_heavy), contact_time_(contact_time) {}

  /// Whether collisions have piled up with so many in a row before this one.
  [[nodiscard]] bool is_piled(const Material<Real>& material, std::uint32_t in_a_row) const {
    return loses(material) && are_enough(material, in_a_row);
  }
  [[nodiscard]] bool is_caught(const Material<Real>& material, const BodyPlan& plan, const Real& now) const {
    if (!loses(material)) return false;
    return is_heavy_ ? are_enough(material, in_a_row(plan, now) / 2)
                     : plan.last_collision == now && plan.strikes_at_once >= most_strikes_at_once;
  }

  [[nodiscard]] std::uint32_t in_a_row(const BodyPlan& plan, const Real& now) const {
    return is_soon(plan, now) ? plan.in_a_row : 0;
  }
  void count(BodyPlan& plan, const Real& now, bool is_strike) const {
    constexpr std::uint32_t most = std::numeric_limits<std::uint32_t>::max();
    plan.in_a_row = is_soon(plan, now) ? std::min(plan.in_a_row, most - 1) + 1 : 0;
    const int strikes = plan.last_collision == now ? plan.strikes_at_once : 0;
    plan.strikes_at_once = static_cast<std::uint8_t>(std::min(strikes + static_cast<int>(is_strike), 255));
    plan.last_collision = now;
  }

 private:
  /// Without forces and without restitution, bodies are struck simultaneously sooner.
  [[nodiscard]] bool are_enough(const Material<Real>& material, std::uint32_t in_a_row) const {
    if (!is_heavy_ && !(material.restitution > Real(0))) return in_a_row >= 4;
    return is_endless(material.restitution, in_a_row);
  }
  [[nodiscard]] bool is_soon(const BodyPlan& plan, const Real& now) const {
    return plan.last_collision == now || now - plan.last_collision < contact_time_;
  }

  bool is_heavy_;
  Real contact_time_;
};

}  // namespace continuo
