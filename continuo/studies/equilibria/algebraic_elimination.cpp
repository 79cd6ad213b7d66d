// continuo/studies/equilibria/algebraic_elimination.cpp
// Eliminates the unknowns of algebraic equations from a linear system.
#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include <continuo/numerics/dense_lu.hpp>
#include <continuo/studies/equilibria/algebraic_elimination.hpp>

namespace continuo::studies {

namespace {

constexpr double singular_part = 1e-13;  // of the largest entry: what rounding leaves of a zero pivot

/// Rows, then columns, so that the largest entry of each is 1: units say nothing.
void equilibrate(std::vector<double>& a, std::size_t m) {
  for (const bool by_rows : {true, false}) {
    for (std::size_t i = 0; i < m; ++i) {
      double largest = 0;
      const auto entry = [&](std::size_t j) -> double& { return by_rows ? a[i * m + j] : a[j * m + i]; };
      for (std::size_t j = 0; j < m; ++j) largest = std::max(largest, std::abs(entry(j)));
      for (std::size_t j = 0; j < m && largest > 0; ++j) entry(j) /= largest;
    }
  }
}

}  // namespace

/// Gaussian elimination with complete pivoting: where no pivot is left, the rows and columns that had none.
Undetermined undetermined_by(std::span<const double> square, std::size_t m) {
  std::vector<double> a(square.begin(), square.end());
  equilibrate(a, m);
  std::vector<std::size_t> rows(m), columns(m);
  std::iota(rows.begin(), rows.end(), 0);
  std::iota(columns.begin(), columns.end(), 0);
  for (std::size_t k = 0; k < m; ++k) {
    std::size_t row = k, column = k;
    for (std::size_t i = k; i < m; ++i)
      for (std::size_t j = k; j < m; ++j)
        if (std::abs(a[rows[i] * m + columns[j]]) > std::abs(a[rows[row] * m + columns[column]])) row = i, column = j;
    std::swap(rows[k], rows[row]);
    std::swap(columns[k], columns[column]);
    const double pivot = a[rows[k] * m + columns[k]];
    if (!(std::abs(pivot) > singular_part)) {
      const auto from = static_cast<std::ptrdiff_t>(k);
      Undetermined open{{rows.begin() + from, rows.end()}, {columns.begin() + from, columns.end()}};
      std::ranges::sort(open.equations);
      std::ranges::sort(open.unknowns);
      return open;
    }
    for (std::size_t i = k + 1; i < m; ++i) {
      const double factor = a[rows[i] * m + columns[k]] / pivot;
      for (std::size_t j = k; j < m && factor != 0; ++j)
        a[rows[i] * m + columns[j]] -= factor * a[rows[k] * m + columns[j]];
    }
  }
  return {};
}

std::vector<double> without_unknowns(std::span<const double> rows, std::span<const double> equations,
                                     const LinearColumns& columns) {
  const std::size_t n = columns.states, m = columns.unknowns, width = columns.all(), kept = width - m;
  const auto old_place = [&](std::size_t j) { return j < n ? j : j + m; };
  const std::size_t count = width == 0 ? 0 : rows.size() / width;
  std::vector<double> square(m * m);
  for (std::size_t i = 0; i < m; ++i)
    for (std::size_t j = 0; j < m; ++j) square[i * m + j] = equations[i * width + n + j];
  if (!undetermined_by(square, m).equations.empty()) return {};
  DenseLU<double, run_time_size> lu(m);
  std::ranges::copy(square, lu.matrix().begin());
  if (m > 0 && !lu.factor()) return {};
  std::vector<double> result(count * kept), column(m);
  for (std::size_t j = 0; j < kept; ++j) {
    for (std::size_t i = 0; i < m; ++i) column[i] = equations[i * width + old_place(j)];
    if (m > 0) lu.solve(column.data());
    for (std::size_t i = 0; i < count; ++i) {
      double sum = rows[i * width + old_place(j)];
      for (std::size_t k = 0; k < m; ++k) sum -= rows[i * width + n + k] * column[k];
      result[i * kept + j] = sum;
    }
  }
  return result;
}

}  // namespace continuo::studies
