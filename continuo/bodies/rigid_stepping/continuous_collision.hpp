// No body passes through another one: what moves farther in a step than a part of its own size is stopped where it
// first touches something. It keeps its velocity, and the next step begins with the contact.
#pragma once
#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include <continuo/bodies/rigid_stepping/mesh_passage.hpp>
#include <continuo/bodies/rigid_stepping/rigid_contacts.hpp>
#include <continuo/bodies/rigid_stepping/time_of_depth.hpp>
#include <continuo/bodies/support/thread_team.hpp>
#include <continuo/bodies/world.hpp>
#include <continuo/shapes/cast.hpp>

namespace continuo {

/// The constant spin that turns one orientation into another within a time.
template <class Real>
[[nodiscard]] Vector<Real, 1> spin_between(const Vector<Real, 1>& from, const Vector<Real, 1>& to, const Real& time) {
  return (to - from) * (1 / time);
}
template <class Real>
[[nodiscard]] Vector<Real, 3> spin_between(const Vector<Real, 4>& p, const Vector<Real, 4>& q, const Real& time) {
  // The vector part of q p^-1, whose length is the sine of half the angle.
  const Vector<Real, 3> from{{p[1], p[2], p[3]}}, to{{q[1], q[2], q[3]}};
  const Real cosine = dot(p, q);
  const Vector<Real, 3> axis = (to * p[0] - from * q[0] - moment(to, from)) * (cosine < Real(0) ? Real(-1) : Real(1));
  const Real sine = length(axis);
  if (!(sine > Real(0))) return {};
  return axis * (2 * std::atan2(sine, std::abs(cosine)) / (sine * time));
}

/// The motion of a part of a body in the last step.
template <class Real, int Dim>
[[nodiscard]] MovingBody<Real, Dim> motion_of(const RigidPart<Real, Dim>& part, const RigidBody<Real, Dim>& body,
                                              const Real& step) {
  MovingBody<Real, Dim> moving{.shape = part.convex};
  RigidBody<Real, Dim> before = body;
  before.x = body.x_before, before.axes = rotation(body.orientation_before);
  const Pose<Real, Dim> first = part.pose(before), last = part.pose(body);
  moving.position = first.centre;
  moving.velocity = (last.centre - first.centre) * (1 / step);
  moving.orientation = body.orientation_before, moving.axes = part.in_body.axes;
  moving.spin = spin_between(body.orientation_before, body.orientation, step);
  return moving;
}

/// The numbers of two bodies, the lower one first.
using BodyPair = std::pair<std::uint32_t, std::uint32_t>;

/// When a body stops, and at which other one: no body is a wall, a mesh, or one that need not stop.
template <class Real>
struct Stop {
  static constexpr std::uint32_t nobody = 0xffffffff;
  Real time{};
  std::uint32_t at = nobody;
};

/// The time of the step after which each body stops.
template <class Real, int Dim>
class StoppingTimes {
 public:
  /// Bodies of the pairs `joined`, which are sorted, pass through each other.
  StoppingTimes(ThreadTeam& team, const World<Real, Dim>& world, RigidPairs<Real, Dim>& pairs,
                std::span<const PartContact<Real, Dim>> contacts, std::span<const BodyPair> joined, const Real& step,
                std::span<const RigidBody<Real, Dim>> bodies)
      : team_(team),
        world_(world),
        pairs_(pairs),
        contacts_(contacts),
        joined_(joined),
        step_(step),
        bodies_(bodies),
        stops_(world.size(), {step}),
        ways_(pairs.parts().size()) {
    team.for_each(0, ways_.size(), 64, [&](std::size_t from, std::size_t to) {
      for (std::size_t i = from; i < to; ++i) ways_[i] = kind_of_way(pairs.parts()[i]);
    });
    for (std::uint32_t i = 0; i < ways_.size(); ++i) {
      if (ways_[i] == Way::passes_nothing) continue;
      if (ways_[i] >= Way::passes_movers) passing_.push_back(static_cast<std::uint32_t>(fast_.size()));
      passing_slow_ += ways_[i] >= Way::passes_slow ? 1 : 0;
      fast_.push_back(i);
    }
    if (!fast_.empty()) pairs.find_still(bodies);
    if (passing_slow_ * ways_.size() > most_tests) pairs.update_tree();
    if (may_stop()) find_near();
  }

