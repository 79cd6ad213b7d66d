// The geometry of a static mesh: its facets, which of them are near or on a way, and what is beside each.
//
// Facets are found by a tree of bounds. A height field has one leaf for a block of cells, since its cells are found by
// their places; of its facets nothing is kept but the heights.
#pragma once
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <variant>
#include <vector>

#include <continuo/bodies/bounds/bounds_tree.hpp>
#include <continuo/bodies/meshes/facet.hpp>
#include <continuo/shapes/mesh_shape.hpp>
#include <continuo/status/result.hpp>

namespace continuo {

/// What is beside the triangles of a mesh: the corners beyond their sides, and the corners around each corner.
struct TriangleNeighbours {
  static constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();
  std::vector<std::array<std::uint32_t, 3>> beyond;  // side k of a triangle: the other triangle's third corner, or none
  std::vector<bool> is_smooth;                       // whether all sides of a triangle are flat or concave, not convex
  std::vector<std::uint32_t> first;  // corner i: the corners around it are from first[i] to first[i + 1]
  std::vector<std::uint32_t> around;
};

template <class Real, int Dim>
class StaticMesh {
 public:
  using V = Vector<Real, Dim>;
  using Corners = std::array<V, static_cast<std::size_t>(Dim)>;
  using Numbers = std::array<std::uint32_t, static_cast<std::size_t>(Dim)>;
  static constexpr std::uint32_t none = TriangleNeighbours::none;

  /// Fails for a shape without facets, for numbers that are not finite, and for facets without length or area; the
  /// message says which. O(n log n).
  [[nodiscard]] static Result<StaticMesh> of(MeshShape<Real, Dim> shape);

  [[nodiscard]] const MeshShape<Real, Dim>& shape() const { return shape_; }
  [[nodiscard]] bool is_two_sided() const { return is_two_sided_; }
  [[nodiscard]] const Bounds<Real, Dim>& bounds() const { return bounds_; }
  /// The number of facets.
  [[nodiscard]] std::size_t size() const { return size_; }
  [[nodiscard]] std::size_t memory() const;

  /// The numbers of the corners of a facet, and their places.
  /// @{
  [[nodiscard]] Numbers numbers(std::uint32_t facet) const;
  [[nodiscard]] V corner(std::uint32_t number) const;
  [[nodiscard]] Corners corners(std::uint32_t facet) const {
    Corners places;
    const Numbers of = numbers(facet);
    for (std::size_t k = 0; k < of.size(); ++k) places[k] = corner(of[k]);
    return places;
  }
  /// @}
  /// The corner of the neighbour beyond a side of a triangle, from corner `side` to the next one: the neighbour's
  /// third. None at a border.
  [[nodiscard]] std::uint32_t beyond(std::uint32_t facet, std::size_t side) const
    requires(Dim == 3);
  /// Whether a triangle is known to have no side that is convex, seen from the free side, and none at a border: then
  /// its own normal is its only one.
  [[nodiscard]] bool is_smooth(std::uint32_t facet) const {
    return !neighbours_.is_smooth.empty() && neighbours_.is_smooth[facet];
  }
  /// Calls visit(place) for the corners that sides join to a corner.
  template <class Visit>
  void for_each_around(std::uint32_t corner, Visit&& visit) const;

  /// Calls visit(facet) for all facets whose bounds overlap `box`.
  template <class Visit>
  void for_each_overlap(const Bounds<Real, Dim>& box, Visit&& visit) const;
  /// Calls visit(facet) for facets whose bounds the box may enter on its way, nearly in the order of entry. The visitor
  /// returns the fraction up to which the box still moves: less than before to shorten its way, below 0 to end.
  template <class Visit>
  void for_each_on_way(const BoxSweep<Real, Dim>& sweep, Visit&& visit) const;

 private:
  using Field = HeightField<Real, Dim>;
  using Facets = std::conditional_t<Dim == 2, Chain<Real>, TriangleMesh<Real>>;
  static constexpr std::uint32_t block_size = 8;  // cells of a height field along an edge of a block
  static constexpr std::uint32_t facets_of_cell = Dim == 2 ? 1 : 2;
  using Cell = std::array<std::uint32_t, Field::axes>;  // its place in the grid
  struct CellRange {
    Cell first{}, last{};  // both included
  };

