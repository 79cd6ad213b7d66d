// Finds wheels on the ground, and solves for the impulses of their springs, tyres, motors and brakes in one step.
// Included only by the sources that instantiate it for a precision.
#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include <continuo/bodies/rigid_stepping/constraint_rows.hpp>
#include <continuo/bodies/vehicle.hpp>

namespace continuo {
namespace detail {

/// Steepest ground, by the part of its normal along the spring, that bears a wheel.
template <class Real>
constexpr Real least_up = Real(0.2);

/// The frame of a wheel: forwards and upwards in its plane, and the rotation that rolls it forwards.
template <class Real, int Dim>
struct WheelFrame {
  Vector<Real, Dim> forward{}, up{}, top{};  // top: the centre with the spring fully compressed
  Spin<Real, Dim> axle{};
};

/// What is there without a force of a vehicle: exactly what was there before, unless somebody has changed it.
template <class Real, int Dim>
Vector<Real, Dim> without(const VehicleForce<Real, Dim>& force, const Vector<Real, Dim>& there) {
  return there == force.sum ? force.others : Vector<Real, Dim>(there - force.force);
}

/// The impulses of friction of at most this size that come nearest to those wanted, which would end all sliding, in the
/// metric of how much they change it: what sliding is left is then against them, by Coulomb's law. They are
/// give*wanted/(give + m) with the m > 0 at which the size is reached, found by Newton's method on its inverse, which
/// converges from 0 without a step too far (J. J. More, D. C. Sorensen, "Computing a trust region step", SIAM J. Sci.
/// Stat. Comput. 4, 1983).
template <class Real>
std::array<Real, 2> within(const std::array<Real, 2>& wanted, const std::array<Real, 2>& give, const Real& most) {
  if (!(most > Real(0))) return {};
  Real m(0);
  std::array<Real, 2> found = wanted;
  for (int round = 0; round < 30; ++round) {
    const Real size = std::hypot(found[0], found[1]);
    if (!(size > most * (1 + 4 * std::numeric_limits<Real>::epsilon()))) return found;
    const Real slope = found[0] * found[0] / (give[0] + m) + found[1] * found[1] / (give[1] + m);
    m += (size - most) / most * (size * size / slope);
    for (std::size_t i = 0; i < 2; ++i) found[i] = give[i] * wanted[i] / (give[i] + m);
  }
  const Real part = most / std::hypot(found[0], found[1]);
  return {found[0] * part, found[1] * part};
}

/// Where a wheel touches the ground.
template <class Real, int Dim>
struct WheelContact {
  Vector<Real, Dim> point{}, normal{};
  Real extension{};  // of the spring, from where it is fully compressed; below 0 beyond the stop
  RayHit<Real, Dim> hit{};
};

/// Rays down through the plane of a wheel. Around each the ground is taken for its tangent plane: so a wheel touches
/// planes exactly, and edges as finely as rays lie.
template <class Real, int Dim>
class WheelRays {
 public:
  static constexpr std::size_t count = 9;
  using V = Vector<Real, Dim>;

  WheelRays(const VehicleWheel<Real, Dim>& wheel, const WheelFrame<Real, Dim>& frame) : wheel_(wheel), frame_(frame) {}

  [[nodiscard]] std::array<Ray<Real, Dim>, count> rays() const {
    std::array<Ray<Real, Dim>, count> made;
    for (std::size_t k = 0; k < count; ++k)
      made[k] = {.origin = frame_.top + frame_.forward * place(k),
                 .direction = -frame_.up,
                 .reach = wheel_.travel + 2 * wheel_.radius};
    return made;
  }

  /// The contact that compresses the spring most.
  [[nodiscard]] std::optional<WheelContact<Real, Dim>> contact(std::span<const RayHit<Real, Dim>> hits) const {
    std::optional<WheelContact<Real, Dim>> found;
    for (std::size_t k = 0; k < count; ++k) {
      const bool is_ground = hits[k].distance > Real(0) && std::isfinite(hits[k].distance) &&
                             dot(hits[k].normal, frame_.up) >= least_up<Real>;
      if (!is_ground) continue;  // 0: it began inside of something that stands beside the wheel
      const auto of_ray = touched(place(k), hits[k]);
      if (of_ray.extension <= wheel_.travel && (!found || of_ray.extension < found->extension)) found = of_ray;
    }
    return found;
  }

