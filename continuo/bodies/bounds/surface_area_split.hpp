// continuo/bodies/bounds/surface_area_split.hpp
// How a node of a tree of bounds is divided. A search enters a node about in proportion to its surface, so that the
// cost of a division is the number of leaves on either side times the surface of their bounds. It is minimized over a
// few planes across the longest extent of the centres (I. Wald, "On fast construction of SAH-based bounding volume
// hierarchies", IEEE Symp. Interactive Ray Tracing (2007) 33-40).
#pragma once
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <utility>

#include <continuo/bodies/bounds/bounds.hpp>

namespace continuo {

/// A leaf of a tree that is being built.
template <class Real, int Dim>
struct BoundedLeaf {
  Bounds<Real, Dim> bounds{};  // finite, or empty
  std::uint32_t number = 0;    // of the leaf
};

/// The least bounds of two that are finite or empty; an empty one is from infinity to minus infinity.
template <class Real, int Dim>
[[nodiscard]] Bounds<Real, Dim> united_finite(const Bounds<Real, Dim>& a, const Bounds<Real, Dim>& b) {
  Bounds<Real, Dim> both;
  for (std::size_t axis = 0; axis < a.lower.size(); ++axis) {
    both.lower[axis] = std::min(a.lower[axis], b.lower[axis]);
    both.upper[axis] = std::max(a.upper[axis], b.upper[axis]);
  }
  return both;
}

template <class Real, int Dim>
class SurfaceAreaSplit {
 public:
  using V = Vector<Real, Dim>;
  using Box = Bounds<Real, Dim>;
  using Leaf = BoundedLeaf<Real, Dim>;

  /// Orders the leaves so that those of the first child come first, and returns how many they are: at least one, and
  /// not all.
  [[nodiscard]] static std::size_t divide(std::span<Leaf> leaves) {
    if (leaves.size() == 2) return 1;
    const SurfaceAreaSplit split(leaves);
    const std::size_t plane = split.best_plane(leaves);
    const std::size_t first = plane == 0 ? 0 : split.partition(leaves, plane);
    return first == 0 ? leaves.size() / 2 : first;
  }

 private:
  static constexpr std::size_t bins = 8;

  /// Twice the centre would overflow. An empty leaf has its centre at 0, since it is nowhere.
  [[nodiscard]] static Real centre(const Box& box, std::size_t axis) {
    return box.lower[axis] <= box.upper[axis] ? box.lower[axis] / 2 + box.upper[axis] / 2 : Real(0);
  }

  explicit SurfaceAreaSplit(std::span<const Leaf> leaves) {
    Box centres;
    for (const Leaf& leaf : leaves)
      for (std::size_t axis = 0; axis < V::size(); ++axis) {
        const Real at = centre(leaf.bounds, axis);
        centres.lower[axis] = std::min(centres.lower[axis], at);
        centres.upper[axis] = std::max(centres.upper[axis], at);
      }
    Real longest(0);
    for (std::size_t axis = 0; axis < V::size(); ++axis)
      if (const Real extent = centres.upper[axis] - centres.lower[axis]; extent > longest) {
        longest = extent;
        axis_ = axis;
      }
    lowest_ = centres.lower[axis_];
    scale_ = Real(bins) / longest;
  }

  /// Where all centres are at one place, or too near or too far apart to tell, all are in the first bin.
  [[nodiscard]] std::size_t bin(const Box& box) const {
    const Real at = (centre(box, axis_) - lowest_) * scale_;
    return at > Real(0) && at <= Real(bins) ? std::min(static_cast<std::size_t>(at), bins - 1) : 0;
  }

  /// A surface that overflows, or is nothing times infinity, counts as the largest number.
  [[nodiscard]] static double cost(std::size_t count, const Box& box) {
    constexpr Real most = std::numeric_limits<Real>::max();
    const Real area = surface(box);
    return static_cast<double>(count) * static_cast<double>(area < most ? area : most);
  }

  /// The first bin of the second child; 0 where all leaves are in one bin.
  [[nodiscard]] std::size_t best_plane(std::span<const Leaf> leaves) const {
    std::array<Box, bins> boxes{};
    std::array<std::size_t, bins> counts{};
    for (const Leaf& leaf : leaves) {
      const std::size_t k = bin(leaf.bounds);
      boxes[k] = united_finite(boxes[k], leaf.bounds);
      ++counts[k];
    }
    std::array<double, bins> cost_below{};  // of the bins below k
    Box box;
    std::size_t count = 0;
    for (std::size_t k = 1; k < bins; ++k) {
      box = united_finite(box, boxes[k - 1]);
      count += counts[k - 1];
      cost_below[k] = cost(count, box);
    }
    std::size_t best = 0;
    double least = 0;
    box = {}, count = 0;
    for (std::size_t k = bins - 1; k > 0; --k) {
      box = united_finite(box, boxes[k]);
      count += counts[k];
      if (count == 0 || count == leaves.size()) continue;
      const double both = cost_below[k] + cost(count, box);
      if (best == 0 || both < least) best = k, least = both;
    }
    return best;
  }

  /// Not std::partition, whose order is left to the library.
  [[nodiscard]] std::size_t partition(std::span<Leaf> leaves, std::size_t plane) const {
    std::size_t first = 0, last = leaves.size();
    for (;;) {
      while (first < last && bin(leaves[first].bounds) < plane) ++first;
      while (first < last && bin(leaves[last - 1].bounds) >= plane) --last;
      if (first == last) return first;
      std::swap(leaves[first], leaves[last - 1]);
    }
  }

  std::size_t axis_ = 0;
  Real lowest_{}, scale_{};
};

}  // namespace continuo
