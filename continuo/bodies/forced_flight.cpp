#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include <continuo/bodies/contact_time.hpp>
#include <continuo/bodies/exact_engine.hpp>
#include <continuo/bodies/forced_flow.hpp>
#include <continuo/bodies/impulse.hpp>
#include <continuo/bodies/queries.hpp>
#include <continuo/methods/dop853.hpp>
#include <continuo/methods/rk4.hpp>
#include <continuo/solve/integrator.hpp>

namespace continuo {

namespace {

constexpr std::uint32_t no_wall = std::numeric_limits<std::uint32_t>::max();

/// Two that can meet before the candidates are listed anew.
struct Candidate {
  std::uint32_t a = 0, b = 0, wall = no_wall;
  bool overlaps = false;  // when it was listed: then what is watched is whether they approach
};

/// The events of a stretch: a candidate touches (or, where it overlapped, approaches); or, last, a body has come as far
/// as the list is good for. Any of them stops the run.
template <class Real, int Dim>
class Watch {
 public:
  using V = Vector<Real, Dim>;
  using X = std::vector<Real>;

  Watch(const World<Real, Dim>& world, const std::vector<Candidate>& candidates, Real reach)
      : world_(&world), candidates_(&candidates), reach_(reach), begin_(world.position), x_(begin_), v_(begin_) {}

  std::size_t size() const { return candidates_->size() + 1; }
  std::string_view name(std::size_t i) const { return i < candidates_->size() ? "contact" : "list"; }
  Direction direction(std::size_t) const { return Direction::falls; }
  bool is_guard(std::size_t) const { return true; }
  template <class System>
  bool active(const System&, std::size_t) const {
    return true;
  }
  Real next_time(std::size_t, Real, bool) const { return std::numeric_limits<Real>::infinity(); }

  template <class System>
  void guards(System&, Real, const X& state, std::span<Real> values) {
    ForcedFlow<Real, Dim>::unpack(state, x_, v_);
    for (std::size_t k = 0; k < candidates_->size(); ++k) values[k] = guard((*candidates_)[k]);
    Real farthest(0);
    for (std::size_t i = 0; i < x_.size(); ++i) farthest = std::max(farthest, squared(V(x_[i] - begin_[i])));
    values[candidates_->size()] = reach_ * reach_ - farthest;
  }
  template <class System>
  EventResponse fire(System&, std::span<const std::size_t>, Real, const X&, X&) {
    return {.stop = true};
  }

 private:
  Real guard(const Candidate& at) const {
    if (at.wall != no_wall) {
      const Wall<Real, Dim> wall = facing(world_->walls()[at.wall], begin_[at.a]);
      if (at.overlaps) return dot(wall.normal, v_[at.a]);
      return dot(wall.normal, x_[at.a]) - wall.offset - world_->radius[at.a];
    }
    const V apart = x_[at.b] - x_[at.a];
    if (at.overlaps) return dot(apart, V(v_[at.b] - v_[at.a]));
    return length(apart) - world_->radius[at.a] - world_->radius[at.b];
  }

  const World<Real, Dim>* world_;
  const std::vector<Candidate>* candidates_;
  Real reach_;
  std::vector<V> begin_, x_, v_;
};

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
    while (world_.time < t) {
      if (++events > options_.most_events) return "more events than `most_events`: bodies may be caught between others";
      if (options_.is_interrupted()) return "interrupted";
      if (std::string fault = fly(t); !fault.empty()) return fault;
    }
    return {};
  }

  void save(ByteWriter& writer) override { writer(contact_time_), writer(step_), writer(last_); }
  void load(ByteReader& reader) override {
    reader(contact_time_), reader(step_), reader(last_);
    reader.expect(contact_time_ >= Real(0) && step_ >= Real(0) && step_ < never && last_.size() == world_.size(),
                  "a motion of other bodies");
  }

  using ExactEngine<Real, Dim>::statistics;
  using ExactEngine<Real, Dim>::contacts;

 private:
  static constexpr Real never = std::numeric_limits<Real>::infinity();

