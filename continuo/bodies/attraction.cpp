// continuo/bodies/attraction.cpp
// Gravity between all pairs of bodies: exact sums, and a Barnes-Hut tree.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <continuo/bodies/attraction.hpp>

namespace continuo {

namespace {

template <class Real, int Dim>
Vector<Real, Dim> pull(const World<Real, Dim>& world, const Vector<Real, Dim>& apart, const Real& mass) {
  using std::sqrt;
  const Real square = squared(apart) + world.attraction.softening * world.attraction.softening;
  if (!(square > Real(0))) return {};  // two points at one place pull in no direction
  return apart * (world.attraction.constant * mass / (square * sqrt(square)));
}

template <class Real, int Dim>
void add_all_pairs(const World<Real, Dim>& world, std::span<const Vector<Real, Dim>> x,
                   std::span<Vector<Real, Dim>> force) {
  for (std::size_t i = 0; i < x.size(); ++i)
    for (std::size_t j = i + 1; j < x.size(); ++j) {
      const Vector<Real, Dim> by_mass = pull<Real, Dim>(world, x[j] - x[i], Real(1)) * (world.mass[i] * world.mass[j]);
      force[i] += by_mass;
      force[j] -= by_mass;
    }
}

/// A tree of squares or cubes, each split until one body is left in it.
template <class Real, int Dim>
class Tree {
 public:
  using V = Vector<Real, Dim>;

  Tree(const World<Real, Dim>& world, std::span<const V> x) : world_(world), x_(x), order_(x.size()) {
    for (std::size_t i = 0; i < order_.size(); ++i) order_[i] = static_cast<std::uint32_t>(i);
    V lower = x[0], upper = x[0];
    for (const V& at : x)
      for (std::size_t axis = 0; axis < V::size(); ++axis) {
        lower[axis] = std::min(lower[axis], at[axis]);
        upper[axis] = std::max(upper[axis], at[axis]);
      }
    Real edge(0);
    for (std::size_t axis = 0; axis < V::size(); ++axis) edge = std::max(edge, upper[axis] - lower[axis]);
    build((lower + upper) * (Real(1) / 2), edge, 0, static_cast<std::uint32_t>(x.size()), 0);
  }

  V force_on(std::uint32_t body) const {
    V sum;
    std::array<std::uint32_t, deepest * children + 1> waiting;
    std::size_t count = 0;
    waiting[count++] = 0;
    const Real opening = world_.attraction.opening;
    while (count > 0) {
      const Cell& cell = cells_[waiting[--count]];
      const V apart = cell.centre - x_[body];
      if (cell.edge * cell.edge < opening * opening * squared(apart)) {
        sum += pull<Real, Dim>(world_, apart, cell.mass);
      } else if (cell.is_leaf) {
        for (std::uint32_t k = cell.first; k < cell.last; ++k)
          if (order_[k] != body) sum += pull<Real, Dim>(world_, x_[order_[k]] - x_[body], world_.mass[order_[k]]);
      } else {
        for (const std::uint32_t child : cell.child)
          if (child != 0) waiting[count++] = child;
      }
    }
    return sum * world_.mass[body];
  }

 private:
  static constexpr std::size_t children = std::size_t{1} << Dim;
  static constexpr std::size_t deepest = 48;   // levels: bodies nearer than 2^-48 of the root's edge share a leaf
  static constexpr std::uint32_t of_leaf = 8;  // bodies: summing up so few is faster than another level
  struct Cell {
    V centre{};  // of mass
    Real mass{}, edge{};
    std::uint32_t first = 0, last = 0;  // of order_
    bool is_leaf = false;
    std::array<std::uint32_t, children> child{};  // 0: no child, for the root is the child of no cell
  };

  std::uint32_t build(const V& middle, Real edge, std::uint32_t first, std::uint32_t last, std::size_t depth) {
    const auto number = static_cast<std::uint32_t>(cells_.size());
    cells_.emplace_back();
    Cell cell{.centre = {}, .mass = {}, .edge = edge, .first = first, .last = last};
    for (std::uint32_t k = first; k < last; ++k) {
      cell.mass += world_.mass[order_[k]];
      cell.centre += x_[order_[k]] * world_.mass[order_[k]];
    }
    cell.centre *= 1 / cell.mass;
    cell.is_leaf = last - first <= of_leaf || depth + 1 == deepest;
    if (!cell.is_leaf) split(cell, middle, depth);
    cells_[number] = cell;
    return number;
  }
  void split(Cell& cell, const V& middle, std::size_t depth) {
    const auto octant = [&](std::uint32_t body) {
      std::size_t which = 0;
      for (std::size_t axis = 0; axis < V::size(); ++axis)
        which |= static_cast<std::size_t>(x_[body][axis] > middle[axis]) << axis;
      return which;
    };
    const auto begin = order_.begin() + cell.first, end = order_.begin() + cell.last;
    std::sort(begin, end, [&](std::uint32_t a, std::uint32_t b) {
      const std::size_t p = octant(a), q = octant(b);
      return p != q ? p < q : a < b;
    });
    for (std::uint32_t from = cell.first; from < cell.last;) {
      const std::size_t which = octant(order_[from]);
      std::uint32_t to = from;
      while (to < cell.last && octant(order_[to]) == which) ++to;
      V part = middle;
      for (std::size_t axis = 0; axis < V::size(); ++axis)
        part[axis] += (which >> axis & 1u ? Real(1) : Real(-1)) * cell.edge / 4;
      cell.child[which] = build(part, cell.edge / 2, from, to, depth + 1);
      from = to;
    }
  }

  const World<Real, Dim>& world_;
  std::span<const V> x_;
  std::vector<std::uint32_t> order_;  // bodies, cell by cell
  std::vector<Cell> cells_;
};

}  // namespace

template <class Real, int Dim>
void add_attraction(const World<Real, Dim>& world, std::span<const Vector<Real, Dim>> x,
                    std::span<Vector<Real, Dim>> force) {
  if (x.empty()) return;
  if (!(world.attraction.opening > Real(0))) return add_all_pairs(world, x, force);
  const Tree<Real, Dim> tree(world, x);
  for (std::uint32_t i = 0; i < x.size(); ++i)
    if (!world.is_fixed(i)) force[i] += tree.force_on(i);
}

template <class Real, int Dim>
Real attraction_energy(const World<Real, Dim>& world) {
  using std::sqrt;
  const Real soft = world.attraction.softening * world.attraction.softening;
  Real sum(0);
  for (std::size_t i = 0; i < world.size(); ++i)
    for (std::size_t j = i + 1; j < world.size(); ++j) {
      const Real square = squared(world.position[j] - world.position[i]) + soft;
      if (world.is_fixed(i) && world.is_fixed(j)) continue;
      if (square > Real(0)) sum -= world.attraction.constant * world.mass[i] * world.mass[j] / sqrt(square);
    }
  return sum;
}

template void add_attraction(const World<float, 2>&, std::span<const Vector<float, 2>>, std::span<Vector<float, 2>>);
template void add_attraction(const World<float, 3>&, std::span<const Vector<float, 3>>, std::span<Vector<float, 3>>);
template void add_attraction(const World<double, 2>&, std::span<const Vector<double, 2>>, std::span<Vector<double, 2>>);
template void add_attraction(const World<double, 3>&, std::span<const Vector<double, 3>>, std::span<Vector<double, 3>>);
template float attraction_energy(const World<float, 2>&);
template float attraction_energy(const World<float, 3>&);
template double attraction_energy(const World<double, 2>&);
template double attraction_energy(const World<double, 3>&);

}  // namespace continuo
