#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <continuo/bodies/constrained/constrained_contacts.hpp>
#include <continuo/bodies/constrained/constrained_events.hpp>
#include <continuo/bodies/constrained/constrained_system.hpp>
#include <continuo/bodies/constrained/contact_steps.hpp>
#include <continuo/bodies/constrained/zeno_guard.hpp>
#include <continuo/bodies/contacts/collision_time.hpp>
#include <continuo/bodies/contacts/contact_time.hpp>
#include <continuo/bodies/contacts/touching.hpp>
#include <continuo/bodies/event_driven/exact_engine.hpp>
#include <continuo/methods/explicit_rk/dop853.hpp>
#include <continuo/methods/explicit_rk/rk4.hpp>
#include <continuo/solve/integrator.hpp>

namespace continuo {

namespace {

template <class Real, int Dim>
class ConstrainedMotion final : public ConstrainedContacts<Real, Dim> {
 public:
  using Base = ConstrainedContacts<Real, Dim>;
  using typename Base::S;
  using typename Base::V;
  using X = std::vector<Real>;

  ConstrainedMotion(World<Real, Dim>& world, const ExactOptions<Real>& options, Companions<Real, Dim>* companions)
      : Base(world, options), companions_(companions), options_(options) {
    const Real usual = usual_contact_time();
    contact_time_ = options.contact_time.value_or(usual);
    stride_ = std::max(contact_time_, Real(steps_of_contact_time * usual));
  }

  std::string advance_to(const Real& t) override {
    if (last_.size() != world_.size()) return "bodies have come or gone: the motion needs a `refresh`";
    std::size_t events = 0;
    resolved_.reset();  // a motion that is read from a snapshot has none
    while (world_.time < t) {
      if (++events > options_.most_events) return "more events than `most_events`: bodies may be caught between others";
      if (options_.is_interrupted()) return "interrupted";
      if (is_steady_ && !(room_ < never)) return stay(t);
      if (is_steady_ || farthest_from(begin_) > room_ / 2) return {};
      if (std::string fault = zeno_guard_.is_in_steps() ? step(t) : fly(t); !fault.empty()) return fault;
    }
    return {};
  }

  std::unique_ptr<ContactEngine<Real, Dim>> clone() const override {
    return std::make_unique<ConstrainedMotion>(*this);
  }
  void keep_within(const Real& room) override {
    room_ = room;
    begin_ = world_.position;
  }
  bool is_steady() const override { return is_steady_; }
  void let_go(const std::vector<bool>& leaves) override {
    std::vector<Touching> stay;
    for (const Lasting& one : lasting_)
      if (!leaves[one.pair.a] && !leaves[one.pair.b]) stay.push_back(one.pair);
    note_lasting(stay);
  }
  void take_over(const ContactEngine<Real, Dim>& other, std::span<const std::uint32_t> to) override {
    const auto& from = static_cast<const ConstrainedMotion&>(other);
    Base::take_over_contacts(from, to);
    steps_.take_over(from.steps_, to);
    if (from.world_.size() <= greatest_before_) return;  // the pace is that of the greatest
    greatest_before_ = from.world_.size();
    step_ = from.step_, lasted_ = from.lasted_, zeno_guard_ = from.zeno_guard_;
  }

  void save(ByteWriter& writer) override {
    writer(contact_time_), writer(stride_), writer(left_by_steps_), writer(step_), writer(lasted_), writer(last_),
        writer(lasting_);
    writer(together), writer(zeno_guard_), writer(steps_), writer(is_slow_), writer(is_steady_);
  }
  void load(ByteReader& reader) override {
    reader(contact_time_), reader(stride_), reader(left_by_steps_), reader(step_), reader(lasted_), reader(last_),
        reader(lasting_);
    reader(together), reader(zeno_guard_), reader(steps_), reader(is_slow_), reader(is_steady_);
    reader.expect(steps_.is_of(world_), "contacts of other bodies");
    reader.expect(zeno_guard_.is_possible(), "steps that cannot be");
    reader.expect(contact_time_ >= Real(0) && stride_ >= Real(0) && stride_ < never && lasted_ >= Real(0) &&
                      step_ >= Real(0) && step_ < never && last_.size() == world_.size() &&
                      together.size() == world_.size(),
                  "a motion of other bodies");
    for (const Lasting& one : lasting_) reader.expect(one.pair.is_of(world_), "contacts of other bodies");
    reader.expect(std::ranges::is_sorted(lasting_, {}, &Lasting::pair), "contacts out of order");
  }

 private:
  using Base::allowance_, Base::contact_time_, Base::last_, Base::lasting_, Base::left_by_steps_, Base::never,
      Base::world_;
  using Base::approaches, Base::find, Base::greatest_acceleration, Base::material_now, Base::note_lasting,
      Base::note_together, Base::strike, Base::strike_all, Base::together, Base::touches;
  using typename Base::Lasting;
  static constexpr Real steps_of_contact_time = 100;  // a thousandth of the time in which a body falls its radius

