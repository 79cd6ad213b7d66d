// Contacts under general forces, for flights and for time steps through contacts: which bodies touch, the impacts of an
// instant, and which contacts persist.
#pragma once
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include <continuo/bodies/contact_events.hpp>
#include <continuo/bodies/contacts/endless_collisions.hpp>
#include <continuo/bodies/contacts/impulse.hpp>
#include <continuo/bodies/contacts/joint_impacts.hpp>
#include <continuo/bodies/contacts/persistent_contacts.hpp>
#include <continuo/bodies/contacts/touching.hpp>
#include <continuo/bodies/event_driven/exact_engine.hpp>
#include <continuo/bodies/exact_options.hpp>

namespace continuo {

template <class Real, int Dim>
[[nodiscard]] Real greatest_acceleration(const World<Real, Dim>& world, std::span<const Vector<Real, Dim>> force) {
  Real greatest(0);
  for (std::size_t i = 0; i < force.size(); ++i)
    greatest = std::max(greatest, length(force[i]) * world.inverse_mass[i]);
  return greatest;
}

/// The records of the engine in which contacts are noted.
template <class Real, int Dim>
struct ContactJournal {
  ExactStatistics& statistics;
  ContactLog<Real, Dim>& log;
  std::vector<Real>& together;  // the last time at which each body lay on another
};

/// A contact that persists, and its impulse so far.
template <class Real>
struct LastingContact {
  Touching pair{};
  Real impulse{}, press{};  // press: the normal force, where nothing moves
  template <class Archive>
  void transfer(Archive& archive) {
    archive(pair), archive(impulse), archive(press);
  }
};

template <class Real, int Dim>
class ConstrainedContacts {
 public:
  using V = Vector<Real, Dim>;
  using S = Spin<Real, Dim>;
  using Lasting = LastingContact<Real>;
  using Journal = ContactJournal<Real, Dim>;
  static constexpr Real never = std::numeric_limits<Real>::infinity();

  ConstrainedContacts(World<Real, Dim>& world, const Real& time_of_contact)
      : contact_time(time_of_contact), last(world.size(), -never), world_(world) {}

  Real contact_time{};       // for so long after a collision a body does not bounce
  Real allowance{};          // bodies touch up to this gap, and may overlap by as much
  Real left_by_steps{};      // persistent contacts touch up to this gap after time steps
  std::vector<Real> last{};  // the time of the last collision of each body
  std::vector<Lasting> lasting{};
  Status fault{};                        // of the impacts when `resolve` was called last
  std::vector<std::uint32_t> numbers{};  // of the bodies in the whole world, where these differ

  /// The greatest acceleration by forces when `resolve` was called last.
  [[nodiscard]] Real pull() const { return allowance / (contact_time * contact_time); }

  /// See ContactEngine: pairs keep their order.
  void take_over(const ConstrainedContacts& other, std::span<const std::uint32_t> to) {
    constexpr auto nowhere = std::numeric_limits<std::uint32_t>::max();
    for (std::size_t i = 0; i < to.size(); ++i)
      if (to[i] != nowhere) last[to[i]] = other.last[i];
    for (const Lasting& one : other.lasting)
      if (const auto pair = one.pair.moved(to)) lasting.push_back({*pair, one.impulse, one.press});
    std::ranges::sort(lasting, {}, &Lasting::pair);
    left_by_steps = std::max(left_by_steps, other.left_by_steps);
  }

