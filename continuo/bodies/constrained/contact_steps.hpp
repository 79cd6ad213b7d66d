// A time step through contacts that begin, slip and end too often to be located one by one, or for which no consistent
// forces exist (bodies jammed by friction). The impulses of all contacts over the step are found together, so that no
// gap closes beyond zero, no impulse pulls, and friction either stops the slip or has the size of the Coulomb limit. J.
// J. Moreau, in "Nonsmooth Mechanics and Applications", CISM 302 (1988); M. Jean, Comput. Methods Appl. Mech. Eng. 177
// (1999) 235-257. The method is of first order in the step.
//
// A gap s with the normal n may close by the end of the step and no further: s + h n . (v_b - v_a) >= 0. The distance
// of two points on straight paths is a convex function of time, so that the gap at the end is no less than this linear
// estimate, and nothing overlaps. Bodies without a contact impulse follow their parabolas.
#pragma once
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include <continuo/bodies/contacts/newton_impulses.hpp>
#include <continuo/bodies/contacts/persistent_contact.hpp>
#include <continuo/bodies/contacts/projected_gauss_seidel.hpp>
#include <continuo/bodies/contacts/touching.hpp>
#include <continuo/bodies/world.hpp>

namespace continuo {

template <class Real, int Dim>
class ContactSteps {
 public:
  using V = Vector<Real, Dim>;
  using S = Spin<Real, Dim>;
  /// The mean force of a contact in the last step, from which the iteration of the next step starts.
  struct Pushed {
    Touching pair{};
    ContactImpulse<Real, Dim> force{};
    template <class Archive>
    void transfer(Archive& archive) {
      archive(pair), archive(force);
    }
  };
  struct Loads {
    std::span<const V> force;
    std::span<const S> torque;  // empty where there is none
    Real pull{};                // the greatest acceleration by them
    Real slow{};                // the speed that they give in a step of full length
  };

  /// Advances the world by h, except for its time. `pairs`, which are sorted, are those that may touch.
  void advance(World<Real, Dim>& world, std::span<const Touching> pairs, const Loads& loads, const Real& h) {
    const std::size_t n = world.size();
    begin(world, loads, h);
    list_rows(world, pairs, loads, h);
    find_impulses(loads, h);
    pushed_.clear();
    std::vector<bool> is_pushed(n + 1);
    for (std::size_t k = 0; k < listed_.size(); ++k) {
      const auto& row = sweeps_.rows()[k];
      if (!(row.impulse.press > Real(0))) continue;
      pushed_.push_back({listed_[k], row.impulse * (1 / h)});
      is_pushed[row.a] = is_pushed[row.b] = true;
    }
    fastest_ = change_ = Real(0);
    for (std::size_t i = 0; i < n; ++i) {
      if (world.is_fixed(i)) continue;
      const auto& now = sweeps_.mover(i + 1);
      const Real turned_by = world.radius[i] * length(S(now.spin - world.spin[i]));
      fastest_ = std::max({fastest_, length(world.velocity[i]), length(now.v), turned_by});
      change_ = std::max({change_, length(V(now.v - world.velocity[i])), turned_by});
      world.position[i] += is_pushed[i + 1] ? now.v * h : (world.velocity[i] + now.v) * (h / 2);
      world.orientation[i] = turned(world.orientation[i], S((world.spin[i] + now.spin) * (Real(1) / 2)), h);
      world.velocity[i] = now.v, world.spin[i] = now.spin;
    }
    const Real by_forces = loads.pull * h;
    if (by_forces > Real(0)) tolerance_ = std::clamp(Real(change_ / (10 * by_forces)), loosest / 1000, loosest);
  }

  [[nodiscard]] std::span<const Pushed> pushed() const { return pushed_; }
  /// Whether the impulses of the last step are right: a bound of the energy of what is wrong is at most that which
  /// forces give all bodies in a step and a hundredth of what impacts take; of many contacts four times as much, as
  /// theirs are found by sweeps only.
  [[nodiscard]] bool are_found() const { return error_ <= (are_few() ? Real(1) : Real(4)); }
  /// The pairs that touched, or nearly, in the last step.
  [[nodiscard]] std::span<const Touching> near() const { return listed_; }
  /// Takes over the contact forces of another engine, whose body i has the number to[i] here.
  void take_over(const ContactSteps& other, std::span<const std::uint32_t> to) {
    for (const Pushed& one : other.pushed_)
      if (const auto pair = one.pair.moved(to)) pushed_.push_back({*pair, one.force});
    std::ranges::sort(pushed_, {}, &Pushed::pair);
  }
  /// The greatest speed in the last step, and the greatest change of a velocity or of a spin times the radius.
  [[nodiscard]] Real fastest() const { return fastest_; }
  [[nodiscard]] Real greatest_change() const { return change_; }

  template <class Archive>
  void transfer(Archive& archive) {
    archive(pushed_), archive(tolerance_);
  }
  /// Whether the values that were read are possible for this world.
  [[nodiscard]] bool is_of(const World<Real, Dim>& world) const {
    return tolerance_ > Real(0) && tolerance_ <= loosest &&
           std::ranges::all_of(pushed_, [&](const Pushed& one) { return one.pair.is_of(world); });
  }

 private:
  using Row = typename ProjectedGaussSeidel<Real, Dim>::Row;
  static constexpr Real loosest = Real(1e-3);

