// continuo/worlds/build_world.cpp
// Evaluates the description of a world with its parameters, and adds its bodies, walls and meshes.
#include <algorithm>
#include <array>
#include <string>
#include <vector>

#include <continuo/language/described_mesh.hpp>
#include <continuo/language/described_shape.hpp>
#include <continuo/language/text/words.hpp>
#include <continuo/status/require.hpp>
#include <continuo/worlds/build_joints.hpp>
#include <continuo/worlds/build_world.hpp>

namespace continuo::worlds {

namespace {

using model::NodeId;

/// Collects expressions one after the other and evaluates them together, since bodies of a pattern share most of their
/// expressions.
class Values {
 public:
  Values(const model::Model& model, std::span<const double> variables) : model_(model), variables_(variables) {}

  void want(NodeId node) { nodes_.push_back(node.valid() ? node : NodeId{0}); }
  template <std::size_t Size>
  void want(const std::array<NodeId, Size>& nodes, std::size_t count) {
    for (std::size_t i = 0; i < count; ++i) want(nodes[i]);
  }
  void want(const std::vector<NodeId>& nodes) {
    for (const NodeId node : nodes) want(node);
  }
  void want(const model::MaterialDescription& m) { want(m.restitution), want(m.friction), want(m.rolling); }
  void compute() { values_ = evaluate(model_, nodes_, variables_); }

  double next() { return values_[next_++]; }
  template <int Dim>
  Vector<double, Dim> next_point() {
    Vector<double, Dim> point;
    for (std::size_t i = 0; i < point.size(); ++i) point[i] = next();
    return point;
  }
  std::span<const double> next(std::size_t count) {
    next_ += count;
    return std::span(values_).subspan(next_ - count, count);
  }
  Material<double> next_material() {
    Material<double> material;
    material.restitution = next();
    material.friction = next();
    material.rolling_resistance = next();
    return material;
  }

 private:
  const model::Model& model_;
  std::span<const double> variables_;
  std::vector<NodeId> nodes_;
  std::vector<double> values_;
  std::size_t next_ = 0;
};

Combine combination(const std::string& name) {
  const auto at = std::ranges::find(model::combinations, name) - model::combinations.begin();
  constexpr std::array kinds{Combine::average, Combine::minimum, Combine::maximum, Combine::product,
                             Combine::geometric_mean};
  static_assert(kinds.size() == model::combinations.size());
  return kinds[static_cast<std::size_t>(at)];
}

}  // namespace

template <int Dim>
BuiltWorld<Dim> build_world(const model::Model& model, std::span<const double> variables) {
  const model::WorldDescription& text = *model.world;
  constexpr std::size_t axes = Dim;
  Values values(model, variables);
  values.want(text.gravity, axes);
  for (const NodeId node : {text.attraction, text.softening, text.opening, text.drag_linear, text.drag_quadratic})
    values.want(node);
  for (const auto& body : text.bodies)
    values.want(model::shape_nodes(body.shape, Dim)), values.want(body.mass), values.want(body.material),
        values.want(body.traits.gravity_scale), values.want(body.traits.damping), values.want(body.traits.spin_damping);
  for (const auto& wall : text.walls)
    values.want(wall.normal, axes), values.want(wall.offset), values.want(wall.material);
  for (const auto& mesh : text.meshes) values.want(model::mesh_nodes(mesh, Dim)), values.want(mesh.material);
  for (const auto& spring : text.springs) {
    if (spring.b == model::no_body) values.want(spring.point, axes);
    values.want(spring.stiffness), values.want(spring.length), values.want(spring.damping);
  }
  values.compute();

  BuiltWorld<Dim> built;
  World<double, Dim>& world = built.world;
  world.time = variables[model::Layout::time];
  world.gravity = values.next_point<Dim>();
  const auto next_or = [&](NodeId node) {
    const double value = values.next();
    return node.valid() ? value : 0;
  };
  world.attraction.constant = next_or(text.attraction);
  world.attraction.softening = next_or(text.softening);
  world.attraction.opening = next_or(text.opening);
  world.drag.linear = next_or(text.drag_linear);
  world.drag.quadratic = next_or(text.drag_quadratic);
  world.reserve(text.bodies.size());
  for (const auto& body : text.bodies) {
    const double* state = variables.data() + model.layout.states + body.first_state;
    BodyDefinition<double, Dim> definition;
    definition.shape = model::described_shape<Dim>(body.shape, values.next(model::shape_nodes(body.shape, Dim).size()));
    definition.mass = values.next();
    definition.material = values.next_material();
    definition.fixed = body.fixed;
    const double gravity_scale = values.next(), damping = values.next(), spin_damping = values.next();
    if (body.traits.gravity_scale.valid()) definition.traits.gravity_scale = gravity_scale;
    if (body.traits.damping.valid()) definition.traits.damping = damping;
    if (body.traits.spin_damping.valid()) definition.traits.spin_damping = spin_damping;
    definition.traits.is_driven = body.driven;
    definition.traits.is_sensor = body.traits.sensor;
    definition.traits.locked = static_cast<Locked>(body.traits.locked);
    definition.group = body.group;
    for (std::size_t axis = 0; axis < axes; ++axis) {
      definition.position[axis] = *state++;
      definition.velocity[axis] = *state++;
    }
    for (std::size_t k = 0; k < definition.orientation.size(); ++k) definition.orientation[k] = *state++;
    for (std::size_t k = 0; k < definition.spin.size(); ++k) definition.spin[k] = *state++;
    const auto added = world.add(definition);
    if (!added && built.status) built.status = invalid_input("`" + body.name + "`: " + added.status().message);
    if (!added) return built;
    world.position.back() = definition.position;  // the states have the centre of mass, not the origin of the shape
  }
  for (const auto& wall : text.walls) {
    Wall<double, Dim> made;
    made.normal = values.next_point<Dim>();
    made.offset = values.next();
    made.material = values.next_material();
    made.thin = wall.thin;
    // A wall is written where normal . x = offset, of any length of the normal.
    made.offset /= length(made.normal);
    if (const Status status = world.add_wall(made); !status) {
      built.status = invalid_input("`" + wall.name + "`: " + status.message);
      return built;
    }
  }
  for (const auto& mesh : text.meshes) {
    MeshDefinition<double, Dim> made{
        .shape = model::described_mesh<Dim>(mesh, values.next(model::mesh_nodes(mesh, Dim).size()))};
    made.material = values.next_material();
    if (const auto added = world.add_mesh(made); !added) {
      built.status = invalid_input("`" + mesh.name + "`: " + added.status().message);
      return built;
    }
  }
  for (const auto& spring : text.springs) {
    Spring<double, Dim> made;
    made.a = world.handle(spring.a);
    if (spring.b == model::no_body) {
      made.b = values.next_point<Dim>();
    } else {
      made.b = world.handle(spring.b);
    }
    made.stiffness = values.next();
    made.rest_length = values.next();
    made.damping = values.next();
    world.springs.push_back(made);
  }
  world.combine_rule = {.restitution = combination(text.combine_rule.restitution),
                        .friction = combination(text.combine_rule.friction),
                        .rolling_resistance = combination(text.combine_rule.rolling)};
  for (const auto& [a, b] : text.ignored) require(world.ignore(a, b));  // the language has counted the groups
  auto joints = add_joints(model, variables, world);
  if (joints) {
    built.joints = *std::move(joints);
  } else {
    built.status = joints.status();
  }
  return built;
}

template BuiltWorld<2> build_world(const model::Model&, std::span<const double>);
template BuiltWorld<3> build_world(const model::Model&, std::span<const double>);

}  // namespace continuo::worlds
