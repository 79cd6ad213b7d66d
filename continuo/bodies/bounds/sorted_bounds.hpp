// continuo/bodies/bounds/sorted_bounds.hpp
// Bounds in the order in which they begin along an axis, and the pairs of them that overlap: sort and sweep (J. D.
// Cohen, M. C. Lin, D. Manocha, M. K. Ponamgi, "I-COLLIDE", Symposium on Interactive 3D Graphics 1995, 189-196). Each
// is compared with those that begin before it ends, several at once, one after the other in memory. While these are
// some hundreds, as in most worlds of the plane, that is faster than a tree.
#pragma once
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <numeric>
#include <span>
#include <vector>

#include <xsimd/xsimd.hpp>

#include <continuo/bodies/bounds/bounds.hpp>

namespace continuo {

/// Bounds in order. A search changes nothing, so that many threads may search at once.
template <class Real, int Dim>
class SortedBounds {
 public:
  /// With so many each may be compared where that is to be faster than a tree.
  static constexpr std::size_t most_compared = 200;
  /// And so many in all of `count` bounds that lie as unevenly as worlds do.
  [[nodiscard]] static constexpr std::size_t most_of(std::size_t count) { return 8 * most_compared * count; }

  /// Takes the bounds and sorts them along the axis on which they are spread most. In O(n) where the order is nearly
  /// that of the last time, else in O(n log n). Returns false, and does nothing, where one of them is empty or not
  /// finite, or where, spread evenly, each would be compared with more than `most`.
  [[nodiscard]] bool sort(std::span<const Bounds<Real, Dim>> all, std::size_t most) {
    const std::size_t axis = widest_axis(all);
    if (!(beside_each(all, axis) <= static_cast<Real>(most))) return false;
    if (axis != axis_ || order_.size() != all.size()) {
      axis_ = axis;
      order_.resize(all.size());
      std::iota(order_.begin(), order_.end(), std::uint32_t{0});
      sort_anew(all);
    } else if (!sort_on(all)) {
      sort_anew(all);
    }
    take(all);
    return true;
  }
  [[nodiscard]] std::size_t size() const { return order_.size(); }

  /// Calls visit(i, j) once for each pair that overlaps and of which the one that begins first is at place `from` up to
  /// `to` - 1 of the order. Returns false, after some of them, where that would take more than `most` comparisons.
  template <class Visit>
  [[nodiscard]] bool for_each_pair(std::size_t from, std::size_t to, std::size_t most, Visit&& visit) const {
    std::vector<std::uint32_t> near(order_.size() + Lanes::size);  // those that overlap one of them
    std::array<bool, Lanes::size> flags{};
    std::size_t compared = 0;
    for (std::size_t k = from; k < to; ++k) {
      const Lanes end(ends_[0][k]);
      std::array<Lanes, others> first, last;
      for (std::size_t i = 0; i < others; ++i) first[i] = Lanes(begins_[i + 1][k]), last[i] = Lanes(ends_[i + 1][k]);
      std::size_t count = 0;
      for (std::size_t j = k + 1; j < order_.size(); j += Lanes::size) {
        const auto begins_before = Lanes::load_unaligned(&begins_[0][j]) <= end;
        auto overlaps = begins_before;
        for (std::size_t i = 0; i < others; ++i)
          overlaps = overlaps & (Lanes::load_unaligned(&begins_[i + 1][j]) <= last[i]) &
                     (Lanes::load_unaligned(&ends_[i + 1][j]) >= first[i]);
        // Without a branch, which would be unpredictable.
        overlaps.store_unaligned(flags.data());
        for (std::size_t lane = 0; lane < Lanes::size; ++lane) {
          near[count] = static_cast<std::uint32_t>(j + lane);
          count += flags[lane] ? 1 : 0;
        }
        compared += Lanes::size;
        if (!xsimd::all(begins_before)) break;
      }
      for (std::size_t n = 0; n < count; ++n) visit(order_[k], order_[near[n]]);
      if (compared > most) return false;
    }
    return true;
  }
  [[nodiscard]] std::size_t memory() const {
    std::size_t bytes = order_.capacity() * sizeof(std::uint32_t);
    for (const auto& list : {std::cref(begins_), std::cref(ends_)})
      for (const auto& numbers : list.get()) bytes += numbers.capacity() * sizeof(Real);
    return bytes;
  }

 private:
  using Lanes = xsimd::batch<Real>;
  static constexpr std::size_t others = static_cast<std::size_t>(Dim) - 1;
  static constexpr std::size_t most_moves = 16;  // of each in an order that is nearly that of before