  [[nodiscard]] const std::vector<Stop<Real>>& stops() const { return stops_; }
  /// Whether a part might pass through something.
  [[nodiscard]] bool may_stop() const {
    const bool has_still = !pairs_.still().empty() || !world_.walls().empty() || !world_.meshes().empty();
    return !fast_.empty() && (!passing_.empty() || has_still);
  }
  /// Whether a part moves so far that it might pass through something.
  [[nodiscard]] bool is_fast(const RigidPart<Real, Dim>& part) const {
    return ways_[static_cast<std::size_t>(&part - pairs_.parts().data())] != Way::passes_nothing;
  }
  /// Stops fast parts at their first contacts with what they do not touch yet.
  void find_first_contacts() {
    auto near = near_.begin();
    for (const std::uint32_t i : fast_) {
      const auto first = near;
      while (near != near_.end() && near->a == i) ++near;
      find_first_contact(pairs_.parts()[i], {first, near});
    }
  }
  /// Stops where contacts of the beginning of the step become deep.
  void find_depths() {
    const auto deepens = collected<std::uint32_t>(contacts_.size(), [this](std::size_t k, auto& list) {
      if (may_become_deep(contacts_[k])) list.push_back(static_cast<std::uint32_t>(k));
    });
    for (const std::uint32_t k : deepens) find_depth(contacts_[k]);
  }

