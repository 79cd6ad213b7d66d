#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <continuo/bodies/contact_time.hpp>
#include <continuo/bodies/exact_engine.hpp>
#include <continuo/bodies/forced_flow.hpp>
#include <continuo/bodies/forced_watch.hpp>
#include <continuo/bodies/impulse.hpp>
#include <continuo/bodies/joint_impacts.hpp>
#include <continuo/bodies/queries.hpp>
#include <continuo/methods/dop853.hpp>
#include <continuo/methods/rk4.hpp>
#include <continuo/solve/integrator.hpp>

namespace continuo {

namespace {

template <class Real, int Dim>
class ForcedFlight final : public ExactEngine<Real, Dim> {
 public:
  using V = Vector<Real, Dim>;
  using S = Spin<Real, Dim>;
  using X = std::vector<Real>;

  ForcedFlight(World<Real, Dim>& world, const ExactOptions<Real>& options, Companions<Real, Dim>* companions)
      : ExactEngine<Real, Dim>(options),
        world_(world),
        companions_(companions),
        options_(options),
        last_(world.size(), -never) {
    contact_time_ = options.contact_time ? *options.contact_time : usual_contact_time();
  }

  std::string advance_to(const Real& t) override {
    if (last_.size() != world_.size()) return "bodies have come or gone: the motion needs a `refresh`";
    std::size_t events = 0;
    resolved_.reset();  // a motion that is read from a snapshot has none
    while (world_.time < t) {
      if (++events > options_.most_events) return "more events than `most_events`: bodies may be caught between others";
      if (options_.is_interrupted()) return "interrupted";
      if (std::string fault = fly(t); !fault.empty()) return fault;
    }
    return {};
  }

  void save(ByteWriter& writer) override {
    writer(contact_time_), writer(step_), writer(lasted_), writer(last_), writer(lasting_);
  }
  void load(ByteReader& reader) override {
    reader(contact_time_), reader(step_), reader(lasted_), reader(last_), reader(lasting_);
    reader.expect(contact_time_ >= Real(0) && lasted_ >= Real(0) && step_ >= Real(0) && step_ < never &&
                      last_.size() == world_.size(),
                  "a motion of other bodies");
    for (const auto& [pair, impulse] : lasting_)
      reader.expect(
          pair.a < world_.size() && pair.b < world_.size() && (!pair.with_wall() || pair.wall < world_.walls().size()),
          "contacts of other bodies");
    reader.expect(std::ranges::is_sorted(lasting_, {}, &Lasting::pair), "contacts out of order");
  }

  using ExactEngine<Real, Dim>::statistics;
  using ExactEngine<Real, Dim>::contacts;

 private:
  static constexpr Real never = std::numeric_limits<Real>::infinity();

  /// A contact that is held, and its impulse so far.
  struct Lasting {
    Touching pair{};
    Real impulse{};
    template <class Archive>
    void transfer(Archive& archive) {
      archive(pair.a), archive(pair.b), archive(pair.wall), archive(impulse);
    }
  };
  /// Of contacts in order.
  static const Lasting* find(const std::vector<Lasting>& contacts, const Touching& pair) {
    const auto at = std::ranges::lower_bound(contacts, pair, {}, &Lasting::pair);
    return at != contacts.end() && at->pair == pair ? &*at : nullptr;
  }

  Real usual_contact_time() {
    using std::sqrt;
    Real smallest = never;
    ForcedFlow<Real, Dim> flow(world_, companions_);
    const Real pull = greatest_acceleration(flow.loads(world_.time).first);
    for (const Real& radius : world_.radius) smallest = std::min(smallest, radius);
    const Real by_force = pull > Real(0) && pull < never ? Real(1e-5) * sqrt(2 * smallest / pull) : Real(0);
    return std::max(by_force, continuo::usual_contact_time(world_));
  }

  Real greatest_acceleration(std::span<const V> force) const {
    Real greatest(0);
    for (std::size_t i = 0; i < force.size(); ++i)
      greatest = std::max(greatest, length(force[i]) * world_.inverse_mass[i]);
    return greatest;
  }

