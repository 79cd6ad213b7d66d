// The exact motion of bodies of any shape and of joints, from contact to contact.
//
// Bodies that joints, lasting contacts or forces connect fly together (rigid_flight.hpp), each group with steps of its
// own. A queue has what happens next: the end of a step, a change of a contact within one, the meeting of two parts, or
// the time at which the list of pairs that may meet is no longer sure. What meets is resolved (contact_instant.hpp)
// together with all that touches it, and flies on in new groups.
#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <numeric>
#include <queue>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <continuo/bodies/contacts/contact_time.hpp>
#include <continuo/bodies/event_driven/exact_engine.hpp>
#include <continuo/bodies/exact_rigid/contact_guards.hpp>
#include <continuo/bodies/exact_rigid/contact_instant.hpp>
#include <continuo/bodies/exact_rigid/lasting_journal.hpp>
#include <continuo/bodies/exact_rigid/limit_search.hpp>
#include <continuo/bodies/exact_rigid/motor_jumps.hpp>
#include <continuo/bodies/exact_rigid/near_parts.hpp>
#include <continuo/bodies/exact_rigid/rigid_flight.hpp>
#include <continuo/bodies/exact_rigid/safe_time.hpp>

namespace continuo {

namespace detail {

template <class Real, int Dim>
class RigidMotion final : public ExactEngine<Real, Dim> {
 public:
  using V = Vector<Real, Dim>;
  using S = Spin<Real, Dim>;
  using X = std::vector<Real>;
  using Body = ExactBody<Real, Dim>;
  using Flight = RigidFlight<Real, Dim>;
  using System = RigidSystem<Real, Dim>;
  using Part = ExactPart<Real, Dim>;
  using ExactEngine<Real, Dim>::contacts, ExactEngine<Real, Dim>::statistics;

  RigidMotion(World<Real, Dim>& world, const ExactOptions<Real>& options)
      : ExactEngine<Real, Dim>(options), world_(world), options_(options) {}

  Status advance_to(const Real& t) override {
    if (Status fault = check_world(); !fault) return fault;
    while (world_.time < t) {
      // Where a motor jumps to another speed, a flight ends, and the next one begins at the next number.
      const auto jump = first_jump<Real>(options_.motors, world_.time, t);
      if (Status fault = fly_to(jump ? jump->before : t); !fault) return fault;
      if (jump) world_.time = jump->after;
    }
    return {};
  }
  void save(ByteWriter& writer) override { transfer(writer); }
  void load(ByteReader& reader) override {
    transfer(reader);
    reader.expect(step_ >= Real(0) && step_ < never, "a step that cannot be");
    near_.begin(world_, {}, {});
    reader.expect(lasting_.fits(near_.parts().size(), world_.walls().size()), "contacts of other bodies");
  }

 private:
  static constexpr Real never = std::numeric_limits<Real>::infinity();
  static constexpr Real rounding = std::numeric_limits<Real>::epsilon();
  enum class What : std::uint8_t { step_ends, contact_changes, parts_near, parts_meet, list_ends };
  struct Next {
    Real t{};
    What what = What::step_ends;
    std::uint32_t index = 0;                 // of a group or a pair
    std::uint64_t stamp_a = 0, stamp_b = 0;  // of the bodies when it was foreseen
    Real level{};                            // of parts: the gap at which they meet
    friend bool operator<(const Next& one, const Next& other) { return one.t > other.t; }  // the earliest on top
  };
  struct Group {
    std::unique_ptr<Flight> flight;
    ContactGuards<Real, Dim> guards{Real(0), Real(0), Real(1), Real(1)};
    std::vector<NearPair> watched;     // pairs in contact, sorted
    std::vector<NearPair> of_contact;  // the pair of each contact of the system
    Real change = never;               // of a contact, in the present step
  };
  static constexpr std::uint32_t nowhere = std::numeric_limits<std::uint32_t>::max();

  /// A body that turned freely when the last call ended: its spin alone would give its momentum to rounding only, which
  /// would add up over many calls.
  struct Kept {
    Orientation<Real, Dim> orientation{};
    S spin{}, momentum{};
    Real energy{};
    bool has_energy = false;
    template <class Archive>
    void transfer(Archive& archive) {
      archive(orientation), archive(spin), archive(momentum), archive(energy), archive(has_energy);
    }
  };

  // Begin and end of a call.

