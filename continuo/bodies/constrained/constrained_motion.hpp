// continuo/bodies/constrained/constrained_motion.hpp
// The exact motion under forces of any kind: a state machine (motion_states.hpp) with a function for each state. It
// integrates the motion from contact to contact, or, where there are too many contacts, takes time steps through them.
#pragma once
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <continuo/bodies/constrained/constrained_contacts.hpp>
#include <continuo/bodies/constrained/constrained_events.hpp>
#include <continuo/bodies/constrained/constrained_system.hpp>
#include <continuo/bodies/constrained/contact_steps.hpp>
#include <continuo/bodies/constrained/motion_states.hpp>
#include <continuo/bodies/constrained/near_pairs.hpp>
#include <continuo/bodies/constrained/zeno_guard.hpp>
#include <continuo/bodies/contacts/collision_time.hpp>
#include <continuo/bodies/contacts/contact_time.hpp>
#include <continuo/bodies/contacts/touching.hpp>
#include <continuo/bodies/event_driven/exact_engine.hpp>
#include <continuo/methods/explicit_rk/dop853.hpp>
#include <continuo/methods/explicit_rk/rk4.hpp>
#include <continuo/solve/integrator.hpp>

namespace continuo {

namespace detail {

template <class Real, int Dim>
class ConstrainedMotion final : public ContactEngine<Real, Dim> {
 public:
  using V = Vector<Real, Dim>;
  using S = Spin<Real, Dim>;
  using X = std::vector<Real>;
  using Flow = ConstrainedSystem<Real, Dim>;
  using ContactEngine<Real, Dim>::contacts, ContactEngine<Real, Dim>::statistics, ContactEngine<Real, Dim>::together;

  ConstrainedMotion(World<Real, Dim>& world, const ExactOptions<Real>& options, Companions<Real, Dim>* companions)
      : ConstrainedMotion(world, options, companions, usual_contact_time_under_forces(world, companions)) {}

  /// Runs the state machine until the call ends, from the state in which the last call left the motion.
  Status advance_to(const Real& t) override {
    if (contact_state_.last.size() != world_.size()) return other_bodies();
    resolved_.reset();  // a motion restored from a snapshot has none
    Call call{.until = t};
    for (MotionState state = first_state(t); state != MotionState::ended;) state = next_state(state, act(state, call));
    return std::move(call.status);
  }

  std::unique_ptr<ContactEngine<Real, Dim>> clone() const override {
    return std::make_unique<ConstrainedMotion>(*this);
  }
  void keep_within(const Real& room) override {
    room_ = room;
    begin_ = world_.position;
  }
  bool is_steady() const override { return is_steady_; }
  void set_numbers(std::span<const std::uint32_t> numbers) override {
    contact_state_.numbers.assign(numbers.begin(), numbers.end());
  }
  void let_go(const std::vector<bool>& leaves) override {
    std::vector<Touching> stay;
    for (const auto& one : contact_state_.lasting)
      if (!leaves[one.pair.a] && !leaves[one.pair.b]) stay.push_back(one.pair);
    contact_state_.note_lasting(stay, journal());
  }
  void take_over(const ContactEngine<Real, Dim>& other, std::span<const std::uint32_t> to) override {
    const auto& from = static_cast<const ConstrainedMotion&>(other);
    for (std::size_t i = 0; i < to.size(); ++i)
      if (to[i] != this->nowhere) together[to[i]] = from.together[i];
    contact_state_.take_over(from.contact_state_, to);
    steps_.take_over(from.steps_, to);
    if (from.world_.size() <= greatest_before_) return;  // the step sizes are those of the largest island
    greatest_before_ = from.world_.size();
    step_ = from.step_, lasted_ = from.lasted_, zeno_guard_ = from.zeno_guard_;
  }

