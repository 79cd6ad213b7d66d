// continuo/bodies/event_driven/event_driven.hpp
// The exact motion of spheres on parabolas, from one predicted event to the next.
#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>
#include <utility>

#include <continuo/bodies/contacts/contact_time.hpp>
#include <continuo/bodies/contacts/impulse.hpp>
#include <continuo/bodies/event_driven/event_prefetch.hpp>
#include <continuo/bodies/event_driven/event_queue.hpp>
#include <continuo/bodies/event_driven/exact_engine.hpp>
#include <continuo/bodies/event_driven/flight_bytes.hpp>
#include <continuo/bodies/event_driven/flights.hpp>
#include <continuo/bodies/event_driven/inelastic_collapse.hpp>
#include <continuo/bodies/event_driven/instant_collisions.hpp>
#include <continuo/bodies/event_driven/resting.hpp>
#include <continuo/bodies/event_driven/simultaneous_impacts.hpp>
#include <continuo/bodies/event_driven/sphere_proxy.hpp>

namespace continuo {

namespace detail {

template <class Real, int Dim>
class EventDriven final : public ParabolicEngine<Real, Dim> {
 public:
  using V = Vector<Real, Dim>;
  using S = Spin<Real, Dim>;

  EventDriven(World<Real, Dim>& world, const ExactOptions<Real>& options)
      : ParabolicEngine<Real, Dim>(options),
        world_(world),
        options_(options),
        contact_time_(options.contact_time ? *options.contact_time : usual_contact_time(world)),
        flights_(world) {
    flights_.slow = slow();
    flights_.at_one_time = time_of_one_instant();
    sort();
    for (std::uint32_t i = 0; i < flights_.paths.size(); ++i) predict(i);
  }

  Status advance_to(const Real& t) override {
    Status status = run_to(t);
    synchronize(flights_.now);
    return status ? check_motion(world_) : status;
  }
  Status run_to(const Real& t) override {
    std::size_t events = 0;
    met.reset();
    if (!fault_) return fault_;
    while (queue_.time() <= t) {
      if (++events > options_.most_events) return too_many_events();
      if (events % 1024 == 0 && options_.is_interrupted()) return interrupted();
      flights_.now = std::max(flights_.now, queue_.time());
      prefetch_.look_ahead(queue_, flights_);
      handle(queue_.first());
      if (!fault_) return fault_;
      if (met) return {};
      if (crossings_since_sort_ > 4 * flights_.paths.size()) sort();
    }
    flights_.now = t;
    return {};
  }
  Real now() const override { return flights_.now; }

  void bring_out(std::uint32_t number) override {
    const std::uint32_t i = place_[number];
    bring(i);
    if (flights_.acts[i] == Act::rests && contacts.is_kept()) note_end(i);
    world_.position[number] = flights_.paths[i].x;
    world_.velocity[number] = flights_.paths[i].v;
    world_.spin[number] = flights_.turnings[i].spin;
  }
  void replace_by_proxy(std::uint32_t number, const V& centre, const Real& radius) override {
    put_sphere(flights_, place_[number], centre, radius);
    predict(place_[number]);
  }
  void take_back(std::uint32_t number) override {
    put_body(flights_, place_[number]);
    predict(place_[number]);
  }
  void find_overlapping(std::uint32_t number, std::vector<std::uint32_t>& found) override {
    continuo::find_overlapping(flights_, place_[number], found);
  }

  void save(ByteWriter& writer) override {
    writer(contact_time_);
    save_flights(writer, flights_);
  }
  void load(ByteReader& reader) override {
    reader(contact_time_);
    reader.expect(contact_time_ >= Real(0), "a contact time below 0");
    flights_.slow = slow();
    flights_.at_one_time = time_of_one_instant();
    if (load_flights(reader, flights_)) sort();
  }

  using ExactEngine<Real, Dim>::statistics;
  using ExactEngine<Real, Dim>::contacts;
  using ParabolicEngine<Real, Dim>::met;

