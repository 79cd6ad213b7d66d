// continuo/bodies/fast_motion.cpp
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <queue>
#include <utility>
#include <vector>

#include <continuo/bodies/collision_time.hpp>
#include <continuo/bodies/contact_list.hpp>
#include <continuo/bodies/contact_solver.hpp>
#include <continuo/bodies/fast_motion.hpp>
#include <continuo/bodies/forces.hpp>
#include <continuo/bodies/impulse.hpp>
#include <continuo/bodies/pair_list.hpp>

namespace continuo {

template <class Real, int Dim>
class FastMotion<Real, Dim>::Stepper {
 public:
  using V = Vector<Real, Dim>;
  using Body = SolverBody<Real, Dim>;

  Stepper(World<Real, Dim>& world, const FastOptions<Real>& options) : world_(world), options_(options) { refresh(); }

  void refresh() {
    pairs_ = {};
    load();
    pairs_.list(world_, bodies_, reach());
  }

  std::string advance() {
    if (!(options_.step > Real(0)) || !(options_.step < std::numeric_limits<Real>::infinity()))
      return "the step must be greater than 0, and finite";
    if (options_.substeps < 1) return "a step has at least one substep";
    if (world_.size() != bodies_.size() || world_.walls().size() != pairs_.walls()) refresh();
    load();
    if (pairs_.is_outdated(bodies_, step_reach())) pairs_.list(world_, bodies_, reach());
    const Real h = options_.step / static_cast<Real>(options_.substeps);
    for (int k = 0; k < options_.substeps; ++k) substep(world_.time + h * static_cast<Real>(k), h);
    for (const Body& body : bodies_)
      if (!is_finite(body.x) || !is_finite(body.v))
        return "a body's motion is no longer finite: a force or a mass is too large for the step";
    store();
    world_.time += options_.step;
    ++statistics.steps;
    statistics.lists = pairs_.lists();
    statistics.contacts = pairs_.pair_contacts().contacts.size() + pairs_.wall_contacts().size();
    statistics.colours = pairs_.pair_contacts().colours();
    return {};
  }

  Real deepest_overlap() const {
    Real deepest(0);
    for (const auto& contact : pairs_.pair_contacts().contacts)
      deepest = std::max(deepest, -gap(bodies_[contact.a], bodies_[contact.b]));
    for (const auto& contact : pairs_.wall_contacts())
      deepest = std::max(deepest, -wall_gap(bodies_[contact.a], world_.walls()[contact.b]));
    return deepest;
  }

  FastStatistics statistics{};

 private:
  static Real gap(const Body& a, const Body& b) { return length(b.x - a.x) - a.radius - b.radius; }
  static Real wall_gap(const Body& a, const Wall<Real, Dim>& wall) {
    return dot(wall.normal, a.x) - wall.offset - a.radius;
  }

  /// The bodies from the world, in the order of the list.
  void load() {
    const std::vector<std::uint32_t>& order = pairs_.order(world_);
    bodies_.resize(order.size());
    for (std::size_t k = 0; k < order.size(); ++k) {
      const std::size_t i = order[k];
      Body& body = bodies_[k];
      body.x = world_.position[i];
      body.v = world_.velocity[i];
      body.spin = world_.spin[i];
      body.radius = world_.radius[i];
      body.inverse_mass = world_.inverse_mass[i];
      body.inverse_inertia = world_.inverse_inertia[i];
      body.acceleration = body.inverse_mass > Real(0) ? world_.gravity : V{};
    }
    has_other_forces_ = !only_gravity(world_);
  }
  void store() {
    const std::vector<std::uint32_t>& order = pairs_.order(world_);
    for (std::size_t k = 0; k < order.size(); ++k) {
      const std::size_t i = order[k];
      const Body& body = bodies_[k];
      if (body.inverse_mass == Real(0)) continue;
      world_.orientation[i] = turned(world_.orientation[i], body.spin, options_.step);
      world_.position[i] = body.x;
      world_.velocity[i] = body.v;
      world_.spin[i] = body.spin;
    }
  }

  /// How far a body may come in one step.
  auto step_reach() const {
    return [dt = options_.step](const Body& body) {
      return length(body.v) * dt + length(body.acceleration) * dt * dt / 2;
    };
  }
  /// Pairs are listed for as long as nobody has come further than this.
  auto reach() const {
    return
        [once = step_reach()](const Body& body) { return std::max(Real(0.15) * body.radius, Real(1.25) * once(body)); };
  }

