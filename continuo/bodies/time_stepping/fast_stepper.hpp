// A step of the fast motion, from the world to the world.
#pragma once
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include <continuo/bodies/fast_motion.hpp>
#include <continuo/bodies/forces.hpp>
#include <continuo/bodies/support/prefetch.hpp>
#include <continuo/bodies/time_stepping/contact_passes.hpp>
#include <continuo/bodies/time_stepping/impacts.hpp>
#include <continuo/bodies/time_stepping/sleep.hpp>
#include <continuo/bodies/time_stepping/torque_integration.hpp>
#include <continuo/bodies/time_stepping/touch_log.hpp>

namespace continuo {

template <class Real, int Dim>
class FastMotion<Real, Dim>::Stepper {
 public:
  using V = Vector<Real, Dim>;

  Stepper(World<Real, Dim>& world, const FastOptions<Real>& options)
      : log(options.contact_events), world_(world), options_(options), team_(options.threads) {
    renew();
  }

  void renew() {
    team_.run([&] { refresh(); });
  }
  void refresh() {
    list_ = {};
    contacts_ = {};
    sleep_ = {};
    list_.begin(world_);
    load();
    make_list();
  }

  std::string advance() {
    std::string error;
    team_.run([&] { error = step(); });
    return error;
  }

  std::string step() {
    if (!(options_.step > Real(0)) || !(options_.step < std::numeric_limits<Real>::infinity()))
      return "the step must be greater than 0, and finite";
    if (options_.substeps < 1) return "a step has at least one substep";
    if (world_.size() != bodies_.size() || world_.walls().size() != list_.walls()) refresh();
    is_other_at_rest_ |= sleep_.wake_changed(world_);
    load();
    bool is_kept = std::exchange(is_restored_, false);
    const auto list_anew = [&] {
      if (!std::exchange(is_kept, true)) contacts_.keep(team_);
      make_list();
    };
    if (is_other_at_rest_ || list_.is_outdated(bodies_, options_.step)) list_anew();
    while (sleep_.wake_near(bodies_, contacts_.rows, list_.order(), options_.step)) list_anew();
    activate();
    place_before_ = {};  // not needed most of the time
    const Real h = options_.step / static_cast<Real>(options_.substeps);
    log.clear();
    torque_integration_.begin(world_, list_.order());
    may_strike_soon_ = has_other_forces_ || may_strike(h, Real(0.1), length(world_.gravity) * options_.step);
    if (!substeps(world_.time, h))
      return "the equations of implicit Euler could not be solved: a smaller step may help";
    if (!bodies_.all_finite())
      return "a body's motion is no longer finite: a force or a mass is too large for the step";
    store();
    world_.time += options_.step;
    if (log.is_kept()) note_touching();
    if (options_.sleep_after > Real(0))
      is_other_at_rest_ =
          sleep_.settle(world_, contacts_, list_.order(), options_.step, options_.sleep_after, options_.sleep_speed);
    ++statistics.steps;
    statistics.asleep = sleep_.asleep();
    statistics.lists = list_.lists();
    statistics.contacts = contacts_.active();
    statistics.colours = contacts_.between_movers.colours;
    return {};
  }

  Real deepest_overlap() const { return contacts_.deepest_overlap(bodies_, world_.walls()); }

  /// Whatever outlives a step and is not in the world. The list is made again, from where the bodies were then.
  void save(ByteWriter& writer) const {
    const bool is_listed = list_.x_of_list().size() == world_.size() && list_.walls() == world_.walls().size();
    writer(is_listed);
    if (!is_listed) return;
    std::vector<V> x(world_.size());
    std::vector<Real> reach(world_.size());
    for (std::size_t k = 0; k < x.size(); ++k) {
      x[list_.order()[k]] = list_.x_of_list()[k];
      reach[list_.order()[k]] = list_.reach_of_list()[k];
    }
    writer(x), writer(reach);
    ContactList<Real, Dim> contacts = contacts_;
    ThreadTeam alone(1);
    if (!is_restored_) contacts.keep(alone);
    contacts.transfer_kept(writer);
    writer(touches_), writer(sleep_), writer(is_other_at_rest_);
  }
  void load(ByteReader& reader) {
    bool is_listed = false;
    reader(is_listed);
    std::vector<V> x;
    std::vector<Real> reach;
    ContactList<Real, Dim> contacts;
    TouchLog<Real, Dim> touches;
    Sleep<Real, Dim> sleep;
    bool is_other_at_rest = false;
    if (is_listed) {
      reader(x), reader(reach);
      contacts.transfer_kept(reader);
      reader(touches), reader(sleep), reader(is_other_at_rest);
      reader.expect(x.size() == world_.size() && reach.size() == x.size(), "a list of other bodies");
      for (std::size_t i = 0; i < x.size() && reader.ok(); ++i)
        reader.expect(is_finite(x[i]) && reach[i] >= Real(0), "a list that is not finite");
      reader.expect(contacts.kept_fits(world_.size(), world_.walls().size()), "contacts of other bodies");
      reader.expect(sleep.fits(world_.size()), "the sleep of other bodies");
    }
    reader.expect_end();
    if (!reader.ok()) return;
    refresh();
    touches_ = std::move(touches);
    sleep_ = std::move(sleep);
    if (!is_listed) return;
    std::swap(world_.position, x);
    list_.sort(world_, place_before_);
    load();
    contacts_ = std::move(contacts);
    list_within([&](std::size_t k) { return reach[list_.order()[k]]; });
    std::swap(world_.position, x);
    load();
    place_before_ = {};
    is_other_at_rest_ = is_other_at_rest;
    is_restored_ = true;
  }

