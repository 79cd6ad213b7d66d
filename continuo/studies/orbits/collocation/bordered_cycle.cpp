// continuo/studies/orbits/collocation/bordered_cycle.cpp
// Eliminates the unknowns of a closed chain of equations link by link.
#include <algorithm>
#include <cmath>

#include <continuo/numerics/dense_lu.hpp>
#include <continuo/numerics/finite.hpp>
#include <continuo/studies/orbits/collocation/bordered_cycle.hpp>

namespace continuo::studies::detail {

namespace {

/// Reflections that leave nothing below the diagonal in the first `pivots` columns. False where a column is gone.
bool triangularise(std::span<double> a, std::size_t rows, std::size_t columns, std::size_t pivots) {
  std::vector<double> mirror(rows), products(columns);
  for (std::size_t j = 0; j < pivots; ++j) {
    double square = 0;
    for (std::size_t i = j; i < rows; ++i) mirror[i] = a[i * columns + j], square += mirror[i] * mirror[i];
    const double length = std::sqrt(square);
    if (!(length > 0) || !std::isfinite(length)) return false;
    const double diagonal = mirror[j] < 0 ? length : -length;
    mirror[j] -= diagonal;
    const double factor = 1 / (length * (length + std::abs(a[j * columns + j])));  // 2 / |mirror|^2
    std::fill(products.begin() + static_cast<std::ptrdiff_t>(j), products.end(), 0.0);
    for (std::size_t i = j; i < rows; ++i) {
      if (mirror[i] == 0) continue;
      for (std::size_t c = j + 1; c < columns; ++c) products[c] += mirror[i] * a[i * columns + c];
    }
    for (std::size_t i = j; i < rows; ++i) {
      if (mirror[i] == 0) continue;
      const double times = factor * mirror[i];
      for (std::size_t c = j + 1; c < columns; ++c) a[i * columns + c] -= times * products[c];
      a[i * columns + j] = 0;
    }
    a[j * columns + j] = diagonal;
  }
  return true;
}

/// Takes the first `pivots` entries out of a row by rows that are triangular there: row -= row R^-1 rows. `rest` is the
/// row behind them.
void take_out(std::span<const double> triangle, std::size_t columns, std::size_t pivots, std::span<double> row,
              std::span<double> rest) {
  for (std::size_t j = 0; j < pivots; ++j) {
    const double factor = row[j] / triangle[j * columns + j];
    if (factor == 0) continue;
    for (std::size_t c = j; c < pivots; ++c) row[c] -= factor * triangle[j * columns + c];
    for (std::size_t c = pivots; c < columns; ++c) rest[c - pivots] -= factor * triangle[j * columns + c];
  }
}

}  // namespace

BorderedCycle::BorderedCycle(std::size_t n, std::size_t interior, std::size_t links)
    : n_(n),
      interior_(interior),
      links_(links),
      rows_(links * height() * width()),
      border_(2 * unknowns()),
      joints_(links * 2 * n * (3 * n + 3)),
      closed_(n * (2 * n + 3)),
      corner_(2 * 3) {}

bool BorderedCycle::solve(double first_border_value, double second_border_value, std::span<double> solution) {
  for (std::size_t row = 0; row < 2; ++row) {
    const auto end = border(row).last(2);
    std::ranges::copy(end, corner_.begin() + static_cast<std::ptrdiff_t>(row * 3));
  }
  corner_[2] = first_border_value;
  corner_[5] = second_border_value;
  if (!eliminate_interiors() || !eliminate_beginnings() || !solve_last(solution)) return false;
  substitute(solution);
  return all_finite(solution);
}

bool BorderedCycle::eliminate_interiors() {
  std::vector<double> rest(width() - interior_);
  const std::size_t stride = interior_ + n_;
  for (std::size_t k = 0; k < links_; ++k) {
    if (!triangularise(link(k), height(), width(), interior_)) return false;
    for (std::size_t row = 0; row < 2; ++row) {
      const auto here = border(row).subspan(k * stride, n_), next = border(row).subspan((k + 1) % links_ * stride, n_);
      std::ranges::fill(rest, 0.0);
      take_out(link(k), width(), interior_, border(row).subspan(k * stride + n_, interior_), rest);
      for (std::size_t i = 0; i < n_; ++i) here[i] += rest[i];
      for (std::size_t i = 0; i < n_; ++i) next[i] += rest[n_ + i];
      for (std::size_t c = 0; c < 3; ++c) corner_[row * 3 + c] += rest[2 * n_ + c];
    }
  }
  return true;
}

/// What is left of each link, joined to what is left of those before it.
bool BorderedCycle::eliminate_beginnings() {
  const std::size_t stride = interior_ + n_, joint_width = 3 * n_ + 3, closed_width = 2 * n_ + 3;
  const auto remaining = [&](std::size_t k, std::size_t i) {
    return link(k).subspan((interior_ + i) * width() + interior_, closed_width);
  };
  for (std::size_t i = 0; i < n_; ++i)
    std::ranges::copy(remaining(0, i), closed_.begin() + static_cast<std::ptrdiff_t>(i * closed_width));
  std::vector<double> rest(joint_width - n_);
  for (std::size_t k = 1; k < links_; ++k) {
    // Columns: the beginning of this link, of the first, of the next, the two, the right-hand side.
    const auto joint = std::span(joints_).subspan(k * 2 * n_ * joint_width, 2 * n_ * joint_width);
    std::ranges::fill(joint, 0.0);
    for (std::size_t i = 0; i < n_; ++i) {
      const auto above = joint.subspan(i * joint_width, joint_width),
                 below = joint.subspan((n_ + i) * joint_width, joint_width);
      for (std::size_t c = 0; c < n_; ++c) {
        above[c] = closed_[i * closed_width + n_ + c];
        above[n_ + c] = closed_[i * closed_width + c];
        below[c] = remaining(k, i)[c];
        below[2 * n_ + c] = remaining(k, i)[n_ + c];
      }
      for (std::size_t c = 0; c < 3; ++c) {
        above[3 * n_ + c] = closed_[i * closed_width + 2 * n_ + c];
        below[3 * n_ + c] = remaining(k, i)[2 * n_ + c];
      }
    }
    if (!triangularise(joint, 2 * n_, joint_width, n_)) return false;
    for (std::size_t i = 0; i < n_; ++i)
      std::ranges::copy(joint.subspan((n_ + i) * joint_width + n_, closed_width),
                        closed_.begin() + static_cast<std::ptrdiff_t>(i * closed_width));
    for (std::size_t row = 0; row < 2; ++row) {
      const auto first = border(row).first(n_), next = border(row).subspan((k + 1) % links_ * stride, n_);
      std::ranges::fill(rest, 0.0);
      take_out(joint, joint_width, n_, border(row).subspan(k * stride, n_), rest);
      for (std::size_t i = 0; i < n_; ++i) first[i] += rest[i];
      for (std::size_t i = 0; i < n_; ++i) next[i] += rest[n_ + i];
      for (std::size_t c = 0; c < 3; ++c) corner_[row * 3 + c] += rest[2 * n_ + c];
    }
  }
  return true;
}

/// For the first beginning and the two.
bool BorderedCycle::solve_last(std::span<double> solution) {
  const std::size_t size = n_ + 2, closed_width = 2 * n_ + 3;
  DenseLU<double, run_time_size> lu(size);
  auto&& matrix = lu.matrix();
  std::vector<double> b(size);
  for (std::size_t i = 0; i < n_; ++i) {
    const auto row = std::span(closed_).subspan(i * closed_width, closed_width);
    for (std::size_t c = 0; c < n_; ++c) matrix[i * size + c] = row[c] + row[n_ + c];
    for (std::size_t c = 0; c < 2; ++c) matrix[i * size + n_ + c] = row[2 * n_ + c];
    b[i] = row[2 * n_ + 2];
  }
  for (std::size_t i = 0; i < 2; ++i) {
    for (std::size_t c = 0; c < n_; ++c) matrix[(n_ + i) * size + c] = border(i)[c];
    for (std::size_t c = 0; c < 2; ++c) matrix[(n_ + i) * size + n_ + c] = corner_[i * 3 + c];
    b[n_ + i] = corner_[i * 3 + 2];
  }
  if (!lu.factor()) return false;
  lu.solve(b.data());
  std::copy_n(b.begin(), n_, solution.begin());
  std::copy_n(b.begin() + static_cast<std::ptrdiff_t>(n_), 2, solution.end() - 2);
  return true;
}

void BorderedCycle::substitute(std::span<double> solution) const {
  const std::size_t stride = interior_ + n_, joint_width = 3 * n_ + 3;
  const auto two = solution.last(2);
  const auto beginning = [&](std::size_t k) { return solution.subspan(k % links_ * stride, n_); };
  for (std::size_t k = links_; k-- > 1;) {
    const auto joint = std::span(joints_).subspan(k * 2 * n_ * joint_width, 2 * n_ * joint_width);
    const auto here = beginning(k);
    for (std::size_t i = n_; i-- > 0;) {
      const auto row = joint.subspan(i * joint_width, joint_width);
      double sum = row[joint_width - 1];
      for (std::size_t c = i + 1; c < n_; ++c) sum -= row[c] * here[c];
      for (std::size_t c = 0; c < n_; ++c) sum -= row[n_ + c] * beginning(0)[c] + row[2 * n_ + c] * beginning(k + 1)[c];
      for (std::size_t c = 0; c < 2; ++c) sum -= row[3 * n_ + c] * two[c];
      here[i] = sum / row[i];
    }
  }
  for (std::size_t k = 0; k < links_; ++k) {
    const auto own = solution.subspan(k * stride + n_, interior_);
    for (std::size_t i = interior_; i-- > 0;) {
      const auto row = std::span(rows_).subspan((k * height() + i) * width(), width());
      double sum = row[width() - 1];
      for (std::size_t c = i + 1; c < interior_; ++c) sum -= row[c] * own[c];
      for (std::size_t c = 0; c < n_; ++c)
        sum -= row[interior_ + c] * beginning(k)[c] + row[interior_ + n_ + c] * beginning(k + 1)[c];
      for (std::size_t c = 0; c < 2; ++c) sum -= row[interior_ + 2 * n_ + c] * two[c];
      own[i] = sum / row[i];
    }
  }
}

}  // namespace continuo::studies::detail