  /// Resolves the collisions of this instant among `near`, one after the other, until no two bodies approach each
  /// other. Where this does not end, contacts that lose energy stop bouncing, and are struck together; where that does
  /// not end either, or impulses are not found, there is a `fault`. Returns the persistent contacts. They are the
  /// contacts that forces press together and whose bodies hardly move relative to each other: by no more in the contact
  /// time than the forces would move them. Such bodies do not collide; normal and friction forces keep them in contact
  /// from here on.
  [[nodiscard]] PersistentContacts<Real, Dim> resolve(std::span<const Touching> near, std::span<const V> force,
                                                      std::span<const S> torque, const Journal& journal) {
    const Real acceleration = greatest_acceleration(world_, force), slow = acceleration * contact_time;
    allowance = slow * contact_time, fault = {};
    if (!(slow < never)) return {};
    std::vector<Touching> touching;
    std::ranges::copy_if(near, std::back_inserter(touching), [&](const Touching& at) { return touches(at); });
    if (touching.empty()) return {};
    const std::vector<Real> before = last;
    const Real least = std::max(slow, Real(rounded_speed() * fastest_of(touching)));
    for (std::uint32_t round = 0; fault && strike_all(touching, slow, before, round, journal); ++round)
      if (round >= usual_rounds && !goes_on(touching, least, round)) break;
    if (!fault) return {};
    if (!(slow > Real(0))) return {};
    std::vector<Touching> gentle;
    for (const Touching& at : touching)
      if (std::abs(approach_of(world_, at)) <= slow &&
          length(V(world_.position[at.b] - world_.position[at.a])) + Real(at.with_wall()) > Real(0))
        gentle.push_back(at);
    const Real smallest = std::ranges::min(world_.radius);
    using std::sqrt;
    PersistentContacts<Real, Dim> held(world_, gentle, slow, Real(sqrt(acceleration / smallest)), force, torque);
    held.settle(world_.velocity, world_.spin);
    std::size_t k = 0;
    for (const Touching& at : gentle)
      if (k < held.size() && held[k] == at) {
        ++k;
      } else {
        strike(at, slow / 1'000'000, material_now(at, slow, before, 0), journal);  // smaller speeds are rounding
      }
    held.look_again();
    return held;
  }

  /// Resolves the bounces of this instant among `near`, one after the other; what does not bounce is left to a time
  /// step. Returns the pairs that approach each other faster than `slow`, and bounce once they touch. Where bounces do
  /// not end, there is a `fault`.
  [[nodiscard]] std::vector<Touching> bounce(std::span<const Touching> near, const Real& slow, const Journal& journal) {
    fault = {};
    const std::vector<Real> before = last;
    const auto bounces = [&](const Touching& at, std::uint32_t round) {
      return approaches(at, slow) && material_now(at, slow, before, round).restitution > Real(0);
    };
    std::vector<Touching> touching, coming;
    std::ranges::copy_if(near, std::back_inserter(touching), [&](const Touching& at) { return touches(at); });
    const Real least = std::max(slow, Real(rounded_speed() * fastest_of(touching)));
    bool is_any = true;
    for (std::uint32_t round = 0; is_any && (round < usual_rounds || goes_on(touching, least, round)); ++round) {
      is_any = false;
      for (const Touching& at : touching)
        if (bounces(at, round)) is_any = strike(at, slow, material_now(at, slow, before, round), journal) || is_any;
    }
    std::ranges::copy_if(near, std::back_inserter(coming),
                         [&](const Touching& at) { return !touches(at) && bounces(at, 0); });
    return coming;
  }

