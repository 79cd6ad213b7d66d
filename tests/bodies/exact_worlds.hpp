// Random worlds that the exact motion claims to know, and how deep their bodies lie in each other, by brute force.
#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>
#include <vector>

#include "random_rigid_worlds.hpp"
#include <continuo/bodies/world.hpp>

namespace continuo::test {

/// A convex polytope by its corners in the world, with all its edges and the normals of all its faces. Found from the
/// corners alone, by trying every pair and every triple.
template <int Dim>
struct BrutePolytope {
  using Real = long double;
  using V = Vector<Real, Dim>;
  std::vector<V> corners;
  std::vector<std::pair<std::size_t, std::size_t>> edges;
  std::vector<V> normals;               // of faces, out of the polytope
  std::vector<std::size_t> of_normals;  // a corner on each face
  Real rounding{};

  BrutePolytope(std::vector<V> of, Real rounded) : corners(std::move(of)), rounding(rounded) {
    if (corners.size() == 2) edges.emplace_back(0, 1);
    if constexpr (Dim == 2) {
      find_sides();
    } else {
      find_faces();
    }
  }
  /// The least of the corners along a direction.
  [[nodiscard]] Real least(const V& along) const {
    Real best = std::numeric_limits<Real>::infinity();
    for (const V& corner : corners) best = std::min(best, Real(dot(along, corner)));
    return best;
  }

