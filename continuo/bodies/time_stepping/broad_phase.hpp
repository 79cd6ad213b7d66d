// The broad phase of the fast motion: a list of the pairs that may touch, valid until a body has moved further than the
// reach with which it was listed (L. Verlet, Phys. Rev. 159 (1967) 98-103). Bodies are sorted by cells, so that
// neighbours in space are neighbours in memory.
#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include <continuo/bodies/time_stepping/contact_list.hpp>
#include <continuo/bodies/time_stepping/hierarchical_grid.hpp>
#include <continuo/bodies/time_stepping/sorted_cells.hpp>

namespace continuo {

template <class Real, int Dim>
class BroadPhase {
 public:
  using V = Vector<Real, Dim>;
  using Bodies = SolverBodies<Real, Dim>;

  /// order()[k] is the number in the world of the body at place k.
  [[nodiscard]] const std::vector<std::uint32_t>& order() const { return order_; }
  [[nodiscard]] const ContactBlocks& blocks() const { return blocks_; }
  [[nodiscard]] std::size_t walls() const { return walls_; }
  [[nodiscard]] Real median_radius() const { return median_; }
  [[nodiscard]] std::size_t lists() const { return lists_; }

  /// Begins with the order of the world, until pairs are listed.
  void begin(const World<Real, Dim>& world) {
    blocks_ = ContactBlocks::of(world.size(), world.size());
    order_.resize(world.size());
    for (std::size_t i = 0; i < order_.size(); ++i) order_[i] = static_cast<std::uint32_t>(i);
  }

  /// Whether a body may move beyond its reach in the next step, so that the list becomes invalid.
  [[nodiscard]] bool is_outdated(const Bodies& bodies, const Real& step) const {
    for (std::size_t k = 0; k < bodies.size(); ++k)
      if (!(length(bodies.x(k) - x_of_list_[k]) + step_reach(bodies, k, step) <= reach_[k])) return true;
    return false;
  }

  /// Sorts the bodies again; place_before[k] is the former place of the body that is now at place k.
  void sort(const World<Real, Dim>& world, std::vector<std::uint32_t>& place_before) {
    const std::size_t bodies = world.size();
    std::vector<std::uint32_t> place_of(bodies);
    for (std::size_t k = 0; k < bodies; ++k) place_of[order_[k]] = static_cast<std::uint32_t>(k);
    if (bodies > 0) {
      std::vector<Real> radii = world.radius;
      const auto middle = radii.begin() + static_cast<std::ptrdiff_t>(radii.size() / 2);
      std::nth_element(radii.begin(), middle, radii.end());
      median_ = *middle;
    }
    cells_.sort(world.position, Real(2.6) * median_, order_);
    blocks_ = ContactBlocks::of(bodies, cells_.most_in_layer());
    place_before.resize(bodies);
    for (std::size_t k = 0; k < bodies; ++k) place_before[k] = place_of[order_[k]];
  }

  /// Lists the pairs that may touch while body k moves by at most reach(k).
  template <class Reach>
  void list(ThreadTeam& team, const World<Real, Dim>& world, const Bodies& bodies, const Reach& reach,
            ContactRows& rows) {
    ++lists_;
    walls_ = world.walls().size();
    all_collide_ = !world.has_ignored_groups();
    reach_.resize(bodies.size());
    x_of_list_.resize(bodies.size());
    bool all_move = true;
    for (std::size_t k = 0; k < bodies.size(); ++k) {
      all_move = all_move && bodies.moves(k);
      x_of_list_[k] = bodies.x(k);
      reach_[k] = bodies.moves(k) ? reach(k) : Real(0);
    }
    find_far(bodies);
    sort_by_size(bodies);
    const Rows<std::uint32_t> with_far = pairs_with_far(team, world, bodies);
    make_rows(team, bodies.size(), rows, [&](std::uint32_t k, ContactRows& part) {
      const std::size_t begin = part.entries.size();
      if (!bodies.moves(k)) return;
      if (!by_size_.is_empty())
        list_bodies_by_size(world, bodies, k, part);
      else if (!is_far_[k])
        list_bodies(world, bodies, all_move, k, part);
      if (!far_.empty() && !with_far.row(k).empty()) {
        for (const std::uint32_t j : with_far.row(k)) part.entries.push_back({.other = j});
        std::ranges::sort(part.entries.begin() + static_cast<std::ptrdiff_t>(begin), part.entries.end(), {},
                          &ContactEntry::other);
      }
      list_walls(world, bodies, k, part);
    });
    rows.fit();
  }