  void save(ByteWriter& writer) override { transfer(writer); }
  void load(ByteReader& reader) override {
    transfer(reader);
    reader.expect(steps_.is_of(world_), "contacts of other bodies");
    reader.expect(zeno_guard_.is_possible(), "steps that cannot be");
    reader.expect(contact_state_.contact_time >= Real(0) && stride_ >= Real(0) && stride_ < never &&
                      lasted_ >= Real(0) && step_ >= Real(0) && step_ < never &&
                      contact_state_.last.size() == world_.size() && together.size() == world_.size(),
                  "a motion of other bodies");
    const auto& lasting = contact_state_.lasting;
    for (const auto& one : lasting) reader.expect(one.pair.is_of(world_), "contacts of other bodies");
    reader.expect(std::ranges::is_sorted(lasting, {}, &LastingContact<Real>::pair), "contacts out of order");
  }

 private:
  static constexpr Real never = std::numeric_limits<Real>::infinity();
  static constexpr Real steps_of_contact_time = 100;  // a thousandth of the time in which a body falls its radius

  struct Call {
    Real until{};
    std::size_t events = 0;
    Status status{};
  };

  ConstrainedMotion(World<Real, Dim>& world, const ExactOptions<Real>& options, Companions<Real, Dim>* companions,
                    const Real& usual)
      : ContactEngine<Real, Dim>(options),
        world_(world),
        companions_(companions),
        options_(options),
        contact_state_(world, options.contact_time.value_or(usual)),
        stride_(std::max(contact_state_.contact_time, Real(steps_of_contact_time * usual))) {
    together.assign(world.size(), -never);
    deepest_at_start_ = deepest_overlap(pairs_within(world, Real(0)));
  }
  static Real usual_contact_time_under_forces(const World<Real, Dim>& world, const Companions<Real, Dim>* companions) {
    using std::sqrt;
    Real smallest = never;
    Flow flow(world, companions);
    const Real pull = greatest_acceleration(world, flow.loads(world.time).first);
    for (const Real& radius : world.radius) smallest = std::min(smallest, radius);
    const Real by_force = pull > Real(0) && pull < never ? Real(1e-5) * sqrt(2 * smallest / pull) : Real(0);
    return std::max(by_force, usual_contact_time(world));
  }
  /// The contents of a snapshot, in this order.
  template <class Archive>
  void transfer(Archive& archive) {
    ConstrainedContacts<Real, Dim>& at = contact_state_;
    archive(at.contact_time), archive(stride_), archive(at.left_by_steps), archive(step_), archive(lasted_),
        archive(at.last), archive(at.lasting);
    archive(together), archive(zeno_guard_), archive(steps_), archive(is_slow_), archive(is_steady_);
  }
  ContactJournal<Real, Dim> journal() { return {statistics, contacts, together}; }

  // The states.

  MotionState first_state(const Real& t) const {
    if (!(world_.time < t)) return MotionState::ended;
    if (is_steady_) return MotionState::at_rest;
    return zeno_guard_.is_in_steps() ? MotionState::contact_steps : MotionState::impacts;
  }
  MotionEvent act(MotionState state, Call& call) {
    switch (state) {
      case MotionState::impacts:
        return impacts(call);
      case MotionState::free_flight:
        return free_flight(call);
      case MotionState::persistent_contact:
        return persistent_contact(call);
      case MotionState::contact_steps:
        return contact_steps(call);
      case MotionState::at_rest:
        return at_rest(call);
      case MotionState::ended:
        break;
    }
    return MotionEvent::failed;
  }
  static MotionEvent fail(Call& call, Status status) {
    call.status = std::move(status);
    return MotionEvent::failed;
  }
  /// Whether the call ends before its time. Tested between flights and between steps.
  std::optional<MotionEvent> stops(Call& call) const {
    if (++call.events > options_.most_events) return fail(call, too_many_events());
    if (options_.is_interrupted()) return fail(call, interrupted());
    if (farthest_way(world_, begin_) > room_ / 2) return MotionEvent::left_room;
    return {};
  }

