// Box2D is not there.
#include <bench/bodies/ray_scenes.hpp>

namespace continuo::bench {

std::optional<RayTimes> rays_of_peer(const RayScene<float, 2>&, std::span<const Ray<float, 2>>, int) {
  return std::nullopt;
}

}  // namespace continuo::bench
