// An instant at which bodies touch: the impulses of what approaches, and then which contacts last.
#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include <continuo/bodies/contacts/complementarity.hpp>
#include <continuo/bodies/contacts/endless_collisions.hpp>
#include <continuo/bodies/event_driven/exact_engine.hpp>
#include <continuo/bodies/exact_rigid/friction_cones.hpp>
#include <continuo/bodies/exact_rigid/friction_modes.hpp>
#include <continuo/bodies/exact_rigid/reduced_contacts.hpp>

namespace continuo {

/// A point at which two parts touch, or a limit at which a joint is, with the numbers of their bodies in the system.
template <class Real, int Dim>
struct TouchingPoint {
  std::uint32_t pair = 0;  // of parts; each limit has a number of its own
  std::uint32_t a = 0, b = 0;
  Vector<Real, Dim> normal{}, place{};  // the normal is from a to b
  Material<Real> material{};            // of both surfaces
  std::optional<ContactFeature<Real, Dim>> feature{};
  Real gap{};
  std::optional<JointLimit> limit{};
  Real slow{};  // of a limit: what parts no faster than this may be held by it
};

template <class Real, int Dim>
class ContactInstant {
 public:
  using V = Vector<Real, Dim>;
  using Row = MotionRow<Real, Dim>;
  using Point = TouchingPoint<Real, Dim>;
  using System = RigidSystem<Real, Dim>;

  /// Points are sorted by their pairs. Approaches up to `slow` are no impacts where a contact loses energy. `noise` is
  /// the error of velocities.
  ContactInstant(System& system, std::span<const Point> points, const Real& slow, const Real& noise)
      : system_(system), points_(points), slow_(slow), noise_(noise), rounding_(points.size()) {}

  /// Moves bodies apart that lie in each other, on the shortest way in the metric of the masses, and no point into
  /// another. What searches for contacts leave of a gap, some roundings each time, would add up where a body bounces
  /// ever faster.
  void separate() {
    const std::vector<Row> joints = system_.joint_rows();
    std::vector<Row> rows;
    std::vector<Real> gaps;
    for (std::size_t k = 0; k < points_.size(); ++k) rows.push_back(row_of(k)), gaps.push_back(points_[k].gap);
    ReducedContacts<Real, Dim> reduced(body_data(), joints, rows);
    const std::vector<Real> ways = complementary_forces<Real>(reduced.matrix(), gaps, Real(0));
    if (ways.empty()) return;
    const std::vector<Real> answers = reduced.answers(std::vector<Real>(joints.size()), ways);
    for (std::size_t r = 0; r < rows.size(); ++r) shift(rows[r], ways[r]);
    for (std::size_t r = 0; r < joints.size(); ++r) shift(joints[r], answers[r]);
  }

  /// A motor without a greatest force strikes a joint that does not have its speed.
  void turn_motors() {
    constexpr Real small = std::is_same_v<Real, float> ? Real(1e-4) : Real(1e-8);
    bool any = false;
    for (std::size_t j = 0; j < system_.joints().size(); ++j) {
      const auto& joint = system_.joints()[j];
      if (joint.motor != MotorMode::keeps_speed || std::isfinite(joint.joint.motor->most)) continue;
      const Real speed = joint.joint.motor->speed;
      any = any || std::abs(speed - system_.motor_rate(j)) > small * std::max(std::abs(speed), Real(1));
    }
    if (!any) return;
    const std::vector<Row> joints = system_.struck_joint_rows();
    apply(joints, ReducedContacts<Real, Dim>(body_data(), joints, {}).answers(joint_rates(joints), {}));
  }