 private:
  /// The greatest speed at the start, from the usual contact time.
  Real slow() const {
    if (is_heavy() || world_.size() == 0 || !(contact_time_ > Real(0))) return Real(0);
    return Real(1e-5) * std::ranges::min(world_.radius) / contact_time_;
  }
  /// The rounding of a path of some radii, from the usual contact time.
  Real time_of_one_instant() const { return Real(1e7) * std::numeric_limits<Real>::epsilon() * contact_time_; }
  /// Sorts the bodies in memory; the motion stays the same.
  void sort() {
    crossings_since_sort_ = 0;
    flights_.sort();
    place_ = flights_.places();
    std::vector<std::uint32_t> numbers;
    for (const auto& plan : flights_.plans) numbers.push_back(plan.number);
    queue_ = EventQueue<Real>(std::move(numbers));
    for (std::uint32_t k = 0; k < flights_.plans.size(); ++k) schedule(k);
  }

  void synchronize(const Real& t) override {
    for (std::size_t i = 0; i < flights_.paths.size(); ++i) {
      if (flights_.acts[i] == Act::is_proxy) continue;
      Path<Real, Dim> at = flights_.paths[i];
      const Plan<Real, Dim>& plan = flights_.plans[i];
      Flights<Real, Dim>::advance(at, plan.acceleration, t);
      world_.position[plan.number] = at.x;
      world_.velocity[plan.number] = at.v;
      turn_to(static_cast<std::uint32_t>(i), t);
      world_.spin[plan.number] = spin_at(flights_.turnings[i], t);
    }
    world_.time = flights_.now = t;
  }
  static S spin_at(const Turning<Real, Dim>& turning, const Real& t) {
    return turning.spin + turning.spin_rate * (t - turning.spun_since);
  }
  /// Advances the orientation of a body to time t. A spin that changes linearly turns the body by its mean.
  void turn_to(std::uint32_t i, const Real& t) {
    Turning<Real, Dim>& turning = flights_.turnings[i];
    const Real from = turning.spun_to;
    turning.spun_to = t;
    if (!(t > from) || (turning.spin == S{} && turning.spin_rate == S{})) return;
    auto& orientation = world_.orientation[flights_.plans[i].number];
    orientation = turned(orientation, spin_at(turning, Real(from + (t - from) / 2)), Real(t - from));
  }

  void schedule(std::uint32_t i) {
    queue_.set(i, std::min(flights_.plans[i].collision_time, flights_.plans[i].crossing_time));
  }
  void predict(std::uint32_t i) {
    flights_.predict(i);
    schedule(i);
  }

  void handle(std::uint32_t i) {
    const Plan<Real, Dim>& plan = flights_.plans[i];
    const std::uint32_t j = plan.partner;
    if (plan.crossing_time <= plan.collision_time) return cross(i);
    if (j >= first_wall && j < look_again) return hit_wall(i, j - first_wall);
    if (plan.path_end <= flights_.now) return go_on(i);
    if (j == look_again || flights_.collisions[j] != plan.collisions_of_partner) {
      ++statistics.outdated;
      return predict(i);
    }
    if (flights_.acts[i] == Act::is_proxy || flights_.acts[j] == Act::is_proxy) return stop_at(i, j);
    plan.number < flights_.plans[j].number ? hit(i, j) : hit(j, i);
  }

  void stop_at(std::uint32_t i, std::uint32_t j) { met = {flights_.plans[i].number, flights_.plans[j].number}; }

  /// Continues a resting body on its next path, where slip or rolling has ended or must change its direction.
  void go_on(std::uint32_t i) {
    bring(i);
    ++flights_.collisions[i];
    go_on_along(flights_, i, contact_time_);
    predict(i);
  }

  void cross(std::uint32_t i) {
    ++statistics.crossings;
    ++crossings_since_sort_;
    Plan<Real, Dim>& plan = flights_.plans[i];
    flights_.grid.remove(i, plan.cell);
    flights_.move_to_now(i);
    if (!flights_.grid.has_cell(flights_.paths[i].x)) {  // it is beyond the range of cell numbers
      plan.is_large = true;
      flights_.large.push_back(i);
      return predict(i);
    }
    plan.cell[plan.axis] += plan.direction;
    flights_.grid.insert(i, plan.cell);
    if (plan.partner == look_again) return predict(i);
    flights_.look_ahead(i);
    schedule(i);
  }