  /// Calls visit(place) for the bodies that the body at place i may touch if it moves by `way`.
  template <class Visit>
  void for_each_neighbour(const World<Real, Dim>& world, const Bodies& bodies, std::uint32_t i, const Real& way,
                          Visit&& visit) const {
    const auto meet = [&](std::uint32_t j) {
      if (j != i && world.collide(order_[i], order_[j])) visit(j);
    };
    if (!by_size_.is_empty()) return by_size_.for_each_overlap(bodies.x(i), bodies.radius(i) + way, meet);
    for_each_usual(bodies, bodies.x(i), bodies.radius(i) + way, 0, meet);
    for (const std::uint32_t j : far_) meet(j);
  }

  /// The position of the body at place k when pairs were listed, and how far it may move from there.
  [[nodiscard]] const std::vector<V>& x_of_list() const { return x_of_list_; }
  [[nodiscard]] const std::vector<Real>& reach_of_list() const { return reach_; }

  [[nodiscard]] std::size_t memory() const {
    return order_.capacity() * 4 + far_.capacity() * 4 + is_far_.capacity() + reach_.capacity() * sizeof(Real) +
           x_of_list_.capacity() * sizeof(V) + cells_.memory() + by_size_.memory();
  }

 private:
  /// Finds the bodies with a far reach: those too large for the cells, and those faster than nearly all others. Such a
  /// body searches for its partners itself and is not searched for, so that the search boxes of all others can stay
  /// small.
  void find_far(const Bodies& bodies) {
    const auto is_fast = [&](std::size_t k) { return reach_[k] > Real(1.001) * skin(bodies.radius(k)); };
    std::size_t fast = 0;
    for (std::size_t k = 0; k < bodies.size(); ++k) fast += is_fast(k) ? 1 : 0;
    const bool is_few = fast <= few(bodies.size());
    far_.clear();
    is_far_.assign(bodies.size(), 0);
    usual_ = Real(0);
    for (std::size_t k = 0; k < bodies.size(); ++k) {
      const Real out = bodies.radius(k) + reach_[k];
      if (out > 4 * median_ || (is_few && is_fast(k))) {
        is_far_[k] = 1;
        far_.push_back(static_cast<std::uint32_t>(k));
      } else {
        usual_ = std::max(usual_, out);
      }
    }
  }
  /// Makes a grid for each size where more than few bodies have a far reach, or more than few reach far further than
  /// more than few others. Then no body counts as one of far reach.
  void sort_by_size(const Bodies& bodies) {
    by_size_.clear();
    const std::size_t some = few(bodies.size());
    if (bodies.size() <= 2 * some) return;
    std::vector<Real> out(bodies.size());
    for (std::size_t k = 0; k < out.size(); ++k) out[k] = bodies.radius(k) + reach_[k];
    const auto many_times = static_cast<Real>(3);
    if (far_.size() <= some && usual_ <= many_times * *std::ranges::min_element(out)) return;
    std::vector<Real> sorted = out;
    const auto small = sorted.begin() + static_cast<std::ptrdiff_t>(some);
    const auto large = sorted.end() - 1 - static_cast<std::ptrdiff_t>(some);
    std::nth_element(sorted.begin(), small, sorted.end());
    std::nth_element(small, large, sorted.end());
    if (far_.size() <= some && *large <= many_times * *small) return;
    far_.clear();
    by_size_.build(x_of_list_, out, *small);
  }
  /// Row k: the partners of the body at place k in its pairs with at least one body of far reach.
  [[nodiscard]] Rows<std::uint32_t> pairs_with_far(ThreadTeam& team, const World<Real, Dim>& world,
                                                   const Bodies& bodies) const {
    Rows<std::uint32_t> found, result;
    if (far_.empty()) return result;
    make_rows(team, far_.size(), found, [&](std::uint32_t f, Rows<std::uint32_t>& part) {
      const std::uint32_t i = far_[f];
      const auto consider = [&](std::uint32_t j) {
        if ((bodies.moves(i) || bodies.moves(j)) && may_meet(world, bodies, i, j)) part.entries.push_back(j);
      };
      for_each_usual(bodies, bodies.x(i), bodies.radius(i) + reach_[i], 0, consider);
      for (std::size_t g = f + 1; g < far_.size(); ++g) consider(far_[g]);
    });
    // A pair of two moving bodies is in the row of the lower place, a pair with a fixed body in the row of the moving
    // one.
    const auto row_of = [&](std::uint32_t i, std::uint32_t j) {
      return bodies.moves(i) && (i < j || !bodies.moves(j)) ? i : j;
    };
    const auto for_each_pair = [&](const auto& act) {
      for (std::size_t f = 0; f < far_.size(); ++f)
        for (const std::uint32_t j : found.row(f)) act(row_of(far_[f], j), far_[f], j);
    };
    result.first.assign(bodies.size() + 1, 0);
    for_each_pair([&](std::uint32_t row, std::uint32_t, std::uint32_t) { ++result.first[row + 1]; });
    for (std::size_t k = 0; k < bodies.size(); ++k) result.first[k + 1] += result.first[k];
    result.entries.resize(result.first.back());
    std::vector<std::uint32_t> next(result.first.begin(), result.first.end() - 1);
    for_each_pair(
        [&](std::uint32_t row, std::uint32_t i, std::uint32_t j) { result.entries[next[row]++] = row == i ? j : i; });
    return result;
  }