  /// Resolves all impacts. Those that approach are struck together, in rounds, until none approaches: a round can bring
  /// others together. So the energy never grows, and is kept where restitution is 1 and nothing rubs: with u before and
  /// u' = -e u or more after, impulses f add f . (u + u') / 2, and u < 0 of all.
  /// Contacts at rest are struck too where nothing bounces, and else only once something makes them approach: so the
  /// last of some balls in a row leaves as fast as the first came. Calls `struck(k, impulse)` for every impulse along
  /// the normal of point k.
  template <class Struck>
  [[nodiscard]] Status strike(Struck&& struck) {
    constexpr std::uint32_t most_rounds = 10'000;
    for (std::uint32_t round = 0; round < most_rounds; ++round) {
      std::vector<std::size_t> approaching;
      note_rounding();
      for (std::size_t k = 0; k < points_.size(); ++k)
        if (rate_of(k) < -rounding_of(k)) approaching.push_back(k);
      if (approaching.empty()) return {};
      if (std::ranges::none_of(approaching, [&](std::size_t k) { return bounces(k, round); })) add_closed(approaching);
      if (Status fault = strike_together(approaching, round, struck); !fault) return fault;
    }
    return cannot_continue("the impact does not end, bodies are jammed between others");
  }

  /// Of the contacts that do not part, those that last: forces press them together.
  [[nodiscard]] Status choose_lasting(const Real& t) {
    system_.find_free_motion(t);
    closed_.clear(), lasting_.clear();
    for (std::size_t k = 0; k < points_.size(); ++k)
      if (std::abs(rate_of(k)) <= slow_of(k)) closed_.push_back(k);
    if (closed_.empty()) return {};
    for (const std::size_t k : closed_)
      if (!points_[k].feature && !points_[k].limit)
        return cannot_continue(
            "two bodies touch by features of which the exact motion cannot keep a contact: sharp "
            "corners or edges that lie on each other");
    for (const std::size_t k : closed_)
      if (points_[k].material.friction > Real(0)) return choose_with_friction();
    return choose_without_friction();
  }
  struct LastingPoint {
    std::size_t point = 0;
    Rubbing rubbing = Rubbing::none;
    V slip{};                           // in space: as in ActingContact
    Real steady_below{}, ends_below{};  // likewise
  };
  [[nodiscard]] std::span<const LastingPoint> lasting() const { return lasting_; }
  /// Points that neither part nor approach.
  [[nodiscard]] std::span<const std::size_t> closed() const { return closed_; }

 private:
  using Moved = Moving<Real, Dim>;

  /// Whether point k, which approaches, is to part again in this round.
  [[nodiscard]] bool bounces(std::size_t k, std::uint32_t round) const {
    const bool ends = is_endless(points_[k].material.restitution, round),
               is_gentle = loses(k) && (ends || rate_of(k) >= -slow_);
    return !is_gentle && points_[k].material.restitution > Real(0);
  }
  /// Adds the points that neither part nor approach, in order.
  void add_closed(std::vector<std::size_t>& approaching) const {
    for (std::size_t k = 0; k < points_.size(); ++k)
      if (std::abs(rate_of(k)) <= rounding_of(k)) approaching.push_back(k);
    std::ranges::sort(approaching);
  }

