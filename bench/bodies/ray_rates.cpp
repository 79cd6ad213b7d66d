// How many rays a second find their nearest hit among 10,000 balls, capsules, boxes and hulls, on one core: as close as
// in a heap, or as in a gas; one by one, or all in one call; beside Box2D and Box3D where they take part.
//   ray_rates [REPEATS]
#include <algorithm>
#include <cstdio>
#include <cstdlib>

#include <bench/bodies/ray_scenes.hpp>
#include <bench/bodies/rigid_ratios.hpp>

#include <continuo/status/require.hpp>

namespace continuo::bench {
namespace {

constexpr std::size_t bodies = 10'000, ray_count = 100'000;

template <class Real, int Dim>
RayTimes found(const std::vector<RayHit<Real, Dim>>& hits) {
  RayTimes sums;
  for (const RayHit<Real, Dim>& hit : hits)
    if (const auto distance = static_cast<double>(hit.distance); std::isfinite(distance))
      ++sums.hits, sums.distance += distance;
  return sums;
}

/// Rays that begin in no body: there systems differ in what they call a hit.
template <class Real, int Dim>
std::vector<Ray<Real, Dim>> rays_from_outside(const Queries<Real, Dim>& queries, double side, double reach) {
  std::vector<Ray<Real, Dim>> rays;
  for (const Ray<Real, Dim>& ray : random_rays<Real, Dim>(4 * ray_count, side, reach))
    if (rays.size() < ray_count && require(queries.in_sphere(ray.origin, Real(1e-3))).bodies.empty())
      rays.push_back(ray);
  return rays;
}

template <class Real, int Dim>
void measure(const char* density, double spacing, int times) {
  const auto scene = ray_scene<Real, Dim>(bodies, spacing);
  World<Real, Dim> world;
  for (const auto& body : scene.bodies) require(world.add(body).status());
  const double begin = processor_seconds();
  const Queries<Real, Dim> queries(world);
  const double built = processor_seconds() - begin;
  for (const double share : {0.2, 1.0}) {
    const auto rays = rays_from_outside(queries, scene.side, share * scene.side);
    const RayTimes single = least_time(times, processor_seconds, [&] {
      RayTimes sums;
      for (const Ray<Real, Dim>& ray : rays)
        for (const auto& hit : require(queries.first_hit(ray)))
          ++sums.hits, sums.distance += static_cast<double>(hit.distance);
      return sums;
    });
    const RayTimes batch =
        least_time(times, processor_seconds, [&] { return found(require(queries.first_hits(rays))); });
    const auto rate = [&](const RayTimes& of) { return static_cast<double>(rays.size()) / of.seconds / 1e6; };
    std::printf("| %s | %s | %s | %.1f | %.2f | %.2f | %.2f", Dim == 2 ? "plane" : "space", density,
                sizeof(Real) == 4 ? "float" : "double", share, 1e3 * built, rate(single), rate(batch));
    std::optional<RayTimes> peer;
    if constexpr (sizeof(Real) == 4) peer = rays_of_peer(scene, rays, times);
    peer ? std::printf(" | %.2f", rate(*peer)) : std::printf(" | ");
    std::printf(" | %zu of mean %.4f", batch.hits, batch.distance / static_cast<double>(batch.hits));
    if (peer) std::printf("; %zu of %.4f", peer->hits, peer->distance / static_cast<double>(peer->hits));
    std::printf(" |\n");
    std::fflush(stdout);
  }
}

}  // namespace
}  // namespace continuo::bench

int main(int count, char** arguments) {
  using namespace continuo::bench;
  const int times = count > 1 ? std::max(1, std::atoi(arguments[1])) : 3;
  std::puts(
      "millions of rays a second; of the peers, Box2D in the plane and Box3D in space\n"
      "| Bodies in | as in a | Numbers | Reach / side | Index, ms | Single | In one call | Peer | Hits; of the peer |\n"
      "|---|---|---|---|---|---|---|---|---|");
  for (const double spacing : {1.0, 2.5}) {
    const char* const density = spacing < 2 ? "heap" : "gas";
    measure<float, 2>(density, spacing, times), measure<double, 2>(density, spacing, times);
    measure<float, 3>(density, spacing, times), measure<double, 3>(density, spacing, times);
  }
}
