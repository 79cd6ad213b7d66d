// The motion under general forces between contacts, as one system of differential equations for an integrator.
#pragma once
#include <algorithm>
#include <cstddef>
#include <span>
#include <utility>
#include <vector>

#include <continuo/bodies/contacts/persistent_contacts.hpp>
#include <continuo/bodies/exact_options.hpp>
#include <continuo/bodies/forces.hpp>

namespace continuo {

/// dq/dt of an orientation q at a spin: half of (0, spin) q in space.
template <class Real>
[[nodiscard]] Vector<Real, 1> rate_of_orientation(const Vector<Real, 1>&, const Vector<Real, 1>& spin) {
  return spin;
}
template <class Real>
[[nodiscard]] Vector<Real, 4> rate_of_orientation(const Vector<Real, 4>& q, const Vector<Real, 3>& spin) {
  const Vector<Real, 3> imaginary{{q[1], q[2], q[3]}};
  const Vector<Real, 3> rate = (spin * q[0] + turning(spin, imaginary)) * (Real(1) / 2);
  return {{-dot(spin, imaginary) / 2, rate[0], rate[1], rate[2]}};
}

/// The state: all positions, all velocities, where torques act all orientations and spins, the impulses of persistent
/// contacts, and last the companions. Fixed bodies are in it too.
template <class Real, int Dim>
class ConstrainedSystem {
 public:
  using V = Vector<Real, Dim>;
  using S = Spin<Real, Dim>;
  using O = Orientation<Real, Dim>;
  using X = std::vector<Real>;

  ConstrainedSystem(const World<Real, Dim>& world, const Companions<Real, Dim>* companions,
                    PersistentContacts<Real, Dim> held = {})
      : world_(&world),
        companions_(companions),
        held_(std::move(held)),
        x_(world.size()),
        v_(world.size()),
        f_(world.size()),
        turns_(!world.torque_laws.empty() || (companions && companions->twists) || held_.rub()) {
    if (companions) rate_.resize(companions->state.size());
    if (turns_) orientation_ = world.orientation, spin_ = world.spin, torque_.resize(world.size());
  }

  void operator()(Real t, const X& state, X& rate) {
    unpack(state);
    const std::size_t n = x_.size();
    all_forces(t, x_, v_, std::span(state).last(rate_.size()));
    std::ranges::copy(rate_, rate.end() - static_cast<std::ptrdiff_t>(rate_.size()));
    held_.hold(x_, v_, spin_, {f_, torque_});
    for (std::size_t k = 0; k < held_.size(); ++k)
      *(rate.end() - tail() + static_cast<std::ptrdiff_t>(k)) = held_.press(k);
    auto to = rate.begin();
    const auto put = [&](const auto& vector) { to = std::ranges::copy(vector.components, to).out; };
    for (std::size_t i = 0; i < n; ++i) put(world_->is_fixed(i) ? V{} : v_[i]);
    for (std::size_t i = 0; i < n; ++i) put(V(f_[i] * world_->inverse_mass[i]));
    if (!turns_) return;
    for (std::size_t i = 0; i < n; ++i) put(rate_of_orientation(orientation_[i], spin_[i]));
    for (std::size_t i = 0; i < n; ++i) put(S(torque_[i] * world_->inverse_inertia[i]));
  }
  [[nodiscard]] X pack() const {
    X state;
    const auto add = [&](const auto& vectors) {
      for (const auto& vector : vectors) state.insert(state.end(), vector.components.begin(), vector.components.end());
    };
    add(world_->position), add(world_->velocity);
    if (turns_) add(world_->orientation), add(world_->spin);
    state.resize(state.size() + held_.size());
    if (companions_) state.insert(state.end(), companions_->state.begin(), companions_->state.end());
    return state;
  }
  static void unpack(const X& state, std::vector<V>& x, std::vector<V>& v) {
    auto from = state.begin();
    take(from, x), take(from, v);
  }
  [[nodiscard]] const PersistentContacts<Real, Dim>& held() const { return held_; }
  /// The number of components of the bodies; those of impulses and companions follow.
  [[nodiscard]] std::size_t size_of_bodies() const {
    return x_.size() * (2 * V::size() + (turns_ ? O::size() + S::size() : 0));
  }
  [[nodiscard]] Real impulse(const X& state, std::size_t k) const {
    return *(state.end() - tail() + static_cast<std::ptrdiff_t>(k));
  }
  /// Writes the state at the end of a flight of this duration into the world and the companions.
  void store(const X& state, World<Real, Dim>& world, Companions<Real, Dim>* companions, const Real& duration) const {
    auto from = state.begin();
    take(from, world.position), take(from, world.velocity);
    if (turns_) {
      take(from, world.orientation), take(from, world.spin);
      for (O& orientation : world.orientation) orientation = turned(orientation, S{}, Real(0));  // of length 1 again
    } else {
      for (std::size_t i = 0; i < world.size(); ++i)
        if (world.spin[i] != S{}) world.orientation[i] = turned(world.orientation[i], world.spin[i], duration);
    }
    if (companions) std::copy(from + static_cast<std::ptrdiff_t>(held_.size()), state.end(), companions->state.begin());
  }
  /// Forces and torques in the present state of the world, without those of contacts.
  [[nodiscard]] std::pair<std::span<const V>, std::span<const S>> loads(Real t) {
    all_forces(t, world_->position, world_->velocity,
               companions_ ? std::span<const Real>(companions_->state) : std::span<const Real>());
    return {f_, torque_};
  }

 private:
  /// The number of components after those of the bodies.
  [[nodiscard]] std::ptrdiff_t tail() const { return static_cast<std::ptrdiff_t>(held_.size() + rate_.size()); }
  template <class Vectors>
  static void take(typename X::const_iterator& from, Vectors& vectors) {
    for (auto& vector : vectors) {
      std::copy_n(from, vector.size(), vector.components.begin());
      from += static_cast<std::ptrdiff_t>(vector.size());
    }
  }
  void unpack(const X& state) {
    auto from = state.begin();
    take(from, x_), take(from, v_);
    if (turns_) take(from, orientation_), take(from, spin_);
  }
  void all_forces(Real t, std::span<const V> x, std::span<const V> v, std::span<const Real> beside) {
    const BodyStates<Real, Dim> at{x, v, orientation_, spin_};
    forces<Real, Dim>(*world_, t, x, v, f_);
    if (turns_) torques<Real, Dim>(*world_, t, at, torque_);
    if (!companions_) return;
    companions_->law(t, at, beside, f_, torque_, rate_);
    for (std::size_t i = 0; i < f_.size(); ++i)
      if (world_->is_fixed(i)) f_[i] = {};
  }

  const World<Real, Dim>* world_;
  const Companions<Real, Dim>* companions_;
  PersistentContacts<Real, Dim> held_;
  std::vector<V> x_, v_, f_;
  std::vector<O> orientation_;
  std::vector<S> spin_, torque_;
  X rate_;  // of the companions
  bool turns_;
};

}  // namespace continuo