  [[nodiscard]] const ExactBody<Real, Dim>& body(std::uint32_t k) const { return std::as_const(system_).bodies()[k]; }
  [[nodiscard]] Row row_of(std::size_t k) const {
    const Point& at = points_[k];
    if (at.limit) return system_.limit_row(*at.limit);
    Row row = row_along(body(at.a), body(at.b), Moved{at.normal, {}}, Moved{at.place, {}});
    row.a = at.a, row.b = at.b;
    return row;
  }
  [[nodiscard]] Row across_of(std::size_t k) const {
    const Point& at = points_[k];
    if (at.limit) return nothing_across(at);
    V across = at.normal;
    across[0] = -at.normal[1], across[1] = at.normal[0];
    Row row = row_along(body(at.a), body(at.b), Moved{across, {}}, Moved{at.place, {}});
    row.a = at.a, row.b = at.b;
    return row;
  }
  /// A limit does not rub.
  [[nodiscard]] static Row nothing_across(const Point& limit) {
    Row row;
    row.a = limit.a, row.b = limit.b;
    return row;
  }
  [[nodiscard]] Real rate_of(const Row& row) const { return row.rate_of(body(row.a), body(row.b)); }
  [[nodiscard]] Real rate_of(std::size_t k) const { return rate_of(row_of(k)); }
  /// The rounding of a rate, that of all speeds which the bodies have had at this instant, and what forces would make
  /// of it in a millionth of the contact time.
  [[nodiscard]] Real rounding_of(std::size_t k) const { return std::max(rounding_[k], rounding_now(k)); }
  [[nodiscard]] Real rounding_now(std::size_t k) const {
    const Row row = row_of(k);
    const auto speed = [](const auto& of, const auto& lever) { return length(of.v) + length(lever) * length(of.spin); };
    return std::max(Real(slow_ / 1'000'000), Real(64 * std::numeric_limits<Real>::epsilon() *
                                                  (speed(body(row.a), row.lever_a) + speed(body(row.b), row.lever_b))));
  }
  /// What an impact stops keeps the rounding of the speed that it had.
  void note_rounding() {
    for (std::size_t k = 0; k < points_.size(); ++k) rounding_[k] = rounding_of(k);
  }
  [[nodiscard]] bool loses(std::size_t k) const {
    return points_[k].material.restitution < Real(1) || points_[k].material.friction > Real(0);
  }
  [[nodiscard]] Real slow_of(std::size_t k) const {
    const Real slow = points_[k].limit ? points_[k].slow : slow_;
    return std::max(Real(16 * rounding_of(k)), loses(k) ? slow : Real(0));
  }
  [[nodiscard]] std::vector<Real> joint_rates(const std::vector<Row>& joints) const {
    std::vector<Real> rates;
    for (const Row& row : joints) rates.push_back(rate_of(row) - row.rate);
    return rates;
  }
  void apply(const Row& row, const Real& impulse) {
    const V along = row.direction * impulse;
    system_.bodies()[row.b].push(along, Spin<Real, Dim>(row.lever_b * impulse));
    system_.bodies()[row.a].push(-along, Spin<Real, Dim>(row.lever_a * -impulse));
  }
  void shift(const Row& row, const Real& way) {
    const auto move = [&](std::uint32_t k, const Spin<Real, Dim>& lever, const Real& signed_way) {
      ExactBody<Real, Dim>& moved = system_.bodies()[k];
      if (moved.is_fixed()) return;
      moved.x += row.direction * (signed_way * moved.inverse_mass);
      const Spin<Real, Dim> turn(moved.inverse_inertia_now * (lever * signed_way));
      moved.orientation = turned(moved.orientation, turn, Real(1));
      moved.turn_with_momentum();
    };
    move(row.b, row.lever_b, way), move(row.a, row.lever_a, -way);
  }
  void apply(const std::vector<Row>& rows, std::span<const Real> impulses) {
    for (std::size_t r = 0; r < rows.size(); ++r) apply(rows[r], impulses[r]);
  }

  [[nodiscard]] const ExactBody<Real, Dim>* body_data() const { return std::as_const(system_).bodies().data(); }