 private:
  /// How far in front of the centre ray k is: 0, then alternately before and behind it.
  [[nodiscard]] Real place(std::size_t k) const {
    const auto step = static_cast<Real>((k + 1) / 2);
    return (k % 2 == 1 ? step : -step) * spacing();
  }
  [[nodiscard]] Real spacing() const { return wheel_.radius * Real(0.24); }

  /// With the plane of a hit, or that point of it next to the ray's part of the wheel which the wheel touches.
  [[nodiscard]] WheelContact<Real, Dim> touched(const Real& x, const RayHit<Real, Dim>& hit) const {
    const Real r = wheel_.radius, ahead = dot(hit.normal, frame_.forward), up = dot(hit.normal, frame_.up);
    const Real tangent = -r * ahead / std::hypot(ahead, up);
    const Real at = std::clamp(tangent, x - spacing() / 2, x + spacing() / 2);
    const Real height = std::sqrt(std::max(r * r - at * at, Real(0)));  // of the centre above the point
    const Real depth = hit.distance + (at - x) * ahead / up;
    WheelContact<Real, Dim> made{.point = frame_.top + frame_.forward * at - frame_.up * depth,
                                 .normal = hit.normal,
                                 .extension = depth - height,
                                 .hit = hit};
    if (at != tangent) made.normal = (frame_.up * height - frame_.forward * at) * (1 / r);
    return made;
  }

  const VehicleWheel<Real, Dim>& wheel_;
  WheelFrame<Real, Dim> frame_;
};

template <class Real, int Dim>
class VehicleStep {
 public:
  using V = Vector<Real, Dim>;
  using S = Spin<Real, Dim>;

  VehicleStep(World<Real, Dim>& world, const Vehicle<Real, Dim>& vehicle, const VehicleControls<Real>& controls,
              const Real& h)
      : world_(world), vehicle_(vehicle), controls_(controls), h_(h), states_(vehicle.states) {
    states_.resize(vehicle.wheels.size());
    const std::size_t c = world.index(vehicle.chassis);
    others_ = world.constant_force[c];
    for (const VehicleForce<Real, Dim>& force : vehicle.forces)
      if (force.body == vehicle.chassis) others_ = without(force, others_);
    add_body(c);
    // The velocity without the wheels.
    const V pull = world.gravity * world.traits(c).gravity_scale + others_ * world.inverse_mass[c];
    bodies_[0].body.v += pull * h;
    pull_ = length(pull), weight_ = pull_ * world.mass[c] * h;
  }

  /// Where the wheels are.
  [[nodiscard]] Status find_contacts(const Queries<Real, Dim>& queries) {
    QueryFilter filter = vehicle_.filter;
    filter.without = vehicle_.chassis, filter.sensors = false;
    for (std::size_t k = 0; k < states_.size(); ++k) {
      states_[k].steer = controls_.steer * vehicle_.wheels[k].greatest_steer;
      frames_.push_back(frame_of(k));
      const WheelRays<Real, Dim> rays(vehicle_.wheels[k], frames_[k]);
      const auto hits = queries.first_hits(rays.rays(), filter);
      if (!hits) return hits.status();
      const auto contact = rays.contact(*hits);
      prepare(k, contact ? &*contact : nullptr);
    }
    return {};
  }

  /// Projected Gauss-Seidel on the impulses until they stand still, which those of a few wheels on one body do soon,
  /// unless tyres that hold share what none of them needs, or slide by much friction.
  void solve() {
    constexpr int most_sweeps = 500;
    const Real enough = 4 * std::numeric_limits<Real>::epsilon();
    for (int sweep = 0; sweep < most_sweeps; ++sweep) {
      Real change(0), sum(weight_);
      for (Contact& contact : contacts_) {
        const Real before = contact.spring.impulse + contact.stop.impulse;
        press(contact);
        const Real load = contact.spring.impulse + contact.stop.impulse;
        change += std::abs(load - before), sum += std::abs(load);
      }
      for (std::size_t k = 0; k < axles_.size(); ++k) change += roll(k);
      residual_ = change > Real(0) ? change / sum : Real(0);
      if (!(residual_ > enough)) return;
    }
  }