  [[nodiscard]] Status fly_to(const Real& t) {
    if (!(world_.time < t)) return {};
    until_ = t, now_ = world_.time, events_ = 0;
    load();
    Status status = begin();
    while (status && !queue_.empty() && queue_.top().t < until_) status = next();
    if (status) now_ = until_;
    store();
    return status;
  }
  [[nodiscard]] Status check_world() const {
    if (options_.step > Real(0))
      return invalid_input("steps of a fixed size exist in the exact motion of balls without joints only");
    for (std::size_t i = 0; i < world_.size(); ++i) {
      if (world_.material[i].rolling_resistance > Real(0))
        return invalid_input("rolling resistance exists only in worlds of balls without joints");
      const BodyTraits<Real> traits = world_.traits(i);
      if (traits.is_sensor) return invalid_input("the exact motion knows no sensors: use FastMotion");
    }
    for (const JointHandle handle : world_.joints()) {
      const Joint<Real, Dim>& joint = *world_.find(handle);
      if (joint.is_broken) continue;
      if (!world_.contains(joint.b) || (joint.a != BodyHandle{} && !world_.contains(joint.a)))
        return invalid_input("a joint connects a body that the world does not contain");
      if (Status fault = check_exactly_movable(joint); !fault) return fault;
    }
    for (const MotorLaw<Real>& law : options_.motors) {
      const Joint<Real, Dim>* const joint = world_.find(law.joint);
      if (!joint || !joint->motor || !law.speed)
        return invalid_input("a law of a motor is of a joint that has none: see ExactOptions::motors");
    }
    return check_motion(world_);
  }
  void load() {
    const std::size_t n = world_.size();
    bodies_.clear(), joints_.clear(), groups_.clear(), free_groups_.clear(), queue_ = {};
    for (std::size_t i = 0; i < n; ++i) bodies_.push_back(exact_body(world_, i));
    take_kept();
    bodies_.push_back({});  // the world itself
    begin_ = bodies_, began_ = world_.time;
    meetings_.assign(n, {world_.time, 0}), seen_.assign(n + 1, {}), stamp_.assign(n + 1, 0),
        group_of_.assign(n + 1, nowhere), place_in_group_.assign(n + 1, 0);
    is_whole_ = !world_.springs.empty() || world_.attraction.constant != Real(0) || world_.drag.linear != Real(0) ||
                world_.drag.quadratic != Real(0) || !world_.force_laws.empty() || !world_.torque_laws.empty();
    std::vector<ActingJoint<Real, Dim>> broken;
    for (const JointHandle handle : world_.joints()) {
      const Joint<Real, Dim>& joint = *world_.find(handle);
      if (joint.is_broken && (!world_.contains(joint.b) || !world_.contains(joint.a))) continue;
      ActingJoint<Real, Dim> acting{.handle = handle, .joint = joint, .a = number_of(joint.a), .b = number_of(joint.b)};
      if (bodies_[acting.a].is_fixed() && bodies_[acting.b].is_fixed()) continue;
      if (joint.motor) acting.motor = MotorMode::keeps_speed;
      acting.held = lasting_limit(joint);
      for (const MotorLaw<Real>& law : options_.motors)
        if (law.joint == handle) acting.law = &law;
      acting.follow_law(now_);
      (joint.is_broken ? broken : joints_).push_back(std::move(acting));
    }
    near_.begin(world_, joints_, broken);
    for (const auto& joint : broken) let_meet(joint);
    contact_time_ = options_.contact_time.value_or(usual_contact_time(world_));
  }
  void take_kept() {
    if (kept_.size() != world_.size()) return;
    for (std::size_t i = 0; i < kept_.size(); ++i) {
      const Kept& kept = kept_[i];
      if (kept.orientation != world_.orientation[i] || kept.spin != world_.spin[i] || bodies_[i].is_fixed()) continue;
      bodies_[i].momentum = kept.momentum, bodies_[i].spin = kept.spin;
      if (kept.has_energy) bodies_[i].energy = kept.energy;
    }
  }
  [[nodiscard]] std::uint32_t number_of(BodyHandle handle) const {
    return static_cast<std::uint32_t>(handle == BodyHandle{} ? world_.size() : world_.index(handle));
  }
  /// All that moves begins at once: what touches or is joined, in groups.
  [[nodiscard]] Status begin() {
    list_pairs();
    if (Status fault = near_.check_number(); !fault) return fault;
    if (Status fault = check_overlaps(); !fault) return fault;
    if (Status fault = check_limits(); !fault) return fault;
    std::vector<std::uint32_t> all;
    for (std::uint32_t i = 0; i < world_.size(); ++i)
      if (!bodies_[i].is_fixed()) all.push_back(i);
    if (Status fault = resolve(all); !fault) return fault;
    list_anew();
    return near_.check_number();
  }
  [[nodiscard]] Status check_overlaps() const {
    for (const NearPair& pair : near_.pairs()) {
      const auto [a, b] = parts_of(pair);
      const Real gap = separation_of(a, bodies_[a.body], b, bodies_[b.body]).gap;
      if (gap < -most_overlap * b.convex->reach)
        return invalid_input("two bodies overlap by " + std::to_string(-gap) +
                             " where the exact motion begins: place them apart, or move the world with FastMotion "
                             "until they are");
    }
    return {};
  }
  [[nodiscard]] Status check_limits() const {
    for (const auto& joint : joints_) {
      const Body &a = bodies_[joint.a], &b = bodies_[joint.b];
      std::vector<MotionRow<Real, Dim>> none;
      for (const LimitSide side : {LimitSide::lower, LimitSide::upper}) {
        if (!has_limit(joint.joint, side)) continue;
        const Real gap = JointConstraints<Real, Dim>(joint, a, b, none).limit(side).error;
        const bool is_angle = joint.joint.kind == JointKind::hinge;
        const Real size = is_angle ? Real(1) : std::max(reach_of(joint.a), reach_of(joint.b));
        if (gap < -most_overlap * size)
          return invalid_input("a joint is beyond its " + std::string(side == LimitSide::lower ? "lower" : "upper") +
                               " limit by " + std::to_string(-gap) +
                               " where the exact motion begins: place its bodies within its limits, or move the world "
                               "with FastMotion until they are");
      }
    }
    return {};
  }
  [[nodiscard]] Real reach_of(std::uint32_t i) const { return i < world_.size() ? world_.radius[i] : Real(0); }
  void store() {
    kept_.assign(world_.size(), {});
    for (std::uint32_t i = 0; i < world_.size(); ++i) {
      const Body body = body_at_end(i);
      world_.position[i] = body.x, world_.orientation[i] = body.orientation;
      if (body.is_fixed()) continue;
      world_.velocity[i] = body.v, world_.spin[i] = body.spin;
      kept_[i] = {body.orientation, body.spin, body.momentum, body.energy.value_or(Real(0)), body.energy.has_value()};
    }
    store_joints();
    for (auto& joint : joints_) {
      joint.follow_law(now_);
      if (joint.law) world_.find(joint.handle)->motor->speed = joint.joint.motor->speed;
    }
    for (const auto& group : groups_)
      if (group.flight) note_impulses(group);
    world_.time = now_;
  }
  void store_joints() {
    X state;
    for (auto& group : groups_) {
      if (!group.flight || group.flight->system().joints().empty()) continue;
      System& system = group.flight->system();
      group.flight->at(std::min(std::max(now_, group.flight->begin()), group.flight->end()), state);
      system.find_shortest_forces(now_, state);
      for (std::size_t j = 0; j < system.joints().size(); ++j) {
        const auto load = system.load_of(j);
        Joint<Real, Dim>& joint = *world_.find(system.joints()[j].handle);
        joint.force = load.force, joint.torque = load.torque, joint.motor_effort = load.motor;
      }
    }
  }
  template <class Archive>
  void transfer(Archive& archive) {
    archive(step_), archive(lasting_), archive(kept_);
  }

  // What happens next.

  [[nodiscard]] Status next() {
    const Next what = queue_.top();
    queue_.pop();
    if (is_outdated(what)) return {};
    now_ = std::max(now_, what.t);
    if (what.what == What::parts_near) return look(what.index, what.level), Status{};
    if (++events_ > options_.most_events) return too_many_events();
    if (options_.is_interrupted()) return interrupted();
    switch (what.what) {
      case What::step_ends:
        return take_steps({what.index});
      case What::contact_changes: {
        const std::vector<std::uint32_t> movers = movers_of(what.index);
        for (const std::uint32_t i : movers)
          if (Status fault = check_progress(i); !fault) return fault;
        return resolve_and_list(movers);
      }
      case What::parts_meet:
        return meet(near_.pairs()[what.index]);
      case What::list_ends:
        list_anew();
        return near_.check_number();
      case What::parts_near:
        break;
    }
    return {};
  }
  [[nodiscard]] bool is_outdated(const Next& what) const {
    switch (what.what) {
      case What::step_ends:
      case What::contact_changes:
        return !groups_[what.index].flight || stamp_[movers_of(what.index).front()] != what.stamp_a;
      case What::parts_near:
      case What::parts_meet: {
        const auto [a, b] = bodies_of(near_.pairs()[what.index]);
        return stamp_[a] != what.stamp_a || stamp_[b] != what.stamp_b;
      }
      case What::list_ends:
        break;
    }
    return false;
  }
  [[nodiscard]] std::vector<std::uint32_t> movers_of(std::uint32_t group) const {
    const System& system = groups_[group].flight->system();
    return {system.numbers().begin(), system.numbers().begin() + static_cast<std::ptrdiff_t>(system.moving())};
  }
  [[nodiscard]] Status meet(const NearPair& pair) {
    std::vector<std::uint32_t> seeds;
    for (const std::uint32_t i : bodies_of(pair)) {
      if (bodies_[i].is_fixed()) continue;
      if (Status fault = check_progress(i); !fault) return fault;
      seeds.push_back(i);
    }
    return resolve_and_list(seeds);
  }
  /// A joint that breaks lets its bodies meet.
  [[nodiscard]] Status resolve_and_list(const std::vector<std::uint32_t>& seeds) {
    if (Status fault = resolve(seeds); !fault || !std::exchange(are_pairs_new_, false)) return fault;
    list_anew();
    return near_.check_number();
  }
  /// An error where a body meets others again and again and time does not go on: without it a wrong foresight, or
  /// impacts of bodies jammed between others, would be a call that never ends.
  [[nodiscard]] Status check_progress(std::uint32_t i) {
    constexpr std::size_t most_meetings = 100'000;
    Meetings& meetings = meetings_[i];
    if (!(now_ - meetings.since <= contact_time_)) meetings = {now_, 0};
    if (++meetings.count <= most_meetings) return {};
    return cannot_continue("body " + std::to_string(i) + " meets others " + std::to_string(most_meetings) +
                           " times within a contact time, at t = " + std::to_string(now_) +
                           ": it is jammed between them");
  }