  /// Whether the two touch: the gap is at most the rounding of a position or the allowance, or, in a persistent
  /// contact, the gap that time steps leave.
  [[nodiscard]] bool touches(const Touching& at) const {
    const Real size = length(world_.position[at.a]) + world_.radius[at.a];
    const Real least = Real(16 * std::numeric_limits<Real>::epsilon() * size), gap = gap_of(world_, at);
    return gap <= std::max(least, allowance) || (gap <= left_by_steps && find(lasting, at));
  }
  /// Whether the two approach each other faster than `slow`, and faster than the rounding of their speeds, and that of
  /// their positions over a contact time, explain.
  [[nodiscard]] bool approaches(const Touching& at, const Real& slow) const {
    constexpr Real rounding = 8 * std::numeric_limits<Real>::epsilon();
    const V rate = (at.with_wall() ? V{} : world_.velocity[at.b]) - world_.velocity[at.a];
    const Real least = std::max(slow, Real(rounding * length(rate))), approach = approach_of(world_, at);
    if (!(approach > least)) return false;
    const Real size = length(world_.position[at.a]) + world_.radius[at.a];
    return approach * contact_time > rounding * size || !(contact_time > Real(0));
  }
  /// Applies the impulse of a collision. False where the two do not approach each other.
  bool strike(const Touching& at, const Real& slow, const Material<Real>& material, const Journal& journal) {
    if (!approaches(at, slow)) return false;
    V no_velocity{};
    S no_spin{};
    const Mover<Real, Dim> wall{no_velocity, no_spin, Real(0), Real(0), Real(0)};
    has_struck(at, collide(mover(at.a), at.with_wall() ? wall : mover(at.b), normal_of(world_, at), material), journal);
    return true;
  }
  /// The combined material of a pair. If a body has collided within the contact time before this instant, or the
  /// contact persists already, the restitution is 0, unless it is 1 or the two approach each other faster than
  /// 2 `slow`, the speed that forces give in the contact time: what returns so soon by its speed, as a light body
  /// between a wall and a heavy one, is in no contact that lasts. It is 0 too in a round by which bounces have used up
  /// the approach.
  [[nodiscard]] Material<Real> material_now(const Touching& at, const Real& slow, const std::vector<Real>& before,
                                            std::uint32_t round) const {
    const bool is_wall = at.with_wall();
    Material<Real> material = combined(world_.combine_rule, world_.material[at.a],
                                       is_wall ? world_.walls()[at.wall].material : world_.material[at.b]);
    const bool is_held =
        world_.time - before[at.a] < contact_time || (!is_wall && world_.time - before[at.b] < contact_time);
    if (material.restitution < Real(1) && ((approach_of(world_, at) <= 2 * slow && (is_held || find(lasting, at))) ||
                                           is_endless(material.restitution, round)))
      material.restitution = Real(0);
    return material;
  }

  /// Says that impulses of these pairs were not found, by the numbers of their bodies in the whole world.
  [[nodiscard]] Status not_found(std::span<const Touching> pairs) const {
    return impulses_not_found(world_.time, numbers_in(pairs),
                              "masses that differ less, fewer bodies that touch, or less friction would have some");
  }
  /// Updates the persistent contacts to `pairs`, which are sorted, and logs those that begin and those that end.
  template <class Pairs>
  void note_lasting(const Pairs& pairs, const Journal& journal) {
    std::vector<Lasting> now;
    for (std::size_t k = 0; k < pairs.size(); ++k) {
      const Lasting* const known = find(lasting, pairs[k]);
      now.push_back({pairs[k], known ? known->impulse : Real(0), Real(0)});
      if (!known) note(pairs[k], ContactChange::begin, Real(0), journal);
    }
    for (const Lasting& one : lasting)
      if (!find(now, one.pair)) note(one.pair, ContactChange::end, one.impulse, journal);
    lasting = std::move(now);
    note_together(world_.time, journal);
  }
  /// Notes time t for bodies that lie on another body, or on two walls of which one has friction: event_driven.hpp has
  /// no parabola for them.
  void note_together(const Real& t, const Journal& journal) const {
    const auto friction = [&](const Touching& at) {
      return combined(world_.combine_rule.friction, world_.material[at.a].friction,
                      world_.walls()[at.wall].material.friction);
    };
    for (std::size_t k = 0; k < lasting.size(); ++k) {
      const Touching& at = lasting[k].pair;
      if (!at.with_wall()) {
        journal.together[at.a] = journal.together[at.b] = t;
      } else if (k > 0 && lasting[k - 1].pair.a == at.a) {  // on that wall, too
        if (friction(lasting[k - 1].pair) > Real(0) || friction(at) > Real(0)) journal.together[at.a] = t;
      }
    }
  }

 private:
  static constexpr std::uint32_t usual_rounds = 256, most_rounds = 10'000;

