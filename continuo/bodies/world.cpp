// continuo/bodies/world.cpp
// Adds, checks and removes bodies, walls and springs, and sums up momenta and energies.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <string>
#include <utility>

#include <continuo/bodies/forces.hpp>
#include <continuo/bodies/world.hpp>
#include <continuo/methods/support/compensated_sum.hpp>
#include <continuo/shapes/direction_of.hpp>

namespace continuo {

namespace {

template <class Real>
bool is_positive(const Real& value) {
  return value > Real(0) && value < std::numeric_limits<Real>::infinity();
}
template <class Real>
bool is_part(const Real& value) {
  return value >= Real(0) && value < std::numeric_limits<Real>::infinity();
}

template <class Real>
Status check_traits(const BodyTraits<Real>& traits) {
  if (!is_part(traits.damping) || !is_part(traits.spin_damping))
    return invalid_input("damping must be 0 or more, and finite");
  if (!(traits.gravity_scale - traits.gravity_scale == Real(0))) return invalid_input("gravity_scale must be finite");
  if (static_cast<unsigned>(traits.locked) > 63) return invalid_input("unknown directions are locked");
  return {};
}

template <class Real, int Dim>
Status check(const BodyDefinition<Real, Dim>& definition) {
  const auto* sphere = std::get_if<Sphere<Real>>(&definition.shape);
  if (sphere && !is_positive(sphere->radius)) return invalid_input("the radius must be greater than 0, and finite");
  if (!is_finite(definition.position)) return invalid_input("the position must be finite");
  if (!is_finite(definition.velocity)) return invalid_input("the velocity must be finite");
  if (!is_finite(definition.spin)) return invalid_input("the spin must be finite");
  if (!is_finite(definition.orientation) || (Dim == 3 && definition.orientation == Orientation<Real, Dim>{}))
    return invalid_input("the orientation must be finite, and in space a quaternion that is not 0");
  if (definition.mass ? !is_positive(*definition.mass) : !is_positive(definition.density))
    return invalid_input("mass and density must be greater than 0, and finite; `fixed` is for bodies that never move");
  if (definition.group >= 32) return invalid_input("groups are numbered from 0 to 31");
  if (Status fault = check_traits(definition.traits); !fault) return fault;
  return check(definition.material);
}

template <class Real>
struct Geometry {
  Real reach{}, volume{}, inertia{};  // of a mass of 1
};
template <class Real, int Size>
Real mean_of_diagonal(const Matrix<Real, Size>& a) {
  Real sum(0);
  for (std::size_t i = 0; i < a.columns.size(); ++i) sum += a[i][i];
  return sum / static_cast<Real>(Size);
}

/// The angular momentum about the centre of mass of body i.
template <class Real, int Dim>
Spin<Real, Dim> momentum_of_spin(const World<Real, Dim>& world, std::size_t i) {
  if (Dim == 2 || !world.solid(i)) return world.spin[i] * (1 / world.inverse_inertia[i]);
  if constexpr (Dim == 3) {
    const Matrix<Real, 3> axes = rotation(world.orientation[i]);
    return axes * (world.inertia(i) * transposed_times(axes, world.spin[i]));
  }
}

}  // namespace

template <class Real>
Status check(const Material<Real>& material) {
  if (!(material.restitution >= Real(0) && material.restitution <= Real(1)))
    return invalid_input("restitution must be between 0 (no bounce) and 1 (no loss)");
  if (!is_part(material.friction)) return invalid_input("friction must be 0 or more, and finite");
  if (!is_part(material.rolling_resistance)) return invalid_input("rolling_resistance must be 0 or more, and finite");
  return {};
}

template <class Real, int Dim>
Status check_bodies(const World<Real, Dim>& world) {
  const std::size_t n = world.size();
  for (const std::size_t size : {world.velocity.size(), world.constant_force.size(), world.orientation.size(),
                                 world.spin.size(), world.radius.size(), world.mass.size(), world.inverse_mass.size(),
                                 world.inverse_inertia.size(), world.material.size()})
    if (size != n)
      return invalid_input("the fields of the bodies have different lengths: `add` and `remove` change all");
  for (std::size_t i = 0; i < n; ++i) {
    const auto of = [i](const char* what) { return std::string(what) + " of body " + std::to_string(i); };
    if (!is_positive(world.radius[i])) return invalid_input(of("the radius") + " must be greater than 0, and finite");
    if (!is_positive(world.mass[i])) return invalid_input(of("the mass") + " must be greater than 0, and finite");
    const Real product = world.mass[i] * world.inverse_mass[i];
    if (world.inverse_mass[i] != Real(0) && !(product > Real(0.999) && product < Real(1.001)))
      return invalid_input(of("inverse_mass") + " must be 1 / mass, or 0 if the body is fixed");
  }
  return {};
}

template <class Real, int Dim>
Result<BodyHandle> World<Real, Dim>::add(const BodyDefinition<Real, Dim>& definition) {
  if (Status fault = check(definition); !fault) return fault;
  std::shared_ptr<const Solid<Real, Dim>> of_shape;
  Geometry<Real> geometry;
  if (const auto* const sphere = std::get_if<Sphere<Real>>(&definition.shape)) {
    geometry = {sphere->radius, volume<Real, Dim>(*sphere), continuo::inertia<Real, Dim>(*sphere, Real(1))};
  } else {
    auto made = solid_of(definition.shape);
    if (!made) return made.status();
    of_shape = *made;
    geometry = {of_shape->reach, of_shape->volume, mean_of_diagonal(of_shape->inertia)};
  }
  const Real m = definition.mass ? *definition.mass : definition.density * geometry.volume;
  const Real j = m * geometry.inertia;
  if (!is_positive(m) || !is_positive(j) || !is_positive(1 / m) || !is_positive(1 / j))
    return invalid_input("mass or moment of inertia is beyond the numbers: the body is too small or too large");

  std::uint32_t slot = static_cast<std::uint32_t>(slots_.size());
  if (free_slots_.empty()) {
    slots_.emplace_back();
  } else {
    slot = free_slots_.back();
    free_slots_.pop_back();
  }
  slots_[slot].index = static_cast<std::uint32_t>(size());
  const bool is_still = definition.fixed && !definition.traits.is_driven;
  velocity.push_back(is_still ? V{} : definition.velocity);
  constant_force.emplace_back();
  O turned_by = definition.orientation;
  if constexpr (Dim == 3) turned_by = direction_of(turned_by);
  orientation.push_back(turned_by);
  position.push_back(of_shape ? V(definition.position + rotation(turned_by) * of_shape->centre) : definition.position);
  spin.push_back(is_still ? S{} : definition.spin);
  radius.push_back(geometry.reach);
  mass.push_back(m);
  inverse_mass.push_back(definition.fixed ? Real(0) : 1 / m);
  inverse_inertia.push_back(definition.fixed ? Real(0) : 1 / j);
  material.push_back(definition.material);
  group_.push_back(definition.group);
  slot_of_.push_back(slot);
  if (of_shape || !solids_.empty()) keep_solid(std::move(of_shape));
  if (!traits_.empty() || definition.traits != BodyTraits<Real>{}) {
    traits_.resize(size());
    traits_.back() = definition.traits;
  }
  return BodyHandle{slot, slots_[slot].generation};
}

template <class Real, int Dim>
void World<Real, Dim>::keep_solid(std::shared_ptr<const Solid<Real, Dim>> of_last) {
  solids_.resize(size());
  solid_count_ += of_last ? 1 : 0;
  solids_.back() = std::move(of_last);
}

template <class Real, int Dim>
Result<std::shared_ptr<const Solid<Real, Dim>>> World<Real, Dim>::solid_of(const Shape<Real, Dim>& shape) const {
  // Bodies are often added in rows of the same shape, which they share.
  constexpr std::size_t most_compared = 8;
  for (std::size_t k = 0; k < std::min(most_compared, solids_.size()); ++k)
    if (const auto& earlier = solids_[solids_.size() - 1 - k]; earlier && earlier->shape == shape) return earlier;
  auto made = continuo::solid<Real, Dim>(shape);
  if (!made) return made.status();
  return std::make_shared<const Solid<Real, Dim>>(std::move(*made));
}

template <class Real, int Dim>
Status World<Real, Dim>::set_traits(BodyHandle body, const BodyTraits<Real>& traits) {
  if (!contains(body)) return invalid_input("the world does not contain this body");
  if (Status fault = check_traits(traits); !fault) return fault;
  traits_.resize(size());
  traits_[index(body)] = traits;
  return {};
}

template <class Real, int Dim>
Inertia<Real, Dim> World<Real, Dim>::inertia(std::size_t i) const {
  if (const Solid<Real, Dim>* const of_body = solid(i)) return of_body->inertia * mass[i];
  const Real of_ball = continuo::inertia<Real, Dim>(Sphere<Real>{radius[i]}, mass[i]);
  return identity_matrix<Real, Dim == 2 ? 1 : 3>() * (inverse_inertia[i] > Real(0) ? 1 / inverse_inertia[i] : of_ball);
}

template <class Real, int Dim>
bool World<Real, Dim>::remove(BodyHandle body) {
  if (!contains(body)) return false;
  const std::size_t i = index(body), last = size() - 1;
  slots_[slot_of_[last]].index = static_cast<std::uint32_t>(i);
  slots_[body.slot].index = nowhere;
  ++slots_[body.slot].generation;
  free_slots_.push_back(body.slot);
  for_each_array(*this, [&](auto& values) {
    values[i] = values[last];
    values.pop_back();
  });
  if (!solids_.empty()) {
    solid_count_ -= solids_[i] ? 1 : 0;
    solids_[i] = std::move(solids_[last]);
    solids_.pop_back();
  }
  if (!traits_.empty()) traits_[i] = traits_[last], traits_.pop_back();
  for (const JointHandle joint : joints())
    if (find(joint)->a == body || find(joint)->b == body) remove_joint(joint);
  return true;
}

template <class Real, int Dim>
World<Real, Dim> World<Real, Dim>::part(std::span<const std::uint32_t> bodies) const {
  World some;
  some.gravity = gravity, some.combine_rule = combine_rule, some.time = time;
  some.walls_ = walls_, some.meshes_ = meshes_, some.ignored_ = ignored_;
  const auto copy = [&](auto& to, const auto& from) {
    for (const std::uint32_t i : bodies) to.push_back(from[i]);
  };
  copy(some.position, position), copy(some.velocity, velocity), copy(some.constant_force, constant_force);
  copy(some.orientation, orientation), copy(some.spin, spin), copy(some.radius, radius), copy(some.mass, mass);
  copy(some.inverse_mass, inverse_mass), copy(some.inverse_inertia, inverse_inertia), copy(some.material, material);
  copy(some.group_, group_);
  if (has_traits()) copy(some.traits_, traits_);
  if (has_solids()) {
    copy(some.solids_, solids_);
    for (const auto& of_body : some.solids_) some.solid_count_ += of_body ? 1 : 0;
  }
  for (std::uint32_t i = 0; i < bodies.size(); ++i) some.slot_of_.push_back(i), some.slots_.push_back({.index = i});
  return some;
}

template <class Real, int Dim>
Status World<Real, Dim>::add_wall(Wall<Real, Dim> wall) {
  if (!is_finite(wall.normal) || wall.normal == V{})
    return invalid_input("the normal of a wall must be finite and not 0");
  if (!(wall.offset - wall.offset == Real(0))) return invalid_input("the offset of a wall must be finite");
  if (Status fault = check(wall.material); !fault) return fault;
  wall.normal = direction_of(wall.normal);
  walls_.push_back(wall);
  return {};
}

template <class Real, int Dim>
Status World<Real, Dim>::add_container(const V& lower, const V& upper, const Material<Real>& of_walls) {
  for (std::size_t axis = 0; axis < lower.size(); ++axis)
    if (!(lower[axis] < upper[axis]))
      return invalid_input("the lower corner of a container must be below the upper one on every axis");
  if (!is_finite(lower) || !is_finite(upper)) return invalid_input("the corners of a container must be finite");
  if (Status fault = check(of_walls); !fault) return fault;
  for (std::size_t axis = 0; axis < lower.size(); ++axis) {
    V up, down;
    up[axis] = Real(1);
    down[axis] = Real(-1);
    walls_.push_back({.normal = up, .offset = lower[axis], .material = of_walls});
    walls_.push_back({.normal = down, .offset = -upper[axis], .material = of_walls});
  }
  return {};
}

template <class Real, int Dim>
Real kinetic_energy(const World<Real, Dim>& world) {
  Real sum(0), rest(0);  // compensated: over very many bodies, rounding would look like a loss
  for (std::size_t i = 0; i < world.size(); ++i) {
    if (world.is_fixed(i)) continue;
    detail::add_compensated(
        Real(squared(world.velocity[i]) / world.inverse_mass[i] + dot(world.spin[i], momentum_of_spin(world, i))), sum,
        rest);
  }
  return sum / 2;
}

template <class Real, int Dim>
Vector<Real, Dim> momentum(const World<Real, Dim>& world) {
  Vector<Real, Dim> sum;
  for (std::size_t i = 0; i < world.size(); ++i) sum += world.mass[i] * world.velocity[i];
  return sum;
}

template <class Real, int Dim>
Spin<Real, Dim> angular_momentum(const World<Real, Dim>& world) {
  Spin<Real, Dim> sum;
  for (std::size_t i = 0; i < world.size(); ++i) {
    if (world.is_fixed(i)) continue;
    sum += moment(world.position[i], world.mass[i] * world.velocity[i]);
    sum += momentum_of_spin(world, i);
  }
  return sum;
}

template Status check(const Material<float>&);
template Status check(const Material<double>&);
template <class Real, int Dim>
std::uint64_t state_hash(const World<Real, Dim>& world) {
  std::uint64_t hash = 14695981039346656037u;
  const auto add = [&](const auto& value) {
    std::array<unsigned char, sizeof(value)> bytes{};
    std::memcpy(bytes.data(), &value, sizeof(value));
    for (const unsigned char byte : bytes) hash = (hash ^ byte) * 1099511628211u;
  };
  add(world.time);
  for (std::size_t i = 0; i < world.size(); ++i)
    add(world.position[i]), add(world.orientation[i]), add(world.velocity[i]), add(world.spin[i]);
  return hash;
}

template class World<float, 2>;
template class World<float, 3>;
template class World<double, 2>;
template class World<double, 3>;

template Status check_bodies(const World<float, 2>&);
template Status check_bodies(const World<float, 3>&);
template Status check_bodies(const World<double, 2>&);
template Status check_bodies(const World<double, 3>&);
template float kinetic_energy(const World<float, 2>&);
template float kinetic_energy(const World<float, 3>&);
template double kinetic_energy(const World<double, 2>&);
template double kinetic_energy(const World<double, 3>&);
template Vector<float, 2> momentum(const World<float, 2>&);
template Vector<float, 3> momentum(const World<float, 3>&);
template Vector<double, 2> momentum(const World<double, 2>&);
template Vector<double, 3> momentum(const World<double, 3>&);
template Spin<float, 2> angular_momentum(const World<float, 2>&);
template Spin<float, 3> angular_momentum(const World<float, 3>&);
template Spin<double, 2> angular_momentum(const World<double, 2>&);
template Spin<double, 3> angular_momentum(const World<double, 3>&);

template std::uint64_t state_hash(const World<float, 2>&);
template std::uint64_t state_hash(const World<float, 3>&);
template std::uint64_t state_hash(const World<double, 2>&);
template std::uint64_t state_hash(const World<double, 3>&);

}  // namespace continuo