  // Flights.

  /// The next steps of groups, what happens in them, and whom their bodies meet until then.
  [[nodiscard]] Status take_steps(const std::vector<std::uint32_t>& groups) {
    for (const std::uint32_t group : groups)
      if (Status fault = take_step(group); !fault) return fault;
    for (const std::uint32_t group : groups)
      for (const std::uint32_t i : movers_of(group))
        for (const std::uint32_t p : near_.pairs_of(i)) foresee(p);
    return {};
  }
  [[nodiscard]] Status take_step(std::uint32_t index) {
    Group& group = groups_[index];
    if (!group.flight->advance()) return ended(*group.flight);
    if (group.flight->end() < until_ || step_ == Real(0)) step_ = group.flight->step_size();
    const std::vector<std::uint32_t> movers = movers_of(index);
    for (const std::uint32_t i : movers) stamp_[i] = ++foreseen_;
    const Real end = group.flight->end();
    if (end < until_) queue_.push({end, What::step_ends, index, stamp_[movers.front()], 0});
    group.change = never;
    if (!group.guards.is_empty()) group.change = group.guards.first_change(*group.flight).value_or(never);
    if (const auto reached = LimitSearch<Real, Dim>::first_reached(*group.flight, world_.radius))
      group.change = std::min(group.change, *reached);
    if (group.change < until_) queue_.push({group.change, What::contact_changes, index, stamp_[movers.front()], 0});
    if (group.change == never && end < until_ && jams(*group.flight)) return ended(*group.flight);
    for (const std::uint32_t i : movers) {
      const Real leaves = near_.leaves_at(i, now_, group.flight->bounds(place_in_group_[i]).speed);
      if (leaves < end) queue_.push({leaves, What::list_ends, 0, 0, 0});
    }
    return {};
  }
  /// RigidSystem::least_parting at the end of a step.
  [[nodiscard]] static Real parting_at_end(Flight& flight) {
    X state;
    flight.at(flight.end(), state);
    flight.system().evaluate(flight.end(), state);
    return flight.system().least_parting();
  }
  /// Whether the forces of friction grow beyond all bounds within a time that does not matter. Their rounding, which is
  /// that of angles by how fast they part bodies, would make thousands of steps of what is left.
  [[nodiscard]] bool jams(Flight& flight) const {
    constexpr Real least = std::is_same_v<Real, float> ? Real(1e-4) : Real(1e-9);
    return flight.step_size() < contact_time_ / 1000 && std::abs(parting_at_end(flight)) < least;
  }
  /// Why a flight cannot go on.
  [[nodiscard]] static Status ended(Flight& flight) {
    constexpr Real jammed = std::is_same_v<Real, float> ? Real(1e-2) : Real(1e-3);
    const std::string where = "the path cannot be followed beyond t = " + std::to_string(flight.end()) + ": ";
    if (parting_at_end(flight) < jammed)
      return cannot_continue(where +
                             "the forces of a contact that slips grow beyond all bounds, bodies jam (Painleve's "
                             "paradox); with less friction they would slide on");
    return cannot_continue(where + std::string(to_string(flight.outcome().ending)) + ", " + flight.outcome().hint);
  }
  /// Body i at a time of its present step. It is kept for all that asks for the same instant.
  [[nodiscard]] const Body& body_at(std::uint32_t i, const Real& t) const {
    Seen& seen = seen_[i];
    if (seen.stamp == stamp_[i] && seen.t == t && group_of_[i] != nowhere) return seen.body;
    seen = {find_body(i, t), t, stamp_[i]};
    return seen.body;
  }
  [[nodiscard]] Body find_body(std::uint32_t i, const Real& t) const {
    Body body = bodies_[i];
    if (group_of_[i] != nowhere) {
      const Flight& flight = *groups_[group_of_[i]].flight;
      flight.body_at(place_in_group_[i], std::clamp(t, flight.begin(), flight.end()), body);
    } else if (body.is_fixed()) {
      System::drive(body, begin_[i], t - began_);
    }
    return body;
  }
  /// Body i at the end of the call; on its constraints where that is the end of a step.
  [[nodiscard]] Body body_at_end(std::uint32_t i) const {
    Body body = body_at(i, now_);
    if (group_of_[i] == nowhere) return body;
    const Flight& flight = *groups_[group_of_[i]].flight;
    if (now_ >= flight.end()) flight.body_at_end(place_in_group_[i], body);
    body.energy = flight.system().bodies()[place_in_group_[i]].energy;
    return body;
  }
  [[nodiscard]] Real end_of(std::uint32_t i) const {
    return group_of_[i] == nowhere ? until_ : groups_[group_of_[i]].flight->end();
  }
  [[nodiscard]] MotionBounds<Real, Dim> bounds_of_motion(std::uint32_t i) const {
    if (group_of_[i] != nowhere) return groups_[group_of_[i]].flight->bounds(place_in_group_[i]);
    MotionBounds<Real, Dim> of_driven;
    if (i >= world_.size()) return of_driven;
    of_driven.spin = length(begin_[i].spin);
    of_driven.acceleration = squared(begin_[i].spin) * world_.radius[i];
    return of_driven;
  }
  /// Body i, which is there at a time of its present step.
  [[nodiscard]] BodyInMotion<Real, Dim> moving(std::uint32_t i, const Real& t, const Body& body) const {
    BodyInMotion<Real, Dim> made{.body = &body, .bounds = bounds_of_motion(i)};
    if (i < world_.size()) made.reach = world_.radius[i];
    if (group_of_[i] != nowhere) made.now = groups_[group_of_[i]].flight->accelerations_at(place_in_group_[i], t, body);
    return made;
  }
  [[nodiscard]] MutualMotion<Real, Dim> mutual_motion(std::uint32_t i, std::uint32_t j) const {
    const MotionBounds<Real, Dim> a = bounds_of_motion(i), b = bounds_of_motion(j);
    return {b.steady - a.steady, a.acceleration + b.acceleration, a.sway + b.sway};
  }

