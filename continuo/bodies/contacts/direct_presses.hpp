// The impulses of contacts without friction that act together, found in finitely many steps (complementarity.hpp). The
// sweeps of projected_gauss_seidel.hpp need more of them the more the masses differ: a light ball between two that are
// a million times as heavy passes on a millionth of what is missing with each.
#pragma once
#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>
#include <span>
#include <type_traits>
#include <vector>

#include <continuo/bodies/contacts/complementarity.hpp>
#include <continuo/bodies/contacts/projected_gauss_seidel.hpp>

namespace continuo {

/// Replaces the impulses along the normals and the velocities by those that the laws of contact ask for, from the state
/// `free` before any impulse. Rows without friction only. In a wider format, because what a heavy body is pushed is so
/// much more than what a light one between it and another may differ by. False where there are too many rows to find
/// them in seconds, or rounding keeps them from being found.
template <class Real, int Dim>
[[nodiscard]] bool press_directly(ProjectedGaussSeidel<Real, Dim>& sweeps,
                                  std::span<const typename ProjectedGaussSeidel<Real, Dim>::Moving> free) {
  using Wide = std::conditional_t<std::is_same_v<Real, float>, double, long double>;
  constexpr std::size_t most_rows = 256;
  const auto& rows = sweeps.rows();
  const std::size_t n = rows.size();
  if (n > most_rows) return false;
  const auto along = [](const auto& one, const auto& other) {
    Wide sum(0);
    for (std::size_t axis = 0; axis < Dim; ++axis) sum += Wide(one[axis]) * Wide(other[axis]);
    return sum;
  };
  const auto yields = [&](std::size_t place) { return Wide(free[place].inverse_mass); };
  std::vector<Wide> matrix(n * n), rates(n);
  Wide greatest(0);
  for (std::size_t i = 0; i < n; ++i) {
    const auto &a = free[rows[i].a].v, &b = free[rows[i].b].v;
    rates[i] = along(b, rows[i].normal) - along(a, rows[i].normal) - Wide(rows[i].least);
    greatest = std::max(greatest, std::abs(rates[i]));
    for (std::size_t j = 0; j < n; ++j) {
      Wide sum(0);
      if (rows[i].a == rows[j].a) sum += yields(rows[i].a);
      if (rows[i].b == rows[j].b) sum += yields(rows[i].b);
      if (rows[i].a == rows[j].b) sum -= yields(rows[i].a);
      if (rows[i].b == rows[j].a) sum -= yields(rows[i].b);
      if (sum != Wide(0)) matrix[j * n + i] = sum * along(rows[i].normal, rows[j].normal);
    }
  }
  const Wide least = std::numeric_limits<Real>::epsilon() * greatest;
  const std::vector<Wide> presses = complementary_forces<Wide>(matrix, rates, least);
  if (presses.empty()) return false;
  std::vector<std::array<Wide, Dim>> velocities(free.size());
  for (std::size_t place = 0; place < free.size(); ++place)
    for (std::size_t axis = 0; axis < Dim; ++axis) velocities[place][axis] = Wide(free[place].v[axis]);
  for (std::size_t k = 0; k < n; ++k) {
    sweeps.row(k).impulse.press = static_cast<Real>(presses[k]);
    for (std::size_t axis = 0; axis < Dim; ++axis) {
      const Wide push = presses[k] * Wide(rows[k].normal[axis]);
      velocities[rows[k].a][axis] -= push * yields(rows[k].a);
      velocities[rows[k].b][axis] += push * yields(rows[k].b);
    }
  }
  for (std::size_t place = 0; place < free.size(); ++place)
    for (std::size_t axis = 0; axis < Dim; ++axis)
      sweeps.mover(place).v[axis] = static_cast<Real>(velocities[place][axis]);
  return true;
}

}  // namespace continuo