  Real usual_contact_time() {
    using std::sqrt;
    Real smallest = never;
    ConstrainedSystem<Real, Dim> flow(world_, companions_);
    const Real pull = greatest_acceleration(flow.loads(world_.time).first);
    for (const Real& radius : world_.radius) smallest = std::min(smallest, radius);
    const Real by_force = pull > Real(0) && pull < never ? Real(1e-5) * sqrt(2 * smallest / pull) : Real(0);
    return std::max(by_force, continuo::usual_contact_time(world_));
  }

  /// From the present to the next contact, or to where candidates are to be listed anew, or to t.
  std::string fly(const Real& t) {
    using std::sqrt;
    Real fastest(0);
    for (const V& v : world_.velocity) fastest = std::max(fastest, squared(v));
    std::vector<Real> radii = world_.radius;
    std::ranges::nth_element(radii, radii.begin() + static_cast<std::ptrdiff_t>(radii.size() / 2));
    const Real median = radii.empty() ? Real(1) : radii[radii.size() / 2];
    const Real reach = std::min(std::max(median, Real(4 * sqrt(fastest) * step_)), Real(room_ / 2));
    candidates_.clear();
    for (const Touching& pair : pairs_within(world_, reach)) candidates_.push_back({.pair = pair});
    PersistentContacts<Real, Dim> held = resolved_ ? std::move(*resolved_) : resolve();
    resolved_.reset();
    if (!held.is_found() && may_step()) {
      zeno_guard_.go_by_steps();
      return {};
    }
    note_lasting(held);
    for (Candidate<Real>& at : candidates_) watch(at);
    for (std::size_t k = 0; k < held.size(); ++k)
      std::ranges::lower_bound(candidates_, held[k], {}, &Candidate<Real>::pair)->watched =
          Candidate<Real>::Watched::nothing;

    ConstrainedSystem<Real, Dim> flow(world_, companions_, std::move(held));
    if (is_steady_ = rests(flow); is_steady_) return {};
    const Real least = 64 * std::numeric_limits<Real>::epsilon(), tolerance = std::max(options_.tolerance, least);
    Options<X> how{.rtol = tolerance, .atol = tolerance * median};
    how.max_steps = options_.most_events;
    how.interrupt = options_.interrupt;
    const std::size_t bodies = flow.size_of_bodies(), all = flow.pack().size();
    if (all > bodies) {  // impulses of contacts need no control
      how.rtol_each.assign(all, how.rtol);
      how.atol_each.assign(all, companions_ ? companions_->absolute_tolerance : how.atol);
      std::fill_n(how.atol_each.begin(), bodies, how.atol);
      std::fill_n(how.atol_each.begin() + static_cast<std::ptrdiff_t>(bodies), flow.held().size(), Real(1e30));
    }
    if (options_.step > Real(0)) {
      how.step = options_.step;
      return follow(t, std::move(flow), Rk4{}, how, reach);
    }
    // Where contacts cut flights short, a step many times as long would have many more of them to look for.
    how.first_step = std::min({step_, std::max(Real(16 * lasted_), Real(1e-3 * step_)), Real(t - world_.time)});
    return follow(t, std::move(flow), Dop853{}, how, reach);
  }

  /// Two that overlap by more than half of what they may are to sink no deeper.
  void watch(Candidate<Real>& at) const {
    const Real gap = gap_of(world_, at.pair), pull = allowance_ / (contact_time_ * contact_time_);
    const bool overlap = gap < -allowance_ / 2, part = approach_of(world_, at.pair) < -pull * contact_time_;
    at.watched = overlap && part ? Candidate<Real>::Watched::approach : Candidate<Real>::Watched::gap;
    at.lowest = overlap ? gap - allowance_ / 2 : -allowance_;
  }

