// Checks the shapes of surfaces.
#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include <continuo/shapes/matrix.hpp>
#include <continuo/shapes/mesh_check.hpp>

namespace continuo {

namespace {

constexpr std::size_t most_facets = std::size_t{1} << 30;

template <class Real>
Real length_or_area(const std::array<Vector<Real, 2>, 2>& corners) {
  return length(Vector<Real, 2>(corners[1] - corners[0]));
}
template <class Real>
Real length_or_area(const std::array<Vector<Real, 3>, 3>& corners) {
  return length(moment(corners[1] - corners[0], corners[2] - corners[0]));
}

}  // namespace

template <class Real, int Dim>
bool is_facet(const std::array<Vector<Real, Dim>, static_cast<std::size_t>(Dim)>& corners) {
  Real longest2(0);
  for (std::size_t k = 0; k < corners.size(); ++k)
    longest2 = std::max(longest2, squared(Vector<Real, Dim>(corners[(k + 1) % corners.size()] - corners[k])));
  const Real size = length_or_area(corners), least = 16 * std::numeric_limits<Real>::epsilon();
  return size - size == Real(0) && size > (Dim == 2 ? Real(0) : least * longest2);
}

template <class Real>
Status check(const Chain<Real>& chain) {
  const std::size_t n = chain.points.size();
  if (n < (chain.is_loop ? 3 : 2)) return invalid_input("a chain needs two points, a loop three");
  if (n > most_facets) return invalid_input("a chain has too many points");
  if (chain.is_loop && (chain.before || chain.after))
    return invalid_input("a loop has no corners before and after its points");
  for (const auto& ghost : {chain.before, chain.after})
    if (ghost && !is_finite(*ghost)) return invalid_input("the corners before and after a chain must be finite");
  for (std::size_t i = 0; i < n; ++i) {
    const std::string number = std::to_string(i);
    if (!is_finite(chain.points[i])) return invalid_input("point " + number + " of the chain is not finite");
    if ((i + 1 < n || chain.is_loop) && !is_facet<Real, 2>({chain.points[i], chain.points[(i + 1) % n]}))
      return invalid_input("the chain has no way from point " + number + " to the next: leave one of them out");
  }
  return {};
}
template <class Real>
Status check(const TriangleMesh<Real>& mesh) {
  if (mesh.triangles.empty()) return invalid_input("a mesh needs at least one triangle");
  if (mesh.triangles.size() > most_facets || mesh.corners.size() > most_facets)
    return invalid_input("a mesh has too many triangles");
  for (std::size_t i = 0; i < mesh.corners.size(); ++i)
    if (!is_finite(mesh.corners[i])) return invalid_input("corner " + std::to_string(i) + " of the mesh is not finite");
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    std::array<Vector<Real, 3>, 3> corners;
    for (std::size_t k = 0; k < 3; ++k) {
      if (mesh.triangles[i][k] >= mesh.corners.size())
        return invalid_input("triangle " + std::to_string(i) + " has a corner that the mesh does not have");
      corners[k] = mesh.corners[mesh.triangles[i][k]];
    }
    if (!is_facet<Real, 3>(corners))
      return invalid_input("triangle " + std::to_string(i) + " of the mesh has no area: leave it out");
  }
  return {};
}
template <class Real, int Dim>
Status check(const HeightField<Real, Dim>& field) {
  std::size_t points = 1;
  if (!is_finite(field.origin)) return invalid_input("the origin of a height field must be finite");
  for (std::size_t axis = 0; axis < field.axes; ++axis) {
    if (!(field.spacing[axis] > Real(0)) || !std::isfinite(field.spacing[axis]))
      return invalid_input("the spacing of a height field must be greater than 0, and finite");
    if (field.counts[axis] < 2) return invalid_input("a height field needs two points or more along each axis");
    points *= field.counts[axis];
    if (points > most_facets) return invalid_input("a height field has too many points");
  }
  if (points != field.heights.size())
    return invalid_input("a height field needs " + std::to_string(points) + " heights, one for each point, not " +
                         std::to_string(field.heights.size()));
  for (std::size_t i = 0; i < points; ++i)
    if (!std::isfinite(field.heights[i]))
      return invalid_input("height " + std::to_string(i) + " of the field is not finite");
  return {};
}

template bool is_facet<float, 2>(const std::array<Vector<float, 2>, 2>&);
template bool is_facet<float, 3>(const std::array<Vector<float, 3>, 3>&);
template bool is_facet<double, 2>(const std::array<Vector<double, 2>, 2>&);
template bool is_facet<double, 3>(const std::array<Vector<double, 3>, 3>&);
template Status check(const Chain<float>&);
template Status check(const Chain<double>&);
template Status check(const TriangleMesh<float>&);
template Status check(const TriangleMesh<double>&);
template Status check(const HeightField<float, 2>&);
template Status check(const HeightField<float, 3>&);
template Status check(const HeightField<double, 2>&);
template Status check(const HeightField<double, 3>&);

}  // namespace continuo
