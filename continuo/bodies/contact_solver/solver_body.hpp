// The layout of bodies in the fast motion: the numbers that a contact reads and writes are adjacent, four at a time, so
// that lanes load and store them together.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <continuo/bodies/contact_solver/contact_blocks.hpp>
#include <continuo/bodies/contact_solver/disturbances.hpp>
#include <continuo/bodies/support/large_array.hpp>
#include <continuo/numerics/lanes.hpp>
#include <continuo/numerics/vector.hpp>

namespace continuo {

template <class Real>
using Quad = std::array<Real, 4>;

/// The number of contacts that are solved at once: as many as fit into a register of 16 bytes, which every machine of
/// this family has.
template <class Real>
inline constexpr std::size_t lanes_at_once = 16 / sizeof(Real);

/// Instead of the spin w, the velocity r w of the rim: then r is in no formula of a contact between spheres.
template <class Real>
struct alignas(8 * sizeof(Real)) BodyMotion {
  Quad<Real> linear{};  // velocity, and last the inverse of the mass
  Quad<Real> rim{};     // radius times spin, and last radius^2 over the moment of inertia
};
template <class Real>
struct alignas(4 * sizeof(Real)) BodyPlace {
  Quad<Real> x_and_radius{};
};

template <int Size, class Real>
[[nodiscard]] Vector<Real, Size> vector_of(const Quad<Real>& quad) {
  Vector<Real, Size> v;
  for (std::size_t axis = 0; axis < v.size(); ++axis) v[axis] = quad[axis];
  return v;
}
template <class Real, int Size>
void put(const Vector<Real, Size>& v, Quad<Real>& quad) {
  for (std::size_t axis = 0; axis < v.size(); ++axis) quad[axis] = v[axis];
}

/// After the bodies come the walls, as immovable bodies, and then stand-ins for lanes without a contact.
template <class Real, int Dim>
struct SolverBodies {
  using V = Vector<Real, Dim>;

  LargeArray<BodyMotion<Real>> motion{};
  LargeArray<BodyPlace<Real>> place{};
  std::vector<std::uint8_t> touched{};  // by a contact that lasts, in this substep
  Disturbances disturbances{};
  std::vector<std::uint32_t> impacts{};  // of this substep; empty where nothing can strike
  std::vector<V> accelerations{};        // empty where gravity is the only force
  V gravity{};
  ContactBlocks blocks{};
  std::size_t bodies = 0;

  [[nodiscard]] std::size_t size() const { return bodies; }
  void resize(std::size_t count, std::size_t walls, const ContactBlocks& in_blocks) {
    blocks = in_blocks;
    const std::size_t all = count + walls + stand_ins * blocks.count;
    if (bodies == count && motion.size() == all) return;
    bodies = count;
    touched.assign(all, 0);
    disturbances.resize(all, blocks);
    motion.assign(all, {});
    place.assign(all, {});
  }
  [[nodiscard]] std::uint32_t wall(std::size_t number) const { return static_cast<std::uint32_t>(size() + number); }
  /// Two stand-ins for each lane of a batch, for each block. They are apart from each other, have mass, and never move.
  static constexpr std::size_t stand_ins = 2 * lanes_at_once<Real>;
  [[nodiscard]] std::uint32_t stand_in(std::size_t block, std::size_t number) const {
    return static_cast<std::uint32_t>(motion.size() - stand_ins * (block + 1) + number);
  }

  [[nodiscard]] std::size_t memory() const {
    return motion.capacity() * sizeof(motion[0]) + place.capacity() * sizeof(place[0]) + touched.capacity() +
           disturbances.memory() + impacts.capacity() * sizeof(impacts[0]) + accelerations.capacity() * sizeof(V);
  }

  [[nodiscard]] V x(std::size_t k) const { return vector_of<Dim>(place[k].x_and_radius); }
  [[nodiscard]] V v(std::size_t k) const { return vector_of<Dim>(motion[k].linear); }
  [[nodiscard]] Real radius(std::size_t k) const { return place[k].x_and_radius[3]; }
  [[nodiscard]] Real inverse_mass(std::size_t k) const { return motion[k].linear[3]; }
  [[nodiscard]] bool moves(std::size_t k) const { return inverse_mass(k) > Real(0); }
  [[nodiscard]] bool all_finite() const {
    Real sum(0);
    for (std::size_t k = 0; k < size(); ++k)
      for (std::size_t axis = 0; axis < 3; ++axis)
        sum += Real(0) * (place[k].x_and_radius[axis] + motion[k].linear[axis] + motion[k].rim[axis]);
    return sum == Real(0);
  }
  [[nodiscard]] V acceleration(std::size_t k) const {
    if (!accelerations.empty()) return accelerations[k];
    return moves(k) ? gravity : V{};
  }
};

}  // namespace continuo