  void accelerate(const Real& t) {
    const std::vector<std::uint32_t>& order = pairs_.order(world_);
    x_.resize(bodies_.size()), v_.resize(bodies_.size()), force_.resize(bodies_.size());
    for (std::size_t k = 0; k < order.size(); ++k) x_[order[k]] = bodies_[k].x, v_[order[k]] = bodies_[k].v;
    forces<Real, Dim>(world_, t, x_, v_, force_);
    for (std::size_t k = 0; k < order.size(); ++k) bodies_[k].acceleration = force_[order[k]] * bodies_[k].inverse_mass;
  }

  void substep(const Real& t, const Real& h) {
    if (has_other_forces_) accelerate(t);
    for (Body& body : bodies_) body.impacts = 0, body.in_contact = false;
    if (may_strike(h)) make_impacts(h);
    for (Body& body : bodies_) body.v += body.acceleration * h;
    ContactStep<Real> step{h, softness(std::min(options_.hertz, Real(0.25) / h), options_.damping, h),
                           options_.fastest_push, true};
    start_contacts();
    solve_contacts(step);
    // Without a contact the path is a parabola: x + v_before h + a h^2 / 2.
    for (Body& body : bodies_) {
      body.x += body.v * h;
      if (!body.in_contact) body.x -= body.acceleration * (h * h / 2);
    }
    step.with_bias = false;
    solve_contacts(step);
  }

  /// The two have struck within this substep and part: their places at its beginning are those they would have come
  /// from.
  static bool has_struck(const Body& a, const Body& b, const Real& parting, const Real& separation) {
    return a.impacts + b.impacts > 0 && separation < Real(0) && parting > Real(0);
  }

  void start_contacts() {
    for (Contact<Real, Dim>& contact : pairs_.pair_contacts().contacts) {
      if (!(contact.normal_impulse > Real(0))) continue;
      Body &a = bodies_[contact.a], &b = bodies_[contact.b];
      const V apart = b.x - a.x;
      const Real distance = length(apart);
      warm_start(contact, a, b, distance > Real(0) ? apart * (1 / distance) : any_direction());
    }
    for (Contact<Real, Dim>& contact : pairs_.wall_contacts()) {
      Body stand_in{};
      if (contact.normal_impulse > Real(0))
        warm_start(contact, bodies_[contact.a], stand_in, V(-world_.walls()[contact.b].normal));
    }
  }

  void solve_contacts(const ContactStep<Real>& step) {
    using std::sqrt;
    for (Contact<Real, Dim>& contact : pairs_.pair_contacts().contacts) {
      Body &a = bodies_[contact.a], &b = bodies_[contact.b];
      const V apart = b.x - a.x;
      const Real square = squared(apart), reach = a.radius + b.radius, distance = sqrt(square);
      const Real separation = distance - reach;
      if (separation > contact_reach(a, b, step.h)) {
        forget(contact);
        continue;
      }
      const V normal = distance > Real(0) ? apart * (1 / distance) : any_direction();
      solve_one(contact, a, b, normal, separation, step);
    }
    for (Contact<Real, Dim>& contact : pairs_.wall_contacts()) {
      const Wall<Real, Dim>& wall = world_.walls()[contact.b];
      Body& a = bodies_[contact.a];
      const Real separation = wall_gap(a, wall);
      Body stand_in{};
      if (separation > contact_reach(a, stand_in, step.h)) {
        forget(contact);
        continue;
      }
      solve_one(contact, a, stand_in, V(-wall.normal), separation, step);
    }
  }
  void solve_one(Contact<Real, Dim>& contact, Body& a, Body& b, const V& normal, const Real& separation,
                 const ContactStep<Real>& step) {
    const Real approach = dot(a.v - b.v, normal);
    // Too fast for a soft contact: struck already, or it will be at the beginning of the next substep.
    if (has_struck(a, b, -approach, separation) ||
        counts(approach, contact.restitution, b.radius > Real(0) ? std::min(a.radius, b.radius) : a.radius, step.h))
      return forget(contact);
    solve_contact(contact, a, b, normal, separation, step);
    const bool touches = contact.normal_impulse > Real(0);
    a.in_contact = a.in_contact || touches;
    b.in_contact = b.in_contact || touches;
  }
  static void forget(Contact<Real, Dim>& contact) {
    contact.normal_impulse = Real(0);
    contact.friction_impulse = {};
    contact.rolling_impulse = {};
  }
  /// Further apart, the two cannot close the gap in a substep.
  static Real contact_reach(const Body& a, const Body& b, const Real& h) {
    using std::abs;
    Real fastest(0);
    for (std::size_t axis = 0; axis < V::size(); ++axis) fastest += abs(b.v[axis] - a.v[axis]);
    return fastest * h;
  }
  static V any_direction() {
    V normal;
    normal[0] = Real(1);
    return normal;
  }

