// continuo/language/world.cpp
// Names of what a world measures, and of the methods that move it.
#include <continuo/language/world.hpp>

namespace continuo::model {

std::vector<std::string> world_measures(int dimension) {
  std::vector<std::string> names{"kinetic", "potential", "momentum_x", "momentum_y"};
  if (dimension == 3) names.emplace_back("momentum_z");
  names.emplace_back("collisions");
  return names;
}

std::vector<std::string> world_integrators() {
  return {"semi_implicit_euler", "symplectic_euler_position_first", "implicit_euler", "central_difference",
          "explicit_euler"};
}

std::vector<std::string> world_methods() {
  std::vector<std::string> names{"exact", "dop853", "rk4", "fast"};
  for (const std::string& integrator : world_integrators()) names.push_back(integrator);
  return names;
}

double collisions_of(const WorldDescription& world, std::span<const double> state) {
  return state[world.first_measure + world_measures(world.dimension).size() - 1];
}

}  // namespace continuo::model