  InelasticCollapse<Real, Dim> pile_up() const { return {is_heavy(), contact_time_}; }
  bool is_piled(const Material<Real>& material, std::uint32_t i) const {
    return pile_up().is_piled(material, pile_up().in_a_row(flights_.plans[i], flights_.now));
  }
  bool is_caught(const Material<Real>& material, std::uint32_t i) const {
    return pile_up().is_caught(material, flights_.plans[i], flights_.now);
  }
  bool is_heavy() const { return world_.gravity != V{}; }
  /// Stops a body, which its neighbours support, until another body hits it.
  void freeze(std::uint32_t i) {
    if (flights_.acts[i] == Act::is_fixed) return;
    turn_to(i, flights_.now);
    flights_.paths[i].v = flights_.plans[i].acceleration = {};
    flights_.turnings[i].spin = flights_.turnings[i].spin_rate = {};
    flights_.plans[i].path_end = Flights<Real, Dim>::never;
    flights_.plans[i].support_count = 0;
    flights_.turnings[i].rests_since = flights_.now;
    flights_.acts[i] = Act::rests;
  }
  bool is_still(std::uint32_t i) const {
    return flights_.acts[i] == Act::is_fixed ||
           (flights_.acts[i] == Act::rests && flights_.plans[i].support_count == 0);
  }
  /// Two bodies that are caught continue with a common velocity, or stop where one of them cannot move.
  void stop(std::uint32_t i, std::uint32_t j) {
    const bool is_held_fast = is_still(i) || is_still(j);
    turn(i);
    turn(j);
    note_collision(i);
    note_collision(j);
    if (is_held_fast) {
      freeze(i);
      freeze(j);
      return;
    }
    const Mover<Real, Dim> a = mover(i, true), b = mover(j, true);
    const V change = b.velocity - a.velocity;
    a.velocity += change * (a.inverse_mass / (a.inverse_mass + b.inverse_mass));
    b.velocity = a.velocity;
    a.spin = b.spin = {};
  }

  void bring(std::uint32_t i) {
    flights_.move_to_now(i);
    turn(i);
  }
  void turn(std::uint32_t i) {
    turn_to(i, flights_.now);
    Turning<Real, Dim>& turning = flights_.turnings[i];
    turning.spin = spin_at(turning, flights_.now);
    turning.spun_since = flights_.now;
  }
  /// Brings a body to the present for an event. A falling body has a constant spin, so that its rotation can wait
  /// unless friction changes it.
  void bring(std::uint32_t i, bool rubs) {
    rubs || flights_.acts[i] == Act::rests ? bring(i) : flights_.move_to_now(i);
  }
  /// Without friction, the rotation of a body is not needed.
  Mover<Real, Dim> mover(std::uint32_t i, bool rubs) {
    Path<Real, Dim>& path = flights_.paths[i];
    const Real inverse_mass = flights_.plans[i].inverse_mass;
    if (!rubs) return {path.v, no_spin_, path.radius, inverse_mass, Real(0)};
    Turning<Real, Dim>& turning = flights_.turnings[i];
    return {path.v, turning.spin, path.radius, inverse_mass, turning.inverse_inertia};
  }

  void hit(std::uint32_t i, std::uint32_t j) {
    if (may_be_shared(i, j) && collide_at_once(i, j)) return;
    ++statistics.collisions;
    Material<Real> material = combined(world_.combine_rule, flights_.material(i), flights_.material(j));
    const bool caught = is_caught(material, i) || is_caught(material, j),
               piled = is_piled(material, i) || is_piled(material, j);
    if (piled && !caught && !is_heavy() && strike_simultaneously(i, j)) return;
    if (piled) material.restitution = Real(0);
    const bool rubs = material.friction > Real(0);
    bring(i, rubs);
    bring(j, rubs);
    const Path<Real, Dim>&a = flights_.paths[i], &b = flights_.paths[j];
    const V apart = b.x - a.x;
    const Real distance = length(apart);
    V normal = distance > Real(0) ? apart * (1 / distance) : V{};
    if (!(distance > Real(0))) normal[0] = Real(1);
    Real impulse(0);
    if (dot(b.v - a.v, normal) < Real(0)) impulse = collide(mover(i, rubs), mover(j, rubs), normal, material);
    if (caught && !is_heavy()) {
      stop(i, j);
    } else {
      if (caught || stays_on(i, j, normal)) stop_at(i, j);
      note_collision(i);
      note_collision(j);
    }
    if (contacts.is_kept() && impulse > Real(0))
      contacts.add({.a = handle_of(i),
                    .b = handle_of(j),
                    .point = a.x + normal * a.radius,
                    .normal = normal,
                    .impulse = impulse,
                    .time = flights_.now});
    predict(i);
    predict(j);
  }

