// Where cores overlap, the depth is the least way out along the normals of faces and, in space, across pairs of edges
// (S. Gottschalk, M. C. Lin, D. Manocha, "OBBTree", SIGGRAPH 1996, section 5).
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <continuo/language/check/world/start/start_shapes.hpp>
#include <continuo/language/described_shape.hpp>
#include <continuo/shapes/closest_points.hpp>
#include <continuo/shapes/solid.hpp>

namespace continuo::model::detail {

namespace {

template <int Dim>
using V = Vector<double, Dim>;

template <int Dim>
double least_along(const Polytope<double, Dim>& of, const V<Dim>& direction) {
  return dot(of.corners[support(of, V<Dim>(-direction))], direction);
}

/// The sides of a polygon, or the edges of a polyhedron, as directions.
std::vector<V<2>> edges_of(const Polytope<double, 2>& of) {
  std::vector<V<2>> edges;
  for (std::size_t i = 0; i + 1 < of.corners.size() || (i < of.corners.size() && i > 1); ++i)
    edges.push_back(of.corners[(i + 1) % of.corners.size()] - of.corners[i]);
  return edges;
}
std::vector<V<3>> edges_of(const Polytope<double, 3>& of) {
  std::vector<V<3>> edges;
  for (const Edge& edge : of.edges) edges.push_back(of.corners[edge.to] - of.corners[edge.from]);
  if (of.corners.size() == 2) edges.push_back(of.corners[1] - of.corners[0]);
  return edges;
}

/// The directions in which the way out can be least.
std::vector<V<2>> ways_out(const Polytope<double, 2>& a, const Polytope<double, 2>& b) {
  std::vector<V<2>> ways;
  for (const auto* of : {&a, &b})
    for (const V<2>& edge : edges_of(*of)) ways.push_back({{-edge[1], edge[0]}});
  return ways;
}
/// The normals of faces are across two of their own edges.
std::vector<V<3>> ways_out(const Polytope<double, 3>& a, const Polytope<double, 3>& b) {
  std::vector<V<3>> edges = edges_of(a), ways;
  const std::vector<V<3>> others = edges_of(b);
  edges.insert(edges.end(), others.begin(), others.end());
  for (std::size_t i = 0; i < edges.size(); ++i)
    for (std::size_t j = 0; j < i; ++j) ways.push_back(moment(edges[i], edges[j]));
  return ways;
}

template <int Dim>
double depth_of(const PlacedCore<Dim>& a, const PlacedCore<Dim>& b) {
  const double round = a.rounding + b.rounding;
  const auto closest = closest_points(a.core, b.core, Pose<double, Dim>{});
  if (closest.distance > 0) return round - closest.distance;
  double least = std::numeric_limits<double>::infinity();
  for (V<Dim> way : ways_out(a.core, b.core)) {
    const double size = length(way);
    if (!(size > 0)) continue;
    way *= 1 / size;
    for (const double side : {1.0, -1.0}) {
      const V<Dim> along = way * side;
      least = std::min(least, -least_along(a.core, V<Dim>(-along)) - least_along(b.core, along));
    }
  }
  return round + (std::isfinite(least) ? least : 0);
}

}  // namespace

template <int Dim>
void StartShapes::place(const Model& model, const WorldDescription& made, std::span<const double> variables) {
  std::vector<NodeId> nodes;
  for (const BodyDescription& body : made.bodies) {
    const std::vector<NodeId> of_body = shape_nodes(body.shape, Dim);
    nodes.insert(nodes.end(), of_body.begin(), of_body.end());
  }
  const std::vector<double> values = evaluate(model, nodes, variables);
  std::span<const double> left = values;
  std::vector<PlacedCores<Dim>> cores;
  for (std::size_t i = 0; i < made.bodies.size(); ++i) {
    const BodyDescription& body = made.bodies[i];
    const std::size_t count = shape_nodes(body.shape, Dim).size();
    const auto solid = continuo::solid<double, Dim>(described_shape<Dim>(body.shape, left.first(count)));
    left = left.subspan(count);
    PlacedCores<Dim>& placed = cores.emplace_back();
    if (!solid) continue;
    const double* state = variables.data() + model.layout.states + body.first_state + 2 * Dim;
    Orientation<double, Dim> orientation;
    for (std::size_t k = 0; k < orientation.size(); ++k) orientation[k] = state[k];
    Pose<double, Dim> pose{.centre = {}, .axes = rotation(orientation)};
    for (std::size_t k = 0; k < pose.centre.size(); ++k) pose.centre[k] = centre[i][k];
    for (const SolidPart<double, Dim>& part : solid->parts) {
      PlacedCore<Dim>& core = placed.emplace_back();
      core.core.edges = part.convex.core.edges;
      core.rounding = part.convex.rounding;
      for (const V<Dim>& corner : part.convex.core.corners)
        core.core.corners.push_back(pose.place(part.in_solid.place(corner)));
    }
  }
  cores_ = std::move(cores);
}

StartShapes::StartShapes(const Model& model, const WorldDescription& made, std::span<const double> variables) {
  std::vector<NodeId> nodes;
  for (const BodyDescription& body : made.bodies) {
    nodes.push_back(body.radius);
    std::array<double, 3>& at = centre.emplace_back();
    for (std::size_t axis = 0; axis < static_cast<std::size_t>(made.dimension); ++axis)
      at[axis] = variables[model.layout.states + body.first_state + 2 * axis];
  }
  radius = evaluate(model, nodes, variables);
  made.dimension == 2 ? place<2>(model, made, variables) : place<3>(model, made, variables);
}

double StartShapes::depth(std::size_t i, std::size_t j) const {
  return std::visit(
      [&](const auto& cores) {
        double deepest = 0;
        for (const auto& a : cores[i])
          for (const auto& b : cores[j]) deepest = std::max(deepest, depth_of(a, b));
        return deepest;
      },
      cores_);
}

template <int Dim>
double StartShapes::depth_in_facet(std::size_t i, const std::array<V<Dim>, Dim>& corners) const {
  PlacedCore<Dim> facet;
  facet.core.corners.assign(corners.begin(), corners.end());
  for (std::uint8_t k = 0; Dim == 3 && k < corners.size(); ++k)
    facet.core.edges.push_back({.from = k, .to = static_cast<std::uint8_t>((k + 1) % corners.size())});
  double deepest = 0;
  for (const PlacedCore<Dim>& part : std::get<std::vector<PlacedCores<Dim>>>(cores_)[i])
    deepest = std::max(deepest, depth_of(part, facet));
  return deepest;
}
template double StartShapes::depth_in_facet<2>(std::size_t, const std::array<V<2>, 2>&) const;
template double StartShapes::depth_in_facet<3>(std::size_t, const std::array<V<3>, 3>&) const;

double StartShapes::depth_in_wall(std::size_t i, const std::array<double, 3>& normal, double offset,
                                  bool is_thin) const {
  double above = -offset;
  for (std::size_t k = 0; k < 3; ++k) above += normal[k] * centre[i][k];
  const double side = is_thin && above < 0 ? -1 : 1;
  return std::visit(
      [&](const auto& cores) {
        double deepest = 0;
        for (const auto& part : cores[i]) {
          auto towards = part.core.corners.front();
          for (std::size_t k = 0; k < towards.size(); ++k) towards[k] = side * normal[k];
          deepest = std::max(deepest, part.rounding - (least_along(part.core, towards) - side * offset));
        }
        return deepest;
      },
      cores_);
}

}  // namespace continuo::model::detail
