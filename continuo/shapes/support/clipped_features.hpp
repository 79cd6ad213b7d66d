// The common part of two features of convex bodies, seen along a normal: faces, segments or corners.
#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <type_traits>
#include <utility>

#include <continuo/shapes/matrix.hpp>
#include <continuo/shapes/polytope.hpp>
#include <continuo/shapes/support/separating_axis.hpp>

namespace continuo {

/// Up to so many numbers, of which those that are not there yet are not cleared: to clear arrays of 64 corners takes
/// longer than to fill four of them.
template <class T, std::size_t Most>
class ShortList {
 public:
  static_assert(std::is_trivially_copyable_v<T>);
  ShortList() {}  // NOLINT(modernize-use-equals-default): leaves the bytes as they are
  ShortList(const ShortList& other) { *this = other; }
  ShortList& operator=(const ShortList& other) {
    size_ = other.size_;
    std::memcpy(bytes_, other.bytes_, size_ * sizeof(T));
    return *this;
  }
  void add(const T& value) {
    if (size_ < Most) data()[size_++] = value;
  }
  void resize(std::size_t size) { size_ = size; }
  [[nodiscard]] std::size_t size() const { return size_; }
  [[nodiscard]] T* data() { return reinterpret_cast<T*>(bytes_); }
  [[nodiscard]] const T* data() const { return reinterpret_cast<const T*>(bytes_); }
  [[nodiscard]] T& operator[](std::size_t i) { return data()[i]; }
  [[nodiscard]] const T& operator[](std::size_t i) const { return data()[i]; }
  [[nodiscard]] const T* begin() const { return data(); }
  [[nodiscard]] const T* end() const { return data() + size_; }

 private:
  std::size_t size_ = 0;
  alignas(T) std::byte bytes_[Most * sizeof(T)];
};

/// A face, a segment or a corner of a polytope: its corners in order, with their numbers.
template <class Real, int Dim>
struct Feature {
  static constexpr std::size_t most_corners = Dim == 2 ? 2 : Polytope<Real, 3>::most_corners;
  ShortList<Vector<Real, Dim>, most_corners> corners;
  ShortList<std::uint8_t, most_corners> numbers;
  std::size_t size = 0;
  Vector<Real, Dim> normal{};  // of a face; 0 of a segment in space and of a corner

  void add(const Vector<Real, Dim>& corner, std::size_t number) {
    corners.add(corner), numbers.add(static_cast<std::uint8_t>(number));
    size = corners.size();
  }
};

/// The face whose normal is nearest to the direction. Of a segment: the whole, or the end that is farther in the
/// direction where it is steeper than 1 in 20.
template <class Real, int Dim>
[[nodiscard]] Feature<Real, Dim> facing_feature(const Polytope<Real, Dim>& polytope,
                                                const Vector<Real, Dim>& direction) {
  Feature<Real, Dim> feature;
  const auto& corners = polytope.corners;
  if (polytope.faces.empty()) {
    const Vector<Real, Dim> along = corners.back() - corners.front();
    const Real rise = dot(along, direction);
    const bool is_whole = corners.size() > 1 && std::abs(rise) < Real(0.05) * length(along);
    if (is_whole || !(rise > Real(0))) feature.add(corners.front(), 0);
    if (is_whole || rise > Real(0)) feature.add(corners.back(), corners.size() - 1);
    return feature;
  }
  std::size_t best = 0;
  for (std::size_t face = 1; face < polytope.faces.size(); ++face)
    if (dot(polytope.faces[face].normal, direction) > dot(polytope.faces[best].normal, direction)) best = face;
  feature.normal = polytope.faces[best].normal;
  if constexpr (Dim == 2) {
    const std::size_t next = (best + 1) % corners.size();
    feature.add(corners[best], best), feature.add(corners[next], next);
  } else {
    for (const std::uint8_t corner : polytope.loop(best)) feature.add(corners[corner], corner);
  }
  return feature;
}
template <class Real, int Dim>
void place(Feature<Real, Dim>& feature, const Pose<Real, Dim>& pose) {
  for (std::size_t i = 0; i < feature.size; ++i) feature.corners[i] = pose.place(feature.corners[i]);
  feature.normal = pose.axes * feature.normal;
}

/// A point of the core of the first body that has a point of the core of the second above it, along the normal.
template <class Real, int Dim>
struct CommonPoint {
  static constexpr std::uint32_t closest = 0xffffffff;  // the feature of the closest points
  Vector<Real, Dim> on_a{};
  Real separation{};  // of the cores
  std::uint32_t feature = 0;
};
/// How much better a point is placed than others that are as deep: each length of separation counts for this many
/// across the normal. Of what is not as near, little more may touch within the step than what is next to the deepest
/// point.
template <class Real>
inline constexpr Real weight_of_depth = Real(2);

/// Moves those to the front that no other point shadows, and returns how many they are. From what is in the shadow one
/// goes down to another point more steeply than at 45 degrees, as from the upper corners of a box to the lower ones:
/// before it bears anything, the bodies would have to turn that far against each other.
template <class Real, int Dim>
[[nodiscard]] std::size_t move_shadowed_back(CommonPoint<Real, Dim>* points, std::size_t size,
                                             const Vector<Real, Dim>& normal) {
  using Point = CommonPoint<Real, Dim>;
  std::sort(points, points + size, [](const Point& p, const Point& q) {
    return p.separation != q.separation ? p.separation < q.separation : p.feature < q.feature;
  });
  std::size_t kept = 0;
  for (std::size_t i = 0; i < size; ++i) {
    const bool is_shadowed = std::any_of(points, points + kept, [&](const Point& lower) {
      Vector<Real, Dim> across = points[i].on_a - lower.on_a;
      across -= normal * dot(across, normal);
      const Real fall = points[i].separation - lower.separation;
      return fall > Real(0) && fall * fall > squared(across);
    });
    if (!is_shadowed) std::swap(points[kept++], points[i]);
  }
  return kept;
}

/// A list of such points.
template <class Real, int Dim>
class CommonPoints {
 public:
  using Point = CommonPoint<Real, Dim>;

