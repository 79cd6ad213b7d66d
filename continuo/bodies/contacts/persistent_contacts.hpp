// Bodies in persistent contact are constrained by normal and friction forces, under other forces of any kind, until a
// normal force would have to pull. Coulomb's friction keeps a contact from slipping where it can (a ball then rolls),
// and acts against the slip where it cannot; so does rolling resistance against rolling, where nothing slips.
//
// With the relative velocity u = J v of the surfaces in contact, forces f change it by A f, A = J M^-1 J^T; they are
// chosen so that u' = 0 in the constrained directions, no normal force pulls, and a contact without normal force may
// open (a linear complementarity problem; D. Baraff, "Fast contact force computation for nonpenetrating rigid bodies",
// SIGGRAPH 1994). Gaps and speeds that arise from integration errors are damped in the time in which a body falls its
// radius (J. Baumgarte, Comput. Methods Appl. Mech. Eng. 1 (1972) 1-16).
#pragma once
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

#include <continuo/bodies/contacts/contact_matrix.hpp>
#include <continuo/bodies/contacts/persistent_contact.hpp>
#include <continuo/bodies/world.hpp>

namespace continuo {

template <class Real, int Dim>
class PersistentContacts {
 public:
  using V = Vector<Real, Dim>;
  using S = Spin<Real, Dim>;
  struct Loads {
    std::span<V> force;
    std::span<S> torque;  // empty without friction
  };

  PersistentContacts() = default;
  /// Keeps those of `touching` that forces press together in the present state of the world. Contacts that slip or roll
  /// slower than `slow` may stick.
  PersistentContacts(const World<Real, Dim>& world, std::span<const Touching> touching, const Real& slow,
                     const Real& rate, std::span<const V> force, std::span<const S> torque)
      : world_(&world), slow_(slow), rate_(rate) {
    for (const Touching& one : touching) held_.emplace_back(world, one);
    for (const Touching& one : touching)
      for (const std::uint32_t body : {one.a, one.b}) rounding_ = std::max(rounding_, Real(1e-9) * length(force[body]));
    choose(force, torque);
    std::erase_if(held_, [](const Held& one) { return !one.is_pressed; });
    for (const Held& one : held_) rubs_ = rubs_ || one.slip.most > Real(0);
  }

  /// False where no consistent contact forces were found.
  [[nodiscard]] bool is_found() const { return is_found_; }
  [[nodiscard]] std::size_t size() const { return held_.size(); }
  const Touching& operator[](std::size_t k) const { return held_[k].pair; }
  /// Whether a contact has friction, so that spins change.
  [[nodiscard]] bool rub() const { return rubs_; }

  /// Adds to the loads the contact forces and torques that they cause at x, v, spin.
  void hold(std::span<const V> x, std::span<const V> v, std::span<const S> spin, const Loads& loads) {
    place(x, v, spin);
    solve(spin, loads.force, loads.torque);
    for (const Held& one : held_) {
      const auto all = one.ends(*world_, one.force(), one.roll.load);
      for (const auto& end : all.ends()) {
        loads.force[end.body] += end.force;
        if (!loads.torque.empty()) loads.torque[end.body] += end.torque;
      }
    }
  }
  [[nodiscard]] Real press(std::size_t k) const { return held_[k].press; }
  /// The guards of each contact, from the last call of `hold`. They fall through 0 where the contact opens, where slip
  /// begins or ends, and where rolling begins or ends.
  static constexpr std::size_t guards = 3;
  [[nodiscard]] Real guard(std::size_t k, std::size_t which) const {
    const Held& one = held_[k];
    if (which == 0) return one.press + 2 * rounding_;
    if (which == 1) return one.slip.guard(one.press, slow_, rounding_);
    return one.can_roll() ? one.roll.guard(one.press, slow_, rounding_) : Real(1);
  }

  /// Removes the relative speeds in the constrained directions by impulses.
  void settle(std::span<V> velocity, std::span<S> spin) {
    if (held_.empty()) return;
    place(world_->position, velocity, spin);
    list_rows(true);
    if (rows_.empty()) return;
    matrix_.fill(*world_, rows_, rows_);
    std::vector<Real> impulse;
    for (const auto& row : rows_) impulse.push_back(-speed_in(row, velocity, spin));
    if (!matrix_.solve(impulse)) return;
    for (std::size_t r = 0; r < rows_.size(); ++r)
      for (const auto& end : rows_[r].ends()) {
        velocity[end.body] += end.force * (impulse[r] * world_->inverse_mass[end.body]);
        spin[end.body] += end.torque * (impulse[r] * world_->inverse_inertia[end.body]);
      }
  }
  /// Updates the directions of slip and rolling after impulses.
  void look_again() {
    for (Held& one : held_) {
      one.move(*world_, world_->velocity, world_->spin);
      one.slip.look_again(slow_), one.roll.look_again(slow_);
    }
  }

