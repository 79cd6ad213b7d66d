// A step through contacts that come, slip and go too often to be followed one by one, or that no forces hold (bodies
// jammed by friction): the impulses of all contacts over the step together, so that none sinks in, none pulls, and
// friction stops the slip or rubs with all it has. J. J. Moreau, in "Nonsmooth Mechanics and Applications", CISM 302
// (1988); M. Jean, Comput. Methods Appl. Mech. Eng. 177 (1999) 235-257. Of first order in the step.
//
// A gap s with the normal n may close by the end of the step and no further: s + h n . (v_b - v_a) >= 0. The distance
// of two points on straight paths is convex, so that their gap then is no less than that: nothing overlaps. Bodies that
// no contact pushes fall on their parabolas.
#pragma once
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include <continuo/bodies/held_contact.hpp>
#include <continuo/bodies/touching.hpp>
#include <continuo/bodies/world.hpp>

namespace continuo {

template <class Real, int Dim>
class ContactSteps {
 public:
  using V = Vector<Real, Dim>;
  using S = Spin<Real, Dim>;
  /// The mean forces of a contact in the last step: the next one begins with them.
  struct Pushed {
    Touching pair{};
    Real press{};
    V rub{};
    S roll{};  // over the smaller radius, as in HeldContact
    template <class Archive>
    void transfer(Archive& archive) {
      archive(pair), archive(press), archive(rub), archive(roll);
    }
  };
  struct Loads {
    std::span<const V> force;
    std::span<const S> torque;  // empty where there is none
    Real pull{};                // the greatest acceleration by them
  };

  /// Moves the world by h, all but its time. `pairs`, in order: those that may meet.
  void advance(World<Real, Dim>& world, std::span<const Touching> pairs, const Loads& loads, const Real& h) {
    const std::size_t n = world.size();
    begin(world, loads, h);
    list_rows(world, pairs, loads.pull, h);
    find_impulses(loads.pull * h);
    pushed_.clear();
    std::vector<bool> is_pushed(n);
    for (const Row& row : rows_) {
      if (!(row.press > Real(0))) continue;
      pushed_.push_back({row.pair, row.press / h, row.rub * (1 / h), row.roll * (1 / h)});
      is_pushed[row.a] = true;
      if (!row.pair.with_wall()) is_pushed[row.b] = true;
    }
    fastest_ = change_ = Real(0);
    for (std::size_t i = 0; i < n; ++i) {
      if (world.is_fixed(i)) continue;
      Moving& now = movers_[i];
      fastest_ = std::max(
          {fastest_, length(world.velocity[i]), length(now.v), world.radius[i] * length(S(now.spin - world.spin[i]))});
      world.position[i] += is_pushed[i] ? now.v * h : (world.velocity[i] + now.v) * (h / 2);
      world.orientation[i] = turned(world.orientation[i], S((world.spin[i] + now.spin) * (Real(1) / 2)), h);
      world.velocity[i] = now.v, world.spin[i] = now.spin;
    }
  }

  std::span<const Pushed> pushed() const { return pushed_; }
  /// What pushed other bodies, which have the numbers `to` here.
  void take_over(const ContactSteps& other, std::span<const std::uint32_t> to) {
    for (const Pushed& one : other.pushed_)
      if (const auto pair = one.pair.moved(to)) pushed_.push_back({*pair, one.press, one.rub, one.roll});
    std::ranges::sort(pushed_, {}, &Pushed::pair);
  }
  /// Of the last step: the greatest speed, and the greatest change of a velocity or of a spin times the radius.
  Real fastest() const { return fastest_; }
  Real greatest_change() const { return change_; }

  template <class Archive>
  void transfer(Archive& archive) {
    archive(pushed_);
  }

 private:
  static constexpr int most_sweeps = 200;
  struct Moving {
    V v{};
    S spin{};
    Real inverse_mass{}, turn{}, radius{};  // turn: radius over the inertia
  };
  struct Row {
    Touching pair{};
    std::uint32_t a = 0, b = 0;  // b: the place behind the last body where there is a wall
    V normal{};
    Real of_normal{}, of_slip{}, of_roll{};  // speeds by impulses of 1
    Real least{};                            // at which the two must part
    Real friction{}, resistance{}, arm{};
    Real press{};
    V rub{};
    S roll{};
  };

