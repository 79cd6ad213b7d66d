// The rule of the event-driven motion against inelastic collapse, where collisions follow one another without end.
//
// Collisions of a body are in a row where each follows the one before within the contact time. The first 32 / (1 - e)
// of them are treated as any other, within bounds: by then a speed of approach has fallen to exp(-32) of itself. After
// them, without gravity, all bodies in contact are struck simultaneously (see simultaneous_impacts.hpp); bodies that
// rounding keeps approaching are caught after `most_strikes_at_once` strikes at one instant. Under gravity the two
// bodies no longer bounce, and after as many collisions again they continue in persistent contact.
#pragma once
#include <algorithm>
#include <cstdint>

#include <continuo/bodies/event_driven/flights.hpp>

namespace continuo {

inline constexpr int fewest_in_a_row = 64, most_in_a_row = 4096, most_strikes_at_once = 64;

template <class Real>
[[nodiscard]] bool loses(const Material<Real>& material) {
  return material.restitution < Real(1) || material.friction > Real(0);
}

template <class Real, int Dim>
class InelasticCollapse {
 public:
  using BodyPlan = Plan<Real, Dim>;

  InelasticCollapse(bool is_heavy, const Real& contact_time) : is_heavy_(is_heavy), contact_time_(contact_time) {}

  /// The number of collisions in a row after which they count as piled up. Without restitution, bodies are struck
  /// simultaneously sooner.
  [[nodiscard]] int enough(const Material<Real>& material) const {
    if (!is_heavy_ && !(material.restitution > Real(0))) return 4;
    const Real lost = 1 - material.restitution;
    return lost * most_in_a_row > Real(32) ? std::max(fewest_in_a_row, static_cast<int>(32 / lost)) : most_in_a_row;
  }
  /// Whether collisions have piled up with so many in a row before this one.
  [[nodiscard]] bool is_piled(const Material<Real>& material, int in_a_row) const {
    return loses(material) && in_a_row >= enough(material);
  }
  [[nodiscard]] bool is_caught(const Material<Real>& material, const BodyPlan& plan, const Real& now) const {
    if (!loses(material)) return false;
    return is_heavy_ ? in_a_row(plan, now) >= 2 * enough(material)
                     : plan.last_collision == now && plan.strikes_at_once >= most_strikes_at_once;
  }

  [[nodiscard]] int in_a_row(const BodyPlan& plan, const Real& now) const {
    return is_soon(plan, now) ? plan.in_a_row : 0;
  }
  void count(BodyPlan& plan, const Real& now, bool is_strike) const {
    plan.in_a_row = static_cast<std::uint16_t>(is_soon(plan, now) ? std::min(plan.in_a_row + 1, 2 * most_in_a_row) : 0);
    const int strikes = plan.last_collision == now ? plan.strikes_at_once : 0;
    plan.strikes_at_once = static_cast<std::uint8_t>(std::min(strikes + static_cast<int>(is_strike), 255));
    plan.last_collision = now;
  }

 private:
  [[nodiscard]] bool is_soon(const BodyPlan& plan, const Real& now) const {
    return plan.last_collision == now || now - plan.last_collision < contact_time_;
  }

  bool is_heavy_;
  Real contact_time_;
};

}  // namespace continuo