 private:
  static constexpr Real flat = 1e-13L;  // corners have the rounding of doubles
  /// Whether all corners are behind the plane through a corner with this normal.
  [[nodiscard]] bool bounds(const V& normal, const V& at) const {
    return std::ranges::all_of(corners, [&](const V& corner) { return dot(normal, V(corner - at)) <= flat; });
  }
  void find_sides() {
    for (std::size_t i = 0; i < corners.size(); ++i)
      for (std::size_t j = 0; j < corners.size(); ++j) {
        const V side = corners[j] - corners[i];
        if (i == j) continue;
        V normal;
        normal[0] = side[1] / length(side), normal[1] = -side[0] / length(side);
        if (!bounds(normal, corners[i])) continue;
        normals.push_back(normal), of_normals.push_back(i), edges.emplace_back(i, j);
      }
  }
  void find_faces() {
    for (std::size_t i = 0; i < corners.size(); ++i)
      for (std::size_t j = 0; j < corners.size(); ++j)
        for (std::size_t k = j + 1; k < corners.size(); ++k) {
          if (i == j || i == k) continue;
          V normal = moment(V(corners[j] - corners[i]), V(corners[k] - corners[i]));
          if (!(length(normal) > 1e-9L)) continue;
          normal = normal * (1 / length(normal));
          if (!bounds(normal, corners[i])) normal = -normal;
          if (!bounds(normal, corners[i])) continue;
          note_edge(i, j), note_edge(i, k), note_edge(j, k);
          const bool is_known =
              std::ranges::any_of(normals, [&](const V& other) { return squared(V(other - normal)) < 1e-20L; });
          if (!is_known) normals.push_back(normal), of_normals.push_back(i);
        }
  }
  // Diagonals of faces, which this takes for edges, too, are no harm: they are lines of the polytope.
  void note_edge(std::size_t i, std::size_t j) {
    const std::pair edge(std::min(i, j), std::max(i, j));
    if (std::ranges::find(edges, edge) == edges.end()) edges.push_back(edge);
  }
};

/// The greatest gap of two polytopes along any normal of a face, or across any two edges: above 0 if and only if they
/// are apart, and if they are not, the least depth by which they would have to move to be so.
template <int Dim>
[[nodiscard]] long double greatest_separation(const BrutePolytope<Dim>& a, const BrutePolytope<Dim>& b) {
  using V = typename BrutePolytope<Dim>::V;
  long double best = -std::numeric_limits<long double>::infinity();
  const auto consider = [&](const V& n) { best = std::max(best, b.least(n) + a.least(-n)); };
  for (const V& n : a.normals) consider(n);
  for (const V& n : b.normals) consider(-n);
  if constexpr (Dim == 3) {
    for (const auto& [i, j] : a.edges)
      for (const auto& [k, l] : b.edges) {
        const V e = a.corners[j] - a.corners[i], f = b.corners[l] - b.corners[k];
        const V n = moment(e, f);
        if (!(squared(n) > 1e-18L * squared(e) * squared(f))) continue;
        consider(n * (1 / length(n))), consider(-n * (1 / length(n)));
      }
  }
  return best;
}

/// The distance of two segments, by trying the ends and the lines.
template <int Dim>
[[nodiscard]] long double distance_of_segments(const Vector<long double, Dim>& p, const Vector<long double, Dim>& q,
                                               const Vector<long double, Dim>& r, const Vector<long double, Dim>& s) {
  using Real = long double;
  using V = Vector<Real, Dim>;
  const auto to_segment = [](const V& point, const V& from, const V& to) {
    const V along = to - from;
    const Real size = squared(along);
    const Real part = size > 0 ? std::clamp(Real(dot(along, V(point - from)) / size), Real(0), Real(1)) : Real(0);
    return length(V(point - from - along * part));
  };
  Real best = std::min({to_segment(p, r, s), to_segment(q, r, s), to_segment(r, p, q), to_segment(s, p, q)});
  const V e = q - p, f = s - r, between = r - p;
  const Real ee = squared(e), ff = squared(f), ef = dot(e, f), size = ee * ff - ef * ef;
  if (size > 1e-18L * ee * ff) {
    const Real u = (dot(between, e) * ff - dot(between, f) * ef) / size;
    const Real v = (dot(between, e) * ef - dot(between, f) * ee) / size;
    if (u >= 0 && u <= 1 && v >= 0 && v <= 1) best = std::min(best, length(V(between + f * v - e * u)));
  }
  return best;
}
/// The distance of two polytopes that are apart: that of two segments, or of a corner above a face.
template <int Dim>
[[nodiscard]] long double distance_apart(const BrutePolytope<Dim>& a, const BrutePolytope<Dim>& b) {
  using Real = long double;
  using V = Vector<Real, Dim>;
  Real best = std::numeric_limits<Real>::infinity();
  const auto segments = [](const BrutePolytope<Dim>& of) {
    auto all = of.edges;
    if (all.empty()) all.emplace_back(0, 0);
    return all;
  };
  for (const auto& [i, j] : segments(a))
    for (const auto& [k, l] : segments(b))
      best = std::min(best, distance_of_segments<Dim>(a.corners[i], a.corners[j], b.corners[k], b.corners[l]));
  if constexpr (Dim == 3) {
    // Above a face: where the foot of the corner is in the polytope, up to rounding.
    const auto corners_above = [&](const BrutePolytope<Dim>& of, const BrutePolytope<Dim>& other) {
      for (std::size_t f = 0; f < of.normals.size(); ++f)
        for (const V& corner : other.corners) {
          const Real height = dot(of.normals[f], V(corner - of.corners[of.of_normals[f]]));
          const V foot = corner - of.normals[f] * height;
          bool is_inside = height >= 0;
          for (std::size_t g = 0; g < of.normals.size() && is_inside; ++g)
            is_inside = dot(of.normals[g], V(foot - of.corners[of.of_normals[g]])) <= 1e-13L;
          if (is_inside) best = std::min(best, height);
        }
    };
    corners_above(a, b), corners_above(b, a);
  }
  return best;
}
/// How deep two rounded polytopes are in each other; at most 0 where they are not.
template <int Dim>
[[nodiscard]] long double depth_of(const BrutePolytope<Dim>& a, const BrutePolytope<Dim>& b) {
  const long double rounding = a.rounding + b.rounding;
  const long double separation = greatest_separation(a, b);
  if (separation > rounding) return rounding - separation;
  const bool is_deep = separation <= 0 && (a.corners.size() > 2 || b.corners.size() > 2);
  return rounding - (is_deep ? separation : distance_apart(a, b));
}

/// The parts of a body where it is now.
template <int Dim>
[[nodiscard]] std::vector<BrutePolytope<Dim>> brute_parts(const World<double, Dim>& world, std::size_t i) {
  using V = Vector<long double, Dim>;
  const auto wide = [](const Vector<double, Dim>& v) {
    V made;
    for (std::size_t axis = 0; axis < Dim; ++axis) made[axis] = v[axis];
    return made;
  };
  std::vector<BrutePolytope<Dim>> all;
  const Solid<double, Dim>* const solid = world.solid(i);
  if (solid == nullptr) {
    all.emplace_back(std::vector<V>{wide(world.position[i])}, world.radius[i]);
    return all;
  }
  Orientation<long double, Dim> orientation;
  for (std::size_t k = 0; k < orientation.size(); ++k) orientation[k] = world.orientation[i][k];
  if constexpr (Dim == 3) orientation = orientation * (1 / length(orientation));
  const Matrix<long double, Dim> axes = rotation(orientation);
  for (const auto& part : solid->parts) {
    std::vector<V> corners;
    for (const auto& corner : part.convex.core.corners)
      corners.push_back(wide(world.position[i]) + axes * wide(part.in_solid.place(corner)));
    all.emplace_back(std::move(corners), part.convex.rounding);
  }
  return all;
}
/// The greatest depth of any two bodies that collide, and of any body in a wall. The time it takes grows with the
/// square of the number of bodies.
template <int Dim, class MayOverlap>
[[nodiscard]] double greatest_depth(const World<double, Dim>& world, MayOverlap&& may_overlap) {
  long double greatest = -std::numeric_limits<long double>::infinity();
  std::vector<std::vector<BrutePolytope<Dim>>> parts;
  for (std::size_t i = 0; i < world.size(); ++i) parts.push_back(brute_parts(world, i));
  for (std::size_t i = 0; i < world.size(); ++i) {
    for (const auto& wall : world.walls())
      for (const auto& part : parts[i]) {
        if (world.is_fixed(i)) continue;
        Vector<long double, Dim> normal;
        for (std::size_t axis = 0; axis < Dim; ++axis) normal[axis] = wall.normal[axis];
        greatest = std::max(greatest, wall.offset - (part.least(normal) - part.rounding));
      }
    for (std::size_t j = i + 1; j < world.size(); ++j) {
      if (may_overlap(i, j) || !world.collide(i, j)) continue;
      if (length(world.position[i] - world.position[j]) > world.radius[i] + world.radius[j] + 1e-9) continue;
      for (const auto& a : parts[i])
        for (const auto& b : parts[j]) greatest = std::max(greatest, depth_of(a, b));
    }
  }
  return static_cast<double>(greatest);
}

/// What a random world for the exact motion may have.
struct ExactWorldKind {
  double gravity = 0;
  bool has_walls = true;
  double restitution = 1, friction = 0;
  std::size_t bodies = 4, joints = 0;
  bool is_level = false;  // bodies begin with sides along the axes, and lie on each other sooner
};

/// A world of random convex shapes and compounds that begin apart.
template <int Dim>
class ExactWorld {
 public:
  using V = Vector<double, Dim>;
  World<double, Dim> world;
  std::vector<std::pair<std::size_t, std::size_t>> joined;
  ExactWorldKind kind;