  template <class Struck>
  [[nodiscard]] Status strike_together(const std::vector<std::size_t>& approaching, std::uint32_t round,
                                       Struck&& struck) {
    const std::vector<Row> joints = system_.struck_joint_rows();
    std::vector<Row> rows;
    std::vector<Real> before, rate_after;
    bool rubs = false;
    for (const std::size_t k : approaching) {
      rows.push_back(row_of(k));
      before.push_back(rate_of(rows.back()));
      rate_after.push_back(bounces(k, round) ? -points_[k].material.restitution * before.back() : Real(0));
      rubs = rubs || points_[k].material.friction > Real(0);
    }
    std::vector<Real> impulses;
    if (rubs) {
      if (Status fault = find_rubbing_impulses(approaching, joints, before, rate_after, rows, impulses); !fault)
        return fault;
    } else {
      ReducedContacts<Real, Dim> reduced(body_data(), joints, rows);
      std::vector<Real> q = before;
      for (std::size_t k = 0; k < q.size(); ++k) q[k] -= rate_after[k];
      const std::vector<Real> rates = reduced.rates(joint_rates(joints), q);
      constexpr Real rounding = std::numeric_limits<Real>::epsilon();
      Real greatest(0);
      for (const Real& rate : rates) greatest = std::max(greatest, std::abs(rate));
      impulses = complementary_forces<Real>(reduced.matrix(), rates, Real(16 * rounding * greatest));
      if (impulses.empty()) return cannot_continue("bodies are jammed between others");
      if (greatest_error<Real>(reduced.matrix(), rates, impulses) > std::sqrt(rounding) * greatest)
        return cannot_continue("their masses differ too much");
    }
    ReducedContacts<Real, Dim> reduced(body_data(), joints, rows);
    const std::vector<Real> answers = reduced.answers(joint_rates(joints), impulses);
    apply(rows, impulses), apply(joints, answers);
    for (std::size_t k = 0; k < approaching.size(); ++k) struck(approaching[k], impulses[rubs ? normal_place(k) : k]);
    return {};
  }

  // With friction.

