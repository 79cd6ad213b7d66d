// Draws a moment into a slice.
#include <cmath>
#include <cstddef>

#include <continuo/live/session/scene.hpp>

namespace continuo::live {

namespace {

std::shared_ptr<const Bodies> bodies_of(const Instant& instant, const worlds::WorldRun* run) {
  if (!run) return nullptr;
  auto bodies = std::make_shared<Bodies>();
  const auto dimension = static_cast<std::size_t>(run->dimension());
  const std::size_t count = run->bodies().size(), states = model::WorldDescription::states_of_body(run->dimension());
  bodies->dimension = dimension;
  bodies->position.reserve(count * dimension);
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t k = 0; k < dimension; ++k)
      bodies->position.push_back(static_cast<float>(instant.x[i * states + 2 * k]));
  }
  constexpr std::size_t few = 500;  // arrows at more bodies say nothing
  for (std::size_t i = 0; i < count && count <= few; ++i) {
    for (std::size_t k = 0; k < dimension; ++k)
      bodies->velocity.push_back(static_cast<float>(instant.x[i * states + 2 * k + 1]));
  }
  constexpr std::size_t angle = 4, quaternion = 6;  // of x, x', y, y', angle, angle'; x, x', ..., z', w, x, y, z, spin
  bodies->orientation.reserve(count * (dimension == 2 ? 1 : 4));
  for (std::size_t i = 0; i < count; ++i) {
    const double* state = instant.x.data() + i * states;
    if (dimension == 2) {
      bodies->orientation.push_back(static_cast<float>(state[angle]));
      continue;
    }
    // Between two steps the state is on the straight way, which is a little shorter.
    const double w = state[quaternion], x = state[quaternion + 1], y = state[quaternion + 2], z = state[quaternion + 3];
    const double length = std::sqrt(w * w + x * x + y * y + z * z);
    for (const double part : {x, y, z, w}) bodies->orientation.push_back(static_cast<float>(part / length));
  }
  return bodies;
}

}  // namespace

void Scene::draw(const Sample& sample, const worlds::WorldRun* world, Slice& slice) {
  numbers_.use(sample.variables);
  numbers_.append(sample.main.t, sample.main.x, slice.scene);
  slice.bodies = bodies_of(sample.main, world);
  slice.ghost = sample.ghost.has_value();
  if (!sample.ghost) return;
  numbers_.append(sample.main.t, sample.ghost->x, slice.ghost_scene);
  slice.ghost_bodies = bodies_of(*sample.ghost, world);
}

}  // namespace continuo::live