  Real usual_contact_time() {
    using std::sqrt;
    Real smallest = never, pull(0);
    for (const V& a : ForcedFlow<Real, Dim>(world_, companions_).accelerations(world_.time))
      pull = std::max(pull, length(a));
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
    const Real reach = std::max(median, Real(8 * sqrt(fastest) * step_));
    list_candidates(reach);
    resolve();
    for (Candidate& at : candidates_) at.overlaps = !(gap(at) > Real(0));

    ForcedFlow<Real, Dim> flow(world_, companions_);
    const Real least = 64 * std::numeric_limits<Real>::epsilon(), tolerance = std::max(options_.tolerance, least);
    Options<X> how{.rtol = tolerance, .atol = tolerance * median};
    how.max_steps = options_.most_events;
    how.interrupt = options_.interrupt;
    if (companions_) {
      how.rtol_each.assign(flow.pack().size(), how.rtol);
      how.atol_each.assign(how.rtol_each.size(), how.atol);
      std::fill(how.atol_each.end() - static_cast<std::ptrdiff_t>(companions_->state.size()), how.atol_each.end(),
                companions_->absolute_tolerance);
    }
    if (options_.step > Real(0)) {
      how.step = options_.step;
      return follow(t, flow, Rk4{}, how, reach);
    }
    how.first_step = std::min(step_, Real(t - world_.time));
    return follow(t, flow, Dop853{}, how, reach);
  }

  template <class Method>
  std::string follow(const Real& t, ForcedFlow<Real, Dim>& flow, Method method, const Options<X>& how,
                     const Real& reach) {
    Integrator integrator(flow, flow.pack(), Interval<Real>{world_.time, t}, method, how,
                          Watch<Real, Dim>(world_, candidates_, reach));
    while (integrator.advance()) step_ = integrator.step_size();
    if (!succeeded(integrator.outcome().ending))
      return "the path cannot be followed beyond t = " + std::to_string(integrator.t()) + ": " +
             std::string(to_string(integrator.outcome().ending));
    const Real duration = integrator.t() - world_.time;
    flow.store(integrator.x(), world_, companions_, duration);
    world_.time = integrator.t();
    resolve();
    return {};
  }

  void list_candidates(const Real& reach) {
    candidates_.clear();
    const Queries<Real, Dim> queries(world_);
    for (std::uint32_t i = 0; i < world_.size(); ++i) {
      if (world_.is_fixed(i)) continue;
      const auto near = queries.in_sphere(world_.position[i], world_.radius[i] + 2 * reach);
      for (const std::uint32_t w : near.value.walls) candidates_.push_back({.a = i, .wall = w});
      for (const BodyHandle& body : near.value.bodies) {
        const auto j = static_cast<std::uint32_t>(world_.index(body));
        if ((j > i || world_.is_fixed(j)) && j != i && world_.collide(i, j)) candidates_.push_back({.a = i, .b = j});
      }
    }
  }

  Real gap(const Candidate& at) const {
    if (at.wall != no_wall) {
      const Wall<Real, Dim> wall = facing(world_.walls()[at.wall], world_.position[at.a]);
      return dot(wall.normal, world_.position[at.a]) - wall.offset - world_.radius[at.a];
    }
    return length(V(world_.position[at.b] - world_.position[at.a])) - world_.radius[at.a] - world_.radius[at.b];
  }
  V normal(const Candidate& at) const {
    if (at.wall != no_wall) return -facing(world_.walls()[at.wall], world_.position[at.a]).normal;
    V n = world_.position[at.b] - world_.position[at.a];
    const Real distance = length(n);
    if (distance > Real(0)) return n * (1 / distance);
    n[0] = Real(1);
    return n;
  }
  /// What counts as touching: the digits of a place.
  bool touches(const Candidate& at) const {
    const Real size = length(world_.position[at.a]) + world_.radius[at.a];
    return gap(at) <= 16 * std::numeric_limits<Real>::epsilon() * size;
  }