 private:
  using Held = PersistentContact<Real, Dim>;
  using Row = ContactDirection<Real, Dim>;
  /// The relative motion that a row constrains: along the normal, slip, or rolling.
  enum class Holds { normal, slip, roll };
  struct RowOf {
    std::size_t held;
    Holds what;
    V across{};
    S about{};
  };

  void place(std::span<const V> x, std::span<const V> v, std::span<const S> spin) {
    for (Held& one : held_) one.place(*world_, x, v, spin);
  }
  [[nodiscard]] static Real speed_in(const Row& row, std::span<const V> v, std::span<const S> spin) {
    Real sum(0);
    for (const auto& end : row.ends()) sum += dot(end.force, v[end.body]) + dot(end.torque, spin[end.body]);
    return sum;
  }

  /// Lists the constrained directions; `with_slow` adds the directions in which motion only begins.
  void list_rows(bool with_slow) {
    rows_.clear(), of_row_.clear();
    const auto add = [&](const RowOf& of) {
      const Held& one = held_[of.held];
      of_row_.push_back(of);
      rows_.push_back(one.ends(*world_, of.what == Holds::normal ? one.normal : of.across, of.about));
    };
    const auto is_held = [&](const auto& grip) {
      return grip.holds || (with_slow && grip.most > Real(0) && !grip.is_fast);
    };
    for (std::size_t k = 0; k < held_.size(); ++k) {
      const Held& one = held_[k];
      if (!one.is_pressed) continue;
      add({k, Holds::normal});
      if (!is_held(one.slip)) continue;
      for (const V& way : across(one.normal)) add({.held = k, .what = Holds::slip, .across = way});
      if (!(one.roll.most > Real(0)) || !is_held(one.roll)) continue;
      if constexpr (Dim == 2) {
        add({.held = k, .what = Holds::roll, .about = {{Real(1)}}});
      } else {
        for (const V& way : across(one.normal)) add({.held = k, .what = Holds::roll, .about = way});
      }
    }
  }
  /// The forces and torques that belong to a normal force of 1, including the friction and rolling resistance of a
  /// contact that slips or rolls.
  [[nodiscard]] Row column_of(const RowOf& of, const Row& row) const {
    const Held& one = held_[of.held];
    if (of.what != Holds::normal) return row;
    V force = one.normal;
    S couple{};
    if (!one.slip.holds && one.slip.most > Real(0)) force -= one.slip.direction(slow_) * one.slip.most;
    if (one.can_roll() && !one.roll.holds) couple = one.roll.direction(slow_) * -one.roll.most;
    return one.ends(*world_, force, couple);
  }

  /// The rate of change of a contact's speed in the direction of a row: by loads, by the turning of the normal, and by
  /// the damping of errors.
  [[nodiscard]] Real free_rate(const RowOf& of, const Row& row, std::span<const S> spin, std::span<const V> force,
                               std::span<const S> torque) const {
    const Held& one = held_[of.held];
    Real sum(0);
    for (const auto& end : row.ends()) {
      sum += world_->inverse_mass[end.body] * dot(end.force, force[end.body]);
      if (!torque.empty()) sum += world_->inverse_inertia[end.body] * dot(end.torque, torque[end.body]);
    }
    if (of.what == Holds::normal) {
      const Real distance = one.pair.with_wall() ? Real(0) : world_->radius[one.pair.a] + world_->radius[one.pair.b];
      const Real deepest = -Real(1e-6) * world_->radius[one.pair.a];
      return sum + squared(one.bend) * distance + 2 * rate_ * one.parting + rate_ * rate_ * std::max(one.gap, deepest);
    }
    if (of.what == Holds::slip) {
      for (const auto& end : row.ends())
        sum -= dot(of.across, turning(spin[end.body], V(one.bend * world_->radius[end.body])));
      return sum + rate_ * dot(one.slip.rate, of.across);
    }
    if constexpr (Dim == 3) {  // the part of the spins along the normal, which turns
      const S between = one.pair.with_wall() ? S{} : S(spin[one.pair.b] - spin[one.pair.a]);
      sum -= dot(one.bend, of.about) * dot(between, one.normal) * one.arm;
    }
    return sum + rate_ * dot(one.roll.rate, of.about);
  }