  /// To the vehicle and its world. A force moves the body during the step, as gravity does, so that where both are in
  /// balance nothing moves. What loads have grown by beyond the weight since the last step is an impulse at the
  /// beginning, which stops a wheel where its spring ends.
  void store(Vehicle<Real, Dim>& vehicle) {
    std::vector<V> forces(bodies_.size()), kicks(bodies_.size());
    const auto give = [&](const Contact& contact, std::vector<V>& to, const V& impulse) {
      to[0] += impulse, to[contact.ground] -= impulse;
    };
    Real loads(0);
    for (const Contact& contact : contacts_) loads += contact.spring.impulse + contact.stop.impulse;
    const Real part = loads > weight_ ? weight_ / loads : Real(1);
    for (const Contact& contact : contacts_) {
      WheelState<Real, Dim>& state = states_[contact.wheel];
      const Real load = contact.spring.impulse + contact.stop.impulse;
      const Real before = vehicle.states.empty() ? Real(0) : vehicle.states[contact.wheel].load * h_;
      const Real lasting = std::min(load, std::max(before, part * load));
      give(contact, kicks, contact.spring.direction * (load - lasting));
      give(contact, forces,
           contact.spring.direction * lasting + contact.along.direction * contact.along.impulse +
               contact.aside.direction * contact.aside.impulse);
      state.load = load / h_, state.along = contact.along.impulse / h_, state.aside = contact.aside.impulse / h_;
    }
    release(world_, vehicle);
    for (std::size_t b = 0; b < bodies_.size(); ++b) {
      const auto& [index, body] = bodies_[b];
      if (body.is_fixed()) continue;
      world_.spin[index] = body.spin;
      world_.velocity[index] += kicks[b] * body.inverse_mass;
      V& there = world_.constant_force[index];
      const V force = forces[b] * (1 / h_);
      vehicle.forces.push_back({.body = world_.handle(index), .force = force, .others = there, .sum = there + force});
      there += force;
    }
    for (std::size_t k = 0; k < states_.size(); ++k) {
      states_[k].spin = axles_[k].spin;
      states_[k].turn += (axles_[k].spin - dot(frames_[k].axle, chassis().spin)) * h_;
    }
    vehicle.states = states_;
    vehicle.residual = residual_;
  }

 private:
  using Row = ConstraintRow<Real, Dim>;  // a is the ground, b the chassis
  /// A body with its velocities at the end of the step; the first is the chassis.
  struct Pushed {
    std::size_t index = 0;  // in the world; beyond its bodies, what never moves
    RigidBody<Real, Dim> body{};
  };
  struct Contact {
    std::size_t wheel = 0, ground = 0;  // the latter into bodies_
    Row spring{}, stop{}, along{}, aside{};
    Real softness{}, rise{};  // of the spring: rise - softness*impulse is the velocity at which it is content
    Real least_rise{};        // of the stop
    Real friction{};
  };
  /// A wheel about its axle: it turns with the angular velocity `spin`, and `impulse`, of motor or brake, is between
  /// low and high and the least that brings it to `target` against the chassis.
  struct Axle {
    Real spin{}, target{}, low{}, high{}, impulse{};
    std::size_t contact = 0;  // into contacts_; beyond these in the air
  };

  /// The place of a body of the world, or of what is no body.
  std::size_t add_body(std::size_t index) {
    const auto known = std::ranges::find(bodies_, index, &Pushed::index);
    if (known != bodies_.end()) return static_cast<std::size_t>(known - bodies_.begin());
    RigidBody<Real, Dim>& body = bodies_.emplace_back(Pushed{.index = index}).body;
    if (index < world_.size()) {
      const bool stands = world_.is_fixed(index);
      body.x = world_.position[index], body.orientation = world_.orientation[index];
      if (!stands || world_.traits(index).is_driven) body.v = world_.velocity[index], body.spin = world_.spin[index];
      if (!stands)
        body.inverse_inertia = inverse(world_.inertia(index)), body.inverse_mass = world_.inverse_mass[index];
    }
    body.update_axes();
    return bodies_.size() - 1;
  }