  void add(const Point& point) { points_.add(point); }
  [[nodiscard]] bool empty() const { return points_.size() == 0; }
  [[nodiscard]] const Point* begin() const { return points_.begin(); }
  [[nodiscard]] const Point* end() const { return points_.end(); }

  void drop_beyond(const Real& margin) {
    Point* const kept = std::remove_if(points_.data(), points_.data() + points_.size(),
                                       [&](const Point& point) { return point.separation > margin; });
    points_.resize(static_cast<std::size_t>(kept - points_.data()));
  }
  /// Keeps so many: the deepest one, the one farthest from it, and in space the two that span the largest areas on
  /// either side of their line; of those that are less deep, only what is much farther away.
  void reduce(const Vector<Real, Dim>& normal, std::size_t most) {
    if (points_.size() <= most) return;
    points_.resize(move_shadowed_back(points_.data(), points_.size(), normal));
    if (points_.size() <= most) return;
    choose(0, [&](const Point& p) { return -p.separation; });
    const auto from_deepest = [&](const Point& p) {
      const Vector<Real, Dim> way = p.on_a - points_[0].on_a;
      return way - normal * dot(way, normal);
    };
    const auto cost = [&](const Point& p) { return weight_of_depth<Real> * (p.separation - points_[0].separation); };
    choose(1, [&](const Point& p) { return length(from_deepest(p)) - cost(p); });
    if constexpr (Dim == 3) {
      Vector<Real, 3> across = moment(normal, from_deepest(points_[1]));
      if (const Real size = length(across); size > Real(0)) across *= 1 / size;
      choose(2, [&](const Point& p) { return dot(from_deepest(p), across) - cost(p); });
      choose(3, [&](const Point& p) { return -dot(from_deepest(p), across) - cost(p); });
    }
    points_.resize(most);
  }

 private:
  template <class Value>
  void choose(std::size_t place, Value&& value) {
    std::size_t best = place;
    for (std::size_t i = place + 1; i < points_.size(); ++i)
      if (value(points_[i]) > value(points_[best])) best = i;
    std::swap(points_[place], points_[best]);
  }