  template <class Method>
  std::string follow(const Real& t, ConstrainedSystem<Real, Dim> flow, Method method, const Options<X>& how,
                     const Real& reach) {
    X start = flow.pack();
    ConstrainedEvents<Real, Dim> watch(world_, candidates_, reach, flow.held().size());
    Integrator integrator(std::move(flow), std::move(start), Interval<Real>{world_.time, t}, method, how,
                          std::move(watch));
    // The last step as its error wanted it: an impact jumps the state, not the forces that set the pace.
    int steps = 0;
    const auto is_stuck = [&] {  // what slips slowly on much else turns its way so fast that steps are very short
      return ++steps >= 16 && integrator.system().held().rub() &&
             integrator.t() - world_.time < static_cast<Real>(steps) * stride_ / 8;
    };
    bool is_too_short = false;
    while (!is_too_short && integrator.advance()) {
      step_ = integrator.step_size();
      is_too_short = may_step() && is_stuck();
    }
    if (integrator.t() < t) step_ = integrator.step_size();
    lasted_ = integrator.t() - world_.time;
    if (may_step() && integrator.outcome().ending == Ending::step_too_small) is_too_short = true;
    if (is_too_short) {
      zeno_guard_.go_by_steps();
    } else if (integrator.t() < t && may_step()) {
      zeno_guard_.has_flown(lasted_, stride_);
    }
    if (!is_too_short && !succeeded(integrator.outcome().ending))
      return "the path cannot be followed beyond t = " + std::to_string(integrator.t()) + ": " +
             std::string(to_string(integrator.outcome().ending));
    for (std::size_t k = 0; k < lasting_.size(); ++k)
      lasting_[k].impulse += integrator.system().impulse(integrator.x(), k);
    integrator.system().store(integrator.x(), world_, companions_, lasted_);
    world_.time = integrator.t();
    note_together(world_.time);
    resolved_ = resolve();
    return {};
  }

  Real farthest_from(const std::vector<V>& before) const {
    using std::sqrt;
    Real farthest(0);
    for (std::size_t i = 0; i < before.size(); ++i)
      farthest = std::max(farthest, squared(V(world_.position[i] - before[i])));
    return sqrt(farthest);
  }
  /// Not where equations move beside, nor where the steps are the user's: those of first order are not for them.
  bool may_step() const {
    return stride_ > Real(0) && !(options_.step > Real(0)) && (!companions_ || companions_->state.empty());
  }
  /// As far as the stride, or to an impact, or to t.
  std::string step(const Real& t) {
    zeno_guard_.has_stepped();
    ConstrainedSystem<Real, Dim> flow(world_, companions_);
    const auto [force, torque] = flow.loads(world_.time);
    const Real pull = greatest_acceleration(force), slow = 2 * pull * stride_;
    allowance_ = pull * stride_ * stride_ / 2;
    left_by_steps_ = pull * stride_ * stride_;
    list_near(pull);
    // What bounces does so at its instant; what does not the step stops.
    const std::vector<Real> before = last_;
    std::vector<Touching> bounce;
    for (const Touching& at : near_)
      if (approaches(at, slow) && material_now(at, before, false).restitution > Real(0)) bounce.push_back(at);
    bool is_any = !bounce.empty();
    for (int round = 0, most = 64; is_any && round < most; ++round) {
      is_any = false;
      for (const Touching& at : bounce)
        is_any = (touches(at) && strike(at, slow, material_now(at, before, false))) || is_any;
    }
    Real h = std::min(stride_, Real(t - world_.time));
    for (const Touching& at : bounce)
      if (approaches(at, slow) && !touches(at)) {
        const V rate =
            force[at.a] * world_.inverse_mass[at.a] - (at.with_wall() ? V{} : force[at.b] * world_.inverse_mass[at.b]);
        h = std::min(h, time_to_close(gap_of(world_, at), Real(-approach_of(world_, at)),
                                      Real(-dot(rate, normal_of(world_, at)))));
      }
    steps_.advance(world_, near_, {force, torque, pull}, h);
    const bool is_last = h >= t - world_.time;
    world_.time = is_last ? t : world_.time + h;
    note_pushed(h);
    const bool was_slow = is_slow_;
    is_slow_ = is_autonomous() && steps_.fastest() <= pull * contact_time_ / 16 &&
               steps_.greatest_change() <= Real(1e-5) * pull * h;
    is_steady_ = was_slow && is_slow_;
    lasted_ = h;
    resolved_.reset();
    if (steps_.fastest() < never) return {};
    return "a body's motion is no longer finite: a speed or a force is too large for the numbers";
  }
  /// Whether forces are the same where places and velocities are.
  bool is_autonomous() const { return !companions_ && world_.force_laws.empty() && world_.torque_laws.empty(); }
  /// Whether nothing moves or begins to, by the forces of contacts that last, but for rounding.
  bool rests(ConstrainedSystem<Real, Dim>& flow) {
    const Real pull = allowance_ / (contact_time_ * contact_time_), least = Real(1e-3) * pull * contact_time_;
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
    for (std::size_t k = 0; k < lasting_.size(); ++k) lasting_[k].press = flow.held().press(k);
    return true;
  }
  /// Nothing moves, but for what turns about itself: the same contacts carry the same until t.
  std::string stay(const Real& t) {
    const Real duration = t - world_.time;
    for (std::size_t i = 0; i < world_.size(); ++i) {
      if (world_.is_fixed(i)) continue;
      world_.velocity[i] = {};
      if (world_.spin[i] != S{}) world_.orientation[i] = turned(world_.orientation[i], world_.spin[i], duration);
    }
    for (Lasting& one : lasting_) one.impulse += one.press * duration;
    note_together(t);
    world_.time = t;
    return {};
  }
  /// Those that may meet in the next step, and have been listed for some.
  void list_near(const Real& pull) {
    using std::sqrt;
    Real fastest(0);
    for (const V& v : world_.velocity) fastest = std::max(fastest, squared(v));
    const Real needed = 4 * stride_ * (sqrt(fastest) + 2 * pull * stride_);
    if (!listed_.empty() && !(farthest_from(listed_) > listed_reach_ - needed)) return;
    listed_reach_ = std::max(8 * needed, Real(std::ranges::min(world_.radius) / 8));
    listed_ = world_.position;
    near_ = pairs_within(world_, listed_reach_);
  }
  void note_pushed(const Real& h) {
    std::vector<Touching> pairs;
    for (const auto& one : steps_.pushed()) pairs.push_back(one.pair);
    note_lasting(pairs);
    for (std::size_t k = 0; k < lasting_.size(); ++k) {
      lasting_[k].press = steps_.pushed()[k].force.press;
      lasting_[k].impulse += lasting_[k].press * h;
    }
  }