  /// Collisions of this instant, one after the other, until nobody approaches. As in the event-driven motion, one that
  /// follows within the contact time loses nothing; what does not end so bounces no more, and then moves as one.
  void resolve() {
    std::vector<Candidate> touching;
    for (const Candidate& at : candidates_)
      if (touches(at)) touching.push_back(at);
    if (touching.empty()) return;
    const std::vector<Real> before = last_;
    for (int round = 0, most = 256; round < most; ++round) {
      bool is_over = true;
      for (const Candidate& at : touching) is_over = !strike(at, before, round > 64, round > 128) && is_over;
      if (is_over) break;
    }
    const std::vector<V> a = ForcedFlow<Real, Dim>(world_, companions_).accelerations(world_.time);
    for (const Candidate& at : touching) part_where_pressed(at, a);
  }
  bool strike(const Candidate& at, const std::vector<Real>& before, bool is_squeezed, bool is_caught) {
    V no_velocity{};
    S no_spin{};
    const Mover<Real, Dim> a = mover(at.a);
    const bool is_wall = at.wall != no_wall;
    const Mover<Real, Dim> b =
        is_wall ? Mover<Real, Dim>{no_velocity, no_spin, Real(0), Real(0), Real(0)} : mover(at.b);
    const V n = normal(at), rate = b.velocity - a.velocity;
    const Real approach = -dot(rate, n);
    if (!(approach > 8 * std::numeric_limits<Real>::epsilon() * length(rate))) return false;
    Material<Real> material =
        combined(world_.material[at.a], is_wall ? world_.walls()[at.wall].material : world_.material[at.b]);
    const bool loses = material.restitution < Real(1) || material.friction > Real(0);
    const bool is_held =
        world_.time - before[at.a] < contact_time_ || (!is_wall && world_.time - before[at.b] < contact_time_);
    if (is_held) material.restitution = Real(1);
    if (is_squeezed && loses) material.restitution = Real(0);
    const Real impulse = collide(a, b, n, material);
    if (is_caught && loses) {
      a.velocity += (b.velocity - a.velocity) * (a.inverse_mass / (a.inverse_mass + b.inverse_mass));
      if (!is_wall && b.inverse_mass > Real(0)) b.velocity = a.velocity;
    }
    last_[at.a] = world_.time;
    if (!is_wall) last_[at.b] = world_.time;
    ++(is_wall ? statistics.wall_collisions : statistics.collisions);
    if (contacts.is_kept())
      contacts.add({.a = world_.handle(at.a),
                    .b = is_wall ? BodyHandle{} : world_.handle(at.b),
                    .wall = at.wall,
                    .point = world_.position[at.a] + n * world_.radius[at.a],
                    .normal = n,
                    .impulse = impulse,
                    .time = world_.time});
    return true;
  }
  /// No flight is shorter than the contact time where the two are pressed together.
  void part_where_pressed(const Candidate& at, const std::vector<V>& acceleration) {
    const bool is_wall = at.wall != no_wall;
    const V n = normal(at), of_b = is_wall ? V{} : acceleration[at.b], v_b = is_wall ? V{} : world_.velocity[at.b];
    const Real press = dot(acceleration[at.a] - of_b, n);
    const Real missing = press * contact_time_ / 2 - dot(v_b - world_.velocity[at.a], n);
    if (!(press > Real(0)) || !(missing > Real(0))) return;
    const Real inverse_b = is_wall ? Real(0) : world_.inverse_mass[at.b];
    const Real impulse = missing / (world_.inverse_mass[at.a] + inverse_b);
    world_.velocity[at.a] -= n * (impulse * world_.inverse_mass[at.a]);
    if (!is_wall) world_.velocity[at.b] += n * (impulse * inverse_b);
  }
  Mover<Real, Dim> mover(std::uint32_t i) {
    return {world_.velocity[i], world_.spin[i], world_.radius[i], world_.inverse_mass[i], world_.inverse_inertia[i]};
  }

  World<Real, Dim>& world_;
  Companions<Real, Dim>* companions_;
  ExactOptions<Real> options_;
  Real contact_time_{}, step_{};
  std::vector<Real> last_;  // when each body collided last
  std::vector<Candidate> candidates_;
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
