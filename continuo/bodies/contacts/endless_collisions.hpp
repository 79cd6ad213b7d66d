// When collisions in a row are an inelastic collapse, which has no end.
#pragma once
#include <cstdint>

namespace continuo {

/// Whether bodies that have struck each other so often in a row, with this restitution, do so without end. A light body
/// between a wall and a heavy one of N times its mass is a damped oscillation whose phase turns by 1 / sqrt(N) with
/// each collision, while speeds fall by sqrt(e). Below critical damping the heavy one leaves after a half turn, which
/// 64 / (1 - e) collisions contain unless they leave less than exp(-32) of all speeds, the rounding of double; above it
/// the light one is squeezed until all have stopped. What loses nothing never comes to this end: the number of
/// collisions alone is no sign of one.
template <class Real>
[[nodiscard]] bool is_endless(const Real& restitution, std::uint32_t collisions) {
  constexpr std::uint32_t fewest = 64;
  return collisions >= fewest && Real(1 - restitution) * static_cast<Real>(collisions) >= Real(64);
}

}  // namespace continuo