  // Impacts: collisions too fast for a soft contact, or with restitution, each at its instant within the substep.

  struct Impact {
    Real time;
    std::uint32_t a, b;  // b from the number of bodies on: walls
    std::uint32_t impacts_a, impacts_b;
    Real restitution, friction;
    bool operator<(const Impact& other) const {  // for a queue whose top is the first
      if (time != other.time) return time > other.time;
      return a != other.a ? a > other.a : b > other.b;
    }
  };

  /// What gravity alone brings about in a substep is no impact; nor is, without restitution, what moves it by less than
  /// half a radius.
  bool counts(const Real& speed, const Real& restitution, const Real& radius, const Real& h) const {
    return restitution > Real(0) ? speed > 4 * greatest_acceleration_ * h : speed * h > radius / 2;
  }

  /// Without restitution only what moves by half a radius in a substep strikes; most worlds at most times have neither.
  bool may_strike(const Real& h) {
    greatest_acceleration_ = Real(0);
    Real fastest(0);
    for (const Body& body : bodies_) {
      greatest_acceleration_ = std::max(greatest_acceleration_, squared(body.acceleration));
      fastest = std::max(fastest, squared(body.v) / (body.radius * body.radius));
    }
    using std::sqrt;
    greatest_acceleration_ = sqrt(greatest_acceleration_);
    return pairs_.has_restitution() || sqrt(fastest) * h > Real(0.2);  // of two that meet, and what gravity adds
  }

  void make_impacts(const Real& h) {
    for (const auto& contact : pairs_.pair_contacts().contacts)
      foresee(contact.a, contact.b, contact.restitution, contact.friction, Real(0), h);
    for (const auto& contact : pairs_.wall_contacts())
      foresee_wall(contact.a, contact.b, contact.restitution, contact.friction, Real(0), h);
    std::size_t left = 64 * bodies_.size();  // a bound for what never ends: balls squeezed between others
    for (; !queue_.empty() && left > 0; --left) {
      const Impact impact = queue_.top();
      queue_.pop();
      if (is_current(impact)) strike(impact, h);
    }
    queue_ = {};
  }
  bool is_current(const Impact& impact) const {
    return bodies_[impact.a].impacts == impact.impacts_a &&
           (impact.b >= bodies_.size() || bodies_[impact.b].impacts == impact.impacts_b);
  }

  void foresee(std::uint32_t i, std::uint32_t j, const Real& restitution, const Real& friction, const Real& from,
               const Real& h) {
    const Body &a = bodies_[i], &b = bodies_[j];
    const V rate = b.v - a.v, pull = b.acceleration - a.acceleration;
    const Real speed = length(rate) + length(pull) * h;
    if (!counts(speed, restitution, std::min(a.radius, b.radius), h)) return;
    const V apart = b.x - a.x + rate * from + pull * (from * from / 2), rate_now = rate + pull * from;
    const Real reach = a.radius + b.radius;
    if (squared(apart) > (reach + speed * h) * (reach + speed * h)) return;
    const Real wait = pull == V{} ? time_to_touch(apart, rate_now, reach)
                                  : time_to_touch(apart, rate_now, pull, reach, Real(h - from));
    if (!(from + wait < h)) return;
    const V then = apart + rate_now * wait + pull * (wait * wait / 2), v_then = rate_now + pull * wait;
    if (!counts(Real(-dot(v_then, then) / reach), restitution, std::min(a.radius, b.radius), h)) return;
    queue_.push({from + wait, i, j, a.impacts, b.impacts, restitution, friction});
  }
  void foresee_wall(std::uint32_t i, std::uint32_t w, const Real& restitution, const Real& friction, const Real& from,
                    const Real& h) {
    const Body& a = bodies_[i];
    const Wall<Real, Dim>& wall = world_.walls()[w];
    const Real pull = dot(a.acceleration, wall.normal), speed = dot(a.v, wall.normal) + pull * from;
    const Real s = wall_gap(a, wall) + (speed - pull * from / 2) * from;
    const Real wait = time_to_close(s, speed, pull);
    if (!(from + wait < h)) return;
    if (!counts(Real(-(speed + pull * wait)), restitution, a.radius, h)) return;
    queue_.push({from + wait, i, static_cast<std::uint32_t>(bodies_.size()) + w, a.impacts, 0, restitution, friction});
  }

