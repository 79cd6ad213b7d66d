// Rays among static bodies of Box3D.
#include <algorithm>
#include <variant>

#include <bench/bodies/ray_scenes.hpp>
#include <bench/bodies/rigid_ratios.hpp>
#include <box3d/box3d.h>

namespace continuo::bench {
namespace {

b3Vec3 of(const Vector<float, 3>& v) {
  return {v[0], v[1], v[2]};
}
void add(b3BodyId body, const b3ShapeDef& definition, const Sphere<float>& ball) {
  const b3Sphere sphere{{0, 0, 0}, ball.radius};
  b3CreateSphereShape(body, &definition, &sphere);
}
void add(b3BodyId body, const b3ShapeDef& definition, const Capsule<float>& rod) {
  const b3Capsule capsule{{0, 0, -rod.length / 2}, {0, 0, rod.length / 2}, rod.radius};
  b3CreateCapsuleShape(body, &definition, &capsule);
}
void add(b3BodyId body, const b3ShapeDef& definition, const Box<float, 3>& box) {
  const b3BoxHull hull = b3MakeBoxHull(box.size[0] / 2, box.size[1] / 2, box.size[2] / 2);
  b3CreateHullShape(body, &definition, &hull.base);
}
void add(b3BodyId body, const b3ShapeDef& definition, const Hull<float, 3>& hull) {
  std::vector<b3Vec3> points;
  for (const Vector<float, 3>& point : hull.points) points.push_back(of(point));
  b3HullData* const found =
      b3CreateHull(points.data(), static_cast<int>(points.size()), static_cast<int>(points.size()));
  b3CreateHullShape(body, &definition, found);
  b3DestroyHull(found);
}
void add(b3BodyId, const b3ShapeDef&, const Compound<float, 3>&) {}  // the scenes have none

}  // namespace

std::optional<RayTimes> rays_of_peer(const RayScene<float, 3>& scene, std::span<const Ray<float, 3>> rays, int times) {
  const b3WorldDef world_definition = b3DefaultWorldDef();
  const b3WorldId world = b3CreateWorld(&world_definition);
  const b3ShapeDef shape_definition = b3DefaultShapeDef();
  for (const auto& at : scene.bodies) {
    b3BodyDef definition = b3DefaultBodyDef();
    definition.position = of(at.position);
    definition.rotation = {{at.orientation[1], at.orientation[2], at.orientation[3]}, at.orientation[0]};
    const b3BodyId body = b3CreateBody(world, &definition);
    std::visit([&](const auto& shape) { add(body, shape_definition, shape); }, at.shape);
  }
  b3World_RebuildStaticTree(world);
  const RayTimes found = least_time(times, processor_seconds, [&] {
    RayTimes sums;
    for (const Ray<float, 3>& ray : rays) {
      const b3RayResult hit =
          b3World_CastRayClosest(world, of(ray.origin), of(ray.direction * ray.reach), b3DefaultQueryFilter());
      if (hit.hit) ++sums.hits, sums.distance += static_cast<double>(hit.fraction * ray.reach);
    }
    return sums;
  });
  b3DestroyWorld(world);
  return found;
}

}  // namespace continuo::bench
