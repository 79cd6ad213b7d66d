// The closest point to the origin of a simplex, by the cases of C. Ericson, "Real-Time Collision Detection", 2005,
// ch. 5.
#pragma once
#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>

#include <continuo/numerics/vector.hpp>

namespace continuo {

/// A simplex of differences of corners, a of the first polytope less b of the second, with the weights of the point of
/// it that is closest to the origin.
template <class Real, int Dim>
class DifferenceSimplex {
 public:
  using V = Vector<Real, Dim>;
  struct Corner {
    V difference{}, a{}, b{};
    std::size_t number_a = 0, number_b = 0;
    Real weight = Real(1);
  };

  [[nodiscard]] bool contains(std::size_t number_a, std::size_t number_b) const {
    return std::any_of(corners_.begin(), corners_.begin() + static_cast<std::ptrdiff_t>(size_),
                       [&](const Corner& c) { return c.number_a == number_a && c.number_b == number_b; });
  }
  void add(const Corner& corner) { corners_[size_++] = corner; }

  /// Keeps the corners of the face that has the point closest to the origin. False where the origin is inside, which
  /// is not asked where it is known to be outside: rounding errors could say otherwise in a flat simplex.
  [[nodiscard]] bool reduce(bool is_outside) {
    if (size_ == 2) take(segment(0, 1));
    if (size_ == 3) {
      if (Dim == 2 && !is_outside && is_inside_triangle()) return false;
      take(triangle(0, 1, 2));
    } else if (size_ == 4) {
      const Face best = tetrahedron(is_outside);
      if (best.size == 0) return false;
      take(best);
    }
    return true;
  }
  /// The points of the two polytopes that have the closest difference.
  [[nodiscard]] V closest() const {
    return sum([](const Corner& c) { return c.difference; });
  }
  [[nodiscard]] V on_a() const {
    return sum([](const Corner& c) { return c.a; });
  }
  [[nodiscard]] V on_b() const {
    return sum([](const Corner& c) { return c.b; });
  }

 private:
  struct Face {
    std::size_t size = 0;
    std::array<std::size_t, 3> corners{};
    std::array<Real, 3> weights{};
    Real squared_distance = std::numeric_limits<Real>::infinity();
  };
  template <class Of>
  [[nodiscard]] V sum(Of&& of) const {
    V total{};
    for (std::size_t i = 0; i < size_; ++i) total += of(corners_[i]) * corners_[i].weight;
    return total;
  }
  void take(const Face& face) {
    std::array<Corner, Dim + 1> kept;
    for (std::size_t i = 0; i < face.size; ++i) kept[i] = corners_[face.corners[i]], kept[i].weight = face.weights[i];
    corners_ = kept;
    size_ = face.size;
  }
  [[nodiscard]] const V& at(std::size_t i) const { return corners_[i].difference; }
  [[nodiscard]] Face with_distance(Face face) const {
    V point{};
    for (std::size_t i = 0; i < face.size; ++i) point += at(face.corners[i]) * face.weights[i];
    face.squared_distance = squared(point);
    return face;
  }
  [[nodiscard]] Face point(std::size_t i) const { return with_distance({1, {i}, {Real(1)}}); }
  [[nodiscard]] Face segment(std::size_t i, std::size_t j) const {
    const V side = at(j) - at(i);
    const Real along = -dot(at(i), side), whole = squared(side);
    if (!(along > Real(0))) return point(i);
    if (!(along < whole)) return point(j);
    return with_distance({2, {i, j}, {1 - along / whole, along / whole}});
  }
  [[nodiscard]] Face nearer(const Face& a, const Face& b) const {
    return b.squared_distance < a.squared_distance ? b : a;
  }
  // In space the inside of the triangle where the origin projects into it, else the nearest of its sides.
  [[nodiscard]] Face triangle(std::size_t i, std::size_t j, std::size_t k) const {
    const V u = at(j) - at(i), v = at(k) - at(i);
    const Real uu = squared(u), uv = dot(u, v), vv = squared(v), ou = -dot(at(i), u), ov = -dot(at(i), v);
    const Real whole = uu * vv - uv * uv, to_j = vv * ou - uv * ov, to_k = uu * ov - uv * ou;
    if (Dim == 3 && to_j > Real(0) && to_k > Real(0) && to_j + to_k < whole)
      return with_distance({3, {i, j, k}, {1 - (to_j + to_k) / whole, to_j / whole, to_k / whole}});
    return nearer(nearer(segment(i, j), segment(i, k)), segment(j, k));
  }
  [[nodiscard]] bool is_inside_triangle() const {
    if constexpr (Dim == 2) {
      const Real a = moment(at(0), at(1))[0], b = moment(at(1), at(2))[0], c = moment(at(2), at(0))[0];
      return (a > Real(0) && b > Real(0) && c > Real(0)) || (a < Real(0) && b < Real(0) && c < Real(0));
    } else {
      return false;
    }
  }
  // The nearest of the faces that have the origin on the side away from the fourth corner, or of all where it is known
  // to be outside; none where it is inside.
  [[nodiscard]] Face tetrahedron(bool is_outside) const {
    Face best;
    if constexpr (Dim == 3) {
      constexpr std::array<std::array<std::size_t, 4>, 4> sides{
          {{0, 1, 2, 3}, {0, 3, 1, 2}, {0, 2, 3, 1}, {1, 3, 2, 0}}};
      for (const auto& [i, j, k, opposite] : sides) {
        const V normal = moment(at(j) - at(i), at(k) - at(i));
        const Real inwards = dot(at(opposite) - at(i), normal), origin = -dot(at(i), normal);
        const bool is_inside = (inwards > Real(0) && origin > Real(0)) || (inwards < Real(0) && origin < Real(0));
        if (is_outside || !is_inside) best = nearer(best, triangle(i, j, k));
      }
    }
    return best;
  }

  std::array<Corner, Dim + 1> corners_{};
  std::size_t size_ = 0;
};

}  // namespace continuo
