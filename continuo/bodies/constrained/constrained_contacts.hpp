// Who touches whom under general forces, what they do to each other in an instant, and which contacts last: what
// flights and steps through contacts have in common.
#pragma once
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>
#include <vector>

#include <continuo/bodies/contacts/impulse.hpp>
#include <continuo/bodies/contacts/joint_impacts.hpp>
#include <continuo/bodies/contacts/touching.hpp>
#include <continuo/bodies/event_driven/exact_engine.hpp>

namespace continuo {

template <class Real, int Dim>
class ConstrainedContacts : public ContactEngine<Real, Dim> {
 public:
  using V = Vector<Real, Dim>;
  using S = Spin<Real, Dim>;

 protected:
  static constexpr Real never = std::numeric_limits<Real>::infinity();

  ConstrainedContacts(World<Real, Dim>& world, const ExactOptions<Real>& options)
      : ContactEngine<Real, Dim>(options), world_(world), last_(world.size(), -never) {
    together.assign(world.size(), -never);
  }

  using ExactEngine<Real, Dim>::statistics;
  using ExactEngine<Real, Dim>::contacts;
  using ContactEngine<Real, Dim>::together;

  /// A contact that is held, and its impulse so far.
  struct Lasting {
    Touching pair{};
    Real impulse{}, press{};  // press: where nothing moves
    template <class Archive>
    void transfer(Archive& archive) {
      archive(pair), archive(impulse), archive(press);
    }
  };
  /// Of contacts in order.
  template <class Contacts>
  static auto find(Contacts& contacts, const Touching& pair) -> decltype(&contacts[0]) {
    const auto at = std::ranges::lower_bound(contacts, pair, {}, &Lasting::pair);
    return at != contacts.end() && at->pair == pair ? &*at : nullptr;
  }

  /// See ContactEngine: pairs keep their order.
  void take_over_contacts(const ConstrainedContacts& other, std::span<const std::uint32_t> to) {
    for (std::size_t i = 0; i < to.size(); ++i)
      if (to[i] != this->nowhere) last_[to[i]] = other.last_[i], together[to[i]] = other.together[i];
    for (const Lasting& one : other.lasting_)
      if (const auto pair = one.pair.moved(to)) lasting_.push_back({*pair, one.impulse, one.press});
    std::ranges::sort(lasting_, {}, &Lasting::pair);
    left_by_steps_ = std::max(left_by_steps_, other.left_by_steps_);
  }

  Real greatest_acceleration(std::span<const V> force) const {
    Real greatest(0);
    for (std::size_t i = 0; i < force.size(); ++i)
      greatest = std::max(greatest, length(force[i]) * world_.inverse_mass[i]);
    return greatest;
  }

  /// What counts as touching: the digits of a place, and what a gap may sink.
  bool touches(const Touching& at) const {
    const Real size = length(world_.position[at.a]) + world_.radius[at.a];
    const Real least = Real(16 * std::numeric_limits<Real>::epsilon() * size), gap = gap_of(world_, at);
    return gap <= std::max(least, allowance_) || (gap <= left_by_steps_ && find(lasting_, at));
  }