  /// Resolves the collisions of the present instant, unless the last flight has done so, and lists the pairs that may
  /// begin to touch from here on.
  MotionEvent impacts(Call& call) {
    if (const auto stop = stops(call)) return *stop;
    list_candidates();
    if (const Real depth = deepest_overlap(near_now()); has_sunk(depth)) return fail(call, sunk(depth));
    if (!resolved_) resolved_ = resolve();
    if (!contact_state_.fault) return fail(call, contact_state_.fault);
    if (!resolved_->is_found() && may_step()) {
      resolved_.reset();
      zeno_guard_.go_by_steps();
      return MotionEvent::none_consistent;
    }
    const PersistentContacts<Real, Dim>& held = *resolved_;
    contact_state_.note_lasting(held, journal());
    for (Candidate<Real>& at : candidates_) watch(at);
    for (std::size_t k = 0; k < held.size(); ++k)
      std::ranges::lower_bound(candidates_, held[k], {}, &Candidate<Real>::pair)->watched =
          Candidate<Real>::Watched::nothing;
    return held.size() == 0 ? MotionEvent::no_contact : MotionEvent::contacts_press;
  }
  MotionEvent free_flight(Call& call) { return follow(call, flow_from_here()); }
  MotionEvent persistent_contact(Call& call) {
    Flow flow = flow_from_here();
    is_steady_ = rests(flow);
    return is_steady_ ? MotionEvent::nothing_moves : follow(call, std::move(flow));
  }
  /// A time step of the length `stride_`, or to the next impact or the end of the call where these are nearer.
  MotionEvent contact_steps(Call& call) {
    if (const auto stop = stops(call)) return *stop;
    resolved_.reset();
    zeno_guard_.has_stepped();
    Flow flow(world_, companions_);
    const auto [force, torque] = flow.loads(world_.time);
    const Real pull = greatest_acceleration(world_, force);
    contact_state_.allowance = pull * stride_ * stride_ / 2;
    contact_state_.left_by_steps = pull * stride_ * stride_;
    near_.renew(world_, stride_, pull);
    const std::vector<Touching> bouncing = contact_state_.bounce(near_.pairs(), 2 * pull * stride_, journal());
    if (!contact_state_.fault) return fail(call, contact_state_.fault);
    const Real left = call.until - world_.time;
    const Real h = time_to_bounce(bouncing, force, std::min(stride_, left));
    steps_.advance(world_, near_.pairs(), {force, torque, pull, pull * stride_}, h);
    world_.time = h >= left ? call.until : world_.time + h;
    note_pushed(h);
    const bool was_slow = is_slow_;
    is_slow_ = is_autonomous() && steps_.fastest() <= pull * contact_state_.contact_time / 16 &&
               steps_.greatest_change() <= Real(1e-5) * pull * h;
    is_steady_ = was_slow && is_slow_;
    lasted_ = h;
    if (!(steps_.fastest() < never))
      return fail(call, cannot_continue(
                            "a body's motion is no longer finite: a speed or a force is too large for the numbers"));
    if (const Real depth = deepest_overlap(near_.pairs()); has_sunk(depth)) return fail(call, sunk(depth));
    if (!steps_.are_found()) return fail(call, contact_state_.not_found(steps_.near()));
    if (!(world_.time < call.until)) return MotionEvent::time_reached;
    if (is_steady_) return MotionEvent::nothing_moves;
    return zeno_guard_.is_in_steps() ? MotionEvent::stepped : MotionEvent::steps_made;
  }
  /// Only rotation goes on: the contact forces are the same to the end of the call.
  MotionEvent at_rest(Call& call) {
    if (const auto stop = stops(call)) return *stop;
    if (room_ < never) return MotionEvent::left_room;
    const Real duration = call.until - world_.time;
    for (std::size_t i = 0; i < world_.size(); ++i) {
      if (world_.is_fixed(i)) continue;
      world_.velocity[i] = {};
      if (world_.spin[i] != S{}) world_.orientation[i] = turned(world_.orientation[i], world_.spin[i], duration);
    }
    for (auto& one : contact_state_.lasting) one.impulse += one.press * duration;
    contact_state_.note_together(call.until, journal());
    world_.time = call.until;
    return MotionEvent::time_reached;
  }