  std::size_t memory() const {
    return bodies_.memory() + list_.memory() + contacts_.memory() + place_before_.capacity() * sizeof(std::uint32_t) +
           (x_.capacity() + v_.capacity() + force_.capacity()) * sizeof(V) + inverse_mass_.capacity() * sizeof(Real) +
           sleep_.memory();
  }

  FastStatistics statistics{};
  ContactLog<Real, Dim> log;

 private:
  void note_touching() {
    const auto handle = [&](std::uint32_t k) { return world_.handle(list_.order()[k]); };
    contacts_.for_each_touching([&](std::uint32_t k, std::uint32_t other, bool is_wall, const Real& impulse) {
      ContactEvent<Real, Dim> event{.a = handle(k)};
      event.impulse = impulse * static_cast<Real>(options_.substeps);
      if (is_wall) {
        event.wall = other;
        event.normal = -facing(world_.walls()[other], bodies_.x(k)).normal;
      } else {
        event.b = handle(other);
        if (event.b.slot < event.a.slot) std::swap(event.a, event.b);
        const V apart = world_.position_of(event.b) - world_.position_of(event.a);
        if (const Real distance = length(apart); distance > Real(0)) event.normal = apart * (1 / distance);
      }
      event.point = world_.position_of(event.a) + event.normal * world_.radius[world_.index(event.a)];
      touches_.touch(event);
    });
    touches_.end_step(world_.time, log);
  }

  /// act(k) for all bodies, several at once.
  template <class Act>
  void for_each_body(Act&& act) {
    team_.for_each(0, bodies_.size(), 1024, [&](std::size_t from, std::size_t to) {
      for (std::size_t k = from; k < to; ++k) act(k);
    });
  }
  /// act(k, i) for all bodies k, which have the number i in the world: there they stand in another order, so what is
  /// read or written of these arrays is asked for early.
  template <class Act, class... Arrays>
  void for_each_in_world(Act&& act, const Arrays&... arrays) {
    constexpr std::size_t ahead = 20;
    const std::vector<std::uint32_t>& order = list_.order();
    team_.for_each(0, bodies_.size(), 1024, [&](std::size_t from, std::size_t to) {
      for (std::size_t k = from; k < to; ++k) {
        if (k + ahead < to) (prefetch(&arrays[order[k + ahead]]), ...);
        act(k, order[k]);
      }
    });
  }
  /// The bodies from the world, in the order of the list.
  void load() {
    const std::vector<std::uint32_t>& order = list_.order();
    bodies_.resize(order.size(), world_.walls().size(), list_.blocks());
    bodies_.gravity = world_.gravity;
    const auto load_body = [&](std::size_t k, std::size_t i) {
      const Real radius = world_.radius[i];
      BodyMotion<Real>& motion = bodies_.motion[k];
      BodyPlace<Real>& place = bodies_.place[k];
      put(world_.position[i], place.x_and_radius);
      place.x_and_radius[3] = radius;
      put(world_.velocity[i], motion.linear);
      put(Spin<Real, Dim>(world_.spin[i] * radius), motion.rim);
      const bool is_asleep = sleep_.is_asleep(i);  // then it is like a fixed one
      motion.linear[3] = is_asleep ? Real(0) : world_.inverse_mass[i];
      motion.rim[3] = is_asleep ? Real(0) : radius * radius * world_.inverse_inertia[i];
    };
    for_each_in_world(load_body, world_.position, world_.velocity, world_.spin, world_.radius, world_.inverse_mass,
                      world_.inverse_inertia);
    for (std::size_t w = 0; w < world_.walls().size(); ++w)
      put(V(world_.walls()[w].normal * world_.walls()[w].offset), bodies_.place[bodies_.wall(w)].x_and_radius);
    for (std::size_t k = bodies_.wall(world_.walls().size()); k < bodies_.motion.size(); ++k) {  // the stand-ins
      bodies_.place[k].x_and_radius[0] = static_cast<Real>(k % 2);
      bodies_.motion[k].linear[3] = Real(1);
    }
    has_other_forces_ = !only_gravity(world_);
    if (!has_other_forces_) bodies_.accelerations.clear();
  }
  void store() {
    const auto store_body = [&](std::size_t k, std::size_t i) {
      if (!bodies_.moves(k)) return;
      const Spin<Real, Dim> spin = vector_of<Spin<Real, Dim>::size()>(bodies_.motion[k].rim) * (1 / bodies_.radius(k));
      world_.orientation[i] = torque_integration_.acts() ? torque_integration_.orientation(i)
                                                         : turned(world_.orientation[i], spin, options_.step);
      world_.position[i] = bodies_.x(k);
      world_.velocity[i] = bodies_.v(k);
      world_.spin[i] = spin;
    };
    for_each_in_world(store_body, world_.orientation, world_.position, world_.velocity, world_.spin);
  }