  void begin(const World<Real, Dim>& world, const Loads& loads, const Real& h) {
    sweeps_.clear();
    for (std::size_t i = 0; i < world.size(); ++i) {
      auto& mover = sweeps_.mover(sweeps_.add(world, i));
      mover.v += loads.force[i] * (h * world.inverse_mass[i]);
      if (!loads.torque.empty()) mover.spin += loads.torque[i] * (h * world.inverse_inertia[i]);
    }
  }
  void list_rows(const World<Real, Dim>& world, std::span<const Touching> pairs, const Loads& loads, const Real& h) {
    listed_.clear();
    mass_ = Real(0);
    for (const Real& one : world.inverse_mass)
      if (one > Real(0)) mass_ += 1 / one;
    Real fastest(0);
    for (const V& v : world.velocity) fastest = std::max(fastest, squared(v));
    using std::sqrt;
    const Real reach = 2 * h * (sqrt(fastest) + 2 * loads.pull * h);
    auto known = pushed_.begin();
    for (const Touching& pair : pairs) {
      const Real gap = gap_of(world, pair);
      if (gap > reach) continue;
      PersistentContact<Real, Dim> contact(world, pair);
      contact.place(world, world.position, world.velocity, world.spin);
      auto& row = sweeps_.add(contact, pair.a + 1, pair.with_wall() ? 0 : pair.b + 1);
      row.least = -gap / h;
      if (!(gap > Real(0))) let_part(row, -gap, contact.arm, loads);
      while (known != pushed_.end() && known->pair < pair) ++known;
      if (known != pushed_.end() && known->pair == pair) row.begin_with(known->force * h);
      listed_.push_back(pair);
    }
  }
  /// Two bodies that overlap by errors separate again in the time in which a body falls its radius. They give way by a
  /// millionth of a radius under the weight of all bodies: what is wedged in between walls cannot separate, and no
  /// impulse would be large enough for it.
  void let_part(Row& row, const Real& overlap, const Real& radius, const Loads& loads) const {
    const Real rate = std::sqrt(loads.pull / radius), weight = mass_ * loads.slow;
    row.least = std::min(overlap, radius) * rate;
    if (weight > Real(0)) row.compliance = Real(1e-6) * radius * rate / weight;
  }
  /// Finds the impulses of all contacts, starting from the forces of the last step: by sweeps; where these do not come
  /// near enough, as where masses differ much, by Newton's method, of few contacts; by sweeps from impulses of 0, since
  /// the start may contain the force of an impact, which sweeps take back but slowly; and before the impulses are not
  /// found at all, by all means.
  void find_impulses(const Loads& loads, const Real& h) {
    constexpr int most_sweeps = 200, more = 4 * most_sweeps, many = 16 * most_sweeps;
    free_ = sweeps_.movers(), energy_ = sweeps_.energy();
    best_.assign(sweeps_.rows().size(), {}), error_ = std::numeric_limits<Real>::infinity();
    const Real scale = mass_ * loads.slow * loads.slow, least = tolerance_ * loads.pull * h;
    sweeps_.begin_and_sweep(least, most_sweeps);
    if (is_near(scale)) return;
    sweeps_.sweep(least, more);
    if (is_near(scale)) return;
    if (are_few()) {
      sweeps_.apply(free_, best_);
      sweeps_.apply(free_, NewtonImpulses<Real, Dim>(sweeps_, free_).find());
      if (is_near(scale)) return;
    }
    if (!are_few() || !are_found()) {
      sweeps_.restore(free_);
      sweeps_.sweep(least, many);
      if (is_near(scale)) return;
    }
    if (are_few() && !are_found()) {
      sweeps_.apply(free_, NewtonImpulses<Real, Dim>(sweeps_, free_).find_by_parts());
      if (is_near(scale)) return;
    }
    sweeps_.apply(free_, best_);
    for (int k = 0; k < 16 && !are_found(); ++k) {
      sweeps_.sweep(least, many);
      if (is_near(scale)) return;
    }
    sweeps_.apply(free_, best_);
  }
  /// Notes the present impulses if they are the best so far. Whether they are good enough: the energy of what is wrong
  /// is small beside that which forces give all bodies in a step, or beside a hundredth of what impacts take.
  [[nodiscard]] bool is_near(const Real& scale) {
    constexpr auto near = Real(0.01), near_of_many = Real(0.1), rounding = 1024 * std::numeric_limits<Real>::epsilon();
    const Real wrong = sweeps_.greatest_error_energy(), lost = std::max(Real(0), Real(energy_ - sweeps_.energy()));
    const Real error = wrong == Real(0) ? wrong : wrong / (scale + lost / 100 + rounding * energy_);
    if (!(error < error_)) return false;
    error_ = error;
    for (std::size_t k = 0; k < best_.size(); ++k) best_[k] = sweeps_.rows()[k].impulse;
    return error_ <= (are_few() ? near : near_of_many);
  }
  [[nodiscard]] bool are_few() const { return sweeps_.rows().size() <= NewtonImpulses<Real, Dim>::usual_rows; }

  ProjectedGaussSeidel<Real, Dim> sweeps_;  // body i at the place i + 1
  std::vector<Touching> listed_;            // of the rows
  std::vector<Pushed> pushed_;
  Real mass_{};  // of all bodies
  // While impulses are searched:
  std::vector<typename ProjectedGaussSeidel<Real, Dim>::Moving> free_;  // without impulses
  std::vector<ContactImpulse<Real, Dim>> best_;
  Real energy_{}, error_{};  // energy_: twice that of free_; error_: of best_, as in is_near
  Real fastest_{}, change_{};
  Real tolerance_ = loosest;  // a tenth of the last change, relative to the change by forces in a step
};

}  // namespace continuo