  [[nodiscard]] static std::size_t widest_axis(std::span<const Bounds<Real, Dim>> all) {
    Bounds<Real, Dim> beginnings;
    for (const Bounds<Real, Dim>& box : all) beginnings = united(beginnings, {box.lower, box.lower});
    std::size_t axis = 0;
    for (std::size_t i = 1; i <= others; ++i)
      if (beginnings.upper[i] - beginnings.lower[i] > beginnings.upper[axis] - beginnings.lower[axis]) axis = i;
    return axis;
  }
  /// How many begin before one ends, were they spread evenly. Not finite where one of the bounds is empty or not
  /// finite.
  [[nodiscard]] static Real beside_each(std::span<const Bounds<Real, Dim>> all, std::size_t axis) {
    if (all.empty()) return Real(0);
    Real lengths(0), undefined(0), first = all[0].lower[axis], last = first;
    for (const Bounds<Real, Dim>& box : all) {
      if (is_empty(box)) return std::numeric_limits<Real>::infinity();
      lengths += box.upper[axis] - box.lower[axis];
      first = std::min(first, box.lower[axis]), last = std::max(last, box.lower[axis]);
      for (std::size_t i = 0; i <= others; ++i)
        undefined += (box.upper[i] - box.upper[i]) + (box.lower[i] - box.lower[i]);
    }
    return lengths / std::max(last - first, lengths / static_cast<Real>(all.size())) + undefined;
  }
  /// What lies evenly is nearly in order once it is in as many equal strips as there are bounds.
  void sort_anew(std::span<const Bounds<Real, Dim>> all) {
    if (put_in_strips(all) && sort_on(all)) return;
    std::ranges::sort(order_, [&](std::uint32_t i, std::uint32_t j) {
      return all[i].lower[axis_] != all[j].lower[axis_] ? all[i].lower[axis_] < all[j].lower[axis_] : i < j;
    });
  }
  /// By counting. False where they all begin at one place.
  [[nodiscard]] bool put_in_strips(std::span<const Bounds<Real, Dim>> all) {
    Real first = all[0].lower[axis_], last = first;
    for (const Bounds<Real, Dim>& box : all)
      first = std::min(first, box.lower[axis_]), last = std::max(last, box.lower[axis_]);
    const Real per_length = static_cast<Real>(all.size() - 1) / (last - first);
    if (!(last > first) || !(per_length < std::numeric_limits<Real>::infinity())) return false;
    const auto strip = [&](std::size_t i) {
      return std::min(static_cast<std::size_t>((all[i].lower[axis_] - first) * per_length), all.size() - 1);
    };
    std::vector<std::uint32_t> next(all.size() + 1);
    for (std::size_t i = 0; i < all.size(); ++i) ++next[strip(i) + 1];
    std::partial_sum(next.begin(), next.end(), next.begin());
    for (std::uint32_t i = 0; i < all.size(); ++i) order_[next[strip(i)]++] = i;
    return true;
  }
  /// By insertion. False where too many are elsewhere now.
  [[nodiscard]] bool sort_on(std::span<const Bounds<Real, Dim>> all) {
    std::size_t moves = 0;
    for (std::size_t k = 1; k < order_.size(); ++k) {
      const std::uint32_t i = order_[k];
      std::size_t at = k;
      for (; at > 0 && all[order_[at - 1]].lower[axis_] > all[i].lower[axis_]; --at) order_[at] = order_[at - 1];
      order_[at] = i;
      moves += k - at;
      if (moves > most_moves * order_.size()) return false;
    }
    return true;
  }
  /// The axis of the order comes first. Behind the last one are some that begin nowhere.
  void take(std::span<const Bounds<Real, Dim>> all) {
    for (std::size_t i = 0; i <= others; ++i) {
      const std::size_t axis = (axis_ + i) % (others + 1);
      begins_[i].assign(all.size() + Lanes::size, std::numeric_limits<Real>::infinity());
      ends_[i].assign(all.size() + Lanes::size, -std::numeric_limits<Real>::infinity());
      for (std::size_t k = 0; k < all.size(); ++k)
        begins_[i][k] = all[order_[k]].lower[axis], ends_[i][k] = all[order_[k]].upper[axis];
    }
  }

  std::size_t axis_ = 0;
  std::vector<std::uint32_t> order_;
  std::array<std::vector<Real>, others + 1> begins_, ends_;
};

}  // namespace continuo