  /// From the present to the next contact, or to where candidates are to be listed anew, or to t.
  std::string fly(const Real& t) {
    using std::sqrt;
    Real fastest(0);
    for (const V& v : world_.velocity) fastest = std::max(fastest, squared(v));
    std::vector<Real> radii = world_.radius;
    std::ranges::nth_element(radii, radii.begin() + static_cast<std::ptrdiff_t>(radii.size() / 2));
    const Real median = radii.empty() ? Real(1) : radii[radii.size() / 2];
    const Real reach = std::max(median, Real(4 * sqrt(fastest) * step_));
    list_candidates(reach);
    HeldContacts<Real, Dim> held = resolved_ ? std::move(*resolved_) : resolve();
    resolved_.reset();
    note_lasting(held);
    using Watched = Candidate::Watched;
    for (Candidate& at : candidates_) at.watched = gap(at.pair) < -allowance_ / 2 ? Watched::approach : Watched::gap;
    for (std::size_t k = 0; k < held.size(); ++k)
      std::ranges::lower_bound(candidates_, held[k], {}, &Candidate::pair)->watched = Watched::nothing;

    ForcedFlow<Real, Dim> flow(world_, companions_, std::move(held));
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

  template <class Method>
  std::string follow(const Real& t, ForcedFlow<Real, Dim> flow, Method method, const Options<X>& how,
                     const Real& reach) {
    X start = flow.pack();
    ForcedWatch<Real, Dim> watch(world_, candidates_, allowance_, reach, flow.held().size());
    Integrator integrator(std::move(flow), std::move(start), Interval<Real>{world_.time, t}, method, how,
                          std::move(watch));
    // The last step as its error wanted it: an impact jumps the state, not the forces that set the pace.
    while (integrator.advance()) step_ = integrator.step_size();
    if (integrator.t() < t) step_ = integrator.step_size();
    lasted_ = integrator.t() - world_.time;
    if (!succeeded(integrator.outcome().ending))
      return "the path cannot be followed beyond t = " + std::to_string(integrator.t()) + ": " +
             std::string(to_string(integrator.outcome().ending));
    for (std::size_t k = 0; k < lasting_.size(); ++k)
      lasting_[k].impulse += integrator.system().impulse(integrator.x(), k);
    integrator.system().store(integrator.x(), world_, companions_, lasted_);
    world_.time = integrator.t();
    resolved_ = resolve();
    return {};
  }

  void list_candidates(const Real& reach) {
    candidates_.clear();
    const Queries<Real, Dim> queries(world_);
    for (std::uint32_t i = 0; i < world_.size(); ++i) {
      if (world_.is_fixed(i)) continue;
      const auto near = queries.in_sphere(world_.position[i], world_.radius[i] + 2 * reach);
      for (const std::uint32_t w : near.value.walls) candidates_.push_back({.pair = {.a = i, .b = i, .wall = w}});
      for (const BodyHandle& body : near.value.bodies) {
        const auto j = static_cast<std::uint32_t>(world_.index(body));
        if ((j > i || world_.is_fixed(j)) && j != i && world_.collide(i, j))
          candidates_.push_back({.pair = {.a = i, .b = j}});
      }
    }
    std::ranges::sort(candidates_, {}, &Candidate::pair);  // so are those that are held
  }

  Real gap(const Touching& at) const {
    if (at.with_wall()) {
      const Wall<Real, Dim> wall = facing(world_.walls()[at.wall], world_.position[at.a]);
      return dot(wall.normal, world_.position[at.a]) - wall.offset - world_.radius[at.a];
    }
    return length(V(world_.position[at.b] - world_.position[at.a])) - world_.radius[at.a] - world_.radius[at.b];
  }
  V normal(const Touching& at) const {
    if (at.with_wall()) return -facing(world_.walls()[at.wall], world_.position[at.a]).normal;
    V n = world_.position[at.b] - world_.position[at.a];
    const Real distance = length(n);
    if (distance > Real(0)) return n * (1 / distance);
    n[0] = Real(1);
    return n;
  }
  Real approach(const Touching& at) const {
    const V of_b = at.with_wall() ? V{} : world_.velocity[at.b];
    return -dot(V(of_b - world_.velocity[at.a]), normal(at));
  }
  /// What counts as touching: the digits of a place, and what a gap may sink.
  bool touches(const Touching& at) const {
    const Real size = length(world_.position[at.a]) + world_.radius[at.a];
    return gap(at) <= std::max(Real(16 * std::numeric_limits<Real>::epsilon() * size), allowance_);
  }

  /// Collisions of this instant, one after the other, until nobody approaches; what does not end so bounces no more,
  /// and then moves as one. Where forces press two together that hardly move, in the contact time by no more than the
  /// forces would move them, no collision happens: they are held from here on.
  HeldContacts<Real, Dim> resolve() {
    ForcedFlow<Real, Dim> flow(world_, companions_);
    const auto [force, torque] = flow.loads(world_.time);
    const Real pull = greatest_acceleration(force), slow = pull * contact_time_;
    allowance_ = slow * contact_time_;
    if (!(slow < never)) return {};
    std::vector<Touching> touching;
    for (const Candidate& at : candidates_)
      if (touches(at.pair)) touching.push_back(at.pair);
    if (touching.empty()) return {};
    const std::vector<Real> before = last_;
    for (int round = 0, most = 256; round < most; ++round)
      if (!strike_all(touching, slow, before, round > 64)) break;
    if (!(slow > Real(0))) return {};
    std::vector<Touching> gentle;
    for (const Touching& at : touching)
      if (std::abs(approach(at)) <= slow &&
          length(V(world_.position[at.b] - world_.position[at.a])) + Real(at.with_wall()) > Real(0))
        gentle.push_back(at);
    const Real smallest = std::ranges::min(world_.radius);
    using std::sqrt;
    HeldContacts<Real, Dim> held(world_, gentle, slow, Real(sqrt(pull / smallest)), force, torque);
    held.settle(world_.velocity, world_.spin);
    std::size_t k = 0;
    for (const Touching& at : gentle)
      if (k < held.size() && held[k] == at) {
        ++k;
      } else {
        strike(at, slow / 1'000'000, material_now(at, before, false));  // what is less is rounding
      }
    return held;
  }
  /// What bounces, one after the other, and then what does not, all together. False where nobody approaches.
  bool strike_all(std::span<const Touching> touching, const Real& slow, const std::vector<Real>& before,
                  bool is_squeezed) {
    bool is_any = false, is_plastic = false;
    std::vector<Touching> plastic;
    for (const Touching& at : touching) {
      const Material<Real> material = material_now(at, before, is_squeezed);
      if (material.restitution > Real(0)) {
        is_any = strike(at, slow, material) || is_any;
      } else {
        plastic.push_back(at);
        is_plastic = is_plastic || approaches(at, slow);
      }
    }
    if (!is_plastic) return is_any;
    const std::vector<Real> impulse = strike_together<Real, Dim>(world_, plastic, slow / 8);
    for (std::size_t k = 0; k < plastic.size(); ++k)
      if (impulse[k] > Real(0)) has_struck(plastic[k], impulse[k]);
    return true;
  }
  bool strike(const Touching& at, const Real& slow, const Material<Real>& material) {
    if (!approaches(at, slow)) return false;
    V no_velocity{};
    S no_spin{};
    const Mover<Real, Dim> wall{no_velocity, no_spin, Real(0), Real(0), Real(0)};
    has_struck(at, collide(mover(at.a), at.with_wall() ? wall : mover(at.b), normal(at), material));
    return true;
  }
  /// By more than `slow`, and than rounding.
  bool approaches(const Touching& at, const Real& slow) const {
    const V rate = (at.with_wall() ? V{} : world_.velocity[at.b]) - world_.velocity[at.a];
    return approach(at) > std::max(slow, Real(8 * std::numeric_limits<Real>::epsilon() * length(rate)));
  }
  /// What has collided within the contact time before this instant, or touched already, bounces no more.
  Material<Real> material_now(const Touching& at, const std::vector<Real>& before, bool is_squeezed) const {
    const bool is_wall = at.with_wall();
    Material<Real> material = combined(world_.meeting, world_.material[at.a],
                                       is_wall ? world_.walls()[at.wall].material : world_.material[at.b]);
    const bool loses = material.restitution < Real(1) || material.friction > Real(0);
    const bool is_held =
        world_.time - before[at.a] < contact_time_ || (!is_wall && world_.time - before[at.b] < contact_time_);
    if (is_held || find(lasting_, at)) material.restitution = material.restitution < Real(1) ? Real(0) : Real(1);
    if (is_squeezed && loses) material.restitution = Real(0);
    return material;
  }
  void has_struck(const Touching& at, const Real& impulse) {
    last_[at.a] = world_.time;
    if (!at.with_wall()) last_[at.b] = world_.time;
    ++(at.with_wall() ? statistics.wall_collisions : statistics.collisions);
    note(at, ContactChange::impact, impulse);
  }
  /// Which contacts go on, which are new, and which have ended.
  void note_lasting(const HeldContacts<Real, Dim>& held) {
    std::vector<Lasting> now;
    for (std::size_t k = 0; k < held.size(); ++k) {
      const Lasting* const known = find(lasting_, held[k]);
      now.push_back({held[k], known ? known->impulse : Real(0)});
      if (!known) note(held[k], ContactChange::begin, Real(0));
    }
    for (const Lasting& one : lasting_)
      if (!find(now, one.pair)) note(one.pair, ContactChange::end, one.impulse);
    lasting_ = std::move(now);
  }
  void note(const Touching& at, ContactChange change, const Real& impulse) {
    if (!contacts.is_kept()) return;
    const V n = normal(at);
    contacts.add({.change = change,
                  .a = world_.handle(at.a),
                  .b = at.with_wall() ? BodyHandle{} : world_.handle(at.b),
                  .wall = at.wall,
                  .point = world_.position[at.a] + n * world_.radius[at.a],
                  .normal = n,
                  .impulse = impulse,
                  .time = world_.time});
  }
  Mover<Real, Dim> mover(std::uint32_t i) {
    return {world_.velocity[i], world_.spin[i], world_.radius[i], world_.inverse_mass[i], world_.inverse_inertia[i]};
  }

  World<Real, Dim>& world_;
  Companions<Real, Dim>* companions_;
  ExactOptions<Real> options_;

  Real contact_time_{}, step_{}, allowance_{}, lasted_ = never;  // lasted_: the last flight
  std::vector<Real> last_;                                       // when each body collided last
  std::vector<Candidate> candidates_;
  std::vector<Lasting> lasting_;
  std::optional<HeldContacts<Real, Dim>> resolved_;  // at the end of the last flight
};

}  // namespace

template <class Real, int Dim>
std::unique_ptr<ExactEngine<Real, Dim>> forced_flight(World<Real, Dim>& world, const ExactOptions<Real>& options,
                                                      Companions<Real, Dim>* companions) {
  return std::make_unique<ForcedFlight<Real, Dim>>(world, options, companions);
}

template std::unique_ptr<ExactEngine<float, 2>> forced_flight(World<float, 2>&, const ExactOptions<float>&,
                                                              Companions<float, 2>*);
template std::unique_ptr<ExactEngine<float, 3>> forced_flight(World<float, 3>&, const ExactOptions<float>&,
                                                              Companions<float, 3>*);
template std::unique_ptr<ExactEngine<double, 2>> forced_flight(World<double, 2>&, const ExactOptions<double>&,
                                                               Companions<double, 2>*);
template std::unique_ptr<ExactEngine<double, 3>> forced_flight(World<double, 3>&, const ExactOptions<double>&,
                                                               Companions<double, 3>*);

}  // namespace continuo
