// Finds the neighbours of the facets of static meshes.
#include <cmath>
#include <string>
#include <utility>

#include <continuo/bodies/meshes/static_mesh.hpp>
#include <continuo/bodies/meshes/surface_normals.hpp>
#include <continuo/shapes/mesh_check.hpp>

namespace continuo {
namespace {

/// For each corner the least number of those at its place.
template <class Real>
std::vector<std::uint32_t> first_at_place(const std::vector<Vector<Real, 3>>& corners) {
  std::vector<std::uint32_t> order(corners.size()), first(corners.size());
  for (std::uint32_t i = 0; i < order.size(); ++i) order[i] = i;
  std::ranges::sort(order, [&](std::uint32_t i, std::uint32_t j) {
    return std::pair(corners[i].components, i) < std::pair(corners[j].components, j);
  });
  for (std::size_t k = 0; k < order.size(); ++k)
    first[order[k]] = k > 0 && corners[order[k]] == corners[order[k - 1]] ? first[order[k - 1]] : order[k];
  return first;
}

/// A side of a triangle between two corners.
struct Side {
  std::uint32_t low, high, triangle, number;
  friend auto operator<=>(const Side&, const Side&) = default;
};

template <class Real>
TriangleNeighbours neighbours_of(const TriangleMesh<Real>& mesh) {
  const std::vector<std::uint32_t> first = first_at_place(mesh.corners);
  const auto corner = [&](std::uint32_t triangle, std::size_t k) { return mesh.triangles[triangle][k % 3]; };
  std::vector<Side> sides;
  sides.reserve(3 * mesh.triangles.size());
  for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i)
    for (std::uint32_t k = 0; k < 3; ++k) {
      const auto [low, high] = std::minmax({first[corner(i, k)], first[corner(i, k + 1)]});
      sides.push_back({low, high, i, k});
    }
  std::ranges::sort(sides);
  TriangleNeighbours found;
  constexpr std::uint32_t none = TriangleNeighbours::none;
  found.beyond.assign(mesh.triangles.size(), {none, none, none});
  std::vector<std::pair<std::uint32_t, std::uint32_t>> joined;  // corners by a side
  for (std::size_t k = 0; k < sides.size(); ++k) {
    const Side& side = sides[k];
    const auto is_same = [&](const Side& other) { return other.low == side.low && other.high == side.high; };
    const bool is_first = k == 0 || !is_same(sides[k - 1]);
    if (is_first) joined.emplace_back(side.low, side.high), joined.emplace_back(side.high, side.low);
    // Where more than two triangles share a side, each sees the next one.
    const std::size_t next = k + 1 < sides.size() && is_same(sides[k + 1]) ? k + 1 : is_first ? k : k - 1;
    if (next != k) found.beyond[side.triangle][side.number] = corner(sides[next].triangle, sides[next].number + 2);
  }
  // Corners at the place of another one have the corners around that.
  std::ranges::sort(joined);
  const auto around = [&](std::uint32_t i) {
    return std::ranges::equal_range(joined, first[i], {}, &std::pair<std::uint32_t, std::uint32_t>::first);
  };
  for (std::uint32_t i = 0; i < mesh.corners.size(); ++i) {
    found.first.push_back(static_cast<std::uint32_t>(found.around.size()));
    for (const auto& [of, other] : around(i)) found.around.push_back(other);
  }
  found.first.push_back(static_cast<std::uint32_t>(found.around.size()));
  return found;
}

}  // namespace

template <class Real, int Dim>
Result<StaticMesh<Real, Dim>> StaticMesh<Real, Dim>::of(MeshShape<Real, Dim> shape) {
  if (Status fault = std::visit([](const auto& of) { return check(of); }, shape); !fault) return fault;
  StaticMesh mesh(std::move(shape));
  mesh.build();
  // Products of sides and heights are to be finite.
  const Real size = length(V(mesh.bounds_.upper - mesh.bounds_.lower)), square = size * size;
  if (!std::isfinite(square * square)) return invalid_input("the mesh is too large: its sizes are beyond the numbers");
  return mesh;
}

template <class Real, int Dim>
void StaticMesh<Real, Dim>::build() {
  std::vector<Bounds<Real, Dim>> leaves;
  if (const Field* const grid = field()) {
    std::size_t blocks = 1;
    size_ = facets_of_cell;
    for (std::size_t axis = 0; axis < Field::axes; ++axis) {
      const std::uint32_t cells = grid->counts[axis] - 1;
      blocks_[axis] = (cells + block_size - 1) / block_size;
      blocks *= blocks_[axis], size_ *= cells;
    }
    leaves.resize(blocks);
    for (std::uint32_t k = 0; k < blocks; ++k)
      for_each_facet(block(k),
                     [&](std::uint32_t facet) { leaves[k] = united(leaves[k], bounds_of<Real, Dim>(corners(facet))); });
  } else {
    is_two_sided_ = facets().is_two_sided;
    if constexpr (Dim == 3) {
      size_ = facets().triangles.size();
      neighbours_ = neighbours_of(facets());
      neighbours_.is_smooth.assign(size_, true);
      for (std::uint32_t k = 0; k < size_; ++k)
        for (const bool is_turned : {false, true})
          if (is_two_sided_ || !is_turned)
            for_each_convex_side(*this, k, is_turned, [&](const auto&) { neighbours_.is_smooth[k] = false; });
    } else {
      size_ = facets().points.size() - (facets().is_loop ? 0 : 1);
    }
    leaves.reserve(size_);
    for (std::uint32_t k = 0; k < size_; ++k) leaves.push_back(bounds_of<Real, Dim>(corners(k)));
  }
  for (const Bounds<Real, Dim>& leaf : leaves) bounds_ = united(bounds_, leaf);
  tree_.build(leaves);
}

template <class Real, int Dim>
std::size_t StaticMesh<Real, Dim>::memory() const {
  std::size_t sum = sizeof(*this) + tree_.memory();
  if (const Field* const grid = field()) return sum + grid->heights.capacity() * sizeof(Real);
  if constexpr (Dim == 2) {
    return sum + facets().points.capacity() * sizeof(V);
  } else {
    sum += facets().corners.capacity() * sizeof(V) + facets().triangles.capacity() * sizeof(Numbers);
    sum += neighbours_.beyond.capacity() * sizeof(Numbers) + neighbours_.is_smooth.capacity() / 8;
    return sum + (neighbours_.first.capacity() + neighbours_.around.capacity()) * sizeof(std::uint32_t);
  }
}

template class StaticMesh<float, 2>;
template class StaticMesh<float, 3>;
template class StaticMesh<double, 2>;
template class StaticMesh<double, 3>;

}  // namespace continuo