  [[nodiscard]] WheelFrame<Real, Dim> frame_of(std::size_t k) const {
    const VehicleWheel<Real, Dim>& wheel = vehicle_.wheels[k];
    const std::size_t c = world_.index(vehicle_.chassis);
    WheelFrame<Real, Dim> frame;
    V ahead, up;
    ahead[0] = Real(1), up[Dim - 1] = Real(1);
    if constexpr (Dim == 3) {
      ahead[0] = std::cos(states_[k].steer), ahead[1] = std::sin(states_[k].steer);
      frame.axle = chassis().axes * turning(up, ahead);
    } else {
      frame.axle[0] = Real(-1);
    }
    frame.forward = chassis().axes * ahead, frame.up = chassis().axes * up;
    frame.top = world_.origin(c) + chassis().axes * wheel.hub + frame.up * wheel.travel;
    return frame;
  }

  void prepare(std::size_t k, const WheelContact<Real, Dim>* contact) {
    const VehicleWheel<Real, Dim>& wheel = vehicle_.wheels[k];
    WheelState<Real, Dim>& state = states_[k];
    const WheelFrame<Real, Dim>& frame = frames_[k];
    Axle axle{.spin = state.spin, .target = Real(0), .contact = contact ? contacts_.size() : nowhere};
    const Real brake = controls_.brake * wheel.greatest_brake * h_;
    if (brake > Real(0)) {
      axle.low = -brake, axle.high = brake;
    } else {
      const Real drive = controls_.throttle * wheel.greatest_drive * h_;
      axle.low = std::min(drive, Real(0)), axle.high = std::max(drive, Real(0));
      axle.target = drive < Real(0) ? Real(-wheel.top_spin) : wheel.top_spin;
    }
    axles_.push_back(axle);
    const Real extension = contact ? std::clamp(contact->extension, Real(0), wheel.travel) : wheel.travel;
    state.compression = wheel.travel - extension;
    state.centre = frame.top - frame.up * extension;
    state.is_on_ground = contact != nullptr;
    if (contact) {
      state.point = contact->point, state.normal = contact->normal, state.ground = contact->hit.body;
      add_contact(k, *contact);
    } else {
      state.point = state.normal = V{};
      state.ground = {};
    }
    state.load = state.along = state.aside = Real(0);
    if (!contact) state.stiffness = wheel.stiffness;
  }