  void begin(const World<Real, Dim>& world, const Loads& loads, const Real& h) {
    const std::size_t n = world.size();
    movers_.assign(n + 1, {});
    for (std::size_t i = 0; i < n; ++i) {
      Moving& to = movers_[i];
      to = {world.velocity[i], world.spin[i], world.inverse_mass[i], world.radius[i] * world.inverse_inertia[i],
            world.radius[i]};
      to.v += loads.force[i] * (h * world.inverse_mass[i]);
      if (!loads.torque.empty()) to.spin += loads.torque[i] * (h * world.inverse_inertia[i]);
    }
  }
  void list_rows(const World<Real, Dim>& world, std::span<const Touching> pairs, const Real& pull, const Real& h) {
    rows_.clear();
    Real fastest(0);
    for (const V& v : world.velocity) fastest = std::max(fastest, squared(v));
    using std::sqrt;
    const Real reach = 2 * h * (sqrt(fastest) + 2 * pull * h);
    auto known = pushed_.begin();
    for (const Touching& pair : pairs) {
      const Real gap = gap_of(world, pair);
      if (gap > reach) continue;
      while (known != pushed_.end() && known->pair < pair) ++known;
      HeldContact<Real, Dim> contact(world, pair);
      contact.place(world, world.position, world.velocity, world.spin);
      Row row{.pair = pair,
              .a = pair.a,
              .b = pair.with_wall() ? static_cast<std::uint32_t>(world.size()) : pair.b,
              .normal = normal_of(world, pair)};
      const Moving &a = movers_[row.a], &b = movers_[row.b];
      row.of_normal = a.inverse_mass + b.inverse_mass;
      row.of_slip = row.of_normal + a.radius * a.turn + b.radius * b.turn;
      row.arm = contact.arm;
      row.of_roll = row.arm * row.arm * (over(a) + over(b));
      // What overlaps by errors parts again in the time in which a body falls its radius.
      row.least = gap > Real(0) ? -gap / h : std::min(-gap, world.radius[pair.a]) * sqrt(pull / world.radius[pair.a]);
      row.friction = contact.slip.most;
      row.resistance = contact.roll.most;
      if (known != pushed_.end() && known->pair == pair) {
        row.press = known->press * h;
        row.rub = (known->rub - row.normal * dot(known->rub, row.normal)) * h;
        row.roll = across_normal(known->roll, row.normal) * h;
      }
      rows_.push_back(row);
    }
  }
  /// The impulses of all contacts, from the forces of the last step. Where those were of an impact they throw bodies
  /// about, which so many sweeps may not take back: impulses of contacts cannot but lower the energy.
  void find_impulses(const Real& change_by_forces) {
    const std::vector<Moving> free = movers_;
    Real weight(0);
    for (const Moving& one : movers_)
      if (one.inverse_mass > Real(0)) weight += 1 / one.inverse_mass;
    const Real most = Real(1.001) * energy() + weight * change_by_forces * change_by_forces;
    for (Row& row : rows_) push(row, row.press, row.rub, row.roll);
    sweep(Real(1e-4) * change_by_forces, most_sweeps);
    if (energy() > most) sweep(Real(1e-4) * change_by_forces, 4 * most_sweeps);
    if (!(energy() > most)) return;
    movers_ = free;
    for (Row& row : rows_) row.press = Real(0), row.rub = {}, row.roll = {};
    sweep(Real(1e-4) * change_by_forces, 4 * most_sweeps);
  }
  void sweep(const Real& least, int most) {
    for (int k = 0; k < most; ++k) {
      Real greatest(0);
      if (k % 2 == 0) {  // to and fro, as in joint_impacts.hpp
        for (Row& row : rows_) greatest = std::max(greatest, set_right(row));
      } else {
        for (auto row = rows_.rbegin(); row != rows_.rend(); ++row) greatest = std::max(greatest, set_right(*row));
      }
      if (!(greatest > least)) return;
    }
  }
  /// Twice as much.
  Real energy() const {
    Real sum(0);
    for (const Moving& one : movers_)
      if (one.inverse_mass > Real(0)) sum += squared(one.v) / one.inverse_mass + squared(one.spin) / over(one);
    return sum;
  }
  static Real over(const Moving& one) { return one.radius > Real(0) ? one.turn / one.radius : Real(0); }
  static S across_normal(const S& spin, const V& normal) {
    if constexpr (Dim == 3) {
      return spin - normal * dot(spin, normal);
    } else {
      return spin;
    }
  }

  /// The impulses act on b, and back on a.
  void push(const Row& row, const Real& press, const V& rub, const S& roll) {
    Moving &a = movers_[row.a], &b = movers_[row.b];
    const V impulse = row.normal * press + rub;
    a.v -= impulse * a.inverse_mass;
    b.v += impulse * b.inverse_mass;
    if (!(row.friction > Real(0))) return;
    const S twist = moment(row.normal, rub);
    a.spin -= twist * a.turn;
    b.spin -= twist * b.turn;
    if (!(row.resistance > Real(0))) return;
    a.spin -= roll * (row.arm * over(a));
    b.spin += roll * (row.arm * over(b));
  }
  /// The whole impulse of one contact, for what the others do. How much it changed, as a speed.
  Real set_right(Row& row) {
    const Moving &a = movers_[row.a], &b = movers_[row.b];
    V rate = b.v - a.v;
    const Real parting = dot(rate, row.normal);
    const Real press = std::max(Real(0), Real(row.press + (row.least - parting) / row.of_normal));
    const Real change = press - row.press;
    row.press = press;
    if (!(row.friction > Real(0))) {
      push(row, change, {}, {});
      return std::abs(change) * row.of_normal;
    }
    rate -=
        row.normal * parting + turning(a.spin, V(row.normal * a.radius)) + turning(b.spin, V(row.normal * b.radius));
    const V rub = limited(V(row.rub - rate * (1 / row.of_slip)), Real(row.friction * press));
    const V rub_change = rub - row.rub;
    row.rub = rub;
    S roll_change{};
    if (row.resistance > Real(0)) {
      const S rolling = across_normal(S((b.spin - a.spin) * row.arm), row.normal);
      const S roll = limited(S(row.roll - rolling * (1 / row.of_roll)), Real(row.resistance * press));
      roll_change = roll - row.roll;
      row.roll = roll;
    }
    push(row, change, rub_change, roll_change);
    return std::max(
        {std::abs(change) * row.of_normal, length(rub_change) * row.of_slip, length(roll_change) * row.of_roll});
  }
  template <class W>
  static W limited(const W& load, const Real& most) {
    const Real size = length(load);
    return size > most ? load * (most / size) : load;
  }

  std::vector<Moving> movers_;  // by number, and one behind them that nothing moves
  std::vector<Row> rows_;
  std::vector<Pushed> pushed_;
  Real fastest_{}, change_{};
};

}  // namespace continuo