  /// Whether there is to be another round after those that should have been enough. What approaches by no more than
  /// `least`, by rounding, needs none; bodies that lose nothing, as a light one between a wall and a heavy one, may
  /// need thousands.
  [[nodiscard]] bool goes_on(std::span<const Touching> touching, const Real& least, std::uint32_t round) {
    if (std::ranges::none_of(touching, [&](const Touching& at) { return approach_of(world_, at) > least; }))
      return false;
    if (round < most_rounds) return true;
    fault = impulses_not_found(world_.time, numbers_in(touching),
                               "they strike each other again and again; masses that differ less would end sooner");
    return false;
  }
  /// By how much of the fastest speed others may be wrong.
  [[nodiscard]] static Real rounded_speed() { return std::sqrt(std::numeric_limits<Real>::epsilon()); }
  [[nodiscard]] Real fastest_of(std::span<const Touching> touching) const {
    Real square(0);
    for (const Touching& at : touching)
      square = std::max({square, squared(world_.velocity[at.a]), squared(world_.velocity[at.b])});
    return std::sqrt(square);
  }
  [[nodiscard]] std::vector<std::uint32_t> numbers_in(std::span<const Touching> touching) const {
    std::vector<std::uint32_t> bodies;
    for (const Touching& at : touching)
      for (const std::uint32_t i : {at.a, at.b}) bodies.push_back(numbers.empty() ? i : numbers[i]);
    std::ranges::sort(bodies);
    bodies.erase(std::ranges::unique(bodies).begin(), bodies.end());
    return bodies;
  }

  /// Finds a pair among sorted contacts.
  [[nodiscard]] static const Lasting* find(const std::vector<Lasting>& contacts, const Touching& pair) {
    const auto at = std::ranges::lower_bound(contacts, pair, {}, &Lasting::pair);
    return at != contacts.end() && at->pair == pair ? &*at : nullptr;
  }

  /// Resolves the contacts that bounce one after the other, and then all others together. False where no two bodies
  /// approach each other.
  [[nodiscard]] bool strike_all(std::span<const Touching> touching, const Real& slow, const std::vector<Real>& before,
                                std::uint32_t round, const Journal& journal) {
    bool is_any = false, is_plastic = false;
    std::vector<Touching> plastic;
    for (const Touching& at : touching) {
      const Material<Real> material = material_now(at, slow, before, round);
      if (material.restitution > Real(0)) {
        is_any = strike(at, slow, material, journal) || is_any;
      } else {
        plastic.push_back(at);
        is_plastic = is_plastic || approaches(at, slow);
      }
    }
    if (!is_plastic) return is_any;
    // What is left of an approach is for the next round.
    const Real fastest = fastest_of(plastic);
    const auto [impulse, error] = strike_together<Real, Dim>(world_, plastic, slow / 8);
    if (!(error <= std::max(Real(slow / 8), Real(rounded_speed() * fastest)))) fault = not_found(plastic);
    for (std::size_t k = 0; k < plastic.size(); ++k)
      if (impulse[k] > Real(0)) has_struck(plastic[k], impulse[k], journal);
    return true;
  }
  void has_struck(const Touching& at, const Real& impulse, const Journal& journal) {
    last[at.a] = world_.time;
    if (!at.with_wall()) last[at.b] = world_.time;
    ++(at.with_wall() ? journal.statistics.wall_collisions : journal.statistics.collisions);
    note(at, ContactChange::impact, impulse, journal);
  }
  void note(const Touching& at, ContactChange change, const Real& impulse, const Journal& journal) const {
    if (journal.log.is_kept()) journal.log.add(event_of(world_, at, world_.time, change, impulse));
  }
  [[nodiscard]] Mover<Real, Dim> mover(std::uint32_t i) {
    return {world_.velocity[i], world_.spin[i], world_.radius[i], world_.inverse_mass[i], world_.inverse_inertia[i]};
  }

  World<Real, Dim>& world_;
};

}  // namespace continuo