  // Meetings.

  [[nodiscard]] std::array<std::uint32_t, 2> bodies_of(const NearPair& pair) const {
    return {pair.is_wall ? static_cast<std::uint32_t>(world_.size()) : near_.parts()[pair.a].body,
            near_.parts()[pair.b].body};
  }
  [[nodiscard]] std::array<Part, 2> parts_of(const NearPair& pair) const {
    const Part b = near_.parts()[pair.b];
    if (!pair.is_wall) return {near_.parts()[pair.a], b};
    const Wall<Real, Dim> wall = facing(world_.walls()[pair.a], bodies_[b.body].x);
    return {
        Part{.wall_normal = wall.normal, .wall_offset = wall.offset, .body = static_cast<std::uint32_t>(world_.size())},
        b};
  }
  /// The rounding of a gap, with room for what impacts leave of it.
  [[nodiscard]] Real band_of(const Body& b, const Part& part) const {
    return 1000 * rounding * (length(b.x) + part.convex->reach);
  }
  /// Begins to look when the parts meet next, within the present steps of both.
  void foresee(std::uint32_t p) {
    const NearPair& pair = near_.pairs()[p];
    const auto [i, j] = bodies_of(pair);
    if (group_of_[j] != nowhere && is_watched(groups_[group_of_[j]], pair)) return;
    if (group_of_[i] != nowhere && is_watched(groups_[group_of_[i]], pair)) return;
    const auto [a, b] = parts_of(pair);
    const Body &body_a = body_at(i, now_), &body_b = body_at(j, now_);
    const Real band = band_of(body_b, b);
    if (are_far(a, body_a, b, body_b, band, std::min({end_of(i), end_of(j), until_}) - now_)) return;
    const Real gap = separation_of(a, body_a, b, body_b).gap;
    look(p, gap > band ? Real(0) : std::min(gap, Real(0)) - band);
  }
  /// Whether a glance at the balls around two bodies tells that their gap stays above a level for a time.
  [[nodiscard]] bool are_far(const Part& a, const Body& body_a, const Part& b, const Body& body_b, const Real& level,
                             const Real& duration) const {
    const MutualMotion<Real, Dim> motion = mutual_motion(a.body, b.body);
    if (a.is_wall())
      return balls_stay_apart(a.wall_normal, Real(dot(a.wall_normal, body_b.x) - a.wall_offset),
                              dot(a.wall_normal, body_b.v), motion, world_.radius[b.body], level, duration);
    const V between = body_b.x - body_a.x;
    const Real distance = length(between);
    if (!(distance > Real(0))) return false;
    const V normal = between * (1 / distance);
    return balls_stay_apart(normal, distance, Real(dot(normal, body_b.v - body_a.v)), motion,
                            Real(world_.radius[a.body] + world_.radius[b.body]), level, duration);
  }
  /// Follows the parts from now on by two steps that cannot pass the instant at which their gap falls to `level`. Where
  /// that does not lead to it, it goes on when that time has come: most of what is foreseen never happens, because one
  /// of the two meets another before.
  void look(std::uint32_t p, const Real& level) {
    const NearPair& pair = near_.pairs()[p];
    const auto [i, j] = bodies_of(pair);
    const auto [a, b] = parts_of(pair);
    const Real to = std::min({end_of(i), end_of(j), until_});
    const MutualMotion<Real, Dim> motion = mutual_motion(i, j);
    Next next{now_, What::parts_near, p, stamp_[i], stamp_[j], level};
    for (int round = 0; round < 2; ++round) {
      const Body &body_a = body_at(i, next.t), &body_b = body_at(j, next.t);
      const Separation<Real, Dim> apart = separation_of(a, body_a, b, body_b);
      const Real longest = to - next.t;
      if (!(longest > Real(0))) return;
      Real safe = safe_time(a, body_a, b, body_b, apart.normal, level, motion, longest);
      if (safe < longest)
        safe = std::max(
            safe, safe_time_at_face(a, moving(i, next.t, body_a), b, moving(j, next.t, body_b), apart, level, longest));
      if (safe >= longest) return;
      if (safe <= 4 * rounding * std::abs(next.t) || apart.gap - level <= band_of(body_b, b) / 250) {
        next.what = What::parts_meet;
        break;
      }
      next.t += safe;
    }
    queue_.push(next);
  }
  [[nodiscard]] static bool is_watched(const Group& group, const NearPair& pair) {
    return std::ranges::binary_search(group.watched, pair);
  }

  void list_pairs() {
    std::vector<Body> now;
    for (std::uint32_t i = 0; i < world_.size(); ++i) now.push_back(body_at(i, now_));
    near_.list(world_, now, now_);
  }
  /// Lists the pairs that may meet, and foresees all events again.
  void list_anew() {
    list_pairs();
    queue_ = {};
    for (std::uint32_t g = 0; g < groups_.size(); ++g) {
      if (!groups_[g].flight) continue;
      const std::vector<std::uint32_t> movers = movers_of(g);
      const Flight& flight = *groups_[g].flight;
      if (flight.end() < until_) queue_.push({flight.end(), What::step_ends, g, stamp_[movers.front()], 0});
      if (groups_[g].change < until_)
        queue_.push({groups_[g].change, What::contact_changes, g, stamp_[movers.front()], 0});
      for (const std::uint32_t i : movers) {
        const Real leaves = near_.leaves_at(i, now_, flight.bounds(place_in_group_[i]).speed);
        if (leaves < flight.end()) queue_.push({leaves, What::list_ends, 0, 0, 0});
      }
    }
    for (std::uint32_t p = 0; p < near_.pairs().size(); ++p) foresee(p);
  }

  // Instants.

