// continuo/language/world.cpp
// Names of what a world and its joints measure.
#include <algorithm>

#include <continuo/language/world.hpp>

namespace continuo::model {

std::vector<std::string> world_measures(int dimension) {
  std::vector<std::string> names{"kinetic", "potential", "momentum_x", "momentum_y"};
  if (dimension == 3) names.emplace_back("momentum_z");
  names.emplace_back("collisions");
  return names;
}

std::vector<std::string> joint_measures(std::string_view kind, int dimension, bool is_named, bool has_motor) {
  std::vector<std::string> names;
  if (is_named && kind == "hinge") names.emplace_back("angle");
  if (is_named && (kind == "slider" || kind == "distance" || kind == "rope" || kind == "wheel"))
    names.emplace_back("length");
  names.insert(names.end(), {"force_x", "force_y"});
  if (dimension == 2) {
    names.emplace_back("torque");
  } else {
    names.insert(names.end(), {"force_z", "torque_x", "torque_y", "torque_z"});
  }
  if (has_motor) names.emplace_back(kind == "slider" ? "motor_force" : "motor_torque");
  return names;
}

std::vector<std::string> character_measures() {
  return {"on_ground"};
}

bool WorldDescription::is_rigid() const {
  return !joints.empty() || !meshes.empty() || std::ranges::any_of(bodies, [](const BodyDescription& body) {
    return body.driven || body.shape.kind != ShapeDescription::Kind::ball || body.traits.any();
  });
}

double collisions_of(const WorldDescription& world, std::span<const double> state) {
  return state[world.first_measure + world_measures(world.dimension).size() - 1];
}

}  // namespace continuo::model