 private:
  /// How far a part moves in the step: what a kind can do, those behind it can as well.
  enum class Way : std::uint8_t {
    passes_nothing,
    passes_still,   // far enough that it may pass through what does not move
    passes_movers,  // through another one that moves as far
    passes_slow     // through one that moves, and is not fast: the way of that is at most half its inner radius
  };
  /// Of two parts of which neither has a way of more than its inner radius, the difference of both is at most the sum
  /// of these, see `may_pass`. The factor is room for rounding.
  [[nodiscard]] Way kind_of_way(const RigidPart<Real, Dim>& part) const {
    const RigidBody<Real, Dim>& body = bodies_[part.body];
    if (body.is_fixed() || world_.traits(part.body).is_sensor) return Way::passes_nothing;
    const Real shift = length(Vector<Real, Dim>(body.x - body.x_before));
    if (!(shift + turn(part) > part.inner_radius / 2)) return Way::passes_nothing;
    constexpr Real room = Real(0.999);
    if (shift > room * (part.inner_radius + pairs_.least_inner_radius() / 2)) return Way::passes_slow;
    return shift > room * part.inner_radius ? Way::passes_movers : Way::passes_still;
  }
  /// What act(k, list) appends for k below `count`, in the order of k; it is called at once by several threads.
  template <class Entry, class Act>
  [[nodiscard]] std::vector<Entry> collected(std::size_t count, Act&& act) const {
    std::vector<std::vector<Entry>> lists(std::clamp<std::size_t>(count / 128, 1, 256));
    team_.share(lists.size(), [&](std::size_t n) {
      for (std::size_t k = count * n / lists.size(); k < count * (n + 1) / lists.size(); ++k) act(k, lists[n]);
    });
    std::vector<Entry> all;
    for (const auto& list : lists) all.insert(all.end(), list.begin(), list.end());
    return all;
  }
  [[nodiscard]] bool may_become_deep(const PartContact<Real, Dim>& found) const {
    if (found.contact.size == 0) return false;
    const auto parts = pairs_.parts();
    const RigidPart<Real, Dim>& a = parts[found.parts.a];
    if (found.parts.b >= parts.size()) return is_fast(a);
    const RigidPart<Real, Dim>& b = parts[found.parts.b];
    return (is_fast(a) || is_fast(b)) && may_pass(a, b);
  }
  /// The body turns about the first point of a contact into the other one.
  void find_depth(const PartContact<Real, Dim>& found) {
    const auto parts = pairs_.parts();
    const bool is_wall = found.parts.b >= parts.size();
    const RigidPart<Real, Dim>& a = parts[found.parts.a];
    const bool is_a_fast = is_fast(a), is_b_fast = !is_wall && is_fast(parts[found.parts.b]);
    const Real time = is_wall ? time_in_wall(found, a) : time_in_part(found, a, parts[found.parts.b]);
    if (is_a_fast) stop(found.a, time, is_wall ? Stop<Real>::nobody : found.b);
    if (is_b_fast) stop(found.b, time, found.a);
  }
  [[nodiscard]] bool collide(std::uint32_t i, std::uint32_t j) const {
    return world_.collide(i, j) && !std::ranges::binary_search(joined_, BodyPair(std::min(i, j), std::max(i, j)));
  }
  /// What a part passes in the step, with room for its turn.
  [[nodiscard]] Bounds<Real, Dim> swept_by(const RigidPart<Real, Dim>& part) const {
    const RigidBody<Real, Dim>& body = bodies_[part.body];
    return grown(united(pairs_.bounds_at(part, part.pose(before(body))), pairs_.bounds_at(part, part.pose(body))),
                 std::min(length(Vector<Real, Dim>(body.x - body.x_before)) + turn(part), part.reach));
  }
  void find_first_contact(const RigidPart<Real, Dim>& part, std::span<const PartPair> near) {
    if (near.empty() && world_.meshes().empty() && world_.walls().empty()) return;
    const RigidBody<Real, Dim>& body = bodies_[part.body];
    const MovingBody<Real, Dim> moving = motion_of(part, body, step_);
    for (std::uint32_t k = 0; k < world_.walls().size(); ++k)
      if (!has_contact(part, k)) stop(part.body, time_at_wall(moving, k, part));
    for (const PartPair& pair : near) {
      const RigidPart<Real, Dim>& other = pairs_.parts()[pair.b];
      if (!collide(part.body, other.body)) continue;
      if (world_.traits(other.body).is_sensor || has_contact(part, other)) continue;
      const auto contact = first_contact(moving, motion_of(other, bodies_[other.body], step_), stops_[part.body].time,
                                         part.inner_radius / 100);
      if (contact && contact->time > Real(0)) stop(part.body, contact->time, other.body);
    }
    for (const WorldMesh<Real, Dim>& mesh : world_.meshes())
      if (mesh.collides(world_.traits(part.body)))
        stop(part.body, time_before_passing(moving, *mesh.geometry, part.inner_radius, stops_[part.body].time, step_));
  }
  /// The parts of other bodies that each fast part may meet on its way, and pass, in the order of their numbers: fast
  /// ones on their ways, and others where the step began, with the margin of contacts. The rooms of the pairs are
  /// larger by what has been before, and their tree has an order of its own: a run that goes on from a snapshot has
  /// others.
  void find_near() {
    if (passing_.empty() && pairs_.still().empty()) return;
    swept_.resize(fast_.size());
    team_.for_each(0, fast_.size(), 64, [&](std::size_t from, std::size_t to) {
      for (std::size_t k = from; k < to; ++k) swept_[k] = swept_by(pairs_.parts()[fast_[k]]);
    });
    near_ = collected<PartPair>(fast_.size(), [this](std::size_t k, auto& list) { find_near_still(k, list); });
    find_near_fast();
    std::ranges::sort(near_);
  }
  void find_near_still(std::size_t k, std::vector<PartPair>& near) const {
    const auto meet = [&](std::uint32_t j) {
      if (ways_[j] != Way::passes_nothing || !matters(fast_[k], j)) return;
      const RigidPart<Real, Dim>& part = pairs_.parts()[j];
      if (overlap(swept_[k], pairs_.bounds_of_contacts(part, before(bodies_[part.body]), step_)))
        near.push_back({fast_[k], j});
    };
    if (ways_[fast_[k]] >= Way::passes_slow) {
      pairs_.for_each_overlap(swept_[k], meet);
    } else if (!pairs_.still().empty()) {
      pairs_.for_each_still(swept_[k], meet);
    }
  }
  /// Pairs of fast parts, of which one can pass others that move, twice.
  void find_near_fast() {
    if (passing_.empty()) return;
    std::vector<std::uint8_t> passes(fast_.size());
    for (const std::uint32_t k : passing_) passes[k] = 1;
    const auto meet_in = [&](std::vector<PartPair>& near, std::uint32_t k, std::uint32_t n) {
      if ((passes[k] | passes[n]) == 0 || !matters(fast_[k], fast_[n])) return;
      near.push_back({fast_[k], fast_[n]}), near.push_back({fast_[n], fast_[k]});
    };
    if (passing_.size() * fast_.size() <= most_tests) {
      for (const std::uint32_t k : passing_)
        for (std::uint32_t n = 0; n < swept_.size(); ++n)
          if ((passes[n] == 0 || n > k) && !are_apart(swept_[k], swept_[n])) meet_in(near_, k, n);
      return;
    }
    if (sweep(meet_in)) return;
    BoundsTree<Real, Dim>(swept_).for_each_pair([&](std::uint32_t k, std::uint32_t n) { meet_in(near_, k, n); });
  }
  /// The same where it is faster to go along an axis; else nothing, and false.
  template <class MeetIn>
  [[nodiscard]] bool sweep(MeetIn&& meet_in) {
    using Sorted = SortedBounds<Real, Dim>;
    Sorted sorted;
    if (!sorted.sort(swept_, Sorted::most_compared)) return false;
    std::vector<std::vector<PartPair>> lists(std::clamp<std::size_t>(sorted.size() / 64, 1, 256));
    std::atomic<bool> is_slow = false;
    team_.share(lists.size(), [&](std::size_t block) {
      const std::size_t from = sorted.size() * block / lists.size(), to = sorted.size() * (block + 1) / lists.size();
      const auto meet = [&](std::uint32_t k, std::uint32_t n) { meet_in(lists[block], k, n); };
      if (!sorted.for_each_pair(from, to, Sorted::most_of(to - from), meet)) is_slow = true;
    });
    if (is_slow) return false;
    for (const auto& list : lists) near_.insert(near_.end(), list.begin(), list.end());
    return true;
  }
  [[nodiscard]] bool matters(std::uint32_t i, std::uint32_t j) const {
    const auto parts = pairs_.parts();
    return parts[i].body != parts[j].body && may_pass(parts[i], parts[j]);
  }
  /// The body at the beginning of the step.
  [[nodiscard]] RigidBody<Real, Dim> before(const RigidBody<Real, Dim>& body) const {
    RigidBody<Real, Dim> then = body;
    then.x = body.x_before, then.orientation = body.orientation_before, then.axes = rotation(then.orientation);
    if (const auto i = static_cast<std::size_t>(&body - bodies_.data()); !body.is_fixed())
      then.v = world_.velocity[i], then.spin = world_.spin[i];
    return then;
  }
  /// When a part first touches a wall; the end of the step where it does not, or has been in it from the beginning.
  [[nodiscard]] Real time_at_wall(const MovingBody<Real, Dim>& moving, std::uint32_t number,
                                  const RigidPart<Real, Dim>& part) const {
    const Wall<Real, Dim> wall = facing(world_.walls()[number], bodies_[part.body].x_before);
    const Convex<Real, Dim> point = {.core = {.corners = {{}}}};
    const MovingBody<Real, Dim> of_wall = {.shape = &point, .position = wall.normal * wall.offset};
    const MovingPair<Real, Dim> pair{moving, of_wall};
    const Real time = pair.time_of_overlap(-wall.normal, Real(0), part.inner_radius / 100, Real(0), step_);
    return time > Real(0) ? time : step_;
  }
  [[nodiscard]] Real time_in_wall(const PartContact<Real, Dim>& found, const RigidPart<Real, Dim>& part) const {
    const auto& first = found.contact.points[0];
    const Convex<Real, Dim> point = {.core = {.corners = {{}}}};
    const MovingBody<Real, Dim> of_wall = {
        .shape = &point,
        .position = bodies_[found.a].x_before + first.arm_a + found.contact.normal * (first.separation / 2)};
    return time_of_depth(motion_of(part, bodies_[found.a], step_), of_wall, found.contact.normal, part.inner_radius / 4,
                         step_);
  }
  [[nodiscard]] Real time_in_part(const PartContact<Real, Dim>& found, const RigidPart<Real, Dim>& a,
                                  const RigidPart<Real, Dim>& b) const {
    return time_of_depth(motion_of(a, bodies_[found.a], step_), motion_of(b, bodies_[found.b], step_),
                         std::min(a.inner_radius, b.inner_radius) / 4, step_);
  }
  /// Two bodies that both move may overlap for a while, and are pushed apart: to stop one of them where the other one
  /// goes on does harm. Only what would pass right through has to be stopped.
  [[nodiscard]] bool may_pass(const RigidPart<Real, Dim>& a, const RigidPart<Real, Dim>& b) const {
    if (bodies_[a.body].is_fixed() || bodies_[b.body].is_fixed()) return true;
    const Vector<Real, Dim> of_a = bodies_[a.body].x - bodies_[a.body].x_before;
    const Vector<Real, Dim> of_b = bodies_[b.body].x - bodies_[b.body].x_before;
    return length(Vector<Real, Dim>(of_a - of_b)) > a.inner_radius + b.inner_radius;
  }
  /// The solver has taken care of those.
  [[nodiscard]] bool has_contact(const RigidPart<Real, Dim>& a, const RigidPart<Real, Dim>& b) const {
    const auto* const first = pairs_.parts().data();
    const auto i = static_cast<std::uint32_t>(&a - first), j = static_cast<std::uint32_t>(&b - first);
    return has_contact(PartPair{std::min(i, j), std::max(i, j)});
  }
  [[nodiscard]] bool has_contact(const RigidPart<Real, Dim>& part, std::uint32_t wall) const {
    const auto parts = pairs_.parts();
    return has_contact(
        PartPair{static_cast<std::uint32_t>(&part - parts.data()), static_cast<std::uint32_t>(parts.size()) + wall});
  }
  [[nodiscard]] bool has_contact(const PartPair& pair) const {
    const auto at = std::ranges::lower_bound(contacts_, pair, {}, &PartContact<Real, Dim>::parts);
    return at != contacts_.end() && at->parts == pair && at->contact.size > 0;
  }
  /// How far the turn of its body moves a part at most.
  [[nodiscard]] Real turn(const RigidPart<Real, Dim>& part) const {
    const RigidBody<Real, Dim>& body = bodies_[part.body];
    return length(spin_between(body.orientation_before, body.orientation, step_)) * step_ * part.reach;
  }
  void stop(std::uint32_t body, const Real& time, std::uint32_t at = Stop<Real>::nobody) {
    if (time < stops_[body].time) stops_[body] = {time, at};
  }