  /// With x the compression and c the part of the normal along the spring, x falls by u/c where the ground leaves the
  /// body with u along the normal, and a spring of force S pushes with S/c along it: both do the same work. So the
  /// impulse p of the spring at the end of the step is h (k (x - h u/c) - d u/c)/c. As the force is the same during the
  /// step, it is right to the first order, and a spring that swung by more than a radian in a step would not come to
  /// rest.
  void add_contact(std::size_t k, const WheelContact<Real, Dim>& at) {
    const VehicleWheel<Real, Dim>& wheel = vehicle_.wheels[k];
    WheelState<Real, Dim>& state = states_[k];
    const WheelFrame<Real, Dim>& frame = frames_[k];
    const bool is_body = world_.contains(at.hit.body);
    const std::size_t ground = add_body(is_body ? world_.index(at.hit.body) : world_.size());
    const Real c = dot(at.normal, frame.up), x = wheel.travel - at.extension;
    Contact made{.wheel = k, .ground = ground, .friction = friction(wheel, at.hit)};
    made.spring = made.stop = row(at, ground, at.normal);
    state.stiffness = std::min(wheel.stiffness, made.spring.mass * c * c / (2 * h_ * h_));
    const Real give = h_ * state.stiffness + wheel.damping;
    made.softness = c * c / (h_ * give);
    made.rise = state.stiffness * x * c / give;
    // It may reach the stop in this step; from beyond it comes back a part of the way, no faster than it would fall.
    const Real beyond = x - wheel.travel;
    made.least_rise =
        beyond > Real(0) ? std::min(Real(0.2) * beyond / h_, std::sqrt(pull_ * beyond)) * c : beyond * c / h_;
    V ahead = turning(frame.axle, at.normal);
    ahead *= 1 / length(ahead);
    made.along = row(at, ground, ahead);
    made.along.lever_b += frame.axle * wheel.radius;  // the ground turns the wheel, not the body
    set_mass(made.along, bodies_[ground].body, chassis());
    made.along.mass = 1 / (1 / made.along.mass + wheel.radius * wheel.radius / wheel.inertia);
    if constexpr (Dim == 3) made.aside = row(at, ground, turning(at.normal, ahead));
    contacts_.push_back(made);
    // From the forces of the step before.
    Contact& contact = contacts_.back();
    push(contact, contact.spring, state.load * h_);
    push_along(contact, state.along * h_);
    push(contact, contact.aside, state.aside * h_);
  }
  [[nodiscard]] Real friction(const VehicleWheel<Real, Dim>& wheel, const RayHit<Real, Dim>& hit) const {
    const Material<Real>& ground = hit.is_wall()   ? world_.walls()[hit.wall].material
                                   : hit.is_mesh() ? world_.meshes()[hit.mesh].material
                                                   : world_.material[world_.index(hit.body)];
    return combined(world_.combine_rule.friction, wheel.friction, ground.friction);
  }
  [[nodiscard]] Row row(const WheelContact<Real, Dim>& at, std::size_t ground, const V& direction) const {
    const RigidBody<Real, Dim>& under = bodies_[ground].body;
    Row made{.direction = direction,
             .lever_a = moment(V(at.point - under.x), direction),
             .lever_b = moment(V(at.point - chassis().x), direction)};
    set_mass(made, under, chassis());
    return made;
  }
  [[nodiscard]] const RigidBody<Real, Dim>& chassis() const { return bodies_[0].body; }
  [[nodiscard]] Real velocity(const Contact& contact, const Row& row) const {
    return row.velocity(bodies_[contact.ground].body, chassis());
  }
  void push(const Contact& contact, Row& row, const Real& impulse) {
    row.impulse += impulse;
    row.apply(impulse, bodies_[contact.ground].body, bodies_[0].body);
  }
  /// Which turns the wheel, too.
  void push_along(Contact& contact, const Real& impulse) {
    const VehicleWheel<Real, Dim>& wheel = vehicle_.wheels[contact.wheel];
    push(contact, contact.along, impulse);
    axles_[contact.wheel].spin -= wheel.radius / wheel.inertia * impulse;
  }
  void push_axle(std::size_t k, const Real& impulse) {
    axles_[k].impulse += impulse;
    axles_[k].spin += impulse / vehicle_.wheels[k].inertia;
    bodies_[0].body.spin -= chassis().inverse_inertia_now * frames_[k].axle * impulse;
  }

  void press(Contact& contact) {
    Row &spring = contact.spring, &stop = contact.stop;
    const Real content = contact.rise - contact.softness * spring.impulse - velocity(contact, spring);
    push(contact, spring, std::max(content / (1 / spring.mass + contact.softness), -spring.impulse));
    push(contact, stop, std::max((contact.least_rise - velocity(contact, stop)) * stop.mass, -stop.impulse));
  }

