// Bodies sorted by the cells of a dense grid over all of them, so that neighbours in space are neighbours in memory.
#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include <continuo/numerics/vector.hpp>

namespace continuo {

/// Bodies sorted by cell, and the cells of a dense grid over all of them.
template <class Real, int Dim>
class SortedCells {
 public:
  using V = Vector<Real, Dim>;

  /// order[k] is the body at place k, cell by cell; `edge` is enlarged where the grid would need too many cells.
  void sort(std::span<const V> x, Real edge, std::vector<std::uint32_t>& order) {
    lower_ = upper_ = x.empty() ? V{} : x[0];
    for (const V& at : x)
      for (std::size_t axis = 0; axis < V::size(); ++axis) {
        lower_[axis] = std::min(lower_[axis], at[axis]);
        upper_[axis] = std::max(upper_[axis], at[axis]);
      }
    choose_counts(edge, x.size());
    std::vector<std::uint32_t> cell(x.size());
    first_.assign(total_ + 1, 0);
    for (std::size_t i = 0; i < x.size(); ++i) {
      cell[i] = static_cast<std::uint32_t>(number(coordinates(x[i])));
      ++first_[cell[i] + 1];
    }
    for (std::size_t c = 0; c < total_; ++c) first_[c + 1] += first_[c];
    order.resize(x.size());
    std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
    for (std::size_t i = 0; i < x.size(); ++i) order[next[cell[i]]++] = static_cast<std::uint32_t>(i);
  }

  /// Calls visit(first, last) for the ranges of places of bodies whose cells overlap the box from `lower` to `upper`,
  /// row by row.
  template <class Visit>
  void for_each_row(const V& lower, const V& upper, Visit&& visit) const {
    const Coordinates from = coordinates(lower), to = coordinates(upper);
    const std::size_t cells = to[axes_[0]] - from[axes_[0]] + 1;
    Coordinates at = from;
    std::size_t cell = number(from);
    for (;;) {
      visit(first_[cell], first_[cell + cells]);
      std::size_t i = 1;
      for (; i < at.size() && at[axes_[i]] == to[axes_[i]]; ++i) {
        cell -= stride_[i] * (to[axes_[i]] - from[axes_[i]]);
        at[axes_[i]] = from[axes_[i]];
      }
      if (i == at.size()) return;
      ++at[axes_[i]];
      cell += stride_[i];
    }
  }

  /// The number of bodies in the fullest layer across the longest axis.
  [[nodiscard]] std::size_t most_in_layer() const {
    const std::size_t cells = total_ / count_[axes_.back()];
    std::size_t most = 0;
    for (std::size_t c = 0; c < total_; c += cells) most = std::max<std::size_t>(most, first_[c + cells] - first_[c]);
    return most;
  }

  [[nodiscard]] std::size_t memory() const { return first_.capacity() * sizeof(std::uint32_t); }

 private:
  using Coordinates = std::array<std::size_t, static_cast<std::size_t>(Dim)>;

  void choose_counts(Real edge, std::size_t bodies) {
    const double most = 8.0 * static_cast<double>(bodies) + 64;
    for (edge_ = edge;; edge_ *= 2) {
      double cells = 1;
      for (std::size_t axis = 0; axis < V::size(); ++axis) {
        const double along = std::floor(static_cast<double>((upper_[axis] - lower_[axis]) / edge_)) + 1;
        cells *= along;
        if (cells <= most) count_[axis] = static_cast<std::size_t>(along);
      }
      if (cells <= most) {
        // The longest axis comes last: then neighbours along it are as near in memory as they can be.
        for (std::size_t axis = 0; axis < V::size(); ++axis) axes_[axis] = axis;
        std::ranges::sort(axes_, {}, [&](std::size_t axis) { return std::pair(count_[axis], axis); });
        stride_[0] = 1;
        for (std::size_t i = 1; i < axes_.size(); ++i) stride_[i] = stride_[i - 1] * count_[axes_[i - 1]];
        total_ = static_cast<std::size_t>(cells);
        return;
      }
    }
  }
  [[nodiscard]] Coordinates coordinates(const V& x) const {
    Coordinates at{};
    for (std::size_t axis = 0; axis < V::size(); ++axis) {
      const Real cells = (x[axis] - lower_[axis]) / edge_;
      at[axis] = cells > Real(0) ? static_cast<std::size_t>(std::min(cells, static_cast<Real>(count_[axis] - 1))) : 0;
    }
    return at;
  }
  [[nodiscard]] std::size_t number(const Coordinates& at) const {
    std::size_t n = 0;
    for (std::size_t i = 0; i < at.size(); ++i) n += at[axes_[i]] * stride_[i];
    return n;
  }

  V lower_{}, upper_{};
  Real edge_ = Real(1);
  Coordinates count_{}, axes_{};  // axes_: in the order of the cells, the one along which the next cell lies first
  Coordinates stride_{};          // from a cell to the next one along axes_[i]
  std::size_t total_ = 0;
  std::vector<std::uint32_t> first_;
};

}  // namespace continuo
