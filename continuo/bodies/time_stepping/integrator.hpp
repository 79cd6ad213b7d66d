// How the fast motion integrates forces between contacts, x'' = a(t, x, v) with a substep of h:
//
//   explicit Euler       x1 = x0 + h v0             v1 = v0 + h a(t0, x0, v0)     order 1, grows whatever h
//   semi-implicit Euler  x1 = x0 + h v1             v1 = v0 + h a(t0, x0, v0)     order 1, stable for h < 2 / omega
//   ..., position first  x1 = x0 + h v0             v1 = v0 + h a(t1, x1, v0)     order 1, stable for h < 2 / omega
//   implicit Euler       x1 = x0 + h v1             v1 = v0 + h a(t1, x1, v1)     order 1, stable for any h, damps
//   central difference   x1 = x0 + h v0 + h^2/2 a0  v1 = v0 + h (a0 + a1) / 2     order 2, stable for h < 2 / omega
//
// omega is the highest angular frequency of springs and masses; the limits are those of x'' = -omega^2 x (E. Hairer,
// C. Lubich, G. Wanner, "Geometric Numerical Integration", 2006, I.1). The central difference is also known as leapfrog
// and as velocity Verlet. A body on which nothing acts but gravity and its constant force follows its parabola exactly,
// but for explicit Euler and the position first, which give the numbers of their formulas. One in contact is moved as
// its contacts allow, by the velocity at the end.
#pragma once
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>
#include <vector>

#include <continuo/bodies/forces.hpp>
#include <continuo/numerics/gmres.hpp>

namespace continuo {

enum class ForceIntegrator {
  semi_implicit_euler,
  symplectic_euler_position_first,
  implicit_euler,
  central_difference,
  explicit_euler
};

/// What corrects the velocity at the end of a substep.
enum class EndCorrection {
  none,
  mean,  // v1 += h (a1 - a0) / 2
  anew   // v1 = v0 + h a1, where a1 reads v0
};

/// With the velocity v1 = v0 + h a the position is x0 + h (v1 - lag h a), with steady_lag where a is constant.
struct IntegratorRule {
  double lag, steady_lag;
  EndCorrection correction;
  bool solves_equations;  // a is that of the end
};
[[nodiscard]] constexpr IntegratorRule rule_of(ForceIntegrator integrator) {
  switch (integrator) {
    case ForceIntegrator::implicit_euler:
      return {0, 0.5, EndCorrection::none, true};
    case ForceIntegrator::central_difference:
      return {0.5, 0.5, EndCorrection::mean, false};
    case ForceIntegrator::explicit_euler:
      return {1, 1, EndCorrection::none, false};
    case ForceIntegrator::symplectic_euler_position_first:
      return {1, 1, EndCorrection::anew, false};
    case ForceIntegrator::semi_implicit_euler:
      break;
  }
  return {0, 0.5, EndCorrection::none, false};
}

/// force[i] becomes that at the end of an implicit Euler step from x, v: u = v + h force(t + h, x + h u, u) / m is
/// solved by Newton's method, each of its linear systems by products with the Jacobian, which are differences of
/// forces. False where that does not converge.
template <class Real, int Dim>
[[nodiscard]] bool forces_at_end(const World<Real, Dim>& world, const Real& t, const Real& h,
                                 std::span<const Vector<Real, Dim>> x, std::span<const Vector<Real, Dim>> v,
                                 std::span<const Real> inverse_mass, std::span<Vector<Real, Dim>> force) {
  using std::sqrt;
  using V = Vector<Real, Dim>;
  constexpr std::size_t axes = V::size();
  const std::size_t bodies = world.size();
  std::vector<V> x_end(bodies), v_end(v.begin(), v.end());
  std::vector<Real> rest(bodies * axes), rest_near(rest), near(rest), u(rest);
  const auto evaluate = [&](const std::vector<Real>& at, std::vector<Real>& result) {
    for (std::size_t i = 0; i < bodies; ++i)
      for (std::size_t axis = 0; axis < axes; ++axis) {
        v_end[i][axis] = at[i * axes + axis];
        x_end[i][axis] = x[i][axis] + h * v_end[i][axis];
      }
    forces<Real, Dim>(world, t + h, x_end, v_end, force);
    for (std::size_t i = 0; i < bodies; ++i)
      for (std::size_t axis = 0; axis < axes; ++axis)
        result[i * axes + axis] = v[i][axis] + h * inverse_mass[i] * force[i][axis] - at[i * axes + axis];
  };
  const auto length_of_all = [](const std::vector<Real>& all) {
    Real sum(0);
    for (const Real& one : all) sum += one * one;
    return Real(sqrt(sum));
  };
  for (std::size_t i = 0; i < bodies; ++i)
    for (std::size_t axis = 0; axis < axes; ++axis) u[i * axes + axis] = v[i][axis];
  evaluate(u, rest);
  const Real epsilon = std::numeric_limits<Real>::epsilon(), scale = length_of_all(u) + length_of_all(rest);
  Real extent(0);
  for (const V& at : x) extent += squared(at);
  extent = sqrt(extent);
  Gmres<std::vector<Real>> gmres(rest, 100);
  Real left = length_of_all(rest);
  for (int iteration = 0; iteration < 50 && left > 8 * epsilon * scale; ++iteration) {
    std::vector<Real> change = rest;
    const auto jacobian = [&](const std::vector<Real>& direction, std::vector<Real>& product) {
      const Real size = length_of_all(direction);
      std::ranges::fill(product, Real(0));
      if (!(size > Real(0))) return;
      const Real apart = sqrt(epsilon) * (1 + length_of_all(u)) / size;
      for (std::size_t i = 0; i < near.size(); ++i) near[i] = u[i] + apart * direction[i];
      evaluate(near, rest_near);
      for (std::size_t i = 0; i < near.size(); ++i) product[i] = (rest[i] - rest_near[i]) / apart;
    };
    gmres.solve(jacobian, change, left / 1000, 1000);
    // Where the whole Newton step increases the residual, a part of it decreases it.
    Real closest = left;
    for (Real part(1); part > Real(0.01); part /= 2) {
      for (std::size_t i = 0; i < u.size(); ++i) near[i] = u[i] + part * change[i];
      evaluate(near, rest_near);
      closest = length_of_all(rest_near);
      if (closest < left) break;
    }
    if (!(closest < left)) {
      // The residual decreases no further. It is rounding where the Newton step would change only the second half of
      // the digits of positions.
      evaluate(u, rest);
      return h * length_of_all(change) <= sqrt(epsilon) * (extent + h * length_of_all(u));
    }
    u = near;
    rest = rest_near;
    left = closest;
  }
  evaluate(u, rest);
  return left <= sqrt(epsilon) * scale;
}

}  // namespace continuo