  [[nodiscard]] bool may_meet(const World<Real, Dim>& world, const Bodies& bodies, std::uint32_t i,
                              std::uint32_t j) const {
    const Real near = bodies.radius(i) + reach_[i] + bodies.radius(j) + reach_[j];
    return squared(bodies.x(j) - bodies.x(i)) < near * near && (all_collide_ || world.collide(order_[i], order_[j]));
  }
  /// Calls visit(j) for the bodies without far reach, at places from `from` on, that may come within `out` of x.
  template <class Visit>
  void for_each_usual(const Bodies& bodies, const V& x, const Real& out, std::uint32_t from, Visit&& visit) const {
    const Real near = out + usual_, most = near * near;
    V corner;
    for (std::size_t axis = 0; axis < V::size(); ++axis) corner[axis] = near;
    std::array<std::uint32_t, 64> met;
    cells_.for_each_row(x - corner, x + corner, [&](std::uint32_t first, std::uint32_t last) {
      for (std::uint32_t at = std::max(first, from); at < last; at += static_cast<std::uint32_t>(met.size())) {
        const std::uint32_t end = std::min(last, at + static_cast<std::uint32_t>(met.size()));
        std::size_t count = 0;
        for (std::uint32_t j = at; j < end; ++j) {
          met[count] = j;
          count += squared(bodies.x(j) - x) < most;  // no branch: it would be unpredictable
        }
        for (std::size_t i = 0; i < count; ++i)
          if (!is_far_[met[i]]) visit(met[i]);
      }
    });
  }

  /// If both bodies of a pair move, the lower place searches for the other.
  void list_bodies(const World<Real, Dim>& world, const Bodies& bodies, bool all_move, std::uint32_t k,
                   ContactRows& part) const {
    for_each_usual(bodies, bodies.x(k), bodies.radius(k) + reach_[k], all_move ? k + 1 : 0, [&](std::uint32_t j) {
      if (j != k && (j > k || !bodies.moves(j)) && may_meet(world, bodies, k, j)) part.entries.push_back({.other = j});
    });
  }

  void list_bodies_by_size(const World<Real, Dim>& world, const Bodies& bodies, std::uint32_t k,
                           ContactRows& part) const {
    const std::size_t begin = part.entries.size();
    by_size_.for_each_overlap(bodies.x(k), bodies.radius(k) + reach_[k], [&](std::uint32_t j) {
      if (j != k && (j > k || !bodies.moves(j)) && (all_collide_ || world.collide(order_[k], order_[j])))
        part.entries.push_back({.other = j});
    });
    std::ranges::sort(part.entries.begin() + static_cast<std::ptrdiff_t>(begin), part.entries.end(), {},
                      &ContactEntry::other);
  }

  void list_walls(const World<Real, Dim>& world, const Bodies& bodies, std::uint32_t k, ContactRows& part) const {
    const V x = bodies.x(k);
    const Real out = bodies.radius(k) + reach_[k];
    for (std::size_t w = 0; w < world.walls().size(); ++w) {
      const Wall<Real, Dim> wall = facing(world.walls()[w], x);
      if (dot(wall.normal, x) - wall.offset <= out) part.entries.push_back({.other = bodies.wall(w)});
    }
  }

  std::vector<std::uint32_t> order_, far_;
  std::vector<std::uint8_t> is_far_;
  std::vector<Real> reach_;
  std::vector<V> x_of_list_;
  Real median_ = Real(1), usual_ = Real(0);
  std::size_t walls_ = 0, lists_ = 0;
  bool all_collide_ = true;  // no groups pass through each other
  ContactBlocks blocks_{};
  SortedCells<Real, Dim> cells_;
  HierarchicalGrid<Real, Dim> by_size_;
};

}  // namespace continuo
