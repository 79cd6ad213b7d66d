// The bodies of several contacts at once, one contact in each lane: loaded by their numbers, and put back.
#pragma once
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <utility>

#include <xsimd/xsimd.hpp>

#include <continuo/bodies/contact_solver/solver_body.hpp>

namespace continuo {

template <class Real>
using ContactLanes = Lanes<Real, lanes_at_once<Real>>;
template <class Real>
using LaneIndices = std::array<std::uint32_t, lanes_at_once<Real>>;

/// Lanes in memory, one of which can be written without the others.
template <class Real>
struct alignas(ContactLanes<Real>) StoredLanes {
  std::array<Real, lanes_at_once<Real>> lane{};

  operator ContactLanes<Real>() const { return ContactLanes<Real>(lane); }
  StoredLanes& operator=(const ContactLanes<Real>& values) {
    lane = values.values();
    return *this;
  }
};
template <class Real, int Size>
[[nodiscard]] Vector<ContactLanes<Real>, Size> loaded(const Vector<StoredLanes<Real>, Size>& stored) {
  Vector<ContactLanes<Real>, Size> v;
  for (std::size_t axis = 0; axis < v.size(); ++axis) v[axis] = stored[axis];
  return v;
}
template <class Real, int Size>
void store(const Vector<ContactLanes<Real>, Size>& v, Vector<StoredLanes<Real>, Size>& stored) {
  for (std::size_t axis = 0; axis < v.size(); ++axis) stored[axis] = v[axis];
}

namespace detail {

template <class Real>
using LaneBatch = xsimd::make_sized_batch_t<Real, lanes_at_once<Real>>;

/// The transposed matrix: by two stages of interleaving for four rows, by one for two.
template <class Batch>
[[nodiscard]] std::array<Batch, 4> transposed(const std::array<Batch, 4>& a) {
  const Batch p = xsimd::zip_lo(a[0], a[2]), q = xsimd::zip_hi(a[0], a[2]);
  const Batch r = xsimd::zip_lo(a[1], a[3]), s = xsimd::zip_hi(a[1], a[3]);
  return {xsimd::zip_lo(p, r), xsimd::zip_hi(p, r), xsimd::zip_lo(q, s), xsimd::zip_hi(q, s)};
}
template <class Batch>
[[nodiscard]] std::array<Batch, 2> transposed(const std::array<Batch, 2>& a) {
  return {xsimd::zip_lo(a[0], a[1]), xsimd::zip_hi(a[0], a[1])};
}

}  // namespace detail

/// Loads four numbers of the body of every lane; `quad_of(i)` is the place of those of body i in memory. Each result
/// has one of the four numbers, of all bodies.
template <class Real, class QuadOf>
[[nodiscard]] std::array<ContactLanes<Real>, 4> load_quads(const LaneIndices<Real>& bodies, const QuadOf& quad_of) {
  constexpr std::size_t width = lanes_at_once<Real>;
  using Batch = detail::LaneBatch<Real>;
  std::array<ContactLanes<Real>, 4> result;
  for (std::size_t part = 0; part < 4; part += width) {
    std::array<Batch, width> rows;
    for (std::size_t lane = 0; lane < width; ++lane)
      rows[lane] = Batch::load_aligned(quad_of(bodies[lane]).data() + part);
    const std::array<Batch, width> columns = detail::transposed(rows);
    for (std::size_t i = 0; i < width; ++i) result[part + i] = std::bit_cast<ContactLanes<Real>>(columns[i]);
  }
  return result;
}

template <class Real, class QuadOf>
void store_quads(const std::array<ContactLanes<Real>, 4>& columns, const LaneIndices<Real>& bodies,
                 const QuadOf& quad_of) {
  constexpr std::size_t width = lanes_at_once<Real>;
  using Batch = detail::LaneBatch<Real>;
  for (std::size_t part = 0; part < 4; part += width) {
    std::array<Batch, width> rows;
    for (std::size_t i = 0; i < width; ++i) rows[i] = std::bit_cast<Batch>(columns[part + i]);
    rows = detail::transposed(rows);
    for (std::size_t lane = 0; lane < width; ++lane) rows[lane].store_aligned(quad_of(bodies[lane]).data() + part);
  }
}

template <class Real, int Dim>
struct LanePlaces {
  Vector<ContactLanes<Real>, Dim> x;
  ContactLanes<Real> radius;
};
template <class Real, int Dim>
[[nodiscard]] LanePlaces<Real, Dim> load_places(const SolverBodies<Real, Dim>& bodies,
                                                const LaneIndices<Real>& numbers) {
  const auto quads =
      load_quads<Real>(numbers, [&](std::uint32_t i) -> const Quad<Real>& { return bodies.place[i].x_and_radius; });
  return {vector_of<Dim>(quads), quads[3]};
}

template <class Real, int Dim>
struct LaneMotions {
  Vector<ContactLanes<Real>, Dim> v;
  ContactLanes<Real> inverse_mass;
  Spin<ContactLanes<Real>, Dim> rim;
  ContactLanes<Real> mobility;  // of the rim: radius^2 over the moment of inertia
};
template <class Real, int Dim>
[[nodiscard]] LaneMotions<Real, Dim> load_motions(const SolverBodies<Real, Dim>& bodies,
                                                  const LaneIndices<Real>& numbers) {
  const auto linear =
      load_quads<Real>(numbers, [&](std::uint32_t i) -> const Quad<Real>& { return bodies.motion[i].linear; });
  const auto rim =
      load_quads<Real>(numbers, [&](std::uint32_t i) -> const Quad<Real>& { return bodies.motion[i].rim; });
  constexpr int axes = Spin<Real, Dim>::size();
  return {vector_of<Dim>(linear), linear[3], vector_of<axes>(rim), rim[3]};
}
template <class Real, int Dim>
void store_motions(const LaneMotions<Real, Dim>& motions, SolverBodies<Real, Dim>& bodies,
                   const LaneIndices<Real>& numbers) {
  std::array<ContactLanes<Real>, 4> linear, rim;
  put(motions.v, linear);
  linear[3] = motions.inverse_mass;
  put(motions.rim, rim);
  rim[3] = motions.mobility;
  store_quads<Real>(linear, numbers, [&](std::uint32_t i) -> Quad<Real>& { return bodies.motion[i].linear; });
  store_quads<Real>(rim, numbers, [&](std::uint32_t i) -> Quad<Real>& { return bodies.motion[i].rim; });
}

}  // namespace continuo
