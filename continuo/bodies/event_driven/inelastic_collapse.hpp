// When collisions pile up without end: the explicit rule against inelastic collapse of the event-driven motion.
//
// Of those of a body that follow on one another within the contact time, the first few are as any other: a speed that
// takes more than 32 / (1 - e) of them to die away would be less than exp(-32) by then. Without gravity, all that touch
// are then struck together (see simultaneous_impacts.hpp); what that leaves, by rounding, is caught after so many
// times. Under gravity two bounce no more then, and after as many again held contacts go on from there.
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

  /// After how many in a row it has piled up. What does not bounce at all is struck together sooner.
  [[nodiscard]] int enough(const Material<Real>& material) const {
    if (!is_heavy_ && !(material.restitution > Real(0))) return 4;
    const Real lost = 1 - material.restitution;
    return lost * most_in_a_row > Real(32) ? std::max(fewest_in_a_row, static_cast<int>(32 / lost)) : most_in_a_row;
  }
  /// With so many collisions in a row before this one.
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