  // Instants and flights.

  void list_candidates() {
    using std::sqrt;
    Real fastest(0);
    for (const V& v : world_.velocity) fastest = std::max(fastest, squared(v));
    std::vector<Real> radii = world_.radius;
    std::ranges::nth_element(radii, radii.begin() + static_cast<std::ptrdiff_t>(radii.size() / 2));
    median_radius_ = radii.empty() ? Real(1) : radii[radii.size() / 2];
    reach_ = std::min(std::max(median_radius_, Real(4 * sqrt(fastest) * step_)), Real(room_ / 2));
    candidates_.clear();
    for (const Touching& pair : pairs_within(world_, reach_)) candidates_.push_back({.pair = pair});
  }
  /// Chooses the guard of a candidate. Two bodies that overlap by more than half of the allowance may sink deeper by
  /// half of it.
  void watch(Candidate<Real>& at) const {
    const Real gap = gap_of(world_, at.pair), allowance = contact_state_.allowance;
    const bool overlap = gap < -allowance / 2,
               part = approach_of(world_, at.pair) < -contact_state_.pull() * contact_state_.contact_time;
    at.watched = overlap && part ? Candidate<Real>::Watched::approach : Candidate<Real>::Watched::gap;
    at.lowest = overlap ? gap - allowance / 2 : -allowance;
  }
  PersistentContacts<Real, Dim> resolve() {
    Flow flow(world_, companions_);
    const auto [force, torque] = flow.loads(world_.time);
    const Real slow = 2 * greatest_acceleration(world_, force) * stride_;
    met_fast_ = std::ranges::any_of(candidates_, [&](const Candidate<Real>& at) {
      return contact_state_.touches(at.pair) && contact_state_.approaches(at.pair, slow);
    });
    return contact_state_.resolve(near_now(), force, torque, journal());
  }
  std::vector<Touching> near_now() const {
    std::vector<Touching> near;
    for (const Candidate<Real>& at : candidates_) near.push_back(at.pair);
    return near;
  }
  Flow flow_from_here() { return {world_, companions_, *std::exchange(resolved_, std::nullopt)}; }

