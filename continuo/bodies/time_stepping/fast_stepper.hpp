// A step of the fast motion, from the world to the world.
#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include <continuo/bodies/fast_motion.hpp>
#include <continuo/bodies/support/crowd.hpp>
#include <continuo/bodies/support/thread_team.hpp>
#include <continuo/bodies/time_stepping/body_transfer.hpp>
#include <continuo/bodies/time_stepping/contact_passes.hpp>
#include <continuo/bodies/time_stepping/fast_options_check.hpp>
#include <continuo/bodies/time_stepping/force_integration.hpp>
#include <continuo/bodies/time_stepping/impacts.hpp>
#include <continuo/bodies/time_stepping/sleep.hpp>
#include <continuo/bodies/time_stepping/step_time.hpp>
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

  /// Where the bodies make no sense, the next step says so.
  void renew() {
    is_stale_ = true;
    if (!check(options_, world_)) return;
    team_.run([&] { refresh(); });
  }
  void refresh() {
    is_stale_ = false;
    ignored_ = world_.ignored_groups();
    list_ = {};
    contacts_ = {};
    sleep_ = {};
    list_.begin(world_);
    load();
    make_list();
  }

  /// Of the same step, substeps, integrator, threads and records.
  void set_options(const FastOptions<Real>& options) { options_ = options; }
  [[nodiscard]] Status advance() {
    Status status;
    team_.run([&] { status = step(); });
    return status;
  }

  [[nodiscard]] Real deepest_overlap() const { return contacts_.deepest_overlap(bodies_, world_.walls()); }

  /// Saves the state that outlasts a step and is not in the world. The list of pairs is not saved but made again, from
  /// the positions at which it was made.
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
    if (contacts.has_resting()) contacts.exchange_with_resting(list_.order(), [](std::uint32_t) { return true; });
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
    exchange_with_resting();
    is_other_at_rest_ = is_other_at_rest;
    is_restored_ = true;
  }

  [[nodiscard]] std::size_t memory() const {
    return bodies_.memory() + list_.memory() + contacts_.memory() + place_before_.capacity() * sizeof(std::uint32_t) +
           forces_.memory() + sleep_.memory();
  }

  FastStatistics statistics{};
  ContactLog<Real, Dim> log;

 private:
  /// The stages of a step.
  [[nodiscard]] Status step() {
    if (Status status = check(options_, world_); !status) return status;
    wake_changed();
    if (!is_other_at_rest_ && sleep_.is_all_asleep()) return rest();
    load();
    list_pairs();
    if (Status status = check_crowd(contacts_.rows.entries.size(), bodies_.size()); !status) return status;
    choose_contacts();
    if (!integrate())
      return {.ending = Ending::nonlinear_solve_failed,
              .message = "the equations of implicit Euler could not be solved: a smaller step may help"};
    if (!bodies_.all_finite())
      return {.ending = Ending::not_finite,
              .message = "a body's motion is no longer finite: a force or a mass is too large for the step"};
    store_bodies(team_, bodies_, list_.order(), torques_, options_.step, world_);
    world_.time = time_after_step(world_.time, options_.step);
    note_contacts();
    put_to_sleep();
    count();
    return {};
  }

  /// Bodies that the caller has changed wake.
  void wake_changed() {
    if (is_stale_ || world_.size() != bodies_.size() || world_.walls().size() != list_.walls()) refresh();
    is_other_at_rest_ |= sleep_.wake_changed(world_);
    if (ignored_ == world_.ignored_groups()) return;
    // Some pairs are none any more, and what lay on another body may fall.
    ignored_ = world_.ignored_groups();
    sleep_.wake_all();
    is_other_at_rest_ = true;
  }
  /// A step while all bodies sleep.
  [[nodiscard]] Status rest() {
    log.clear();
    world_.time = time_after_step(world_.time, options_.step);
    note_contacts();
    count();
    return {};
  }
  void load() { load_bodies(team_, world_, list_.order(), list_.blocks(), sleep_, bodies_); }

  /// Lists the pairs that may touch within some steps, if bodies have moved too far since the last list, or other
  /// bodies sleep than then. Wakes the bodies that an awake body may touch.
  void list_pairs() {
    bool is_kept = std::exchange(is_restored_, false);
    const auto list_anew = [&] {
      if (!std::exchange(is_kept, true)) contacts_.keep(team_);
      exchange_with_resting();
      make_list();
    };
    if (is_other_at_rest_ || list_.is_outdated(bodies_, options_.step)) list_anew();
    while (sleep_.wake_near(bodies_, contacts_.rows, list_.order(), options_.step, options_.sleep_speed)) list_anew();
  }
  void exchange_with_resting() {
    if (sleep_.asleep() == 0 && !contacts_.has_resting()) return;
    std::vector<std::uint32_t> number_at = list_.order();
    for (std::size_t k = 0; k < place_before_.size(); ++k) number_at[place_before_[k]] = list_.order()[k];
    contacts_.exchange_with_resting(number_at,
                                    [this](std::uint32_t i) { return !sleep_.is_asleep(i) && !world_.is_fixed(i); });
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

  /// Chooses the pairs that may touch within this step, with their materials and the impulses of the last step.
  void choose_contacts() {
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
    place_before_ = {};  // not needed most of the time
  }
  template <class Is>
  [[nodiscard]] bool any_material(const Is& is) const {
    return std::ranges::any_of(world_.material, is) ||
           std::ranges::any_of(world_.walls(), is, &Wall<Real, Dim>::material);
  }

  [[nodiscard]] Real substep() const { return options_.step / static_cast<Real>(options_.substeps); }

  /// Integrates the substeps. False where the equations of an implicit method could not be solved.
  [[nodiscard]] bool integrate() {
    const Real h = substep();
    log.clear();
    forces_.begin(world_, list_.order());
    torques_.begin(world_, list_.order());
    const bool may_strike_soon = forces_.acts() || may_bounce_ ||
                                 may_strike(bodies_, h, Real(0.1), Real(length(world_.gravity) * options_.step));
    const IntegratorRule rule = rule_of(options_.integrator);
    const auto push_body = [&](std::uint32_t k) {
      put(V(bodies_.v(k) + bodies_.acceleration(k) * h), bodies_.motion[k].linear);
      bodies_.touched[k] = 0;
    };
    const Real lag = static_cast<Real>(rule.lag) * h, steady_lag = static_cast<Real>(rule.steady_lag) * h;
    const auto move_body = [&](std::uint32_t k) {
      V v = bodies_.v(k);
      if (!bodies_.touched[k]) v -= bodies_.acceleration(k) * (forces_.is_steady(bodies_, k) ? steady_lag : lag);
      put(V(bodies_.x(k) + v * h), bodies_.place[k].x_and_radius);
    };
    ContactPasses passes(team_, contacts_, bodies_);
    ContactStep<Real> step = contact_step(h);
    if (!forces_.acts() && !torques_.acts() && !may_strike_soon) {
      passes.push(step, push_body);
      for (int k = 1; k < options_.substeps; ++k) passes.relax_and_push(step, move_body, push_body);
      passes.relax(step, move_body);
      return true;
    }
    for (int k = 0; k < options_.substeps; ++k) {
      const Real now = world_.time + h * static_cast<Real>(k);
      if (!forces_.accelerate(bodies_, rule, now, h)) return false;
      if (may_strike_soon) make_impacts(step, now);
      torques_.push(bodies_, now, h);
      passes.push(step, push_body);
      torques_.turn(bodies_, rule, h);
      passes.relax(step, move_body);
      if (forces_.acts() && rule.correction != EndCorrection::none) {
        forces_.correct(bodies_, team_, rule, now + h, h);
        torques_.correct(bodies_, rule, now + h, h);
      }
    }
    return true;
  }
  [[nodiscard]] Real hertz_of(const Real& h) const { return std::min(options_.hertz, 1 / (3 * h)); }
  [[nodiscard]] ContactStep<Real> contact_step(const Real& h) const {
    // The threshold of a disturbance was found by measurement: it keeps the overlaps in a falling heap below a
    // hundredth of the radius.
    constexpr auto disturbance = static_cast<Real>(0.0011);
    return {.h = h,
            .soft = over_relaxed(softness(hertz_of(h), options_.damping, h)),
            .fastest_push = options_.fastest_push / over_relaxation<Real>,
            .friction = friction_,
            .disturbance = disturbance * list_.median_radius(),
            .disturbance_of_radius = disturbance};
  }
  void make_impacts(ContactStep<Real>& step, const Real& now) {
    step.may_strike = may_bounce_ || may_strike(bodies_, step.h, Real(0.2), Real(0));
    if (step.may_strike)
      statistics.impacts += impacts_.make(world_, list_, contacts_, bodies_, step, options_.step, now, log);
  }

  void note_contacts() {
    if (!log.is_kept()) return;
    note_touching(world_, bodies_, list_.order(), contacts_, options_.substeps, touches_);
    touches_.end_step(world_.time, log);
  }
  void put_to_sleep() {
    if (options_.sleep_after > Real(0))
      is_other_at_rest_ = sleep_.settle(world_, bodies_, contacts_, list_.order(), options_.step, substep(),
                                        options_.sleep_after, options_.sleep_speed);
  }
  void count() {
    ++statistics.steps;
    statistics.hertz = static_cast<double>(hertz_of(options_.step / static_cast<Real>(options_.substeps)));
    statistics.asleep = sleep_.asleep();
    statistics.lists = list_.lists();
    statistics.contacts = contacts_.active();
    statistics.colours = contacts_.between_movers.colours;
  }

  World<Real, Dim>& world_;
  FastOptions<Real> options_;
  ThreadTeam team_;
  SolverBodies<Real, Dim> bodies_;
  BroadPhase<Real, Dim> list_;
  ContactList<Real, Dim> contacts_;
  Impacts<Real, Dim> impacts_;
  ForceIntegration<Real, Dim> forces_;
  TorqueIntegration<Real, Dim> torques_;
  TouchLog<Real, Dim> touches_;
  bool is_restored_ = false;  // the impulses of the last step have been kept already
  bool is_stale_ = true;      // the world is to be loaded anew
  bool may_bounce_ = false;
  Real friction_ = Real(0);                  // of most contacts
  std::vector<std::uint32_t> place_before_;  // of each body in the last list, until contacts have its impulses
  Sleep<Real, Dim> sleep_;
  bool is_other_at_rest_ = false;            // other bodies sleep than when pairs were listed
  std::array<std::uint32_t, 32> ignored_{};  // groups, when pairs were listed
};

}  // namespace continuo