  ShortList<Point, 2 * Polytope<Real, Dim>::most_corners> points_;
};

/// The parts of two segments that lie above each other, seen along the normal: the ends of the common part.
template <class Real, int Dim>
void add_common_of_segments(const Feature<Real, Dim>& a, const Feature<Real, Dim>& b, const Vector<Real, Dim>& normal,
                            CommonPoints<Real, Dim>& common) {
  Vector<Real, Dim> along = a.corners[1] - a.corners[0];
  along -= normal * dot(along, normal);
  along *= 1 / length(along);
  const auto at = [&](const Vector<Real, Dim>& x) { return dot(x, along); };
  const Real a0 = at(a.corners[0]), a1 = at(a.corners[1]), b0 = at(b.corners[0]), b1 = at(b.corners[1]);
  const Real whole_a = a1 - a0, whole_b = b1 - b0;
  const auto add = [&](const Real& place, std::uint32_t feature) {
    const Vector<Real, Dim> on_a = a.corners[0] + (a.corners[1] - a.corners[0]) * ((place - a0) / whole_a);
    const Vector<Real, Dim> on_b = b.corners[0] + (b.corners[1] - b.corners[0]) * ((place - b0) / whole_b);
    common.add({on_a, dot(on_b - on_a, normal), feature});
  };
  // a1 > a0; b may go either way.
  const bool is_reversed = whole_b < Real(0);
  const Real b_low = is_reversed ? b1 : b0, b_high = is_reversed ? b0 : b1;
  const Real low = a0 > b_low ? a0 : b_low, high = a1 < b_high ? a1 : b_high;
  if (!(low <= high)) return;
  const auto number = [](const Feature<Real, Dim>& feature, std::size_t i) {
    return std::uint32_t{feature.numbers[i]};
  };
  add(low, a0 > b_low ? number(a, 0) : 0x100u | number(b, is_reversed ? 1 : 0));
  if (low < high) add(high, a1 < b_high ? number(a, 1) : 0x100u | number(b, is_reversed ? 0 : 1));
}

/// In the plane, the corner of one and the point of the segment of the other one that lie above each other.
template <class Real>
void add_corner_above_segment(const Feature<Real, 2>& a, const Feature<Real, 2>& b, const Vector<Real, 2>& normal,
                              CommonPoints<Real, 2>& common) {
  const Feature<Real, 2>& segment = a.size == 2 ? a : b;
  const Vector<Real, 2> corner = (a.size == 2 ? b : a).corners[0], side = segment.corners[1] - segment.corners[0];
  const Real across = moment(normal, side)[0];
  if (std::abs(across) < Real(0.05) * length(side)) return;  // seen from its end
  const Real share = moment(normal, corner - segment.corners[0])[0] / across;
  if (share < Real(0) || share > Real(1)) return;
  const Vector<Real, 2> on_segment = segment.corners[0] + side * share;
  if (a.size == 2) {
    common.add({on_segment, dot(corner - on_segment, normal), 0x100u | b.numbers[0]});
  } else {
    common.add({corner, dot(on_segment - corner, normal), a.numbers[0]});
  }
}

/// A corner of a polygon that is cut by the sides of another one: who made it.
template <class Real>
struct CutCorner {
  Vector<Real, 3> x{};
  std::uint32_t feature = 0;  // bits 0 to 7: the corner, or the beginning of the side; 8 to 15: the cutting side + 1
};
/// The part of a polygon, or of a segment, within a prism over a polygon along the normal (I. E. Sutherland, G. W.
/// Hodgman, Comm. ACM 17, 1974, 32-42).
template <class Real>
class CutPolygon {
 public:
  explicit CutPolygon(const Feature<Real, 3>& polygon) {
    for (std::size_t i = 0; i < polygon.size; ++i) both_[0].add({polygon.corners[i], polygon.numbers[i]});
  }
  void cut(const Feature<Real, 3>& by, const Vector<Real, 3>& normal) {
    for (std::size_t i = 0; i < by.size && both_[now_].size() > 0; ++i) {
      const std::size_t next = (i + 1) % by.size;
      // Outwards, as the corners go counter-clockwise about the face's own normal.
      Vector<Real, 3> outwards = moment(by.corners[next] - by.corners[i], normal);
      if (dot(by.normal, normal) < Real(0)) outwards = -outwards;
      cut_by_plane(outwards, dot(outwards, by.corners[i]), by.numbers[i]);
    }
  }
  [[nodiscard]] const CutCorner<Real>* begin() const { return both_[now_].begin(); }
  [[nodiscard]] const CutCorner<Real>* end() const { return both_[now_].end(); }