  /// Whether the present collision of two bodies, or of one with a wall, may be at one instant with others.
  bool may_be_shared(std::uint32_t i, std::uint32_t j) {
    return flights_.plans[i].is_tied || flights_.plans[j].is_tied ||
           queue_.has_others_until(flights_.now + flights_.at_one_time, i, j);
  }
  /// Lets collide what touches body i, or is connected with it by contacts, where several pairs approach each other at
  /// this instant. False where they do not, or where one of them is caught.
  bool collide_at_once(std::uint32_t i, std::uint32_t j) {
    at_once_.gather(flights_, i);
    const auto touching = at_once_.contacts();
    if (touching.size() < 2) return false;
    const auto velocity_now = [this](std::uint32_t k) { return flights_.velocity_now(k); };
    if (at_once_.find_approaching(flights_, velocity_now) < 2 || are_caught(touching)) return false;
    for (const std::uint32_t k : at_once_.members()) bring(k);
    constexpr int most_rounds = 1000;  // what still approaches then has its next collision at this instant as well
    for (int round = 0; round < most_rounds; ++round) {
      const auto velocity = [this](std::uint32_t k) -> const V& { return flights_.paths[k].v; };
      if (round > 0 && (at_once_.find_approaching(flights_, velocity) == 0 || are_caught(touching))) break;
      const bool piled = lose_what_piles_up(touching);
      if (piled && !is_heavy() && strike_simultaneously(i, j)) break;
      if (!round_.collide(touching, [this](std::uint32_t k) { return mover(k, true); }))
        give_up(numbers_of_struck(touching));
      for (std::size_t c = 0; c < touching.size(); ++c) note_round(touching[c], at_once_.wall_of(c));
      if (!fault_) break;
    }
    for (std::size_t c = 0; c < touching.size(); ++c) stay(touching[c], at_once_.wall_of(c));
    for (const std::uint32_t k : at_once_.members()) predict(k);
    return true;
  }
  void give_up(std::vector<std::uint32_t> numbers) {
    fault_ = impulses_not_found(flights_.now, std::move(numbers),
                                "masses that differ less, fewer bodies that touch, or less friction would have some");
  }
  [[nodiscard]] std::vector<std::uint32_t> numbers_of_struck(std::span<const Collision<Real, Dim>> all) const {
    std::vector<std::uint32_t> numbers;
    for (const Collision<Real, Dim>& one : all)
      for (const std::uint32_t k : {one.a, one.b})
        if (one.acts && k != Collision<Real, Dim>::wall) numbers.push_back(flights_.plans[k].number);
    std::ranges::sort(numbers);
    numbers.erase(std::ranges::unique(numbers).begin(), numbers.end());
    return numbers;
  }
  /// Whether one of the bodies of a contact that acts does what `does(material, body)` says.
  template <class Does>
  static bool any_body(const Collision<Real, Dim>& one, Does&& does) {
    return one.acts &&
           (does(one.material, one.a) || (one.b != Collision<Real, Dim>::wall && does(one.material, one.b)));
  }
  bool are_caught(std::span<const Collision<Real, Dim>> all) const {
    return std::ranges::any_of(all, [this](const Collision<Real, Dim>& one) {
      return any_body(one, [this](const auto& material, std::uint32_t k) { return is_caught(material, k); });
    });
  }
  /// Takes the restitution of those contacts that pile up. Returns whether there are any.
  bool lose_what_piles_up(std::span<Collision<Real, Dim>> all) const {
    bool piled = false;
    for (Collision<Real, Dim>& one : all) {
      if (!any_body(one, [this](const auto& material, std::uint32_t k) { return is_piled(material, k); })) continue;
      one.material.restitution = Real(0);
      piled = true;
    }
    return piled;
  }
  void note_round(const Collision<Real, Dim>& one, std::uint32_t wall) {
    if (!one.acts) return;
    const bool is_wall = one.b == Collision<Real, Dim>::wall;
    ++(is_wall ? statistics.wall_collisions : statistics.collisions);
    note_collision(one.a);
    if (!is_wall) note_collision(one.b);
    if (!contacts.is_kept() || !(one.impulse > Real(0))) return;
    if (is_wall) return note_wall(one.a, wall, ContactChange::impact, one.impulse);
    const Path<Real, Dim>& a = flights_.paths[one.a];
    contacts.add({.a = handle_of(one.a),
                  .b = handle_of(one.b),
                  .point = a.x + one.normal * a.radius,
                  .normal = one.normal,
                  .impulse = one.impulse,
                  .time = flights_.now});
  }
  /// After the last round: who now lies on whom.
  void stay(const Collision<Real, Dim>& one, std::uint32_t wall) {
    if (!is_heavy() || flights_.plans[one.a].last_collision != flights_.now) return;
    if (one.b != Collision<Real, Dim>::wall) {
      if (stays_on(one.a, one.b, one.normal)) stop_at(one.a, one.b);
    } else if (flights_.acts[one.a] == Act::falls) {
      rest_after_hit(one.a, wall, false);
    }
  }