  void make_list() {
    const std::vector<std::uint32_t> earlier = std::move(place_before_);
    list_.sort(world_, place_before_);
    if (!earlier.empty())
      for (std::uint32_t& place : place_before_) place = earlier[place];
    is_other_at_rest_ = false;
    load();
    list_within(SweptBounds<Real>(bodies_, options_.step));
  }
  template <class Reach>
  void list_within(const Reach& reach) {
    list_.list(team_, world_, bodies_, reach, contacts_.rows);
    contacts_.blocks = list_.blocks();
  }

  template <class Is>
  bool any_material(const Is& is) const {
    return std::ranges::any_of(world_.material, is) ||
           std::ranges::any_of(world_.walls(), is, &Wall<Real, Dim>::material);
  }

  void activate() {
    const auto material_of = [this, &order = list_.order()](std::uint32_t k) -> const Material<Real>& {
      return k < order.size() ? world_.material[order[k]] : world_.walls()[k - order.size()].material;
    };
    const auto combine_rule_of = [this, &material_of](std::uint32_t a, std::uint32_t b) {
      return combined(world_.combine_rule, material_of(a), material_of(b));
    };
    const Material<Real> first = bodies_.size() > 0 ? world_.material[0] : Material<Real>{};
    friction_ = combined(world_.combine_rule.friction, first.friction, first.friction);
    may_bounce_ = any_material([](const Material<Real>& material) { return material.restitution > Real(0); });
    const bool has_special_material =
        may_bounce_ || any_material([&](const Material<Real>& material) {
          return material.rolling_resistance > Real(0) || material.friction != first.friction;
        });
    contacts_.activate(team_, bodies_, world_.walls(), combine_rule_of, has_special_material,
                       swept_bounds_of_blocks(team_, bodies_, options_.step), place_before_);
  }

  /// Accelerations by all forces at time t; with h, at the end of a step of that. False where that could not be solved.
  bool accelerate(const Real& t, const Real& h) {
    const std::vector<std::uint32_t>& order = list_.order();
    x_.resize(bodies_.size()), v_.resize(bodies_.size()), force_.resize(bodies_.size());
    inverse_mass_.resize(bodies_.size());
    for (std::size_t k = 0; k < order.size(); ++k) {
      const std::size_t i = order[k];
      x_[i] = bodies_.x(k), v_[i] = bodies_.v(k), inverse_mass_[i] = bodies_.inverse_mass(k);
    }
    const bool is_solved = h == Real(0) || forces_at_end<Real, Dim>(world_, t, h, x_, v_, inverse_mass_, force_);
    if (h == Real(0)) forces<Real, Dim>(world_, t, x_, v_, force_);
    bodies_.accelerations.resize(bodies_.size());
    for (std::size_t k = 0; k < order.size(); ++k)
      bodies_.accelerations[k] = force_[order[k]] * bodies_.inverse_mass(k);
    return is_solved;
  }
  /// Whether gravity and the constant force are all that acts.
  bool is_steady(std::size_t k) const {
    if (!has_other_forces_ || !bodies_.moves(k)) return true;
    const std::size_t i = list_.order()[k];
    return bodies_.acceleration(k) ==
           (world_.mass[i] * world_.gravity + world_.constant_force[i]) * bodies_.inverse_mass(k);
  }