  /// Resolves the present instant for these bodies and all that they touch, and lets them fly on.
  [[nodiscard]] Status resolve(const std::vector<std::uint32_t>& seeds) {
    std::vector<std::uint32_t> bodies = gather(seeds);
    if (remove_broken_joints()) {
      list_pairs();
      bodies = gather(bodies);
    }
    System instant(world_, bodies_, bodies, now_, is_whole_);
    for (auto& joint : joints_) {
      if (!is_gathered_[joint.a] && !is_gathered_[joint.b]) continue;
      joint.held = lasting_limit(joint.joint);
      joint.follow_law(now_);
      instant.add(joint, bodies_);
    }
    std::vector<Point> points = find_points(instant, bodies);
    if (std::ranges::any_of(points, [&](const Point& point) { return is_deep(instant, point); })) {
      ContactInstant<Real, Dim>(instant, points, Real(0), Real(0)).separate();
      for (std::size_t k = 0; k < instant.moving(); ++k) bodies_[bodies[k]] = instant.bodies()[k];
      points = find_points(instant, bodies);
    }
    if (Status fault = check_motors(instant, points); !fault) return fault;
    instant.find_free_motion(now_);
    Real pull(0);
    for (std::uint32_t k = 0; k < instant.moving(); ++k) pull = std::max(pull, length(instant.linear(k)));
    for (const Point& point : points) pull = std::max(pull, pull_at(instant, point));
    for (Point& point : points)
      if (point.limit) point.slow = pull * contact_time_ / arm_of(instant.joints()[point.limit->joint], instant);
    Real noise = pull * contact_time_ / 10'000, reach(0);
    for (const std::uint32_t i : bodies) {
      const Real fastest = length(bodies_[i].v) + (1 + length(bodies_[i].spin)) * world_.radius[i];
      noise = std::max(noise, Real(4 * options_.tolerance * fastest)), reach = std::max(reach, world_.radius[i]);
    }
    // What falls as far as a guard lets it would bounce for ever, if its speed were no less than those of impacts.
    constexpr Real dip = std::is_same_v<Real, float> ? Real(0) : ContactGuards<Real, Dim>::small;
    const Real least_fall = 2 * std::sqrt(2 * pull * dip * reach);
    ContactInstant<Real, Dim> resolver(instant, points, std::max(Real(pull * contact_time_), least_fall), noise);
    resolver.turn_motors();
    Status status = resolver.strike([&](std::size_t k, const Real& impulse) {
      if (impulse > Real(0)) note_impact(instant, points[k], impulse);
    });
    if (!status) return impulses_not_found(now_, bodies, status.message);
    for (std::size_t k = 0; k < instant.moving(); ++k) bodies_[bodies[k]] = instant.bodies()[k];
    choose_motors(instant);
    if (status = resolver.choose_lasting(now_); !status) return status;
    note_lasting(resolver, points);
    hold_limits(resolver, points);
    return fly(bodies, instant, resolver, points);
  }

  using Point = TouchingPoint<Real, Dim>;