  MotionEvent follow(Call& call, Flow flow) {
    const Real least = 64 * std::numeric_limits<Real>::epsilon(), tolerance = std::max(options_.tolerance, least);
    Options<X> how{.rtol = tolerance, .atol = tolerance * median_radius_};
    how.max_steps = options_.most_events;
    how.interrupt = options_.interrupt;
    const std::size_t bodies = flow.size_of_bodies(), all = flow.pack().size();
    if (all > bodies) {  // impulses of contacts need no error control
      how.rtol_each.assign(all, how.rtol);
      how.atol_each.assign(all, companions_ ? companions_->absolute_tolerance : how.atol);
      std::fill_n(how.atol_each.begin(), bodies, how.atol);
      std::fill_n(how.atol_each.begin() + static_cast<std::ptrdiff_t>(bodies), flow.held().size(), Real(1e30));
    }
    if (options_.step > Real(0)) {
      how.step = options_.step;
      return follow_by(Rk4{}, call, std::move(flow), how);
    }
    // Where contacts keep flights short, a first step many times as long would contain many more contacts to locate.
    how.first_step =
        std::min({step_, std::max(Real(16 * lasted_), Real(1e-3 * step_)), Real(call.until - world_.time)});
    return follow_by(Dop853{}, call, std::move(flow), how);
  }
  template <class Method>
  MotionEvent follow_by(Method method, Call& call, Flow flow, const Options<X>& how) {
    X start = flow.pack();
    ConstrainedEvents<Real, Dim> events(world_, candidates_, reach_, flow.held().size());
    Integrator integrator(std::move(flow), std::move(start), Interval<Real>{world_.time, call.until}, method, how,
                          std::move(events));
    // The next flight begins with the step size that error control proposed last: an impact changes the state abruptly,
    // but not the forces, which determine the step size.
    int steps = 0;
    const auto is_stuck = [&] {  // the direction of a slow slip turns so fast that steps are very short
      return ++steps >= 16 && integrator.system().held().rub() &&
             integrator.t() - world_.time < static_cast<Real>(steps) * stride_ / 8;
    };
    bool is_too_short = false;
    while (!is_too_short && integrator.advance()) {
      step_ = integrator.step_size();
      is_too_short = may_step() && is_stuck();
    }
    const bool is_before_end = integrator.t() < call.until;
    if (is_before_end) step_ = integrator.step_size();
    lasted_ = integrator.t() - world_.time;
    if (may_step() && integrator.outcome().ending == Ending::step_too_small) is_too_short = true;
    if (!is_too_short && !succeeded(integrator.outcome().ending))
      return fail(call, cannot_continue("the path cannot be followed beyond t = " + std::to_string(integrator.t()) +
                                        ": " + std::string(to_string(integrator.outcome().ending))));
    land(integrator.system(), integrator.x(), integrator.t());
    if (is_too_short) {
      zeno_guard_.go_by_steps();
    } else if (is_before_end && may_step() && !(met_fast_ && lasted_ < stride_)) {
      zeno_guard_.has_flown(lasted_, stride_);
    }
    if (!contact_state_.fault) return fail(call, contact_state_.fault);
    if (!(world_.time < call.until)) return MotionEvent::time_reached;
    return zeno_guard_.is_in_steps() ? MotionEvent::too_many_events : MotionEvent::contact_changes;
  }
  /// Writes the end of a flight into the world and resolves the collisions of that instant.
  void land(const Flow& flow, const X& state, const Real& t) {
    auto& lasting = contact_state_.lasting;
    for (std::size_t k = 0; k < lasting.size(); ++k) lasting[k].impulse += flow.impulse(state, k);
    flow.store(state, world_, companions_, lasted_);
    world_.time = t;
    contact_state_.note_together(world_.time, journal());
    resolved_ = resolve();
  }
  /// Whether all bodies are at rest and, under the forces of persistent contacts, stay so, to rounding.
  bool rests(Flow& flow) {
    const Real pull = contact_state_.pull(), least = Real(1e-3) * pull * contact_state_.contact_time;
    const auto moves = [&](const V& v) { return length(v) > least; };
    if (!is_autonomous() || flow.held().size() == 0 || std::ranges::any_of(world_.velocity, moves)) return false;
    const X state = flow.pack();
    X rate(state.size());
    flow(world_.time, state, rate);
    const std::size_t n = world_.size(), bodies = flow.size_of_bodies();
    const auto begins = [&](std::size_t first, std::size_t last, const Real& most) {
      return std::any_of(rate.begin() + static_cast<std::ptrdiff_t>(first),
                         rate.begin() + static_cast<std::ptrdiff_t>(last),
                         [&](const Real& value) { return std::abs(value) > most; });
    };
    const Real widest = std::ranges::max(world_.radius);
    if (begins(n * V::size(), 2 * n * V::size(), Real(1e-8) * pull)) return false;
    if (bodies > 2 * n * V::size() && begins(bodies - n * S::size(), bodies, Real(1e-8) * pull / widest)) return false;
    auto& lasting = contact_state_.lasting;
    for (std::size_t k = 0; k < lasting.size(); ++k) lasting[k].press = flow.held().press(k);
    return true;
  }
  /// Whether forces depend on positions and velocities only.
  bool is_autonomous() const { return !companions_ && world_.force_laws.empty() && world_.torque_laws.empty(); }

  // Overlap.

