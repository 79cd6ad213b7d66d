// The end of a flight with lasting contacts or motors, within a step: a contact force falls to 0, a contact begins to
// slip or to stick, a corner comes to lie beside one that touches, a contact leaves its feature, a motor reaches its
// speed or its greatest force, the force of a limit falls to 0, a joint bears its strength, or rows that depend on each
// other no longer agree.
#pragma once
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include <continuo/bodies/exact_rigid/reduced_contacts.hpp>
#include <continuo/bodies/exact_rigid/rigid_flight.hpp>
#include <continuo/bodies/exact_rigid/rubbing_in_space.hpp>
#include <continuo/bodies/exact_rigid/separation.hpp>
#include <continuo/numerics/root_bracketing.hpp>

namespace continuo {

/// Two parts that stay in contact, by the numbers of their bodies in the system.
template <class Real, int Dim>
struct WatchedPair {
  ExactPart<Real, Dim> part_a{}, part_b{};
  std::uint32_t a = 0, b = 0;
  Real overlap{};  // beyond what is in contact, that is the end of the flight, in units of the size
};

template <class Real, int Dim>
class ContactGuards {
 public:
  using V = Vector<Real, Dim>;
  using X = std::vector<Real>;
  using System = RigidSystem<Real, Dim>;
  /// What a guard that begins at 0 may fall by; of gaps, in units of the size.
  static constexpr Real small = std::is_same_v<Real, float> ? Real(1e-4) : Real(1e-10);

  /// Corners nearer to the face than `near` times the size of their body may stay there, where what is in contact holds
  /// them. A contact has left its feature where the gap is more than `drift` times the size.
  ContactGuards(const Real& near, const Real& drift, const Real& force, const Real& speed)
      : near_(near), drift_(drift), force_(force), speed_(speed) {}

  void watch(const WatchedPair<Real, Dim>& pair) { pairs_.push_back(pair); }
  /// To be called before the first step.
  void begin(System& system, const Real& t, const X& state) {
    system.evaluate(t, state);
    for (const auto& contact : system.contacts())
      for (const auto& pair : pairs_)
        if (pair.a == contact.a && pair.b == contact.b) find_corners(system, contact, pair);
    for (auto& corner : corners_) corner.is_held = corner.is_held && depends(system, corner);
    for (auto& pair : pairs_) pair.overlap = std::max(2 * small, Real(small - beyond_held(system, pair)));
    last_ = values(system, t, state);
    small_.assign(last_.size(), small);
    for (std::size_t k = 0; k < corners_.size(); ++k)
      if (corners_[k].is_held) small_[first_corner_ + k] = drift_;
    for (std::size_t i = 0; i < first_corner_; ++i)  // what was allowed where the contacts were chosen
      if (last_[i] > -100 * small) small_[i] = std::max(small_[i], -2 * last_[i]);
    allow_slow_slips(system);
    armed_.resize(last_.size());
    for (std::size_t i = 0; i < last_.size(); ++i) armed_[i] = last_[i] > small_[i];
  }
  [[nodiscard]] bool is_empty() const { return last_.empty(); }
  /// The first time in the present step of the flight at which a guard falls through 0.
  [[nodiscard]] std::optional<Real> first_change(RigidFlight<Real, Dim>& flight) {
    constexpr int samples = 8;
    X state;
    Real before = flight.begin();
    for (int sample = 1; sample <= samples; ++sample) {
      const Real t = sample == samples
                         ? flight.end()
                         : flight.begin() + (flight.end() - flight.begin()) * static_cast<Real>(sample) / samples;
      flight.at(t, state);
      const std::vector<Real> now = values(flight.system(), t, state);
      std::optional<Real> first;
      for (std::size_t i = 0; i < now.size(); ++i) {
        const Real level = armed_[i] ? Real(0) : -small_[i];
        if (now[i] < level) {
          const Real at = root(flight, i, level, before, t, last_[i], now[i]);
          if (!first || at < *first) first = at;
        } else if (now[i] > small_[i]) {
          armed_[i] = true;
        }
      }
      if (first) return first;
      last_ = now, before = t;
    }
    return {};
  }

 private:
  struct Corner {
    std::uint32_t contact = 0;
    V in_body{};
    bool of_b = false;
    Real rounding{}, size{};
    bool is_held = false;  // on the face, by the contacts and joints
  };