  /// Motor or brake with the friction of the tyre; how much they have changed. What keeps a tyre from sliding forwards
  /// depends on whether the wheel turns: both are found together.
  [[nodiscard]] Real roll(std::size_t k) {
    Axle& axle = axles_[k];
    const Real before = axle.impulse;
    if (axle.contact == nowhere) {
      turn(k);
      return std::abs(axle.impulse - before) / vehicle_.wheels[k].radius;
    }
    Contact& contact = contacts_[axle.contact];
    const Real most = contact.friction * (contact.spring.impulse + contact.stop.impulse);
    const Real along = contact.along.impulse, aside = contact.aside.impulse;
    hold(contact, k);
    if constexpr (Dim == 3) push(contact, contact.aside, -velocity(contact, contact.aside) * contact.aside.mass);
    if (std::hypot(contact.along.impulse, contact.aside.impulse) > most) slide(contact, k, along, aside, most);
    return std::abs(contact.along.impulse - along) + std::abs(contact.aside.impulse - aside);
  }
  /// The impulse of motor or brake with that of the tyre as it is.
  void turn(std::size_t k) {
    const Real against = axles_[k].spin - dot(frames_[k].axle, chassis().spin);
    const Real wanted = axles_[k].impulse + (axles_[k].target - against) / mobility_of_axle(k);
    push_axle(k, std::clamp(wanted, axles_[k].low, axles_[k].high) - axles_[k].impulse);
  }
  [[nodiscard]] Real mobility_of_axle(std::size_t k) const {
    return 1 / vehicle_.wheels[k].inertia + dot(frames_[k].axle, chassis().inverse_inertia_now * frames_[k].axle);
  }
  [[nodiscard]] Real slip(const Contact& contact) const {
    return velocity(contact, contact.along) - vehicle_.wheels[contact.wheel].radius * axles_[contact.wheel].spin;
  }

  /// Keeps the tyre from sliding along, whatever that takes: where the impulse of the axle is not at a limit, by both
  /// together, a system of two equations; else by the tyre alone.
  void hold(Contact& contact, std::size_t k) {
    Axle& axle = axles_[k];
    if (std::isfinite(axle.target) && axle.low < axle.high) {
      const Real of_tyre = 1 / contact.along.mass, of_axle = mobility_of_axle(k);
      const Real both = coupling(contact, k);
      const Real slipping = -slip(contact);
      const Real turning_by = axle.target - (axle.spin - dot(frames_[k].axle, chassis().spin));
      const Real determinant = of_tyre * of_axle - both * both;
      const Real impulse = (of_tyre * turning_by - both * slipping) / determinant;
      push_axle(k, std::clamp(axle.impulse + impulse, axle.low, axle.high) - axle.impulse);
    } else {
      push_axle(k, (axle.target > Real(0) ? axle.high : axle.low) - axle.impulse);
    }
    push_along(contact, -slip(contact) * contact.along.mass);
  }
  /// From the impulses of the sweep before: against the way in which the tyre slides, with all its friction. The wheel
  /// turns as that allows.
  void slide(Contact& contact, std::size_t k, const Real& along, const Real& aside, const Real& most) {
    push_along(contact, along - contact.along.impulse), push(contact, contact.aside, aside - contact.aside.impulse);
    turn(k);
    const std::array give = {give_along(contact, k), Dim == 2 ? Real(1) : 1 / contact.aside.mass};
    const auto [x, y] =
        within<Real>({along - slip(contact) / give[0], aside - velocity(contact, contact.aside) / give[1]}, give, most);
    push_along(contact, x - along), push(contact, contact.aside, y - aside);
    turn(k);
  }
  /// How much an impulse along changes the slip, where a wheel that its motor or brake holds stays held.
  [[nodiscard]] Real give_along(const Contact& contact, std::size_t k) const {
    const Axle& axle = axles_[k];
    const bool is_held = axle.low < axle.impulse && axle.impulse < axle.high;
    const Real both = is_held ? coupling(contact, k) : Real(0);
    return 1 / contact.along.mass - both * both / mobility_of_axle(k);
  }
  /// How much an impulse of the axle changes the slip.
  [[nodiscard]] Real coupling(const Contact& contact, std::size_t k) const {
    return -(vehicle_.wheels[k].radius / vehicle_.wheels[k].inertia +
             dot(contact.along.lever_b, chassis().inverse_inertia_now * frames_[k].axle));
  }