  /// What bounces, one after the other, and then what does not, all together. False where nobody approaches.
  bool strike_all(std::span<const Touching> touching, const Real& slow, const std::vector<Real>& before,
                  bool is_squeezed) {
    bool is_any = false, is_plastic = false;
    std::vector<Touching> plastic;
    for (const Touching& at : touching) {
      const Material<Real> material = material_now(at, before, is_squeezed);
      if (material.restitution > Real(0)) {
        is_any = strike(at, slow, material) || is_any;
      } else {
        plastic.push_back(at);
        is_plastic = is_plastic || approaches(at, slow);
      }
    }
    if (!is_plastic) return is_any;
    const std::vector<Real> impulse = strike_together<Real, Dim>(world_, plastic, slow / 8);
    for (std::size_t k = 0; k < plastic.size(); ++k)
      if (impulse[k] > Real(0)) has_struck(plastic[k], impulse[k]);
    return true;
  }
  bool strike(const Touching& at, const Real& slow, const Material<Real>& material) {
    if (!approaches(at, slow)) return false;
    V no_velocity{};
    S no_spin{};
    const Mover<Real, Dim> wall{no_velocity, no_spin, Real(0), Real(0), Real(0)};
    has_struck(at, collide(mover(at.a), at.with_wall() ? wall : mover(at.b), normal_of(world_, at), material));
    return true;
  }
  /// By more than `slow`, and than rounding.
  bool approaches(const Touching& at, const Real& slow) const {
    const V rate = (at.with_wall() ? V{} : world_.velocity[at.b]) - world_.velocity[at.a];
    return approach_of(world_, at) > std::max(slow, Real(8 * std::numeric_limits<Real>::epsilon() * length(rate)));
  }
  /// What has collided within the contact time before this instant, or touched already, bounces no more.
  Material<Real> material_now(const Touching& at, const std::vector<Real>& before, bool is_squeezed) const {
    const bool is_wall = at.with_wall();
    Material<Real> material = combined(world_.combine_rule, world_.material[at.a],
                                       is_wall ? world_.walls()[at.wall].material : world_.material[at.b]);
    const bool loses = material.restitution < Real(1) || material.friction > Real(0);
    const bool is_held =
        world_.time - before[at.a] < contact_time_ || (!is_wall && world_.time - before[at.b] < contact_time_);
    if (is_held || find(lasting_, at)) material.restitution = material.restitution < Real(1) ? Real(0) : Real(1);
    if (is_squeezed && loses) material.restitution = Real(0);
    return material;
  }
  void has_struck(const Touching& at, const Real& impulse) {
    last_[at.a] = world_.time;
    if (!at.with_wall()) last_[at.b] = world_.time;
    ++(at.with_wall() ? statistics.wall_collisions : statistics.collisions);
    note(at, ContactChange::impact, impulse);
  }
  /// Which contacts go on, which are new, and which have ended.
  template <class Pairs>
  void note_lasting(const Pairs& held) {
    std::vector<Lasting> now;
    for (std::size_t k = 0; k < held.size(); ++k) {
      const Lasting* const known = find(lasting_, held[k]);
      now.push_back({held[k], known ? known->impulse : Real(0), Real(0)});
      if (!known) note(held[k], ContactChange::begin, Real(0));
    }
    for (const Lasting& one : lasting_)
      if (!find(now, one.pair)) note(one.pair, ContactChange::end, one.impulse);
    lasting_ = std::move(now);
    note_together(world_.time);
  }
  /// Who lies on another, or on two walls of which one rubs: what event_driven.cpp has no parabola for.
  void note_together(const Real& t) {
    const auto friction = [&](const Touching& at) {
      return combined(world_.combine_rule.friction, world_.material[at.a].friction,
                      world_.walls()[at.wall].material.friction);
    };
    for (std::size_t k = 0; k < lasting_.size(); ++k) {
      const Touching& at = lasting_[k].pair;
      if (!at.with_wall()) {
        together[at.a] = together[at.b] = t;
      } else if (k > 0 && lasting_[k - 1].pair.a == at.a) {  // on that wall, too
        if (friction(lasting_[k - 1].pair) > Real(0) || friction(at) > Real(0)) together[at.a] = t;
      }
    }
  }
  void note(const Touching& at, ContactChange change, const Real& impulse) {
    if (contacts.is_kept()) contacts.add(event_of(world_, at, world_.time, change, impulse));
  }
  Mover<Real, Dim> mover(std::uint32_t i) {
    return {world_.velocity[i], world_.spin[i], world_.radius[i], world_.inverse_mass[i], world_.inverse_inertia[i]};
  }

  World<Real, Dim>& world_;
  Real contact_time_{};
  Real allowance_{};        // to which a gap may sink
  Real left_by_steps_{};    // gaps that steps through contacts leave of those that last
  std::vector<Real> last_;  // when each body collided last
  std::vector<Lasting> lasting_;
};

}  // namespace continuo