  [[nodiscard]] Real root(RigidFlight<Real, Dim>& flight, std::size_t i, const Real& level, const Real& near,
                          const Real& far, const Real& value_near, const Real& value_far) {
    X state;
    const auto beyond = [&](const Real& t) {
      flight.at(t, state);
      return level - values(flight.system(), t, state)[i];
    };
    if (!(level - value_near <= Real(0))) return far;
    return enclose_root<Real>(beyond, near, far, level - value_near, level - value_far).far;
  }
  /// What still slips slowly the other way where it begins to slip is on its way to 0: no change of the contact.
  void allow_slow_slips(const System& system) {
    if (Dim == 3) return;
    std::size_t guard = system.contacts().size();
    for (const auto& one : system.contacts()) {
      if (!one.is_first || one.rubbing == Rubbing::none) continue;
      if (one.rubbing != Rubbing::sticks) small_[guard] = std::max(small, -2 * last_[guard]);
      ++guard;
    }
  }
  /// The corners of the other body that may come to lie on the face of a contact.
  void find_corners(const System& system, const ActingContact<Real, Dim>& contact, const WatchedPair<Real, Dim>& pair) {
    using Kind = typename ContactFeature<Real, Dim>::Kind;
    const Kind kind = contact.feature.kind;
    if (kind != Kind::face_of_a && kind != Kind::face_of_b) return;
    const bool of_b = kind == Kind::face_of_a;
    const ExactPart<Real, Dim>& part = of_b ? pair.part_b : pair.part_a;
    if (part.is_wall()) return;
    const auto number = static_cast<std::uint32_t>(&contact - system.contacts().data());
    for (const V& corner : part.convex->core.corners) {
      Corner one{number, part.in_body.place(corner), of_b, part.rounding(), part.convex->reach};
      const auto touches = [&](const auto& other) {
        return other.a == contact.a && other.b == contact.b &&
               (of_b ? other.feature.point_b : other.feature.point_a) == one.in_body;
      };
      if (std::ranges::any_of(system.contacts(), touches)) continue;
      const Real gap = gap_of(system, one);
      if (gap < -near_) continue;  // beside the face
      one.is_held = gap <= near_;
      corners_.push_back(one);
    }
  }
  [[nodiscard]] ContactPlace<Real, Dim> place(const System& system, const Corner& corner) const {
    const auto& contact = system.contacts()[corner.contact];
    ContactFeature<Real, Dim> feature = contact.feature;
    (corner.of_b ? feature.point_b : feature.point_a) = corner.in_body;
    (corner.of_b ? feature.rounding_b : feature.rounding_a) = corner.rounding;  // of the part, maybe another one
    return place_of(feature, system.bodies()[contact.a], system.bodies()[contact.b]);
  }
  [[nodiscard]] Real gap_of(const System& system, const Corner& corner) const {
    return place(system, corner).gap / corner.size;
  }
  [[nodiscard]] static MotionRow<Real, Dim> row_of(const System& system, const ActingContact<Real, Dim>& contact,
                                                   const ContactPlace<Real, Dim>& at) {
    MotionRow<Real, Dim> row = normal_row(at, system.bodies()[contact.a], system.bodies()[contact.b]);
    row.a = contact.a, row.b = contact.b;
    return row;
  }
  /// Whether a corner cannot move against its face as long as joints and contacts hold, as the fourth corner of a box
  /// on a floor: its row depends on theirs. Its gap has the errors within a step, which are no change of the contact.
  [[nodiscard]] bool depends(const System& system, const Corner& corner) const {
    std::vector<MotionRow<Real, Dim>> held = system.joint_rows();
    for (const auto& contact : system.contacts())
      held.push_back(
          row_of(system, contact, place_of(contact.feature, system.bodies()[contact.a], system.bodies()[contact.b])));
    const MotionRow<Real, Dim> row = row_of(system, system.contacts()[corner.contact], place(system, corner));
    const std::vector<MotionRow<Real, Dim>> rows{row};
    const Real free = ReducedContacts<Real, Dim>(system.bodies().data(), held, rows).matrix()[0];
    return !(free > Real(1e-6) * response(row, row, system.bodies().data()));
  }
  /// The gap of a pair beyond that of its contacts that last, whose errors within a step are not its own.
  [[nodiscard]] Real beyond_held(const System& system, const WatchedPair<Real, Dim>& pair) const {
    const ExactBody<Real, Dim>&a = system.bodies()[pair.a], &b = system.bodies()[pair.b];
    Real held = std::numeric_limits<Real>::infinity();
    for (const auto& contact : system.contacts())
      if (contact.a == pair.a && contact.b == pair.b) held = std::min(held, place_of(contact.feature, a, b).gap);
    const Real gap = separation_of(pair.part_a, a, pair.part_b, b).gap;
    return (gap - (held < std::numeric_limits<Real>::infinity() ? held : Real(0))) / pair.part_b.convex->reach;
  }
  [[nodiscard]] std::vector<Real> values(System& system, const Real& t, const X& state) {
    // Errors of the state within a step leave some disagreement, too.
    constexpr Real most_disagreement = std::is_same_v<Real, float> ? Real(1e-1) : Real(1e-5);
    system.evaluate(t, state);
    system.share_forces();
    std::vector<Real> all;
    const auto contacts = system.contacts();
    for (std::size_t k = 0; k < contacts.size(); ++k) {
      // In space the room of what sticks tells also whether it presses.
      const bool is_in_room = Dim == 3 && contacts[k].rubbing == Rubbing::sticks;
      all.push_back(is_in_room ? Real(1) : system.press(k) / force_);
    }
    if constexpr (Dim == 2) {
      add_rubbing(system, all);
    } else {
      add_rubbing_in_space(system, force_, speed_, all);
    }
    first_corner_ = all.size();
    for (const Corner& corner : corners_) all.push_back(gap_of(system, corner));
    for (const WatchedPair<Real, Dim>& pair : pairs_) {
      const Real gap = beyond_held(system, pair);
      all.push_back(drift_ - gap), all.push_back(pair.overlap + gap);
    }
    add_motors(system, all);
    for (std::size_t j = 0; j < system.joints().size(); ++j)
      if (is_held_on_one_side(system.joints()[j])) all.push_back(system.push_of_limit(j) / force_);
    if (system.has_dependent_rows()) all.push_back(1 - system.disagreement() / most_disagreement);
    const auto breaks = [](const auto& joint) { return has_strength(joint.joint); };
    if (!std::ranges::any_of(system.joints(), breaks)) return all;
    system.find_shortest_forces(t, state);
    for (std::size_t j = 0; j < system.joints().size(); ++j)
      if (breaks(system.joints()[j])) all.push_back(1 - system.strain(j));
    return all;
  }
  /// Of each pair that rubs its friction or its slip, then whether the forces of all that slip are stable.
  void add_rubbing(const System& system, std::vector<Real>& all) const {
    const auto contacts = system.contacts();
    bool is_slipping = false;
    for (std::size_t k = 0; k < contacts.size(); ++k) {
      const auto& one = contacts[k];
      if (!one.is_first || one.rubbing == Rubbing::none) continue;
      if (one.rubbing == Rubbing::sticks) {
        Real most(0);
        for (std::size_t l = 0; l < contacts.size(); ++l)
          if (contacts[l].pair == one.pair) most += one.friction * system.press(l);
        all.push_back((most - std::abs(system.stick(k))) / force_);
        continue;
      }
      const auto &a = system.bodies()[one.a], &b = system.bodies()[one.b];
      const Real slip = across_row(place_of(one.feature, a, b), a, b).rate_of(a, b);
      all.push_back((one.rubbing == Rubbing::forwards ? slip : -slip) / speed_);
      is_slipping = true;
    }
    if (is_slipping) all.push_back(system.is_stable() ? Real(1) : Real(-1));
  }
  void add_motors(const System& system, std::vector<Real>& all) const {
    for (std::size_t j = 0; j < system.joints().size(); ++j) {
      const auto& joint = system.joints()[j];
      if (joint.motor == MotorMode::none) continue;
      const JointMotor<Real>& motor = *joint.joint.motor;
      if (!(motor.most < std::numeric_limits<Real>::infinity())) continue;
      if (joint.motor == MotorMode::keeps_speed) {
        all.push_back(motor.most > Real(0) ? 1 - std::abs(system.load_of(j).motor) / motor.most : Real(1));
      } else {
        const Real behind = motor.speed - system.motor_rate(j);
        all.push_back((joint.motor == MotorMode::forwards ? behind : -behind) /
                      std::max(std::abs(motor.speed), Real(1)));
      }
    }
  }

  Real near_, drift_, force_, speed_;  // force_ and speed_: by which these are divided
  std::vector<WatchedPair<Real, Dim>> pairs_;
  std::vector<Corner> corners_;
  std::size_t first_corner_ = 0;    // among the guards
  std::vector<Real> last_, small_;  // small_: a guard that has not been above this is not to fall below its negative
  std::vector<bool> armed_;
};

}  // namespace continuo