  /// Collisions of this instant, one after the other, until nobody approaches; what does not end so bounces no more,
  /// and then moves as one. Where forces press two together that hardly move, in the contact time by no more than the
  /// forces would move them, no collision happens: they are held from here on.
  PersistentContacts<Real, Dim> resolve() {
    ConstrainedSystem<Real, Dim> flow(world_, companions_);
    const auto [force, torque] = flow.loads(world_.time);
    const Real pull = greatest_acceleration(force), slow = pull * contact_time_;
    allowance_ = slow * contact_time_;
    if (!(slow < never)) return {};
    std::vector<Touching> touching;
    for (const Candidate<Real>& at : candidates_)
      if (touches(at.pair)) touching.push_back(at.pair);
    if (touching.empty()) return {};
    const std::vector<Real> before = last_;
    for (int round = 0, most = 256; round < most; ++round)
      if (!strike_all(touching, slow, before, round > 64)) break;
    if (!(slow > Real(0))) return {};
    std::vector<Touching> gentle;
    for (const Touching& at : touching)
      if (std::abs(approach_of(world_, at)) <= slow &&
          length(V(world_.position[at.b] - world_.position[at.a])) + Real(at.with_wall()) > Real(0))
        gentle.push_back(at);
    const Real smallest = std::ranges::min(world_.radius);
    using std::sqrt;
    PersistentContacts<Real, Dim> held(world_, gentle, slow, Real(sqrt(pull / smallest)), force, torque);
    held.settle(world_.velocity, world_.spin);
    std::size_t k = 0;
    for (const Touching& at : gentle)
      if (k < held.size() && held[k] == at) {
        ++k;
      } else {
        strike(at, slow / 1'000'000, material_now(at, before, false));  // what is less is rounding
      }
    held.look_again();
    return held;
  }
  Companions<Real, Dim>* companions_;
  ExactOptions<Real> options_;

  Real step_{}, lasted_ = never;     // the last step of a flight as its error wanted it, and the last flight
  Real stride_{};                    // of steps through contacts
  std::size_t greatest_before_ = 0;  // bodies of the one whose pace was taken over
  Real room_ = never;                // in which bodies keep round where they began
  std::vector<V> begin_;
  std::vector<Candidate<Real>> candidates_;
  std::optional<PersistentContacts<Real, Dim>> resolved_;  // at the end of the last flight
  ZenoGuard zeno_guard_;
  ContactSteps<Real, Dim> steps_;
  bool is_slow_ = false, is_steady_ = false;  // in the last step; for good
  std::vector<Touching> near_;                // of steps
  std::vector<V> listed_;                     // where bodies were when they were listed
  Real listed_reach_{};
};

}  // namespace

template <class Real, int Dim>
std::unique_ptr<ContactEngine<Real, Dim>> constrained_motion(World<Real, Dim>& world, const ExactOptions<Real>& options,
                                                             Companions<Real, Dim>* companions) {
  return std::make_unique<ConstrainedMotion<Real, Dim>>(world, options, companions);
}

template std::unique_ptr<ContactEngine<float, 2>> constrained_motion(World<float, 2>&, const ExactOptions<float>&,
                                                                     Companions<float, 2>*);
template std::unique_ptr<ContactEngine<float, 3>> constrained_motion(World<float, 3>&, const ExactOptions<float>&,
                                                                     Companions<float, 3>*);
template std::unique_ptr<ContactEngine<double, 2>> constrained_motion(World<double, 2>&, const ExactOptions<double>&,
                                                                      Companions<double, 2>*);
template std::unique_ptr<ContactEngine<double, 3>> constrained_motion(World<double, 3>&, const ExactOptions<double>&,
                                                                      Companions<double, 3>*);

}  // namespace continuo
