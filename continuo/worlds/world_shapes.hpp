// The shapes of a world for display: names, sizes, surfaces and constant positions of its bodies, walls,
// meshes, springs and joints.
#pragma once
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <map>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include <continuo/bodies/meshes/static_mesh.hpp>
#include <continuo/bodies/world.hpp>
#include <continuo/language/model.hpp>
#include <continuo/language/world.hpp>
#include <continuo/worlds/world_run.hpp>

namespace continuo::worlds {

/// The bodies, walls, meshes, springs and joints of a world, without their motion.
struct Shapes {
  std::vector<BodyShape> bodies;
  std::vector<WallShape> walls;
  std::vector<StaticMeshShape> meshes;
  std::vector<SpringShape> springs;
  std::vector<BodyForm> forms;
  std::vector<JointShape> joints;
};

/// A vector as a point; z is 0 in the plane.
template <int Dim>
[[nodiscard]] Point point_of(const Vector<double, Dim>& v) {
  Point point{};
  for (std::size_t i = 0; i < v.size(); ++i) point[i] = v[i];
  return point;
}

/// The surface of a solid. Arcs have corners every 15 degrees; in space edges of rounded polyhedra are shown sharp.
/// @{
[[nodiscard]] BodyForm form_of(const Solid<double, 2>& solid);
[[nodiscard]] BodyForm form_of(const Solid<double, 3>& solid);
/// @}

/// The facets of a static mesh.
template <int Dim>
[[nodiscard]] StaticMeshShape shape_of(const StaticMesh<double, Dim>& mesh, const std::string& name) {
  StaticMeshShape shape{.name = name, .corners = {}, .facets = {}, .thin = mesh.is_two_sided()};
  std::uint32_t most = 0;
  for (std::uint32_t facet = 0; facet < mesh.size(); ++facet) {
    const auto numbers = mesh.numbers(facet);
    shape.facets.push_back({numbers[0], numbers[1], numbers.back()});
    most = std::max(most, std::ranges::max(numbers));
  }
  for (std::uint32_t corner = 0; corner <= most; ++corner) shape.corners.push_back(point_of<Dim>(mesh.corner(corner)));
  return shape;
}

/// The shapes of a model's world with these values of its parameters; nothing where they make none.
[[nodiscard]] Shapes shapes_of(const model::Model& model, std::span<const double> variables);

/// The greatest distance of the places where an unbroken joint holds its bodies.
template <int Dim>
[[nodiscard]] double greatest_gap(const Joint<double, Dim>& joint) {
  switch (joint.kind) {
    case JointKind::distance:
      if (joint.limits) return joint.limits->upper;
      return joint.spring ? std::numeric_limits<double>::infinity() : joint.length;
    case JointKind::slider:
    case JointKind::wheel:
    case JointKind::gear:
    case JointKind::pull:
      return std::numeric_limits<double>::infinity();
    case JointKind::hinge:
    case JointKind::ball:
    case JointKind::weld:
    case JointKind::universal:
      break;
  }
  return 0;
}

/// `text` is the description from which the world was built, with these joints; its names have the order of the world.
template <int Dim>
[[nodiscard]] Shapes shapes_of(const World<double, Dim>& world, std::span<const JointHandle> joints,
                               const model::WorldDescription& text) {
  Shapes shapes;
  std::map<const Solid<double, Dim>*, std::size_t> forms;  // equal bodies share their solids
  for (std::size_t i = 0; i < world.size(); ++i) {
    shapes.bodies.push_back({text.bodies[i].name, world.radius[i], world.mass[i], text.bodies[i].is_unstoppable()});
    const Solid<double, Dim>* const solid = world.solid(i);
    if (!solid) continue;
    const auto [known, is_new] = forms.try_emplace(solid, shapes.forms.size());
    if (is_new) shapes.forms.push_back(form_of(*solid));
    shapes.bodies.back().form = known->second;
  }
  for (std::size_t k = 0; k < joints.size(); ++k) {
    const Joint<double, Dim>* const joint = world.find(joints[k]);
    if (!joint) continue;
    const model::JointDescription& of = text.joints[k];
    const bool has_axis = joint->kind == JointKind::slider || joint->kind == JointKind::wheel;
    shapes.joints.push_back({of.is_named ? of.name : "", of.kind, of.first, of.second, point_of<Dim>(joint->anchor_b),
                             point_of<Dim>(joint->anchor_a), has_axis ? point_of<Dim>(joint->axes_a[0]) : Point{},
                             greatest_gap(*joint)});
  }
  for (std::size_t w = 0; w < world.walls().size(); ++w) {
    const Wall<double, Dim>& wall = world.walls()[w];
    shapes.walls.push_back({text.walls[w].name, point_of<Dim>(wall.normal), wall.offset, wall.thin});
  }
  for (std::size_t m = 0; m < world.meshes().size(); ++m)
    shapes.meshes.push_back(shape_of(*world.meshes()[m].geometry, text.meshes[m].name));
  for (std::size_t k = 0; k < world.springs.size(); ++k) {
    const auto* end = std::get_if<Vector<double, Dim>>(&world.springs[k].b);
    shapes.springs.push_back({text.springs[k].a, text.springs[k].b, end ? point_of<Dim>(*end) : Point{}});
  }
  return shapes;
}

}  // namespace continuo::worlds