  void solve(std::span<const S> spin, std::span<const V> force, std::span<const S> torque) {
    for (Held& one : held_) one.press = Real(0), one.slip.load = {}, one.roll.load = {};
    list_rows(false);
    if (rows_.empty()) return;
    columns_.clear(), size_.clear();
    for (std::size_t r = 0; r < rows_.size(); ++r) {
      columns_.push_back(column_of(of_row_[r], rows_[r]));
      size_.push_back(-free_rate(of_row_[r], rows_[r], spin, force, torque));
    }
    matrix_.fill(*world_, rows_, columns_);
    if (!matrix_.solve(size_)) return;
    for (std::size_t r = 0; r < rows_.size(); ++r) {
      const RowOf& of = of_row_[r];
      Held& one = held_[of.held];
      if (of.what == Holds::slip) {
        one.slip.load += of.across * size_[r];
      } else if (of.what == Holds::roll) {
        one.roll.load += of.about * size_[r];
      } else {
        one.press = size_[r];
        if (!one.slip.holds) one.slip.load = one.slip.direction(slow_) * (-one.slip.most * size_[r]);
        if (one.can_roll() && !one.roll.holds) one.roll.load = one.roll.direction(slow_) * (-one.roll.most * size_[r]);
      }
    }
  }

  /// Chooses the contacts that have a normal force, and those of them that stick.
  void choose(std::span<const V> force, std::span<const S> torque) {
    const World<Real, Dim>& world = *world_;
    place(world.position, world.velocity, world.spin);
    for (Held& one : held_) one.slip.start(slow_), one.roll.start(slow_);
    std::vector<V> all;
    std::vector<S> twist;
    for (int round = 0; round < 50; ++round) {
      all.assign(force.begin(), force.end());
      twist.assign(world.size(), S{});
      std::ranges::copy(torque, twist.begin());
      hold(world.position, world.velocity, world.spin, {all, twist});
      if (!change(all, twist)) return;
    }
    is_found_ = false;
  }
  /// Opens contacts that pull, closes contacts that would sink in, and lets those slip or roll that friction cannot
  /// keep at rest. False where all contacts are consistent.
  [[nodiscard]] bool change(std::span<const V> force, std::span<const S> torque) {
    bool is_other = false;
    Real greatest(0);
    for (const Held& one : held_) greatest = std::max(greatest, one.press);
    for (std::size_t k = 0; k < held_.size(); ++k) {
      if (held_[k].changes > 8) {  // undecided: it stays as it is, but sticks
        is_found_ = false;
        held_[k].slip.holds = held_[k].slip.most > Real(0) && !held_[k].slip.is_fast;
      } else if (change(k, greatest, force, torque)) {
        is_other = true, ++held_[k].changes;
      }
    }
    return is_other;
  }
  [[nodiscard]] bool change(std::size_t k, const Real& greatest, std::span<const V> force, std::span<const S> torque) {
    Held& one = held_[k];
    // Whether forces would bring the two together by more than rounding, which is given in units of forces.
    const auto returns = [&](const RowOf& of, const Real& least) {
      const Row row = one.ends(*world_, of.what == Holds::normal ? one.normal : of.across, of.about);
      return free_rate(of, row, world_->spin, force, torque) < -least * greatest * response(*world_, row, row);
    };
    const auto begins_again = [](const auto& grip) { return grip.most > Real(0) && !grip.holds && !grip.is_fast; };
    if (one.is_pressed && one.press < -rounding_) {
      one.is_pressed = false;
    } else if (!one.is_pressed) {
      if (!returns({k, Holds::normal}, Real(1e-9))) return false;
      one.is_pressed = true;
    } else if (one.slip.is_too_weak(one.press, rounding_)) {
      one.slip.let_go();
    } else if (begins_again(one.slip) &&
               returns({.held = k, .what = Holds::slip, .across = one.slip.way}, Real(1e-6))) {
      one.slip.holds = true;  // it can stick once others slip
    } else if (one.can_roll() && one.roll.is_too_weak(one.press, rounding_)) {
      one.roll.let_go();
    } else if (one.can_roll() && begins_again(one.roll) &&
               returns({.held = k, .what = Holds::roll, .about = one.roll.way}, Real(1e-6))) {
      one.roll.holds = true;
    } else {
      return false;
    }
    return true;
  }

  const World<Real, Dim>* world_ = nullptr;
  Real slow_{}, rate_{};
  Real rounding_{};  // of forces: a contact with hardly any force pulls or slips only beyond this
  bool rubs_ = false, is_found_ = true;
  std::vector<Held> held_;
  // Of the constrained directions:
  std::vector<RowOf> of_row_;
  std::vector<Row> rows_, columns_;
  std::vector<Real> size_;
  ContactMatrix<Real, Dim> matrix_;
};

}  // namespace continuo