  [[nodiscard]] static Status jammed() {
    return cannot_continue(
        "no forces of contacts with friction belong together: bodies jam (Painleve's paradox), or "
        "too many rub at once");
  }
  /// The rows of these points, and after them one across for each of their pairs; the pairs by their places.
  [[nodiscard]] FrictionProblem<Real> problem_of(std::span<const std::size_t> points, std::vector<Row>& rows,
                                                 std::vector<std::size_t>& leaders) const {
    FrictionProblem<Real> problem;
    leaders.clear();
    for (const std::size_t k : points) {
      if (leaders.empty() || points_[leaders.back()].pair != points_[k].pair) {
        leaders.push_back(k);
        problem.pairs.push_back({.friction = points_[k].material.friction});
      }
      problem.pair_of_point.push_back(static_cast<std::uint32_t>(leaders.size() - 1));
    }
    for (const std::size_t k : leaders) rows.push_back(across_of(k));
    return problem;
  }
  /// Newton's law along the normals, Coulomb's law across with the velocities after the impact. Where these two would
  /// add energy (T. R. Kane, D. A. Levinson, "Dynamics", 1985), restitution is lowered until they do not. Adds the rows
  /// across to `rows`.
  [[nodiscard]] Status find_rubbing_impulses(const std::vector<std::size_t>& approaching,
                                             const std::vector<Row>& joints, const std::vector<Real>& before,
                                             const std::vector<Real>& rate_after, std::vector<Row>& rows,
                                             std::vector<Real>& impulses) {
    std::vector<std::size_t> leaders;
    auto problem = problem_of_impact(approaching, rows, leaders);
    ReducedContacts<Real, Dim> reduced(body_data(), joints, rows);
    problem.matrix.assign(reduced.matrix().begin(), reduced.matrix().end());
    std::vector<Real> rates;
    for (const Row& row : rows) rates.push_back(rate_of(row));
    const std::vector<Real> free = reduced.rates(joint_rates(joints), rates);
    const auto solve = [&](const Real& share) {
      problem.rates = free;
      for (std::size_t k = 0; k < before.size(); ++k) problem.rates[normal_place(k)] -= share * rate_after[k];
      return Forces(problem).solve();
    };
    const auto gain = [&](const std::vector<Real>& forces) {
      Real sum(0);
      for (std::size_t r = 0; r < rows.size(); ++r) {
        Real after = free[r];
        for (std::size_t c = 0; c < rows.size(); ++c) after += problem.matrix[c * rows.size() + r] * forces[c];
        sum += forces[r] * (free[r] + after) / 2;
      }
      return sum;
    };
    auto found = solve(Real(1));
    if (found && gain(found->forces) > Real(0)) {
      Real low(0), high(1);
      for (int round = 0; round < std::numeric_limits<Real>::digits; ++round) {
        const auto trial = solve((low + high) / 2);
        (trial && !(gain(trial->forces) > Real(0)) ? low : high) = (low + high) / 2;
      }
      found = solve(low);
    }
    if (!found) return jammed();
    impulses = found->forces;
    return {};
  }
  /// Of the plane: the points along the normal, then the pairs across it; of space: of each point its three rows.
  /// @{
  using Forces = std::conditional_t<Dim == 2, FrictionModes<Real>, FrictionCones<Real>>;
  [[nodiscard]] static std::size_t normal_place(std::size_t k) { return Dim == 2 ? k : 3 * k; }
  [[nodiscard]] auto problem_of_impact(std::span<const std::size_t> points, std::vector<Row>& rows,
                                       std::vector<std::size_t>& leaders) const {
    if constexpr (Dim == 2) {
      return problem_of(points, rows, leaders);
    } else {
      ConeProblem<Real> problem;
      rows.clear();
      for (const std::size_t k : points) {
        const Point& at = points_[k];
        problem.contacts.push_back({.friction = at.limit ? Real(0) : at.material.friction});
        rows.push_back(row_of(k));
        if (at.limit) {
          rows.insert(rows.end(), 2, nothing_across(at));
          continue;
        }
        for (const Moved& tangent : tangents(Moved{at.normal, {}})) {
          Row row = row_along(body(at.a), body(at.b), tangent, Moved{at.place, {}});
          row.a = at.a, row.b = at.b;
          rows.push_back(row);
        }
      }
      return problem;
    }
  }
  /// @}
  [[nodiscard]] Status choose_with_friction() {
    if constexpr (Dim == 3) {
      return choose_in_space();
    } else {
      std::vector<Row> rows, plain;
      std::vector<std::size_t> leaders;
      for (const std::size_t k : closed_) rows.push_back(lasting_row(k, false));
      FrictionProblem<Real> problem = problem_of(closed_, plain, leaders);
      for (std::size_t p = 0; p < leaders.size(); ++p) {
        rows.push_back(lasting_row(leaders[p], true));
        const Real slip = rate_of(rows.back()), slow = slow_of(leaders[p]);
        auto& pair = problem.pairs[p];
        pair.may_stick = std::abs(slip) <= slow;
        pair.may_go_forwards = slip >= -slow, pair.may_go_backwards = slip <= slow;
      }
      if (!take_motion(problem, rows)) return {};
      const auto found = FrictionModes<Real>(problem).solve();
      if (!found) return jammed();
      for (std::size_t k = 0; k < closed_.size(); ++k)
        if (found->presses[k]) lasting_.push_back({closed_[k], found->rubbing[problem.pair_of_point[k]], {}, {}});
      return {};
    }
  }
  /// Gives a problem of forces the responses of these rows and their accelerations without forces. False where all of
  /// them are 0.
  template <class Problem>
  [[nodiscard]] bool take_motion(Problem& problem, const std::vector<Row>& rows) const {
    const std::vector<Row> joints = system_.joint_rows();
    ReducedContacts<Real, Dim> reduced(body_data(), joints, rows);
    problem.matrix.assign(reduced.matrix().begin(), reduced.matrix().end());
    problem.rates = reduced.rates(accelerations(joints), accelerations(rows));
    return std::ranges::any_of(problem.rates, [](const Real& rate) { return rate != Real(0); });
  }
  /// Up to this speed a slip is none but for errors.
  [[nodiscard]] Real least_slip(std::size_t k) const { return std::max(rounding_of(k), noise_); }
  [[nodiscard]] Status choose_in_space() {
    std::vector<Row> rows;
    ConeProblem<Real> problem;
    std::vector<std::array<V, 2>> across;
    for (const std::size_t k : closed_) {
      const Point& at = points_[k];
      rows.push_back(lasting_row(k, false));
      if (at.limit) {
        rows.insert(rows.end(), 2, nothing_across(at));
        across.emplace_back();
        problem.contacts.push_back({.friction = Real(0)});
        continue;
      }
      const ContactPlace<Real, Dim> place = place_of(*at.feature, body(at.a), body(at.b));
      std::array<Real, 2> slip{};
      for (std::size_t i = 0; i < 2; ++i) {
        Row row = tangent_rows(place, body(at.a), body(at.b))[i];
        row.a = at.a, row.b = at.b;
        slip[i] = rate_of(row);
        rows.push_back(row);
      }
      across.push_back({rows[rows.size() - 2].direction, rows.back().direction});
      ConeContact<Real> contact{.friction = at.material.friction};
      const Real speed = std::hypot(slip[0], slip[1]);
      if (speed > least_slip(k)) contact.slip = {slip[0] / speed, slip[1] / speed};
      problem.contacts.push_back(contact);
    }
    if (!take_motion(problem, rows)) return {};
    const auto found = FrictionCones<Real>(problem).solve();
    if (!found) return jammed();
    for (std::size_t k = 0; k < closed_.size(); ++k) {
      if (found->modes[k] == ConeMode::open) continue;
      LastingPoint one{.point = closed_[k]};
      if (problem.contacts[k].friction > Real(0))
        one.rubbing = found->modes[k] == ConeMode::sticks ? Rubbing::sticks : Rubbing::forwards;
      if (one.rubbing == Rubbing::forwards) {
        one.slip = across[k][0] * found->slips[k][0] + across[k][1] * found->slips[k][1];
        const Real least = least_slip(closed_[k]);
        (problem.contacts[k].slip ? one.ends_below : one.steady_below) =
            problem.contacts[k].slip ? least / 2 : 100 * least;
      }
      lasting_.push_back(one);
    }
    return {};
  }
  [[nodiscard]] Status choose_without_friction() {
    std::vector<Row> rows;
    for (const std::size_t k : closed_) rows.push_back(lasting_row(k, false));
    const std::vector<Row> joints = system_.joint_rows();
    ReducedContacts<Real, Dim> reduced(body_data(), joints, rows);
    const std::vector<Real> q = reduced.rates(accelerations(joints), accelerations(rows));
    Real greatest(0);
    for (const Real& value : q) greatest = std::max(greatest, std::abs(value));
    const Real least = (std::is_same_v<Real, float> ? Real(1e-4) : Real(1e-11)) * greatest;
    const std::vector<Real> forces = complementary_forces<Real>(reduced.matrix(), q, least);
    if (forces.empty()) return cannot_continue("the forces of contacts cannot be found");
    for (std::size_t k = 0; k < closed_.size(); ++k)
      if (forces[k] > Real(0)) lasting_.push_back({closed_[k], Rubbing::none, {}, {}});
    return {};
  }
  [[nodiscard]] Row lasting_row(std::size_t k, bool is_across) const {
    const Point& at = points_[k];
    if (at.limit) return is_across ? nothing_across(at) : system_.limit_row(*at.limit);
    const ContactPlace<Real, Dim> place = place_of(*at.feature, body(at.a), body(at.b));
    Row row = normal_row(place, body(at.a), body(at.b));
    if constexpr (Dim == 2) {
      if (is_across) row = across_row(place, body(at.a), body(at.b));
    }
    row.a = at.a, row.b = at.b;
    return row;
  }
  [[nodiscard]] std::vector<Real> accelerations(const std::vector<Row>& rows) const {
    std::vector<Real> all;
    for (const Row& row : rows) all.push_back(system_.free_acceleration(row));
    return all;
  }

  System& system_;
  std::span<const Point> points_;
  Real slow_, noise_;
  std::vector<Real> rounding_;  // of each point, as far as noted
  std::vector<std::size_t> closed_;
  std::vector<LastingPoint> lasting_;
};

}  // namespace continuo
