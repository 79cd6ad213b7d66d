// Where a function of the plane, known on a grid, is zero: as curves.
#pragma once
#include <cstddef>
#include <utility>
#include <vector>

namespace continuo::studies {

struct Grid {
  std::size_t columns = 0, rows = 0;
  double left = 0, bottom = 0, width = 1, height = 1;  // the corner, and the distances between neighbours
  std::vector<double> values{};                        // row by row

  [[nodiscard]] double x(std::size_t i) const { return left + static_cast<double>(i) * width; }
  [[nodiscard]] double y(std::size_t j) const { return bottom + static_cast<double>(j) * height; }
  [[nodiscard]] double at(std::size_t i, std::size_t j) const { return values[j * columns + i]; }
};

using Polyline = std::vector<std::pair<double, double>>;

/// By marching squares: straight through each cell, joined from cell to cell. Cells with a NaN have no part of it.
[[nodiscard]] std::vector<Polyline> zero_lines(const Grid& grid);

/// Where the function is not positive: one closed path that winds round all of it once, and round none of the rest,
/// with bridges of no width between its pieces; to be filled. It goes as far as the grid does. A NaN counts as
/// positive.
[[nodiscard]] Polyline path_round_negative(const Grid& grid);

}  // namespace continuo::studies