  explicit StaticMesh(MeshShape<Real, Dim> shape) : shape_(std::move(shape)) {}
  void build();
  [[nodiscard]] const Field* field() const { return std::get_if<Field>(&shape_); }
  [[nodiscard]] const Facets& facets() const { return std::get<Facets>(shape_); }
  [[nodiscard]] CellRange block(std::uint32_t number) const;
  /// The cells of a block that are below a box; no last above the first where there are none.
  [[nodiscard]] CellRange cells_below(const Bounds<Real, Dim>& box, CellRange range) const;
  template <class Act>
  void for_each_facet(const CellRange& cells, Act&& act) const;
  [[nodiscard]] V point_of_grid(const Field& field, std::uint32_t number) const;

  MeshShape<Real, Dim> shape_;
  bool is_two_sided_ = false;
  std::size_t size_ = 0;
  Bounds<Real, Dim> bounds_;
  Cell blocks_{};                  // of a height field, along each axis
  TriangleNeighbours neighbours_;  // of triangles
  BoundsTree<Real, Dim> tree_;     // of facets, or of blocks of cells
};

template <class Real, int Dim>
auto StaticMesh<Real, Dim>::point_of_grid(const Field& field, std::uint32_t number) const -> V {
  V x = field.origin;
  std::uint32_t rest = number;
  for (std::size_t axis = 0; axis < Field::axes; ++axis) {
    x[axis] += field.spacing[axis] * static_cast<Real>(rest % field.counts[axis]);
    rest /= field.counts[axis];
  }
  x[Dim - 1] += field.heights[number];
  return x;
}
template <class Real, int Dim>
auto StaticMesh<Real, Dim>::corner(std::uint32_t number) const -> V {
  if (const Field* const grid = field()) return point_of_grid(*grid, number);
  if constexpr (Dim == 3) {
    return facets().corners[number];
  } else {
    const Chain<Real>& chain = facets();
    return chain.points[number];
  }
}

/// The corners of a cell are those at its lower end; in space, counter-clockwise from there 00, 10, 11, 01, of which
/// the first triangle has 00, 10, 11, the second one 00, 11, 01.
template <class Real, int Dim>
auto StaticMesh<Real, Dim>::numbers(std::uint32_t facet) const -> Numbers {
  if (const Field* const grid = field()) {
    if constexpr (Dim == 2) {
      return {facet + 1, facet};
    } else {
      const std::uint32_t cell = facet / 2, width = grid->counts[0];
      const std::uint32_t low = cell / (width - 1) * width + cell % (width - 1), high = low + width + 1;
      return facet % 2 == 0 ? Numbers{low, low + 1, high} : Numbers{low, high, high - 1};
    }
  }
  if constexpr (Dim == 3) {
    return facets().triangles[facet];
  } else {
    return {facet, static_cast<std::uint32_t>((facet + 1) % facets().points.size())};
  }
}

template <class Real, int Dim>
std::uint32_t StaticMesh<Real, Dim>::beyond(std::uint32_t facet, std::size_t side) const
  requires(Dim == 3)
{
  const Field* const grid = field();
  if (!grid) return neighbours_.beyond[facet][side];
  const std::uint32_t width = grid->counts[0], cell = facet / 2, low = numbers(facet)[0];
  const std::uint32_t x = cell % (width - 1), y = cell / (width - 1);
  if (facet % 2 == 0) {
    if (side == 0) return y > 0 ? low - width : none;
    if (side == 1) return x + 2 < width ? low + width + 2 : none;
    return low + width;
  }
  if (side == 0) return low + 1;
  if (side == 1) return y + 2 < grid->counts[1] ? low + 2 * width + 1 : none;
  return x > 0 ? low - 1 : none;
}

template <class Real, int Dim>
template <class Visit>
void StaticMesh<Real, Dim>::for_each_around(std::uint32_t corner_number, Visit&& visit) const {
  if (const Field* const grid = field()) {
    const std::uint32_t width = grid->counts[0], x = corner_number % width, y = corner_number / width;
    const bool has_left = x > 0, has_right = x + 1 < width;
    if (has_left) visit(corner(corner_number - 1));
    if (has_right) visit(corner(corner_number + 1));
    if constexpr (Dim == 3) {
      const bool has_lower = y > 0, has_upper = y + 1 < grid->counts[1];
      if (has_lower) visit(corner(corner_number - width));
      if (has_upper) visit(corner(corner_number + width));
      if (has_lower && has_left) visit(corner(corner_number - width - 1));
      if (has_upper && has_right) visit(corner(corner_number + width + 1));
    }
    return;
  }
  if constexpr (Dim == 3) {
    for (std::uint32_t k = neighbours_.first[corner_number]; k < neighbours_.first[corner_number + 1]; ++k)
      visit(corner(neighbours_.around[k]));
  } else {
    const Chain<Real>& chain = facets();
    const std::size_t n = chain.points.size();
    if (corner_number > 0 || chain.is_loop) {
      visit(chain.points[(corner_number + n - 1) % n]);
    } else if (chain.before) {
      visit(*chain.before);
    }
    if (corner_number + 1 < n || chain.is_loop) {
      visit(chain.points[(corner_number + 1) % n]);
    } else if (chain.after) {
      visit(*chain.after);
    }
  }
}

template <class Real, int Dim>
auto StaticMesh<Real, Dim>::block(std::uint32_t number) const -> CellRange {
  CellRange range;
  for (std::size_t axis = 0; axis < Field::axes; ++axis) {
    range.first[axis] = number % blocks_[axis] * block_size;
    range.last[axis] = std::min(range.first[axis] + block_size, field()->counts[axis] - 1) - 1;
    number /= blocks_[axis];
  }
  return range;
}
template <class Real, int Dim>
auto StaticMesh<Real, Dim>::cells_below(const Bounds<Real, Dim>& box, CellRange range) const -> CellRange {
  const Field& grid = *field();
  for (std::size_t axis = 0; axis < Field::axes; ++axis) {
    // One cell more on either side, for the sake of rounding: the bounds of facets decide.
    const Real low = (box.lower[axis] - grid.origin[axis]) / grid.spacing[axis] - 1;
    const Real high = (box.upper[axis] - grid.origin[axis]) / grid.spacing[axis] + 1;
    if (low > static_cast<Real>(range.first[axis]))
      range.first[axis] =
          low < static_cast<Real>(range.last[axis]) ? static_cast<std::uint32_t>(low) : range.last[axis];
    if (high < static_cast<Real>(range.last[axis]))
      range.last[axis] =
          high > static_cast<Real>(range.first[axis]) ? static_cast<std::uint32_t>(high) : range.first[axis];
  }
  return range;
}
template <class Real, int Dim>
template <class Act>
void StaticMesh<Real, Dim>::for_each_facet(const CellRange& cells, Act&& act) const {
  if constexpr (Dim == 2) {
    for (std::uint32_t x = cells.first[0]; x <= cells.last[0]; ++x) act(x);
  } else {
    for (std::uint32_t y = cells.first[1]; y <= cells.last[1]; ++y)
      for (std::uint32_t x = cells.first[0]; x <= cells.last[0]; ++x) {
        const std::uint32_t cell = y * (field()->counts[0] - 1) + x;
        act(2 * cell), act(2 * cell + 1);
      }
  }
}

template <class Real, int Dim>
template <class Visit>
void StaticMesh<Real, Dim>::for_each_overlap(const Bounds<Real, Dim>& box, Visit&& visit) const {
  if (!field()) return tree_.for_each_overlap(box, visit);
  tree_.for_each_overlap(box, [&](std::uint32_t number) {
    for_each_facet(cells_below(box, block(number)), [&](std::uint32_t facet) {
      if (overlap(box, bounds_of<Real, Dim>(corners(facet)))) visit(facet);
    });
  });
}

template <class Real, int Dim>
template <class Visit>
void StaticMesh<Real, Dim>::for_each_on_way(const BoxSweep<Real, Dim>& sweep, Visit&& visit) const {
  if (!field()) return tree_.for_each_on_way(sweep, [&](std::uint32_t facet, const Real&) { return visit(facet); });
  const SweepSlabs<Real, Dim> slabs(sweep);
  Real end = sweep.end;
  tree_.for_each_on_way(sweep, [&](std::uint32_t number, const Real&) {
    for_each_facet(block(number), [&](std::uint32_t facet) {
      if (end < Real(0)) return;
      const Real entry = slabs.entry(bounds_of<Real, Dim>(corners(facet)), end);
      if (entry == std::numeric_limits<Real>::infinity()) return;
      end = visit(facet);
    });
    return end;
  });
}

extern template class StaticMesh<float, 2>;
extern template class StaticMesh<float, 3>;
extern template class StaticMesh<double, 2>;
extern template class StaticMesh<double, 3>;

}  // namespace continuo
