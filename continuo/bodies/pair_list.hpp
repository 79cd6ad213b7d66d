// The broad phase of the fast motion: which bodies may touch before they have moved further than they were listed for.
// The list holds for as long (L. Verlet, Phys. Rev. 159 (1967) 98-103). Bodies are sorted by cells, so that neighbours
// in space are neighbours in memory.
#pragma once
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include <continuo/bodies/contact_list.hpp>
#include <continuo/bodies/sorted_cells.hpp>

namespace continuo {

template <class Real, int Dim>
class PairList {
 public:
  using V = Vector<Real, Dim>;
  using Bodies = SolverBodies<Real, Dim>;

  /// order()[k] is the number in the world of the body at place k.
  const std::vector<std::uint32_t>& order() const { return order_; }
  const ContactBlocks& blocks() const { return blocks_; }
  std::size_t walls() const { return walls_; }
  Real median_radius() const { return median_; }
  std::size_t lists() const { return lists_; }

  /// That of the world, as long as nothing is listed.
  void begin(const World<Real, Dim>& world) {
    blocks_ = ContactBlocks::of(world.size(), world.size());
    order_.resize(world.size());
    for (std::size_t i = 0; i < order_.size(); ++i) order_[i] = static_cast<std::uint32_t>(i);
  }

  /// Whether a body may come further in the next step than the list is good for.
  template <class StepReach>
  bool is_outdated(const Bodies& bodies, const StepReach& step_reach) const {
    for (std::size_t k = 0; k < bodies.size(); ++k)
      if (!(length(bodies.x(k) - x_of_list_[k]) + step_reach(k) <= reach_[k])) return true;
    return false;
  }

  /// Sorts the bodies anew; place_before[k] is where the one that is now at k was.
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

  /// Lists what may touch while body k moves by reach(k) at most.
  template <class Reach>
  void list(Team& team, const World<Real, Dim>& world, const Bodies& bodies, const Reach& reach, ContactRows& rows) {
    ++lists_;
    walls_ = world.walls().size();
    reach_.resize(bodies.size());
    x_of_list_.resize(bodies.size());
    far_.clear();
    usual_ = Real(0);
    bool all_move = true;
    for (std::size_t k = 0; k < bodies.size(); ++k) {
      all_move = all_move && bodies.moves(k);
      x_of_list_[k] = bodies.x(k);
      reach_[k] = bodies.moves(k) ? reach(k) : Real(0);
      // What reaches far, larger or faster than cells are made for, looks for others itself and is not looked for.
      if (is_far(bodies, k)) {
        far_.push_back(static_cast<std::uint32_t>(k));
      } else {
        usual_ = std::max(usual_, bodies.radius(k) + reach_[k]);
      }
    }
    make_rows(team, bodies.size(), rows, [&](std::uint32_t k, ContactRows& part) {
      if (!bodies.moves(k)) return;
      list_bodies(world, bodies, all_move, k, part);
      list_walls(world, bodies, k, part);
    });
    rows.fit();
  }

  /// visit(place) for the bodies that the one at place i may meet if it moves by `way` from where it is.
  template <class Visit>
  void for_each_neighbour(const World<Real, Dim>& world, const Bodies& bodies, std::uint32_t i, const Real& way,
                          Visit&& visit) const {
    const auto meet = [&](std::uint32_t j) {
      if (j != i && world.collide(order_[i], order_[j])) visit(j);
    };
    for_each_in_box(bodies.x(i), bodies.radius(i) + way + usual_, 0, [&](std::uint32_t j) {
      if (!is_far(bodies, j)) meet(j);
    });
    for (const std::uint32_t j : far_) meet(j);
  }

  /// Where the body at place k was when it was listed, and how far it may go from there.
  const std::vector<V>& x_of_list() const { return x_of_list_; }
  const std::vector<Real>& reach_of_list() const { return reach_; }

  std::size_t memory() const {
    return order_.capacity() * 4 + far_.capacity() * 4 + reach_.capacity() * sizeof(Real) +
           x_of_list_.capacity() * sizeof(V) + cells_.memory();
  }

 private:
  bool is_far(const Bodies& bodies, std::size_t k) const { return bodies.radius(k) + reach_[k] > 4 * median_; }
  /// Those at places from `from` on whose cells meet the box round x.
  template <class Visit>
  void for_each_in_box(const V& x, const Real& out, std::uint32_t from, Visit&& visit) const {
    V corner;
    for (std::size_t axis = 0; axis < V::size(); ++axis) corner[axis] = out;
    cells_.for_each_row(x - corner, x + corner, [&](std::uint32_t first, std::uint32_t last) {
      for (std::uint32_t j = std::max(first, from); j < last; ++j) visit(j);
    });
  }

  void list_bodies(const World<Real, Dim>& world, const Bodies& bodies, bool all_move, std::uint32_t k,
                   ContactRows& part) const {
    const std::size_t begin = part.entries.size();
    const V x = bodies.x(k);
    const Real out = bodies.radius(k) + reach_[k], most = (out + usual_) * (out + usual_);
    const auto consider = [&](std::uint32_t j) {
      const Real near = out + bodies.radius(j) + reach_[j];
      if (squared(bodies.x(j) - x) < near * near && (j > k || !bodies.moves(j)) && j != k &&
          world.collide(order_[k], order_[j]))
        part.entries.push_back({.other = j});
    };
    // What reaches far, or those at lower places that it would find, are found from both sides and kept from one.
    for_each_in_box(x, out + usual_, all_move && !is_far(bodies, k) ? k + 1 : 0, [&](std::uint32_t j) {
      if (squared(bodies.x(j) - x) < most && !is_far(bodies, j)) consider(j);
    });
    for (const std::uint32_t j : far_) consider(j);
    if (!far_.empty())
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
  std::vector<Real> reach_;
  std::vector<V> x_of_list_;
  Real median_ = Real(1), usual_ = Real(0);
  std::size_t walls_ = 0, lists_ = 0;
  ContactBlocks blocks_{};
  SortedCells<Real, Dim> cells_;
};

}  // namespace continuo