  /// The substeps of a step from time t on; false where equations could not be solved.
  bool substeps(const Real& t, const Real& h) {
    const bool is_simple = !has_other_forces_ && !torque_integration_.acts() && !may_strike_soon_;
    const IntegratorRule rule = rule_of(options_.integrator);
    ContactPasses passes(team_, contacts_, bodies_);
    const auto push_body = [&](std::uint32_t k) {
      put(V(bodies_.v(k) + bodies_.acceleration(k) * h), bodies_.motion[k].linear);
      bodies_.touched[k] = 0;
    };
    const Real lag = static_cast<Real>(rule.lag) * h, steady_lag = static_cast<Real>(rule.steady_lag) * h;
    const auto move_body = [&](std::uint32_t k) {
      V v = bodies_.v(k);
      if (!bodies_.touched[k]) v -= bodies_.acceleration(k) * (is_steady(k) ? steady_lag : lag);
      put(V(bodies_.x(k) + v * h), bodies_.place[k].x_and_radius);
    };
    ContactStep<Real> step = contact_step(h);
    for (int k = 0; k < options_.substeps; ++k) {
      const Real now = t + h * static_cast<Real>(k);
      if (k > 0 && is_simple) {
        passes.relax_and_push(step, move_body, push_body);
        continue;
      }
      if (has_other_forces_ && !accelerate(now, rule.solves_equations ? h : Real(0))) return false;
      look_for_impacts(step, now);
      torque_integration_.push(bodies_, now, h);
      passes.push(step, push_body);
      if (is_simple) continue;
      torque_integration_.turn(bodies_, rule, h);
      passes.relax(step, move_body);
      if (has_other_forces_ && rule.ends_with_correction) correct(now, h);
    }
    if (is_simple) passes.relax(step, move_body);
    return true;
  }
  ContactStep<Real> contact_step(const Real& h) const {
    // From 0.45 of the rate of substeps on, a column under a mass ten times its balls' never comes to rest. What is a
    // disturbance was measured: it keeps the overlaps of a falling heap below a hundredth of the radius.
    return {.h = h,
            .soft = softness(std::min(options_.hertz, 1 / (3 * h)), options_.damping, h),
            .fastest_push = options_.fastest_push,
            .friction = friction_,
            .disturbance = Real(0.0008) * list_.median_radius()};
  }

  /// The mean of the accelerations at the beginning and at the end is what changed the velocity.
  void correct(const Real& t, const Real& h) {
    const std::vector<V> before = bodies_.accelerations;
    accelerate(t + h, Real(0));
    for_each_body([&](std::size_t k) {
      if (bodies_.touched[k]) return;
      put(V(bodies_.v(k) + (bodies_.accelerations[k] - before[k]) * (h / 2)), bodies_.motion[k].linear);
    });
    torque_integration_.correct(bodies_, t + h, h);
  }

  void look_for_impacts(ContactStep<Real>& step, const Real& t) {
    using std::sqrt;
    step.may_strike = may_strike_soon_ && may_strike(step.h, Real(0.2), Real(0));
    if (!step.may_strike) return;
    Real pull = squared(bodies_.gravity);
    for (const V& acceleration : bodies_.accelerations) pull = std::max(pull, squared(acceleration));
    step.greatest_acceleration = sqrt(pull);
    bodies_.impacts.assign(bodies_.size(), 0);
    statistics.impacts += impacts_.make(world_, list_, contacts_, bodies_, step, options_.step, t, log);
  }
  /// Without restitution only what moves by half a radius in a substep strikes; most worlds at most times have
  /// neither. That is when two of a fifth meet, and gravity adds to it. With a tenth, and what a step's gravity adds,
  /// no impact is to be expected within the step: without restitution nothing makes a body faster than the fastest.
  bool may_strike(const Real& h, const Real& part_of_radius, const Real& gain) const {
    using std::abs;
    if (may_bounce_) return true;
    const Real part = part_of_radius / h;
    int fast = 0;
    for (std::size_t k = 0; k < bodies_.size(); ++k) {
      const Real slow = part * bodies_.radius(k) - gain;
      fast |= static_cast<int>(squared(bodies_.v(k)) > slow * abs(slow));
    }
    return fast != 0;
  }

  World<Real, Dim>& world_;
  FastOptions<Real> options_;
  ThreadTeam team_;
  SolverBodies<Real, Dim> bodies_;
  PairList<Real, Dim> list_;
  ContactList<Real, Dim> contacts_;
  Impacts<Real, Dim> impacts_;
  TorqueIntegration<Real, Dim> torque_integration_;
  TouchLog<Real, Dim> touches_;
  bool is_restored_ = false;  // the impulses of the last step have been kept already
  bool has_other_forces_ = false, may_bounce_ = false;
  bool may_strike_soon_ = false;  // something is so fast that impacts are looked for in every substep
  Real friction_ = Real(0);
  std::vector<std::uint32_t> place_before_;
  std::vector<V> x_, v_, force_;
  std::vector<Real> inverse_mass_;
  Sleep<Real, Dim> sleep_;
  bool is_other_at_rest_ = false;  // than when pairs were listed
};

}  // namespace continuo