  /// These bodies, their groups and all that touches them, brought to the present instant.
  [[nodiscard]] std::vector<std::uint32_t> gather(std::vector<std::uint32_t> open) {
    is_gathered_.assign(world_.size() + 1, false);
    std::vector<std::uint32_t> all;
    while (!open.empty()) {
      const std::uint32_t i = open.back();
      open.pop_back();
      if (is_gathered_[i]) continue;
      is_gathered_[i] = true;
      all.push_back(i);
      if (group_of_[i] != nowhere) {
        const std::vector<std::uint32_t> movers = movers_of(group_of_[i]);
        land(group_of_[i]);
        open.insert(open.end(), movers.begin(), movers.end());
      } else {
        for (const auto& joint : joints_)  // at the beginning
          if (joint.a == i || joint.b == i)
            for (const std::uint32_t j : {joint.a, joint.b})
              if (!bodies_[j].is_fixed()) open.push_back(j);
        if (is_whole_)
          for (std::uint32_t j = 0; j < world_.size(); ++j)
            if (!bodies_[j].is_fixed() && !is_gathered_[j]) open.push_back(j);
      }
      for (const std::uint32_t p : near_.pairs_of(i)) {
        const auto [a, b] = bodies_of(near_.pairs()[p]);
        const std::uint32_t other = a == i ? b : a;
        if (!bodies_[other].is_fixed() && !is_gathered_[other] && touches(near_.pairs()[p])) open.push_back(other);
      }
    }
    for (std::uint32_t i = 0; i < world_.size(); ++i)
      if (bodies_[i].is_fixed()) bodies_[i] = body_at(i, now_);
    std::ranges::sort(all);
    return all;
  }
  [[nodiscard]] Status check_motors(const System& instant, const std::vector<Point>& points) const {
    for (const Point& point : points) {
      if (!point.limit) continue;
      const auto& joint = instant.joints()[point.limit->joint];
      if (joint.motor == MotorMode::none || joint.joint.motor->most < never || joint.joint.kind == JointKind::wheel)
        continue;
      const Real speed = joint.joint.motor->speed;
      if (point.limit->side == LimitSide::upper ? speed > Real(0) : speed < Real(0))
        return cannot_continue("a motor without a greatest force drives its joint against its limit, at t = " +
                               std::to_string(now_) + ": give it a greatest force, or take the limit away");
    }
    return {};
  }
  /// The numbers of the joints of the present instant.
  [[nodiscard]] std::vector<std::size_t> gathered_joints() const {
    std::vector<std::size_t> numbers;
    for (std::size_t j = 0; j < joints_.size(); ++j)
      if (is_gathered_[joints_[j].a] || is_gathered_[joints_[j].b]) numbers.push_back(j);
    return numbers;
  }
  /// Limits that last hold their joints from here on.
  void hold_limits(const ContactInstant<Real, Dim>& resolver, const std::vector<Point>& points) {
    const std::vector<std::size_t> numbers = gathered_joints();
    for (const auto& one : resolver.lasting())
      if (const auto& limit = points[one.point].limit) joints_[numbers[limit->joint]].held = limit->side;
  }
  /// Marks the joints of a system that bear more than their strength. Whether there are any.
  [[nodiscard]] bool break_joints(System& system, const X& state) {
    const auto is_weak = [](const auto& joint) { return has_strength(joint.joint); };
    if (!std::ranges::any_of(system.joints(), is_weak)) return false;
    system.find_shortest_forces(now_, state);
    bool any = false;
    for (std::size_t j = 0; j < system.joints().size(); ++j) {
      const auto& joint = system.joints()[j];
      if (!is_weak(joint) || !(system.strain(j) >= 1 - 64 * rounding)) continue;
      for (auto& one : joints_)
        if (one.handle == joint.handle) one.breaks = any = true;
      const auto load = system.load_of(j);
      Joint<Real, Dim>& broken = *world_.find(joint.handle);
      broken.is_broken = true;
      broken.force = load.force, broken.torque = load.torque, broken.motor_effort = load.motor;
    }
    return any;
  }
  /// Whether bodies that were connected may meet from now on.
  [[nodiscard]] bool remove_broken_joints() {
    bool any = false;
    for (const auto& joint : joints_)
      if (joint.breaks) any = let_meet(joint) || any;
    std::erase_if(joints_, [](const auto& joint) { return joint.breaks; });
    are_pairs_new_ = are_pairs_new_ || any;
    return any;
  }
  /// Lets two bodies collide that a broken joint kept from it, unless they lie in each other.
  bool let_meet(const ActingJoint<Real, Dim>& broken) {
    if (broken.joint.collide || broken.joint.a == BodyHandle{}) return false;
    for (const Part& a : near_.parts())
      for (const Part& b : near_.parts())
        if (a.body == broken.a && b.body == broken.b &&
            separation_of(a, body_at(a.body, now_), b, body_at(b.body, now_)).gap < -touching_gap(b) / 4)
          return false;
    near_.let_meet(broken.a, broken.b);
    return true;
  }
  /// Whether motors keep their speed from here on, or work with all their force.
  void choose_motors(System& instant) {
    constexpr Real near = std::is_same_v<Real, float> ? Real(1e-4) : Real(1e-10);
    const std::vector<std::size_t> numbers = gathered_joints();
    const auto set = [&](std::size_t k, MotorMode mode) {
      joints_[numbers[k]].motor = mode;
      instant.set_motor(k, mode);
    };
    bool any_keeps = false;
    for (std::size_t k = 0; k < numbers.size(); ++k) {
      ActingJoint<Real, Dim>& joint = joints_[numbers[k]];
      const bool is_overloaded = std::exchange(joint.is_overloaded, false);
      if (joint.motor == MotorMode::none || !(joint.joint.motor->most < never) || is_overloaded) continue;
      const Real speed = joint.joint.motor->speed, behind = speed - instant.motor_rate(k);
      // What a strong motor does to the speed within the rounding of the time is no lag.
      const auto row = instant.driven_row(instant.joints()[k]);
      const Real pull = joint.joint.motor->most * response(row, row, std::as_const(instant).bodies().data());
      const Real least =
          std::max(Real(near * std::max(std::abs(speed), Real(1))), Real(16 * rounding * std::abs(now_) * pull));
      const bool keeps = std::abs(behind) <= least;
      set(k, keeps ? MotorMode::keeps_speed : behind > Real(0) ? MotorMode::forwards : MotorMode::backwards);
      any_keeps = any_keeps || keeps;
    }
    for (std::size_t round = 0; any_keeps && round < numbers.size(); ++round) {
      instant.find_shortest_forces(now_, instant.pack());
      any_keeps = false;
      for (std::size_t k = 0; k < numbers.size(); ++k) {
        const ActingJoint<Real, Dim>& joint = joints_[numbers[k]];
        if (joint.motor != MotorMode::keeps_speed) continue;
        const Real effort = instant.load_of(k).motor, most = joint.joint.motor->most;
        if (!(std::abs(effort) > most)) continue;
        set(k, effort > Real(0) ? MotorMode::forwards : MotorMode::backwards);
        any_keeps = true;
        break;
      }
    }
  }
  /// Motors that have reached their greatest force in a flight that ends here cease to keep their speed.
  void note_overloaded(const System& system) {
    for (std::size_t j = 0; j < system.joints().size(); ++j) {
      if (system.joints()[j].motor != MotorMode::keeps_speed) continue;
      const Real effort = system.load_of(j).motor, most = system.joints()[j].joint.motor->most;
      if (!(std::abs(effort) >= most * (1 - 64 * rounding))) continue;
      for (auto& joint : joints_)
        if (joint.handle == system.joints()[j].handle)
          joint.motor = effort > Real(0) ? MotorMode::forwards : MotorMode::backwards, joint.is_overloaded = true;
    }
  }
  /// Ends the flight of a group at the present instant.
  void land(std::uint32_t index) {
    Group& group = groups_[index];
    note_impulses(group);
    X state;
    group.flight->at(now_, state);
    System& system = group.flight->system();
    if (!system.joints().empty()) {
      system.evaluate(now_, state);
      note_overloaded(system);
      static_cast<void>(break_joints(system, state));
    }
    static_cast<void>(system.project(now_, state, true));
    for (std::size_t k = 0; k < system.moving(); ++k) {
      const std::uint32_t i = system.numbers()[k];
      bodies_[i] = system.bodies()[k];
      group_of_[i] = nowhere;
      stamp_[i] = ++foreseen_;
    }
    group = {};
    free_groups_.push_back(index);
  }
  [[nodiscard]] bool touches(const NearPair& pair) const {
    const auto [a, b] = parts_of(pair);
    const Body &body_a = body_at(a.body, now_), &body_b = body_at(b.body, now_);
    return !are_far(a, body_a, b, body_b, touching_gap(b), Real(0)) &&
           separation_of(a, body_a, b, body_b).gap <= touching_gap(b);
  }
  /// How fast the free motion accelerates two bodies against each other where they touch: not only forces press, but
  /// also what turns.
  [[nodiscard]] static Real pull_at(const System& instant, const Point& point) {
    if (!point.feature) return Real(0);
    const Body &a = instant.bodies()[point.a], &b = instant.bodies()[point.b];
    MotionRow<Real, Dim> row = normal_row(place_of(*point.feature, a, b), a, b);
    row.a = point.a, row.b = point.b;
    return std::abs(instant.free_acceleration(row));
  }
  /// What makes an angular velocity a velocity; 1 where the coordinate of a joint is a length.
  [[nodiscard]] Real arm_of(const ActingJoint<Real, Dim>& joint, const System& instant) const {
    if (joint.joint.kind != JointKind::hinge) return Real(1);
    return std::max(reach_of(instant.numbers()[joint.a]), reach_of(instant.numbers()[joint.b]));
  }
  /// Whether bodies are farther in each other at a point than rounding puts them.
  [[nodiscard]] bool is_deep(const System& instant, const Point& point) const {
    if (point.limit)
      return point.gap < -LimitSearch<Real, Dim>::size_of(instant, point.limit->joint, world_.radius).near / 4;
    return point.gap < -touching_gap(parts_of(near_.pairs()[point.pair])[1]) / 4;
  }
  [[nodiscard]] static Real touching_gap(const Part& part) { return std::sqrt(rounding) / 100 * part.convex->reach; }