  /// Strikes all bodies that are connected with these by contacts, so that no two approach each other afterwards.
  /// Returns whether any motion has changed.
  bool strike_simultaneously(std::uint32_t i, std::uint32_t j) {
    const V& v = flights_.paths[i].v;
    const V rate = i == j ? v : V(flights_.paths[j].v - v);
    simultaneous_.gather(flights_, i, Real(length(rate) * contact_time_));
    for (const std::uint32_t k : simultaneous_.members()) bring(k);
    Real speeds = flights_.slow;
    for (const std::uint32_t k : simultaneous_.members())
      speeds = std::max(speeds, Real(2 * length(flights_.paths[k].v)));
    constexpr Real rounding = std::numeric_limits<Real>::epsilon();
    const auto [impulses, error] = simultaneous_.strike(world_, flights_, Real(rounding * speeds));
    if (!(error <= std::sqrt(rounding) * speeds)) {
      std::vector<std::uint32_t> numbers;
      for (const std::uint32_t k : simultaneous_.members()) numbers.push_back(flights_.plans[k].number);
      give_up(std::move(numbers));
    }
    for (std::size_t k = 0; k < impulses.size(); ++k) {
      if (!(impulses[k] > Real(0))) continue;
      const Touching& at = simultaneous_.pairs()[k];
      ++(at.with_wall() ? statistics.wall_collisions : statistics.collisions);
      if (contacts.is_kept()) contacts.add(event_of(world_, at, flights_.now, ContactChange::impact, impulses[k]));
    }
    for (const std::uint32_t k : simultaneous_.struck()) note_collision(k, true);
    for (const std::uint32_t k : simultaneous_.struck()) predict(k);
    return !simultaneous_.struck().empty();
  }

  /// Whether the two, after a collision, would fly for less than the contact time. A body that rests on a sphere does
  /// not move on a parabola.
  bool stays_on(std::uint32_t i, std::uint32_t j, const V& normal) const {
    const Real press = dot(flights_.plans[i].acceleration - flights_.plans[j].acceleration, normal);
    const Real parting = dot(flights_.paths[j].v - flights_.paths[i].v, normal);
    return press > Real(0) && parting < press * contact_time_ / 2;
  }

