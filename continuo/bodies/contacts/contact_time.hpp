// continuo/bodies/contacts/contact_time.hpp
#pragma once
#include <algorithm>
#include <cmath>
#include <limits>

#include <continuo/bodies/world.hpp>

namespace continuo {

/// A hundred-thousandth of the time in which a body falls its radius, or flies it where there is no gravity.
template <class Real, int Dim>
[[nodiscard]] Real usual_contact_time(const World<Real, Dim>& world) {
  using std::sqrt;
  Real smallest = std::numeric_limits<Real>::infinity(), fastest(0), farthest(0);
  for (std::size_t i = 0; i < world.size(); ++i) {
    smallest = std::min(smallest, world.radius[i]);
    fastest = std::max(fastest, length(world.velocity[i]));
    farthest = std::max(farthest, length(world.position[i]));
  }
  const Real g = length(world.gravity);
  // A flight of duration t rises by g t^2 / 8, which must exceed the rounding of a position.
  const Real visible = 16 * std::numeric_limits<Real>::epsilon() * farthest;
  if (g > Real(0)) return std::max(Real(1e-5) * sqrt(2 * smallest / g), sqrt(8 * visible / g));
  return fastest > Real(0) ? Real(1e-5) * smallest / fastest : Real(0);
}

}  // namespace continuo
