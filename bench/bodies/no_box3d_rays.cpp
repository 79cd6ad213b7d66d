// Box3D is not there.
#include <bench/bodies/ray_scenes.hpp>

namespace continuo::bench {

std::optional<RayTimes> rays_of_peer(const RayScene<float, 3>&, std::span<const Ray<float, 3>>, int) {
  return std::nullopt;
}

}  // namespace continuo::bench