  void hit_wall(std::uint32_t i, std::uint32_t w) {
    if (may_be_shared(i, i) && collide_at_once(i, i)) return;
    ++statistics.wall_collisions;
    Material<Real> material = combined(world_.combine_rule, flights_.material(i), world_.walls()[w].material);
    const bool caught = is_caught(material, i), piled = is_piled(material, i);
    if (piled && !caught && !is_heavy() && strike_simultaneously(i, i)) return;
    if (piled) material.restitution = Real(0);
    const bool rubs = material.friction > Real(0);
    bring(i, rubs);
    const Wall<Real, Dim> wall = facing(world_.walls()[w], flights_.paths[i].x);
    V no_velocity{};
    S no_spin{};
    const Mover<Real, Dim> of_wall{no_velocity, no_spin, Real(0), Real(0), Real(0)};
    Real impulse(0);
    if (dot(flights_.paths[i].v, wall.normal) < Real(0))
      impulse = collide(mover(i, rubs), of_wall, V(-wall.normal), material);
    note_collision(i);
    if (contacts.is_kept() && impulse > Real(0)) note_wall(i, w, ContactChange::impact, impulse);
    rest_after_hit(i, w, caught);
    predict(i);
  }
  void rest_after_hit(std::uint32_t i, std::uint32_t w, bool caught) {
    const Rest rest = caught ? Rest::flies : rest_on_walls(flights_, i, w, contact_time_);
    if (caught || rest == Rest::lies_in_groove) is_heavy() ? stop_at(i, i) : freeze(i);
    if (rest == Rest::lies && contacts.is_kept())
      for (std::uint32_t k = 0; k < flights_.plans[i].support_count; ++k)
        note_wall(i, flights_.plans[i].supports[k], ContactChange::begin, Real(0));
  }

  /// Notes that a body has a new path. It no longer rests on its supports, until it hits them again.
  void note_collision(std::uint32_t i, bool is_strike = false) {
    Plan<Real, Dim>& plan = flights_.plans[i];
    ++flights_.collisions[i];
    pile_up().count(plan, flights_.now, is_strike);
    if (flights_.acts[i] != Act::rests) return;
    if (contacts.is_kept()) note_end(i);
    flights_.acts[i] = Act::falls;
    plan.acceleration = world_.gravity;
    flights_.turnings[i].spin_rate = {};
    plan.path_end = Flights<Real, Dim>::never;
  }

  void note_end(std::uint32_t i) {
    const Plan<Real, Dim>& plan = flights_.plans[i];
    const auto forces = support_forces(flights_, i);
    for (std::uint32_t k = 0; k < plan.support_count; ++k)
      note_wall(i, plan.supports[k], ContactChange::end,
                Real(forces[k] * (flights_.now - flights_.turnings[i].rests_since)));
  }
  BodyHandle handle_of(std::uint32_t i) const { return world_.handle(flights_.plans[i].number); }
  void note_wall(std::uint32_t i, std::uint32_t w, ContactChange change, const Real& impulse) {
    const Path<Real, Dim>& path = flights_.paths[i];
    const V normal = -facing(world_.walls()[w], path.x).normal;
    contacts.add({.change = change,
                  .a = handle_of(i),
                  .wall = w,
                  .point = path.x + normal * path.radius,
                  .normal = normal,
                  .impulse = impulse,
                  .time = flights_.now});
  }

  World<Real, Dim>& world_;
  ExactOptions<Real> options_;
  Real contact_time_;
  Flights<Real, Dim> flights_;
  EventQueue<Real> queue_;
  EventPrefetch<Real, Dim> prefetch_;
  SimultaneousImpacts<Real, Dim> simultaneous_;
  InstantCollisions<Real, Dim> at_once_;
  CollisionRound<Real, Dim> round_;
  std::size_t crossings_since_sort_ = 0;
  std::vector<std::uint32_t> place_;  // of each number
  S no_spin_{};
  Status fault_{};  // why the motion cannot go on
};

}  // namespace detail

template <class Real, int Dim>
std::unique_ptr<ParabolicEngine<Real, Dim>> event_driven(World<Real, Dim>& world, const ExactOptions<Real>& options) {
  return std::make_unique<detail::EventDriven<Real, Dim>>(world, options);
}

}  // namespace continuo
