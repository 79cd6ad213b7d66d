// Rays through many bodies of mixed shapes, the same for each system that answers them.
#pragma once
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <optional>
#include <random>
#include <span>
#include <vector>

#include <continuo/bodies/body.hpp>
#include <continuo/bodies/queries.hpp>

namespace continuo::bench {

/// How long a system takes for all rays, each time of so many, and what it finds, for comparison.
struct RayTimes {
  double seconds = std::numeric_limits<double>::infinity();  // the least of all times
  std::size_t hits = 0;
  double distance = 0;  // of all hits
};

/// Bodies in a cube from 0 to `side`.
template <class Real, int Dim>
struct RayScene {
  double side = 0;
  std::vector<BodyDefinition<Real, Dim>> bodies{};
};

/// Numbers that the standard library does not choose, so that all kinds of number get the same scene.
class SceneNumbers {
 public:
  /// Between the bounds.
  [[nodiscard]] double between(double lower, double upper) {
    return lower + (upper - lower) * static_cast<double>(engine_()) * 0x1p-32;
  }
  template <class Real, int Size>
  [[nodiscard]] Vector<Real, Size> vector(double lower, double upper) {
    Vector<Real, Size> v;
    for (Real& part : v.components) part = static_cast<Real>(between(lower, upper));
    return v;
  }
  /// Of length 1, uniform.
  template <class Real, int Size>
  [[nodiscard]] Vector<Real, Size> direction() {
    for (;;) {
      const Vector<double, Size> v = vector<double, Size>(-1, 1);
      const double size = length(v);
      if (size > 1 || size < 0.1) continue;
      Vector<Real, Size> unit;
      for (std::size_t axis = 0; axis < unit.size(); ++axis) unit[axis] = static_cast<Real>(v[axis] / size);
      return unit;
    }
  }

 private:
  std::mt19937 engine_{7};
};

/// Balls, capsules, boxes and hulls in turn, about as large as a ball of radius 0.5, on a lattice with `spacing`, from
/// which each is moved by up to a fifth: 1 is the density of a heap, 2.5 that of a gas.
template <class Real, int Dim>
[[nodiscard]] RayScene<Real, Dim> ray_scene(std::size_t count, double spacing) {
  SceneNumbers numbers;
  const auto row = static_cast<std::size_t>(std::ceil(std::pow(static_cast<double>(count), 1.0 / Dim) - 1e-9));
  RayScene<Real, Dim> scene{.side = spacing * static_cast<double>(row)};
  for (std::size_t k = 0; k < count; ++k) {
    BodyDefinition<Real, Dim> body;
    std::size_t rest = k;
    for (std::size_t axis = 0; axis < Dim; ++axis, rest /= row)
      body.position[axis] =
          static_cast<Real>(spacing * (static_cast<double>(rest % row) + 0.5 + numbers.between(-0.2, 0.2)));
    if constexpr (Dim == 2) {
      body.orientation = numbers.vector<Real, 1>(-std::numbers::pi, std::numbers::pi);
    } else {
      body.orientation = numbers.direction<Real, 4>();
    }
    if (k % 4 == 0) body.shape = Sphere<Real>{static_cast<Real>(numbers.between(0.35, 0.5))};
    if (k % 4 == 1)
      body.shape =
          Capsule<Real>{static_cast<Real>(numbers.between(0.3, 0.7)), static_cast<Real>(numbers.between(0.2, 0.35))};
    if (k % 4 == 2) body.shape = Box<Real, Dim>{.size = numbers.vector<Real, Dim>(0.5, 0.9)};
    if (k % 4 == 3) {
      Hull<Real, Dim> hull;
      for (int point = 0; point < (Dim == 2 ? 7 : 12); ++point)
        hull.points.push_back(numbers.direction<Real, Dim>() * Real(0.5));
      body.shape = hull;
    }
    scene.bodies.push_back(body);
  }
  return scene;
}

/// Rays from anywhere within a cube to anywhere.
template <class Real, int Dim>
[[nodiscard]] std::vector<Ray<Real, Dim>> random_rays(std::size_t count, double side, double reach) {
  SceneNumbers numbers;
  std::vector<Ray<Real, Dim>> rays(count);
  for (Ray<Real, Dim>& ray : rays)
    ray = {.origin = numbers.vector<Real, Dim>(0, side),
           .direction = numbers.direction<Real, Dim>(),
           .reach = static_cast<Real>(reach)};
  return rays;
}

/// The nearest hits of rays by Box2D in the plane, by Box3D in space; none where it does not take part. Bodies are
/// static there, for which their trees are built anew.
/// @{
[[nodiscard]] std::optional<RayTimes> rays_of_peer(const RayScene<float, 2>& scene, std::span<const Ray<float, 2>> rays,
                                                   int times);
[[nodiscard]] std::optional<RayTimes> rays_of_peer(const RayScene<float, 3>& scene, std::span<const Ray<float, 3>> rays,
                                                   int times);
/// @}

/// The least time of `act`, which returns what was found.
template <class Act>
[[nodiscard]] RayTimes least_time(int times, double (*now)(), Act&& act) {
  RayTimes least;
  for (int k = 0; k < times; ++k) {
    const double begin = now();
    RayTimes found = act();
    found.seconds = std::min(least.seconds, now() - begin);
    least = found;
  }
  return least;
}

}  // namespace continuo::bench
