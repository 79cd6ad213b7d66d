// continuo/bodies/forces.cpp
// Forces, torques and potential energies of a world at given positions and velocities.
#include <algorithm>
#include <cmath>
#include <cstddef>

#include <continuo/bodies/attraction.hpp>
#include <continuo/bodies/forces.hpp>

namespace continuo {

namespace {

/// One end of a spring: a body, or a point that does not move.
template <class Real, int Dim>
struct End {
  Vector<Real, Dim> x{}, v{};
  std::size_t body = 0;
  bool is_body = false;
};

template <class Real, int Dim>
std::array<End<Real, Dim>, 2> ends_of(const World<Real, Dim>& world, const Spring<Real, Dim>& spring,
                                      std::span<const Vector<Real, Dim>> x, std::span<const Vector<Real, Dim>> v) {
  const auto at_body = [&](BodyHandle body) {
    const std::size_t i = world.index(body);
    return End<Real, Dim>{x[i], v[i], i, true};
  };
  if (const auto* other = std::get_if<BodyHandle>(&spring.b)) return {at_body(spring.a), at_body(*other)};
  return {at_body(spring.a), End<Real, Dim>{std::get<Vector<Real, Dim>>(spring.b), {}, 0, false}};
}

/// Whether the bodies of a spring still exist: without one of them it exerts no force.
template <class Real, int Dim>
bool holds(const World<Real, Dim>& world, const Spring<Real, Dim>& spring) {
  const auto* other = std::get_if<BodyHandle>(&spring.b);
  return world.contains(spring.a) && (!other || world.contains(*other));
}

template <class Real, int Dim>
void add_spring(const World<Real, Dim>& world, const Spring<Real, Dim>& spring, std::span<const Vector<Real, Dim>> x,
                std::span<const Vector<Real, Dim>> v, std::span<Vector<Real, Dim>> force) {
  const auto [a, b] = ends_of(world, spring, x, v);
  const Vector<Real, Dim> apart = b.x - a.x;
  const Real distance = length(apart);
  if (!(distance > Real(0))) return;  // no direction to pull in
  const Vector<Real, Dim> along = apart * (1 / distance);
  const Real pull = spring.stiffness * (distance - spring.rest_length) + spring.damping * dot(b.v - a.v, along);
  force[a.body] += along * pull;
  if (b.is_body) force[b.body] -= along * pull;
}

template <class Real, int Dim>
Real energy_of(const World<Real, Dim>& world, const Spring<Real, Dim>& spring) {
  const auto [a, b] = ends_of(world, spring, std::span(world.position), std::span(world.velocity));
  const Real longer = length(b.x - a.x) - spring.rest_length;
  return spring.stiffness * longer * longer / 2;
}

}  // namespace

template <class Real, int Dim>
void forces(const World<Real, Dim>& world, Real t, std::span<const Vector<Real, Dim>> x,
            std::span<const Vector<Real, Dim>> v, std::span<Vector<Real, Dim>> force) {
  for (std::size_t i = 0; i < world.size(); ++i) force[i] = world.mass[i] * world.gravity + world.constant_force[i];
  if (world.drag.linear != Real(0) || world.drag.quadratic != Real(0)) {
    for (std::size_t i = 0; i < world.size(); ++i)
      force[i] -= v[i] * (world.drag.linear + world.drag.quadratic * length(v[i]));
  }
  for (const Spring<Real, Dim>& spring : world.springs)
    if (holds(world, spring)) add_spring(world, spring, x, v, force);
  if (world.attraction.constant != Real(0)) add_attraction(world, x, force);
  for (const ForceLaw<Real, Dim>& law : world.force_laws) law(world, t, x, v, force);
  for (std::size_t i = 0; i < world.size(); ++i)
    if (world.is_fixed(i)) force[i] = {};
}

template <class Real, int Dim>
void torques(const World<Real, Dim>& world, Real t, const BodyStates<Real, Dim>& at,
             std::span<Spin<Real, Dim>> torque) {
  std::ranges::fill(torque, Spin<Real, Dim>{});
  for (const TorqueLaw<Real, Dim>& law : world.torque_laws) law(world, t, at, torque);
}

template <class Real, int Dim>
bool only_gravity(const World<Real, Dim>& world) {
  return world.springs.empty() && world.attraction.constant == Real(0) && world.drag.linear == Real(0) &&
         world.drag.quadratic == Real(0) && world.force_laws.empty() && world.torque_laws.empty() &&
         std::ranges::all_of(world.constant_force, [](const auto& f) { return f == Vector<Real, Dim>{}; });
}

template <class Real, int Dim>
Real potential_energy(const World<Real, Dim>& world) {
  Real sum(0);
  for (std::size_t i = 0; i < world.size(); ++i)
    if (!world.is_fixed(i)) sum -= dot(world.mass[i] * world.gravity + world.constant_force[i], world.position[i]);
  for (const Spring<Real, Dim>& spring : world.springs)
    if (holds(world, spring)) sum += energy_of(world, spring);
  if (world.attraction.constant != Real(0)) sum += attraction_energy(world);
  return sum;
}

template void forces(const World<float, 2>&, float, std::span<const Vector<float, 2>>,
                     std::span<const Vector<float, 2>>, std::span<Vector<float, 2>>);
template void forces(const World<float, 3>&, float, std::span<const Vector<float, 3>>,
                     std::span<const Vector<float, 3>>, std::span<Vector<float, 3>>);
template void forces(const World<double, 2>&, double, std::span<const Vector<double, 2>>,
                     std::span<const Vector<double, 2>>, std::span<Vector<double, 2>>);
template void forces(const World<double, 3>&, double, std::span<const Vector<double, 3>>,
                     std::span<const Vector<double, 3>>, std::span<Vector<double, 3>>);
template void torques(const World<float, 2>&, float, const BodyStates<float, 2>&, std::span<Spin<float, 2>>);
template void torques(const World<float, 3>&, float, const BodyStates<float, 3>&, std::span<Spin<float, 3>>);
template void torques(const World<double, 2>&, double, const BodyStates<double, 2>&, std::span<Spin<double, 2>>);
template void torques(const World<double, 3>&, double, const BodyStates<double, 3>&, std::span<Spin<double, 3>>);
template bool only_gravity(const World<float, 2>&);
template bool only_gravity(const World<float, 3>&);
template bool only_gravity(const World<double, 2>&);
template bool only_gravity(const World<double, 3>&);
template float potential_energy(const World<float, 2>&);
template float potential_energy(const World<float, 3>&);
template double potential_energy(const World<double, 2>&);
template double potential_energy(const World<double, 3>&);

}  // namespace continuo
