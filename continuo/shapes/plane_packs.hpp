// The planes of a polytope in the lanes of registers, and where a ray enters it: the planes of a pack are compared at
// once, without branches, which would be unpredictable.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include <continuo/shapes/ray_entry.hpp>

namespace continuo {

/// As many planes as a register of 16 bytes, which every machine has, has numbers.
template <class Real, int Dim>
struct PlanePack {
  using Register [[gnu::vector_size(16)]] = Real;
  static constexpr std::size_t width = sizeof(Register) / sizeof(Real);
  /// One component of a vector for each plane: arrays of bare registers would lose their alignment.
  struct Part {
    Register numbers{};
  };
  std::array<Part, static_cast<std::size_t>(Dim)> normal{};
  // Everything is below a plane that is not set.
  Register offset = Register{} + std::numeric_limits<Real>::max();

  /// Puts the plane of a face in a lane.
  void set(std::size_t lane, const Face<Real, Dim>& face) {
    for (std::size_t axis = 0; axis < normal.size(); ++axis) normal[axis].numbers[lane] = face.normal[axis];
    offset[lane] = face.offset;
  }
  /// Of the plane in a lane.
  [[nodiscard]] Vector<Real, Dim> normal_of(std::size_t lane) const {
    Vector<Real, Dim> n;
    for (std::size_t axis = 0; axis < normal.size(); ++axis) n[axis] = normal[axis].numbers[lane];
    return n;
  }
  /// The product of v with each normal.
  [[nodiscard]] Register times_normals(const Vector<Real, Dim>& v) const {
    Register sum{};
    for (std::size_t axis = 0; axis < normal.size(); ++axis) sum += normal[axis].numbers * v[axis];
    return sum;
  }
};

/// Appends the planes of a polytope to packs, and returns how many packs these are.
template <class Real, int Dim>
std::uint32_t append_planes(const Polytope<Real, Dim>& core, std::vector<PlanePack<Real, Dim>>& packs) {
  constexpr std::size_t width = PlanePack<Real, Dim>::width;
  for (std::size_t k = 0; k < core.faces.size(); ++k) {
    if (k % width == 0) packs.emplace_back();
    packs.back().set(k % width, core.faces[k]);
  }
  return static_cast<std::uint32_t>((core.faces.size() + width - 1) / width);
}

/// The same as `entry_of_planes`, of a polytope that is not rounded, to the bit.
template <class Real, int Dim>
[[nodiscard]] std::optional<RayEntry<Real, Dim>> entry_of_packs(std::span<const PlanePack<Real, Dim>> packs,
                                                                const Vector<Real, Dim>& origin,
                                                                const Vector<Real, Dim>& direction, const Real& reach) {
  using Pack = PlanePack<Real, Dim>;
  using Register = typename Pack::Register;
  Register entered{}, of_pack{}, left = Register{} + reach;
  auto is_missed = entered > entered;
  for (std::size_t k = 0; k < packs.size(); ++k) {
    const Register height = packs[k].times_normals(origin) - packs[k].offset;
    const Register rate = packs[k].times_normals(direction), distance = -height / rate;
    const auto enters = rate < Real(0);
    is_missed |= (height > Real(0)) & ~enters;
    const auto is_later = enters & (distance > entered);
    entered = is_later ? distance : entered;
    of_pack = is_later ? Register{} + static_cast<Real>(k) : of_pack;
    left = ((rate > Real(0)) & (distance < left)) ? distance : left;
  }
  std::size_t last = 0;  // the lane of the last plane that is entered; of equal ones, of the first
  Real end = left[0];
  for (std::size_t lane = 0; lane < Pack::width; ++lane) {
    if (is_missed[lane]) return std::nullopt;
    const bool is_before = entered[lane] == entered[last] && of_pack[lane] < of_pack[last];
    if (entered[lane] > entered[last] || is_before) last = lane;
    if (left[lane] < end) end = left[lane];
  }
  if (entered[last] > end) return std::nullopt;
  if (!(entered[last] > Real(0))) return RayEntry<Real, Dim>{};
  return RayEntry<Real, Dim>{entered[last], packs[static_cast<std::size_t>(of_pack[last])].normal_of(last)};
}

}  // namespace continuo