 private:
  using Corners = ShortList<CutCorner<Real>, 2 * Polytope<Real, 3>::most_corners>;

  // Keeps the points x with outwards . x <= offset.
  void cut_by_plane(const Vector<Real, 3>& outwards, const Real& offset, std::uint8_t side) {
    const Corners& corners = both_[now_];
    Corners& kept = both_[1 - now_];
    kept.resize(0);
    const std::size_t size = corners.size();
    const auto beyond = [&](std::size_t i) { return dot(outwards, corners[i].x) - offset; };
    const std::size_t sides = size == 2 ? 1 : size;  // a segment does not come back
    const auto crossing = [&](std::size_t i, std::size_t j, const Real& at_i, const Real& at_j) {
      const std::uint32_t feature = (corners[i].feature & 0xffu) | (std::uint32_t{side} + 1) << 8;
      kept.add({corners[i].x + (corners[j].x - corners[i].x) * (at_i / (at_i - at_j)), feature});
    };
    for (std::size_t i = 0; i < size; ++i) {
      const Real at_i = beyond(i);
      if (at_i <= Real(0)) kept.add(corners[i]);
      if (i >= sides) break;
      const std::size_t j = (i + 1) % size;
      const Real at_j = beyond(j);
      if ((at_i < Real(0) && at_j > Real(0)) || (at_i > Real(0) && at_j < Real(0))) crossing(i, j, at_i, at_j);
    }
    now_ = 1 - now_;
  }

  Corners both_[2];
  std::size_t now_ = 0;
};

/// The points of one face that have points of the other feature above them.
template <class Real>
void add_common_with_face(const Feature<Real, 3>& face, const Feature<Real, 3>& other, const Vector<Real, 3>& normal,
                          bool is_face_of_a, CommonPoints<Real, 3>& common) {
  const Real slope = dot(face.normal, normal);
  if (std::abs(slope) < Real(0.05)) return;  // seen from its side
  CutPolygon<Real> cut(other);
  cut.cut(face, normal);
  for (const CutCorner<Real>& corner : cut) {
    // Along the normal from the corner to the plane of the face.
    const Real distance = dot(face.normal, face.corners[0] - corner.x) / slope;
    if (is_face_of_a) {
      common.add({corner.x + normal * distance, -distance, corner.feature});
    } else {
      common.add({corner.x, distance, 0x10000u | corner.feature});
    }
  }
}

/// The points of feature a that have points of feature b above them, seen along the normal: of the area, or the length,
/// that they have in common, the corners.
template <class Real, int Dim>
[[nodiscard]] CommonPoints<Real, Dim> common_points(const Feature<Real, Dim>& a, const Feature<Real, Dim>& b,
                                                    const Vector<Real, Dim>& normal) {
  CommonPoints<Real, Dim> common;
  if constexpr (Dim == 3) {
    const bool is_face_a = a.size > 2, is_face_b = b.size > 2;
    // The face that is seen more nearly from above cuts the other.
    if (is_face_a && (!is_face_b || std::abs(dot(a.normal, normal)) >= std::abs(dot(b.normal, normal)) - Real(1e-3))) {
      add_common_with_face(a, b, normal, true, common);
      return common;
    }
    if (is_face_b) {
      add_common_with_face(b, a, normal, false, common);
      return common;
    }
  }
  if constexpr (Dim == 2) {
    if (a.size + b.size == 3) add_corner_above_segment(a, b, normal, common);
  }
  if (a.size == 2 && b.size == 2) {
    Vector<Real, Dim> u = a.corners[1] - a.corners[0], v = b.corners[1] - b.corners[0];
    if constexpr (Dim == 3) {
      // Segments that are not nearly parallel cross in one point, the closest one.
      const Vector<Real, 3> across = moment(u, v);
      if (squared(across) > Real(0.0025) * squared(u) * squared(v)) return common;
    }
    const Real seen_a = squared(u) - dot(u, normal) * dot(u, normal);
    const Real seen_b = squared(v) - dot(v, normal) * dot(v, normal);
    if (seen_a > Real(0.0025) * squared(u) && seen_b > Real(0.0025) * squared(v))
      add_common_of_segments(a, b, normal, common);
  }
  return common;
}

}  // namespace continuo
