// continuo/bodies/event_driven/cell_grid.hpp
// The bodies in each cell of an unbounded grid, in a hash table: cells whose numbers agree modulo the size of the table
// share a list, which costs only needless tests of bodies that are far apart. The first bodies of a list are in the
// table itself, so that gathering those of many cells follows no chain and has no branch that is hard to predict.
#pragma once
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include <continuo/bodies/support/short_lists.hpp>
#include <continuo/numerics/vector.hpp>

namespace continuo {

template <class Real, int Dim>
class CellGrid {
 public:
  using Cell = std::array<std::int64_t, static_cast<std::size_t>(Dim)>;

  CellGrid() = default;
  /// A table for so many bodies, with about one body per list.
  CellGrid(const Real& edge, std::size_t bodies) : edge_(edge) {
    while ((std::size_t{1} << (bits_ * Dim)) < bodies && bits_ < 20 / Dim + 2) ++bits_;
    lists_ = ShortLists(std::size_t{1} << (bits_ * Dim), bodies);
  }

  [[nodiscard]] Real edge() const { return edge_; }
  /// Whether x is near enough to the origin for its digits to resolve a place within a cell.
  [[nodiscard]] bool has_cell(const Vector<Real, Dim>& x) const {
    using std::abs;
    for (std::size_t axis = 0; axis < x.size(); ++axis)
      if (!(abs(x[axis]) < edge_ * farthest)) return false;
    return true;
  }
  [[nodiscard]] Cell cell_of(const Vector<Real, Dim>& x) const {
    using std::floor;
    Cell cell{};
    for (std::size_t axis = 0; axis < x.size(); ++axis) cell[axis] = static_cast<std::int64_t>(floor(x[axis] / edge_));
    return cell;
  }

  void insert(std::uint32_t body, const Cell& cell) { lists_.insert(list_of(cell), body); }
  void remove(std::uint32_t body, const Cell& cell) { lists_.remove(list_of(cell), body); }

  /// Writes the bodies of the cells from `lower` to `upper`, both included and at most three along an axis, to `found`,
  /// which grows as needed; gives their count.
  [[nodiscard]] std::size_t gather(const Cell& lower, const Cell& upper, std::vector<std::uint32_t>& found) const {
    constexpr std::size_t cells = Dim == 3 ? 27 : 9;
    std::array<std::size_t, cells> lists;
    std::size_t number = 0, count = 0;
    for_each_list(lower, upper, [&](std::size_t list) { lists[number++] = list; });
    for (std::size_t k = 0; k < number; ++k) {
      if (found.size() < count + 2) found.resize(2 * count + 2 * cells);
      count = lists_.append_to(found, count, lists[k]);
    }
    return count;
  }

  /// Gathers the bodies of a cell and all its neighbours.
  [[nodiscard]] std::size_t gather_around(const Cell& cell, std::vector<std::uint32_t>& found) const {
    return gather(shifted(cell, -1), shifted(cell, 1), found);
  }
  /// Prefetches the lists of these cells, which lie in rows, each in a cache line or two.
  void ask_for_around(const Cell& cell) const {
    const Cell lower = shifted(cell, -1);
    Cell first = shifted(cell, 1);
    first.back() = lower.back();
    for_each_list(lower, first, [&](std::size_t list) { lists_.ask_for(list); });
  }

  /// The list of a cell in the table. Bodies that are sorted by it are neighbours in memory where they are neighbours
  /// in space.
  [[nodiscard]] std::size_t list_of(const Cell& cell) const {
    std::size_t list = 0;
    for (const std::int64_t coordinate : cell) list = list << bits_ | part_of(coordinate);
    return list;
  }

 private:
  static constexpr Real farthest = Real(std::int64_t{1} << (std::numeric_limits<Real>::digits - 5));

  [[nodiscard]] static Cell shifted(Cell cell, std::int64_t by) {
    for (std::int64_t& coordinate : cell) coordinate += by;
    return cell;
  }
  [[nodiscard]] std::size_t part_of(std::int64_t coordinate) const {
    return static_cast<std::size_t>(coordinate) & ((std::size_t{1} << bits_) - 1);
  }
  template <class Visit>
  void for_each_list(const Cell& lower, const Cell& upper, Visit&& visit) const {
    for (std::int64_t x = lower[0]; x <= upper[0]; ++x)
      for (std::int64_t y = lower[1]; y <= upper[1]; ++y) {
        const std::size_t row = part_of(x) << bits_ | part_of(y);
        if constexpr (Dim == 2) {
          visit(row);
        } else {
          for (std::int64_t z = lower[2]; z <= upper[2]; ++z) visit(row << bits_ | part_of(z));
        }
      }
  }

  Real edge_ = Real(1);
  std::size_t bits_ = 2;  // used of a cell's number, per axis: at least four cells, so that neighbours differ
  ShortLists lists_;
};

}  // namespace continuo
