// continuo/bodies/cell_grid.hpp
// Which bodies are in which cell of a grid without borders: cells whose numbers agree modulo the size of the table
// share a list, which costs a test of two bodies that are far apart and nothing else. The first bodies of a list lie in
// the table itself, so that gathering those of many cells follows no chain and takes no branch that is hard to foresee.
#pragma once
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
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
  CellGrid(const Real& edge, std::size_t bodies) : edge_(edge), next_(bodies, none) {
    while ((std::size_t{1} << (bits_ * Dim)) < bodies && bits_ < 20 / Dim + 2) ++bits_;
    lists_.assign(std::size_t{1} << (bits_ * Dim), {});
    rest_.assign(lists_.size(), none);
  }

  Real edge() const { return edge_; }
  /// Whether x is near enough to the origin for its digits to tell where in a cell it is.
  bool has_cell(const Vector<Real, Dim>& x) const {
    using std::abs;
    for (std::size_t axis = 0; axis < x.size(); ++axis)
      if (!(abs(x[axis]) < edge_ * farthest)) return false;
    return true;
  }
  Cell cell_of(const Vector<Real, Dim>& x) const {
    using std::floor;
    Cell cell{};
    for (std::size_t axis = 0; axis < x.size(); ++axis) cell[axis] = static_cast<std::int64_t>(floor(x[axis] / edge_));
    return cell;
  }

  void insert(std::uint32_t body, const Cell& cell) {
    const std::size_t at = list_of(cell);
    List& list = lists_[at];
    if (list.count < in_table) {
      list.body[list.count] = body;
    } else {
      next_[body] = rest_[at];
      rest_[at] = body;
    }
    ++list.count;
  }
  void remove(std::uint32_t body, const Cell& cell) {
    const std::size_t at = list_of(cell);
    List& list = lists_[at];
    --list.count;
    for (std::uint32_t k = 0; k < in_table; ++k) {
      if (k > list.count || list.body[k] != body) continue;
      if (list.count >= in_table) {
        list.body[k] = rest_[at];
        rest_[at] = next_[rest_[at]];
      } else {
        list.body[k] = list.body[list.count];
      }
      return;
    }
    std::uint32_t* link = &rest_[at];
    while (*link != body) link = &next_[*link];
    *link = next_[body];
  }

  /// Appends the bodies of the cells from `lower` to `upper`, both included, to the first `count` of `found`, which
  /// grows as needed; gives the new count.
  std::size_t gather(const Cell& lower, const Cell& upper, std::vector<std::uint32_t>& found, std::size_t count) const {
    Cell cell = lower;
    constexpr std::size_t last = static_cast<std::size_t>(Dim - 1);
    for (;;) {
      for (cell[last] = lower[last]; cell[last] <= upper[last]; ++cell[last]) {
        const std::size_t at = list_of(cell);
        const List& list = lists_[at];
        if (found.size() < count + list.count + in_table) found.resize(2 * (count + list.count + in_table));
        std::memcpy(found.data() + count, list.body.data(), sizeof list.body);
        count += list.count < in_table ? list.count : in_table;
        if (list.count > in_table)
          for (std::uint32_t body = rest_[at]; body != none; body = next_[body]) found[count++] = body;
      }
      std::size_t axis = last;
      while (axis-- > 0 && cell[axis] == upper[axis]) cell[axis] = lower[axis];
      if (axis >= last) return count;
      ++cell[axis];
    }
  }

  /// Which list of the table a cell has: sorted by it, neighbours in space are neighbours in memory.
  std::size_t list_of(const Cell& cell) const {
    const auto mask = static_cast<std::uint64_t>((std::size_t{1} << bits_) - 1);
    std::size_t list = 0;
    for (std::size_t axis = 0; axis < cell.size(); ++axis)
      list = list << bits_ | static_cast<std::size_t>(static_cast<std::uint64_t>(cell[axis]) & mask);
    return list;
  }

 private:
  static constexpr std::uint32_t in_table = 3;
  static constexpr Real farthest = Real(std::int64_t{1} << (std::numeric_limits<Real>::digits - 5));
  struct List {
    std::uint32_t count = 0;
    std::array<std::uint32_t, in_table> body{};
  };

  Real edge_ = Real(1);
  std::size_t bits_ = 2;  // of a cell's number that the table knows, by axis: four cells, so that neighbours differ
  std::vector<List> lists_;
  std::vector<std::uint32_t> rest_, next_;  // what a list has beyond, and its chain
};

}  // namespace continuo
