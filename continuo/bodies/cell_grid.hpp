// continuo/bodies/cell_grid.hpp
// Which bodies are in which cell of a grid without borders: cells whose numbers agree modulo the size of the table
// share a list, which costs a test of two bodies that are far apart and nothing else.
#pragma once
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include <continuo/bodies/vector.hpp>

namespace continuo {

template <class Real, int Dim>
class CellGrid {
 public:
  using Cell = std::array<std::int64_t, static_cast<std::size_t>(Dim)>;
  static constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();

  CellGrid() = default;
  /// Room for `bodies` at about one in a list of the table.
  CellGrid(const Real& edge, std::size_t bodies) : edge_(edge), next_(bodies, none), before_(bodies, none) {
    while ((std::size_t{1} << (bits_ * Dim)) < bodies && bits_ < 20 / Dim + 2) ++bits_;
    first_.assign(std::size_t{1} << (bits_ * Dim), none);
  }

  Real edge() const { return edge_; }
  Cell cell_of(const Vector<Real, Dim>& x) const {
    using std::floor;
    Cell cell{};
    for (std::size_t axis = 0; axis < x.size(); ++axis) cell[axis] = static_cast<std::int64_t>(floor(x[axis] / edge_));
    return cell;
  }

  void insert(std::uint32_t body, const Cell& cell) {
    const std::size_t list = list_of(cell);
    next_[body] = first_[list];
    before_[body] = none;
    if (first_[list] != none) before_[first_[list]] = body;
    first_[list] = body;
  }
  void remove(std::uint32_t body, const Cell& cell) {
    if (before_[body] != none) {
      next_[before_[body]] = next_[body];
    } else {
      first_[list_of(cell)] = next_[body];
    }
    if (next_[body] != none) before_[next_[body]] = before_[body];
  }

  /// visit(body) for every body of the cells from `lower` to `upper`, both included.
  template <class Visit>
  void for_each_in(const Cell& lower, const Cell& upper, Visit&& visit) const {
    Cell cell = lower;
    for (;;) {
      for (std::uint32_t body = first_[list_of(cell)]; body != none; body = next_[body]) visit(body);
      std::size_t axis = 0;
      while (axis < cell.size() && cell[axis] == upper[axis]) {
        cell[axis] = lower[axis];
        ++axis;
      }
      if (axis == cell.size()) return;
      ++cell[axis];
    }
  }

 private:
  std::size_t list_of(const Cell& cell) const {
    const auto mask = static_cast<std::uint64_t>((std::size_t{1} << bits_) - 1);
    std::size_t list = 0;
    for (std::size_t axis = 0; axis < cell.size(); ++axis)
      list = list << bits_ | static_cast<std::size_t>(static_cast<std::uint64_t>(cell[axis]) & mask);
    return list;
  }

  Real edge_ = Real(1);
  std::size_t bits_ = 2;  // of a cell's number that the table knows, by axis: four cells, so that neighbours differ
  std::vector<std::uint32_t> first_, next_, before_;
};

}  // namespace continuo