  static constexpr std::size_t most_tests = 1 << 16;  // of bounds, one by one: some 0.1 ms

  ThreadTeam& team_;
  const World<Real, Dim>& world_;
  const RigidPairs<Real, Dim>& pairs_;
  std::span<const PartContact<Real, Dim>> contacts_;
  std::span<const BodyPair> joined_;
  Real step_;
  std::span<const RigidBody<Real, Dim>> bodies_;
  std::vector<Stop<Real>> stops_;
  std::vector<Way> ways_;                 // of each part
  std::vector<std::uint32_t> fast_;       // the parts that are
  std::size_t passing_slow_ = 0;          // how many of them can pass slow ones
  std::vector<std::uint32_t> passing_;    // the places there of those that can pass others that move
  std::vector<Bounds<Real, Dim>> swept_;  // by the fast ones
  std::vector<PartPair> near_;            // fast ones, and what they may meet
};

/// Puts a body back to where it was at a time of the step.
template <class Real, int Dim>
void put_back(RigidBody<Real, Dim>& body, const Real& time, const Real& step) {
  const Spin<Real, Dim> spin = spin_between(body.orientation_before, body.orientation, step);
  body.x = body.x_before + (body.x - body.x_before) * (time / step);
  body.orientation = turned(body.orientation_before, spin, time);
  const Matrix<Real, Dim> axes = body.axes;
  body.update_axes();
  // The spin goes back with the body: about other axes of the body, the same spin would be another energy.
  if constexpr (Dim == 3) body.spin = body.axes * Pose<Real, Dim>{{}, axes}.local_direction(body.spin);
}
/// Moves a body that has stopped at a driven one along with this to the end of the step: else that would pass it.
template <class Real, int Dim>
void carry_along(RigidBody<Real, Dim>& body, const RigidBody<Real, Dim>& driven, const Real& time, const Real& step) {
  const Spin<Real, Dim> spin = spin_between(driven.orientation_before, driven.orientation, step);
  const Vector<Real, Dim> then = driven.x_before + (driven.x - driven.x_before) * (time / step);
  const Pose<Real, Dim> axes_then{{}, rotation(turned(driven.orientation_before, spin, time))};
  body.x = driven.x + rotation(driven.orientation) * axes_then.local_direction(body.x - then);
  body.orientation = turned(body.orientation, spin, step - time);
  body.update_axes();
}

/// Stops fast bodies. Returns how many. `bodies` have the world's bodies first.
template <class Real, int Dim>
std::size_t stop_fast_bodies(ThreadTeam& team, const World<Real, Dim>& world, RigidPairs<Real, Dim>& pairs,
                             std::span<const PartContact<Real, Dim>> contacts, std::span<const BodyPair> joined,
                             const Real& step, std::span<RigidBody<Real, Dim>> bodies) {
  StoppingTimes<Real, Dim> times(team, world, pairs, contacts, joined, step, bodies);
  if (!times.may_stop()) return 0;
  times.find_first_contacts();
  times.find_depths();
  std::size_t stopped = 0;
  for (std::size_t i = 0; i < world.size(); ++i) {
    const Stop<Real> stop = times.stops()[i];
    if (!(stop.time < step)) continue;
    put_back(bodies[i], stop.time, step);
    if (stop.at != Stop<Real>::nobody && bodies[stop.at].is_fixed())
      carry_along(bodies[i], bodies[stop.at], stop.time, step);
    ++stopped;
  }
  return stopped;
}

}  // namespace continuo