  [[nodiscard]] std::vector<Point> find_points(System& instant, const std::vector<std::uint32_t>& bodies) {
    std::vector<std::uint32_t> pairs;
    for (const std::uint32_t i : bodies)
      for (const std::uint32_t p : near_.pairs_of(i)) {
        const auto [a, b] = bodies_of(near_.pairs()[p]);  // others are elsewhere by now
        if ((bodies_[a].is_fixed() || is_gathered_[a]) && (bodies_[b].is_fixed() || is_gathered_[b]))
          pairs.push_back(p);
      }
    std::ranges::sort(pairs);
    pairs.erase(std::ranges::unique(pairs).begin(), pairs.end());
    std::vector<Point> points;
    for (const std::uint32_t p : pairs) {
      if (near_.pairs()[p].is_wall) {
        add_points_at_wall(instant, p, points);
      } else {
        add_points(instant, p, points);
      }
    }
    add_limits(instant, points);
    return points;
  }
  /// The limits at which joints are.
  void add_limits(const System& instant, std::vector<Point>& points) const {
    for (std::uint32_t j = 0; j < instant.joints().size(); ++j) {
      const auto& joint = instant.joints()[j];
      for (const LimitSide side : {LimitSide::lower, LimitSide::upper}) {
        if (joint.held == LimitSide::both || !has_limit(joint.joint, side)) continue;
        const Real gap = instant.limit_row({j, side}).error;
        if (gap > LimitSearch<Real, Dim>::size_of(instant, j, world_.radius).near) continue;
        const auto number = static_cast<std::uint32_t>(near_.pairs().size() + points.size());
        points.push_back({.pair = number,
                          .a = joint.a,
                          .b = joint.b,
                          .material = {.restitution = Real(0), .friction = Real(0)},
                          .gap = gap,
                          .limit = JointLimit{j, side}});
      }
    }
  }
  void add_points_at_wall(System& instant, std::uint32_t p, std::vector<Point>& points) {
    const NearPair& pair = near_.pairs()[p];
    const auto [wall, part] = parts_of(pair);
    const Body& body = bodies_[part.body];
    const V n = wall.wall_normal;
    Point point{.pair = p, .a = instant.local(wall.body, bodies_), .b = instant.local(part.body, bodies_), .normal = n};
    point.material = combined(world_.combine_rule, world_.walls()[pair.a].material, world_.material[part.body]);
    for (const V& corner : part.convex->core.corners) {
      const V in_body = part.in_body.place(corner), x = body.pose().place(in_body) - n * part.rounding();
      if (dot(n, x) - wall.wall_offset > touching_gap(part)) continue;
      point.place = x, point.gap = dot(n, x) - wall.wall_offset;
      point.feature = ContactFeature<Real, Dim>{.kind = ContactFeature<Real, Dim>::Kind::face_of_a,
                                                .point_a = n * wall.wall_offset,
                                                .point_b = in_body,
                                                .along_a = n,
                                                .rounding_b = part.rounding()};
      points.push_back(point);
    }
  }
  void add_points(System& instant, std::uint32_t p, std::vector<Point>& points) {
    const auto [part_a, part_b] = parts_of(near_.pairs()[p]);
    const Body &a = bodies_[part_a.body], &b = bodies_[part_b.body];
    const auto found = touching_places(part_a, a, part_b, b, touching_gap(part_b));
    Point point{.pair = p, .normal = found.normal};
    point.material = combined(world_.combine_rule, world_.material[part_a.body], world_.material[part_b.body]);
    for (std::size_t k = 0; k < found.places.size(); ++k) {
      const V& place = found.places[k];
      point.gap = found.gaps[k];
      point.a = instant.local(part_a.body, bodies_), point.b = instant.local(part_b.body, bodies_);
      point.place = place;
      point.feature =
          feature_at(*part_a.convex, part_a.in_body, a, *part_b.convex, part_b.in_body, b, point.normal, place);
      points.push_back(point);
    }
  }

  // New groups.

  [[nodiscard]] Status fly(const std::vector<std::uint32_t>& bodies, const System& instant,
                           const ContactInstant<Real, Dim>& resolver, const std::vector<Point>& points) {
    std::vector<std::uint32_t> root(world_.size());
    std::iota(root.begin(), root.end(), 0u);
    const auto find = [&](std::uint32_t i) {
      while (root[i] != i) i = root[i] = root[root[i]];
      return i;
    };
    const auto join = [&](std::uint32_t i, std::uint32_t j) {
      if (!bodies_[i].is_fixed() && !bodies_[j].is_fixed()) root[find(i)] = find(j);
    };
    for (const auto& joint : joints_)
      if (is_gathered_[joint.a] || is_gathered_[joint.b]) join(joint.a, joint.b);
    for (const auto& one : resolver.lasting()) {
      const Point& point = points[one.point];
      join(instant.numbers()[point.a], instant.numbers()[point.b]);
    }
    for (std::size_t k = 1; is_whole_ && k < bodies.size(); ++k) join(bodies[0], bodies[k]);
    std::vector<std::uint32_t> order = bodies;
    std::ranges::sort(order, {}, [&](std::uint32_t i) { return std::pair(find(i), i); });
    std::vector<std::uint32_t> begun;
    for (auto first = order.begin(); first != order.end();) {
      const auto last = std::find_if(first, order.end(), [&](std::uint32_t i) { return find(i) != find(*first); });
      begun.push_back(start_group({first, last}, instant, resolver, points));
      first = last;
    }
    bool any_breaks = false;
    for (const std::uint32_t group : begun) {
      System& system = groups_[group].flight->system();
      if (Status fault = check_agreement(system); !fault) return fault;
      any_breaks = break_joints(system, system.pack()) || any_breaks;
    }
    if (!any_breaks) return take_steps(begun);
    for (const std::uint32_t group : begun) land(group);
    return resolve(bodies);
  }
  /// Joints that hold the same twice can agree in all positions, as the hinges of a door, or in the present one only.
  [[nodiscard]] Status check_agreement(System& system) const {
    constexpr Real most = std::is_same_v<Real, float> ? Real(1e-2) : Real(1e-6);
    if (!system.has_dependent_rows()) return {};
    system.evaluate(now_, system.pack());
    if (std::max(system.disagreement_of_rates(), system.disagreement()) <= most) return {};
    return cannot_continue(
        "the joints of body " + std::to_string(system.numbers()[0]) +
        " and of those that it is joined to hold each other twice, and no forces keep them all, at t = " +
        std::to_string(now_) +
        ": as two motors of different speeds about one axis, or a hinge on the line of a distance; take one away");
  }
  /// Makes a group of these bodies, with their joints and lasting contacts.
  [[nodiscard]] std::uint32_t start_group(std::vector<std::uint32_t> bodies, const System& instant,
                                          const ContactInstant<Real, Dim>& resolver, const std::vector<Point>& points) {
    const std::uint32_t index = free_group();
    Group& group = groups_[index];
    for (std::size_t k = 0; k < bodies.size(); ++k)
      group_of_[bodies[k]] = index, place_in_group_[bodies[k]] = static_cast<std::uint32_t>(k);
    const auto is_here = [&](std::uint32_t i) { return i < world_.size() && group_of_[i] == index; };
    System system(world_, bodies_, std::move(bodies), now_, is_whole_);
    for (const auto& joint : joints_)
      if (is_here(joint.a) || is_here(joint.b)) system.add(joint, bodies_);
    std::uint32_t last_pair = nowhere;
    for (const auto& one : resolver.lasting()) {
      const Point& at = points[one.point];
      if (at.limit) continue;
      ActingContact<Real, Dim> contact{.feature = *at.feature,
                                       .a = instant.numbers()[at.a],
                                       .b = instant.numbers()[at.b],
                                       .pair = at.pair,
                                       .rubbing = one.rubbing,
                                       .friction = at.material.friction,
                                       .is_first = at.pair != last_pair,
                                       .slip = one.slip,
                                       .steady_below = one.steady_below,
                                       .ends_below = one.ends_below};
      if (!is_here(contact.a) && !is_here(contact.b)) continue;
      last_pair = at.pair;
      system.add(contact, bodies_);
      group.of_contact.push_back(near_.pairs()[at.pair]);
    }
    group.flight = std::make_unique<Flight>(std::move(system), now_, until_, options_, world_.radius, step_);
    watch(group, instant, resolver, points, is_here);
    return index;
  }
  /// Guards the lasting contacts and the joints of a group, and the pairs that stay closed.
  template <class IsHere>
  void watch(Group& group, const System& instant, const ContactInstant<Real, Dim>& resolver,
             const std::vector<Point>& points, IsHere&& is_here) {
    System& system = group.flight->system();
    for (const auto& one : resolver.lasting()) {
      const Point& at = points[one.point];
      if (at.limit) continue;
      if (is_here(instant.numbers()[at.a]) || is_here(instant.numbers()[at.b]))
        group.watched.push_back(near_.pairs()[at.pair]);
    }
    std::ranges::sort(group.watched);
    group.watched.erase(std::ranges::unique(group.watched).begin(), group.watched.end());
    const bool may_change =
        std::ranges::any_of(system.joints(),
                            [](const auto& joint) {
                              return (joint.motor != MotorMode::none && joint.joint.motor->most < never) ||
                                     has_strength(joint.joint) || is_held_on_one_side(joint);
                            }) ||
        system.has_dependent_rows();
    if (group.watched.empty() && !may_change) return;
    Real force(0), speed(0);
    for (std::uint32_t k = 0; k < system.moving(); ++k) {
      const std::uint32_t i = system.numbers()[k];
      const Real pull = length(instant.linear(instant_place(instant, i)));
      force = std::max(force, Real(pull * world_.mass[i]));
      speed = std::max(speed, Real(std::sqrt(pull * world_.radius[i])));
    }
    group.guards = {Real(std::sqrt(rounding) / 50), std::max(Real(1e4) * rounding, Real(1000) * options_.tolerance),
                    force > Real(0) ? force : Real(1), speed > Real(0) ? speed : Real(1)};
    for (const NearPair& pair : group.watched) {
      const auto [a, b] = parts_of(pair);
      group.guards.watch({a, b, system.local(a.body, bodies_), system.local(b.body, bodies_)});
    }
    group.guards.begin(system, now_, system.pack());
  }
  [[nodiscard]] static std::uint32_t instant_place(const System& instant, std::uint32_t number) {
    return static_cast<std::uint32_t>(std::ranges::find(instant.numbers(), number) - instant.numbers().begin());
  }
  [[nodiscard]] std::uint32_t free_group() {
    if (free_groups_.empty()) {
      groups_.emplace_back();
      return static_cast<std::uint32_t>(groups_.size() - 1);
    }
    const std::uint32_t index = free_groups_.back();
    free_groups_.pop_back();
    groups_[index] = {};
    return index;
  }