  /// Both go to the place of the impact, change their velocities, and go back along their new paths to the beginning.
  void strike(const Impact& impact, const Real& h) {
    ++statistics.impacts;
    const Material<Real> material{impact.restitution, impact.friction, Real(0)};
    Body& a = bodies_[impact.a];
    go(a, impact.time);
    if (impact.b < bodies_.size()) {
      Body& b = bodies_[impact.b];
      go(b, impact.time);
      const V apart = b.x - a.x;
      const Real distance = length(apart);
      const V normal = distance > Real(0) ? apart * (1 / distance) : any_direction();
      if (dot(b.v - a.v, normal) < Real(0)) collide(mover(a), mover(b), normal, material);
      after_impact(impact.b, impact.time);
    } else {
      Body stand_in{};
      const Wall<Real, Dim>& wall = world_.walls()[impact.b - bodies_.size()];
      if (dot(a.v, wall.normal) < Real(0)) collide(mover(a), mover(stand_in), V(-wall.normal), material);
    }
    after_impact(impact.a, impact.time);
    foresee_all(impact.a, impact.time, h);
    if (impact.b < bodies_.size()) foresee_all(impact.b, impact.time, h);
  }
  void after_impact(std::uint32_t i, const Real& time) {
    go(bodies_[i], Real(-time));
    ++bodies_[i].impacts;
  }
  static void go(Body& body, const Real& duration) {
    body.x += body.v * duration + body.acceleration * (duration * duration / 2);
    body.v += body.acceleration * duration;
  }
  static Mover<Real, Dim> mover(Body& body) {
    return {body.v, body.spin, body.radius, body.inverse_mass, body.inverse_inertia};
  }
  /// A body that an impact made faster may get further than its pairs were listed for: then it looks itself.
  void foresee_all(std::uint32_t i, const Real& from, const Real& h) {
    pairs_.for_each_neighbour(world_, bodies_, i, Real(length(bodies_[i].v) * options_.step),
                              [&](std::uint32_t j, const Material<Real>& material) {
                                foresee(std::min(i, j), std::max(i, j), material.restitution, material.friction, from,
                                        h);
                              });
    for (std::uint32_t w = 0; w < world_.walls().size(); ++w) {
      const Material<Real> material = combined(pairs_.material(world_, i), world_.walls()[w].material);
      foresee_wall(i, w, material.restitution, material.friction, from, h);
    }
  }

  World<Real, Dim>& world_;
  FastOptions<Real> options_;
  std::vector<Body> bodies_;
  PairList<Real, Dim> pairs_;
  bool has_other_forces_ = false;
  Real greatest_acceleration_ = Real(0);
  std::vector<V> x_, v_, force_;
  std::priority_queue<Impact> queue_;
};

template <class Real, int Dim>
FastMotion<Real, Dim>::FastMotion(World<Real, Dim>& world, const FastOptions<Real>& options)
    : stepper_(std::make_unique<Stepper>(world, options)) {}
template <class Real, int Dim>
FastMotion<Real, Dim>::FastMotion(FastMotion&&) noexcept = default;
template <class Real, int Dim>
FastMotion<Real, Dim>& FastMotion<Real, Dim>::operator=(FastMotion&&) noexcept = default;
template <class Real, int Dim>
FastMotion<Real, Dim>::~FastMotion() = default;
template <class Real, int Dim>
std::string FastMotion<Real, Dim>::advance() {
  return stepper_->advance();
}
template <class Real, int Dim>
void FastMotion<Real, Dim>::refresh() {
  stepper_->refresh();
}
template <class Real, int Dim>
Real FastMotion<Real, Dim>::deepest_overlap() const {
  return stepper_->deepest_overlap();
}
template <class Real, int Dim>
const FastStatistics& FastMotion<Real, Dim>::statistics() const {
  return stepper_->statistics;
}

template class FastMotion<float, 2>;
template class FastMotion<float, 3>;
template class FastMotion<double, 2>;
template class FastMotion<double, 3>;

}  // namespace continuo