  /// With friction in half of the worlds, where `may_rub`.
  ExactWorld(unsigned seed, bool alike, bool may_rub = Dim == 2) : numbers_(seed) {
    kind.gravity = numbers_.one_in(3) ? 0 : 9.81;
    kind.has_walls = !numbers_.one_in(5) || kind.gravity > 0;
    kind.restitution = numbers_.one_in(3) ? 1 : numbers_.one_in(3) ? 0 : numbers_.between(0, 1);
    kind.friction = !may_rub || numbers_.one_in(2) ? 0 : numbers_.between(0.05, 1);
    kind.bodies = 2 + numbers_.below(7);
    kind.joints = numbers_.one_in(3) ? 1 + numbers_.below(2) : 0;
    kind.is_level = numbers_.one_in(3);
    alike_ = alike;
    make();
  }
  [[nodiscard]] double depth() const {
    return greatest_depth(world, [&](std::size_t i, std::size_t j) {
      return std::ranges::find(joined, std::pair(i, j)) != joined.end();
    });
  }

 private:
  void make() {
    world.gravity[Dim - 1] = -kind.gravity;
    const Material<double> material{.restitution = kind.restitution, .friction = kind.friction};
    V lower, upper;
    lower.components.fill(Dim == 2 ? -2.5 : -1.8), upper.components.fill(Dim == 2 ? 2.5 : 1.8);
    if (kind.has_walls) static_cast<void>(world.add_container(lower, upper, material));
    for (std::size_t k = 0; k < kind.bodies; ++k) add_body(material);
    for (std::size_t k = 0; k < kind.joints; ++k) add_joint();
  }
  void add_body(const Material<double>& material) {
    for (int attempt = 0; attempt < 100; ++attempt) {
      BodyDefinition<double, Dim> body{.shape = shape(), .material = material};
      for (double& x : body.position.components) x = numbers_.between(-2, 2);
      for (double& x : body.velocity.components) x = numbers_.between(-2, 2);
      for (double& x : body.spin.components) x = kind.is_level ? 0 : numbers_.between(-3, 3);
      if (!kind.is_level)
        for (double& x : body.orientation.components) x = numbers_.between(-1, 1);
      if (!alike_) body.mass = numbers_.between(0.2, 3);
      const auto added = world.add(body);
      if (!added) continue;
      if (depth() < -1e-3) return;
      world.remove(*added);
    }
  }
  void add_joint() {
    if (world.size() < 2) return;
    const std::size_t i = numbers_.below(world.size()), j = numbers_.below(world.size());
    if (i == j) return;
    JointDefinition<double, Dim> joint{.a = world.handle(i), .b = world.handle(j)};
    constexpr std::array kinds{JointKind::hinge, JointKind::ball, JointKind::distance, JointKind::weld};
    joint.kind = kinds[numbers_.below(kinds.size())];
    if (Dim == 2 && joint.kind == JointKind::ball) joint.kind = JointKind::hinge;
    joint.anchor = world.position[i], joint.anchor_b = world.position[j];
    if (joint.kind != JointKind::distance)
      joint.anchor = (world.position[i] + world.position[j]) * 0.5, joint.anchor_b.reset();
    if (world.add_joint(joint)) joined.emplace_back(std::min(i, j), std::max(i, j));
  }
  [[nodiscard]] double size() { return numbers_.between(0.2, 0.7); }
  [[nodiscard]] Shape<double, Dim> shape() {
    switch (numbers_.below(6)) {
      case 0:
        return Sphere<double>{size() / 2};
      case 1:
        return Capsule<double>{size(), size() / 3};
      case 2: {
        Hull<double, Dim> hull;
        for (std::size_t k = 4 + numbers_.below(6); k > 0; --k) {
          V& point = hull.points.emplace_back();
          for (double& x : point.components) x = numbers_.between(-0.4, 0.4);
        }
        if (numbers_.one_in(4)) hull.rounding = numbers_.between(0.02, 0.1);
        return hull;
      }
      case 3: {
        Compound<double, Dim> compound;
        for (std::size_t k = 1 + numbers_.below(3); k > 0; --k) {
          ShapePart<double, Dim> part{.shape = box()};
          if (numbers_.one_in(3)) part.shape = Sphere<double>{size() / 2};
          for (double& x : part.position.components) x = numbers_.between(-0.4, 0.4);
          compound.parts.push_back(part);
        }
        return compound;
      }
      default:
        return box();
    }
  }
  [[nodiscard]] Box<double, Dim> box() {
    Box<double, Dim> made;
    for (double& side : made.size.components) side = alike_ ? 0.5 : size();
    if (numbers_.one_in(5)) made.rounding = numbers_.between(0.01, 0.05);
    return made;
  }
  RandomNumbers<double> numbers_;
  bool alike_ = false;
};

}  // namespace continuo::test