  /// The deepest overlap among these pairs beyond what contacts may have, in units of the smaller radius.
  Real deepest_overlap(std::span<const Touching> pairs) const {
    Real deepest(0);
    for (const Touching& at : pairs) {
      const Real smaller = at.with_wall() ? world_.radius[at.a] : std::min(world_.radius[at.a], world_.radius[at.b]);
      deepest = std::max(deepest, Real((-gap_of(world_, at) - 4 * contact_state_.allowance) / smaller));
    }
    return deepest;
  }
  /// Contacts are kept to some millionths of a radius, in large heaps to a ten-thousandth. A deeper overlap than this
  /// one shows that their impulses were not found, and that what follows would be wrong. Bodies that began in each
  /// other may have stayed there.
  /// Single precision is not judged: there an island has been seen to find overlaps that the world does not have.
  bool has_sunk(const Real& depth) const {
    constexpr Real most = Real(1e-3);
    constexpr bool is_judged = std::numeric_limits<Real>::digits >= std::numeric_limits<double>::digits;
    return is_judged && depth > std::max(most, Real(2 * deepest_at_start_));
  }
  static Status sunk(const Real& depth) {
    return cannot_continue("bodies sink into each other, by " + std::to_string(depth) +
                           " of a radius: the impulses of their contacts cannot be found");
  }

  // Steps through contacts.

  /// Whether time steps of first order may be used: not where equations are integrated with the bodies, and not where
  /// the user has chosen the step.
  bool may_step() const {
    return stride_ > Real(0) && !(options_.step > Real(0)) && (!companions_ || companions_->state.empty());
  }
  /// The time to the next of these impacts, at most `most`.
  Real time_to_bounce(std::span<const Touching> bouncing, std::span<const V> force, const Real& most) const {
    Real h = most;
    for (const Touching& at : bouncing) {
      const V rate =
          force[at.a] * world_.inverse_mass[at.a] - (at.with_wall() ? V{} : force[at.b] * world_.inverse_mass[at.b]);
      h = std::min(h, time_to_close(gap_of(world_, at), Real(-approach_of(world_, at)),
                                    Real(-dot(rate, normal_of(world_, at)))));
    }
    return h;
  }
  void note_pushed(const Real& h) {
    std::vector<Touching> pairs;
    for (const auto& one : steps_.pushed()) pairs.push_back(one.pair);
    contact_state_.note_lasting(pairs, journal());
    auto& lasting = contact_state_.lasting;
    for (std::size_t k = 0; k < lasting.size(); ++k) {
      lasting[k].press = steps_.pushed()[k].force.press;
      lasting[k].impulse += lasting[k].press * h;
    }
  }

  World<Real, Dim>& world_;
  Companions<Real, Dim>* companions_;
  ExactOptions<Real> options_;
  ConstrainedContacts<Real, Dim> contact_state_;

  Real step_{}, lasted_ = never;     // step size proposed in the last flight; duration of that flight
  Real deepest_at_start_{};          // overlap, in units of the smaller radius
  Real stride_{};                    // the length of time steps through contacts
  std::size_t greatest_before_ = 0;  // bodies of the island whose step sizes were taken over
  Real room_ = never;                // a call ends where a body is half as far from begin_
  std::vector<V> begin_;
  Real median_radius_{}, reach_{};                         // reach_: a body's way until candidates are listed again
  std::vector<Candidate<Real>> candidates_;                // sorted
  std::optional<PersistentContacts<Real, Dim>> resolved_;  // after the impacts of the present instant
  ZenoGuard zeno_guard_;
  ContactSteps<Real, Dim> steps_;
  bool met_fast_ = false;  // at the last instant bodies met faster than forces would bring them together in two steps
  bool is_slow_ = false, is_steady_ = false;  // is_slow_: in the last step; is_steady_: at rest for good
  NearPairs<Real, Dim> near_;                 // for time steps
};

}  // namespace detail

template <class Real, int Dim>
std::unique_ptr<ContactEngine<Real, Dim>> constrained_motion(World<Real, Dim>& world, const ExactOptions<Real>& options,
                                                             Companions<Real, Dim>* companions) {
  return std::make_unique<detail::ConstrainedMotion<Real, Dim>>(world, options, companions);
}

}  // namespace continuo