  // The log.

  [[nodiscard]] ContactEvent<Real, Dim> event_of(const NearPair& pair, ContactChange change, const V& place,
                                                 const V& normal, const Real& impulse) const {
    const auto [a, b] = bodies_of(pair);
    ContactEvent<Real, Dim> event{.change = change, .point = place, .normal = normal, .impulse = impulse, .time = now_};
    event.a = world_.handle(pair.is_wall ? b : a);
    if (pair.is_wall) {
      event.wall = pair.a, event.normal = -normal;
    } else {
      event.b = world_.handle(b);
    }
    return event;
  }
  void note_impact(const System&, const Point& point, const Real& impulse) {
    if (point.limit) return;
    const NearPair& pair = near_.pairs()[point.pair];
    ++(pair.is_wall ? statistics.wall_collisions : statistics.collisions);
    if (contacts.is_kept()) contacts.add(event_of(pair, ContactChange::impact, point.place, point.normal, impulse));
  }
  /// Adds what the contacts of a group have pushed since it began.
  void note_impulses(const Group& group) {
    const System& system = group.flight->system();
    if (system.contacts().empty()) return;
    X state;
    group.flight->at(std::clamp(now_, group.flight->begin(), group.flight->end()), state);
    for (std::size_t k = 0; k < system.contacts().size(); ++k)
      lasting_.add_impulse(group.of_contact[k], system.impulse(state, k));
  }
  void note_lasting(const ContactInstant<Real, Dim>& resolver, const std::vector<Point>& points) {
    std::vector<NearPair> now;
    for (const auto& one : resolver.lasting())
      if (!points[one.point].limit) now.push_back(near_.pairs()[points[one.point].pair]);
    std::ranges::sort(now);
    now.erase(std::ranges::unique(now).begin(), now.end());
    lasting_.update(
        now,
        [&](const NearPair& pair) {
          return is_gathered_[near_.parts()[pair.b].body] ||
                 (!pair.is_wall && is_gathered_[near_.parts()[pair.a].body]);
        },
        [&](const NearPair& pair, ContactChange change, const Real& impulse) {
          if (!contacts.is_kept()) return;
          V place = bodies_[near_.parts()[pair.b].body].x, normal{};
          for (const Point& point : points)
            if (!point.limit && near_.pairs()[point.pair] == pair) place = point.place, normal = point.normal;
          contacts.add(event_of(pair, change, place, normal, impulse));
        });
  }

  static constexpr Real most_overlap = std::is_same_v<Real, float> ? Real(1e-3) : Real(1e-6);

  World<Real, Dim>& world_;
  ExactOptions<Real> options_;
  Real step_{};  // of the last flight
  std::vector<Kept> kept_;
  LastingJournal<Real, Dim> lasting_;
  // Of the present call:
  Real until_{}, now_{}, began_{}, contact_time_{};
  std::size_t events_ = 0;
  bool are_pairs_new_ = false;        // of bodies that a joint connected which has broken since the last list
  bool is_whole_ = false;             // forces couple all bodies
  std::vector<Body> bodies_, begin_;  // at the last instant that concerned them; at the beginning; last, the world
  std::vector<ActingJoint<Real, Dim>> joints_;
  NearParts<Real, Dim> near_;
  std::vector<std::uint64_t> stamp_;  // of bodies: changes where what was foreseen for a body is no longer valid
  std::uint64_t foreseen_ = 0;
  struct Seen {
    Body body{};
    Real t = never;
    std::uint64_t stamp = 0;
  };
  struct Meetings {
    Real since{};
    std::size_t count = 0;
  };
  std::vector<Meetings> meetings_;  // of bodies, within a contact time
  mutable std::vector<Seen> seen_;  // of bodies in flight, at the time for which each was looked for last
  std::vector<std::uint32_t> group_of_, place_in_group_;
  std::vector<Group> groups_;
  std::vector<std::uint32_t> free_groups_;
  std::priority_queue<Next> queue_;
  std::vector<bool> is_gathered_;
};

}  // namespace detail

template <class Real, int Dim>
std::unique_ptr<ExactEngine<Real, Dim>> rigid_motion(World<Real, Dim>& world, const ExactOptions<Real>& options) {
  return std::make_unique<detail::RigidMotion<Real, Dim>>(world, options);
}

}  // namespace continuo