  static constexpr std::size_t nowhere = static_cast<std::size_t>(-1);
  World<Real, Dim>& world_;
  const Vehicle<Real, Dim>& vehicle_;
  VehicleControls<Real> controls_;
  Real h_;
  std::vector<WheelState<Real, Dim>> states_;
  V others_{};
  Real pull_{}, weight_{};  // the acceleration of the chassis without the wheels, and the impulse of that
  std::vector<Pushed> bodies_;
  std::vector<WheelFrame<Real, Dim>> frames_;
  std::vector<Contact> contacts_;
  std::vector<Axle> axles_;
  Real residual_{};
};

template <class Real>
bool is_part(const Real& value) {
  return value >= Real(0) && std::isfinite(value);
}

template <class Real, int Dim>
Status check(const VehicleWheel<Real, Dim>& wheel) {
  if (!(wheel.radius > Real(0)) || !std::isfinite(wheel.radius) || !is_finite(wheel.hub))
    return invalid_input("a wheel needs a hub that is finite, and a radius greater than 0");
  if (!is_part(wheel.travel)) return invalid_input("the travel of a spring must be 0 or more, and finite");
  if (!is_part(wheel.stiffness) || !is_part(wheel.damping) || !(wheel.stiffness + wheel.damping > Real(0)))
    return invalid_input("stiffness and damping of a wheel must be 0 or more, one of them greater, and finite");
  if (!is_part(wheel.friction)) return invalid_input("the friction of a tyre must be 0 or more, and finite");
  if (!(wheel.inertia > Real(0)) || !std::isfinite(wheel.inertia))
    return invalid_input("the moment of inertia of a wheel must be greater than 0, and finite");
  if (!is_part(wheel.greatest_drive) || !is_part(wheel.greatest_brake) || !(wheel.top_spin >= Real(0)))
    return invalid_input("the greatest torques and the top spin of a wheel must be 0 or more");
  if (!(std::abs(wheel.greatest_steer) < Real(1.57)))
    return invalid_input("a wheel is steered by less than a right angle");
  return {};
}

template <class Real, int Dim>
Status check(const World<Real, Dim>& world, const Vehicle<Real, Dim>& vehicle, const VehicleControls<Real>& controls) {
  constexpr std::size_t most_wheels = 64;
  if (!world.contains(vehicle.chassis)) return invalid_input("the chassis is no body of this world");
  const std::size_t c = world.index(vehicle.chassis);
  if (world.is_fixed(c)) return invalid_input("the chassis is fixed: a vehicle must be able to move");
  if (!is_finite(world.position[c]) || !is_finite(world.velocity[c]) || !is_finite(world.spin[c]))
    return invalid_input("place and velocity of the chassis must be finite");
  if (vehicle.wheels.size() > most_wheels) return invalid_input("a vehicle has at most 64 wheels");
  if (!vehicle.states.empty() && vehicle.states.size() != vehicle.wheels.size())
    return invalid_input("a vehicle has one state for each wheel, or none at all: `drive` makes them");
  const auto is_between = [](const Real& least, const Real& value) { return value >= least && value <= Real(1); };
  if (!is_between(Real(-1), controls.throttle) || !is_between(Real(-1), controls.steer) ||
      !is_between(Real(0), controls.brake))
    return invalid_input("throttle and steer must be between -1 and 1, the brake between 0 and 1");
  for (const VehicleWheel<Real, Dim>& wheel : vehicle.wheels)
    if (Status fault = check(wheel); !fault) return fault;
  return {};
}

}  // namespace detail

template <class Real, int Dim>
Status drive(World<Real, Dim>& world, const Queries<Real, Dim>& queries, Vehicle<Real, Dim>& vehicle,
             const VehicleControls<Real>& controls, const Real& duration) {
  if (Status fault = detail::check(world, vehicle, controls); !fault) return fault;
  if (!(duration > Real(0)) || !std::isfinite(duration)) return invalid_input("the duration must be greater than 0");
  detail::VehicleStep<Real, Dim> step(world, vehicle, controls, duration);
  if (Status fault = step.find_contacts(queries); !fault) return fault;
  step.solve();
  step.store(vehicle);
  return {};
}

template <class Real, int Dim>
void release(World<Real, Dim>& world, Vehicle<Real, Dim>& vehicle) {
  for (const VehicleForce<Real, Dim>& force : vehicle.forces) {
    if (!world.contains(force.body)) continue;
    auto& there = world.constant_force[world.index(force.body)];
    there = detail::without(force, there);
  }
  vehicle.forces.clear();
}

}  // namespace continuo
