// Until when two convex parts of bodies surely stay apart.
#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

#include <continuo/bodies/exact_rigid/rigid_flight.hpp>
#include <continuo/bodies/exact_rigid/separation.hpp>

namespace continuo {

/// What may happen to the distance of two bodies: b accelerates against a by `steady`, and points of both by no more
/// than `most` beyond that, together; their centres by no more than `sway` beyond it.
template <class Real, int Dim>
struct MutualMotion {
  Vector<Real, Dim> steady{};
  Real most{}, sway{};

  /// The least second derivative of a distance along a normal; 0 where it is positive, so that what follows is concave.
  [[nodiscard]] Real curvature(const Vector<Real, Dim>& normal, const Real& beyond) const {
    return std::min(Real(dot(normal, steady) - beyond), Real(0));
  }
};

/// Whether the balls around two bodies surely stay apart, by more than `level`, for a time. The distance of their
/// centres, from which `radii` are taken, is no less than that along the present line between them, or along the normal
/// of a wall, and this one is no less than a parabola that bends downwards: its ends tell.
template <class Real, int Dim>
[[nodiscard]] bool balls_stay_apart(const Vector<Real, Dim>& normal, const Real& distance, const Real& rate,
                                    const MutualMotion<Real, Dim>& motion, const Real& radii, const Real& level,
                                    const Real& duration) {
  const Real curvature = motion.curvature(normal, motion.sway), room = distance - radii - level;
  return room > Real(0) && room + rate * duration + curvature * duration * duration / 2 > Real(0);
}

/// The corners of the core of a part, or a point of a wall, and their velocities.
template <class Real, int Dim>
struct MovingCorners {
  std::array<Vector<Real, Dim>, Polytope<Real, Dim>::most_corners> place{}, velocity{};
  std::size_t size = 0;

  MovingCorners(const ExactPart<Real, Dim>& part, const ExactBody<Real, Dim>& body) {
    if (part.is_wall()) {
      place[size++] = part.wall_normal * part.wall_offset;
      return;
    }
    const Pose<Real, Dim> pose = part.pose(body);
    for (const Vector<Real, Dim>& corner : part.convex->core.corners) {
      place[size] = pose.place(corner);
      velocity[size] = body.velocity_at(place[size]);
      ++size;
    }
  }
};

/// A direction that turns about a point that moves on.
template <class Real, int Dim>
struct TurningNormal {
  Vector<Real, Dim> normal{}, change{};  // of length 1; its change in time
  Vector<Real, Dim> place{}, velocity{};
};

/// The heights of corners along a normal, or with the sign -1 against it, each with its rate.
template <class Real, int Dim>
struct CornerHeights {
  std::array<Real, Polytope<Real, Dim>::most_corners> value{}, rate{};
  std::size_t size;

  CornerHeights(const MovingCorners<Real, Dim>& corners, const TurningNormal<Real, Dim>& along, const Real& sign)
      : size(corners.size) {
    for (std::size_t i = 0; i < size; ++i) {
      const Vector<Real, Dim> arm = corners.place[i] - along.place;
      value[i] = sign * dot(along.normal, arm);
      rate[i] = sign * (dot(along.normal, corners.velocity[i] - along.velocity) + dot(along.change, arm));
    }
  }
  /// The least of them after a time, with its rate then.
  [[nodiscard]] std::array<Real, 2> least(const Real& duration) const {
    std::array<Real, 2> best{std::numeric_limits<Real>::infinity(), Real(0)};
    for (std::size_t i = 0; i < size; ++i)
      if (const Real here = value[i] + rate[i] * duration; here < best[0]) best = {here, rate[i]};
    return best;
  }
};

/// A time, at most `longest`, for which the sum of both heights stays above `beyond`, above which it is now, where it
/// is bent by `curvature`, which is not above 0. The least of the heights is concave in time: chords approach its zero
/// from the left, tangents from the right.
template <class Real, int Dim>
[[nodiscard]] Real time_above(const CornerHeights<Real, Dim>& of_a, const CornerHeights<Real, Dim>& of_b,
                              const Real& beyond, const Real& curvature, const Real& longest) {
  const auto room = [&](const Real& duration) {
    const auto at_a = of_a.least(duration), at_b = of_b.least(duration);
    return std::array<Real, 2>{at_a[0] + at_b[0] - beyond + curvature * duration * duration / 2,
                               at_a[1] + at_b[1] + curvature * duration};
  };
  Real low(0), high = longest, at_low = room(low)[0];
  auto at_high = room(high);
  if (at_high[0] >= Real(0)) return longest;
  if (!(at_low > Real(0))) return Real(0);
  for (int round = 0; round < 40; ++round) {
    const Real chord = low + (high - low) * (at_low / (at_low - at_high[0]));
    if (chord > low) low = chord, at_low = room(low)[0];
    if (!(at_low > Real(0))) break;
    const Real tangent = at_high[1] < Real(0) ? high - at_high[0] / at_high[1] : high;
    if (tangent < high && tangent > low) high = tangent, at_high = room(high);
    if (at_high[0] >= Real(0) || high - low <= Real(1e-3) * low) break;
  }
  return low;
}

/// The corners that are nearest along a normal, up to a height: of an edge two, of a face more.
template <class Real, int Dim>
struct NearestCorners {
  std::size_t count = 0, first = 0, second = 0;

  NearestCorners(const CornerHeights<Real, Dim>& heights, const Real& within) {
    const Real least = heights.least(Real(0))[0];
    for (std::size_t i = 0; i < heights.size; ++i) {
      if (heights.value[i] > least + within) continue;
      (count == 0 ? first : second) = i;
      ++count;
    }
  }
};

/// The change of a normal that stays across an edge of a and one of b.
template <class Real>
[[nodiscard]] Vector<Real, 3> change_across(const MovingCorners<Real, 3>& of_a, const NearestCorners<Real, 3>& at_a,
                                            const MovingCorners<Real, 3>& of_b, const NearestCorners<Real, 3>& at_b,
                                            const Vector<Real, 3>& normal) {
  using V = Vector<Real, 3>;
  const V e = of_a.place[at_a.second] - of_a.place[at_a.first], f = of_b.place[at_b.second] - of_b.place[at_b.first];
  const V e_change = of_a.velocity[at_a.second] - of_a.velocity[at_a.first];
  const V f_change = of_b.velocity[at_b.second] - of_b.velocity[at_b.first];
  const V across_e = moment(e, normal), across_f = moment(f, normal);
  const Real size = dot(across_f, e);  // as dot(across_e, f), but for the sign
  if (!(std::abs(size) > Real(1e-6) * length(e) * length(f))) return {};
  return across_e * (dot(normal, f_change) / size) - across_f * (dot(normal, e_change) / size);
}

/// How the normal turns with the features that are nearest: with a face, with an edge where a corner is opposite, or
/// with two edges that cross. No matter what it is, what follows from it is sure.
template <class Real, int Dim>
[[nodiscard]] Vector<Real, Dim> change_of_normal(const MovingCorners<Real, Dim>& of_a, const ExactBody<Real, Dim>& a,
                                                 const MovingCorners<Real, Dim>& of_b, const ExactBody<Real, Dim>& b,
                                                 const TurningNormal<Real, Dim>& along, const Real& within) {
  const NearestCorners<Real, Dim> at_a(CornerHeights<Real, Dim>(of_a, along, Real(-1)), within);
  const NearestCorners<Real, Dim> at_b(CornerHeights<Real, Dim>(of_b, along, Real(1)), within);
  if (at_a.count >= Dim || at_a.count > at_b.count) return turning(a.spin, along.normal);
  if (at_b.count >= Dim || at_b.count > at_a.count) return turning(b.spin, along.normal);
  if constexpr (Dim == 3) {
    if (at_a.count == 2) return change_across(of_a, at_a, of_b, at_b, along.normal);
  }
  return {};
}

/// The greatest distances of corners from a point that moves, and from its velocity.
template <class Real, int Dim>
[[nodiscard]] std::array<Real, 2> spread_of(const MovingCorners<Real, Dim>& corners,
                                            const TurningNormal<Real, Dim>& about) {
  std::array<Real, 2> most{};
  for (std::size_t i = 0; i < corners.size; ++i) {
    most[0] = std::max(most[0], length(Vector<Real, Dim>(corners.place[i] - about.place)));
    most[1] = std::max(most[1], length(Vector<Real, Dim>(corners.velocity[i] - about.velocity)));
  }
  return most;
}

/// A time, at most `longest`, for which the gap surely stays above `level`, above which it is now. The present normal
/// separates the parts as long as the least corner of b is beyond the greatest of a; every corner stays above a
/// parabola. Where that is a short time, a normal n that turns with the nearest features by w tells more: corners of
/// one edge or face then do not count for their own rates. With n'' = -w^2 n the distance along n of two corners, whose
/// places differ by d, has the second derivative n . d'' + 2 n' . d' - w^2 n . d.
template <class Real, int Dim>
[[nodiscard]] Real safe_time(const ExactPart<Real, Dim>& part_a, const ExactBody<Real, Dim>& a,
                             const ExactPart<Real, Dim>& part_b, const ExactBody<Real, Dim>& b,
                             const Vector<Real, Dim>& normal, const Real& level, const MutualMotion<Real, Dim>& motion,
                             const Real& longest) {
  const MovingCorners<Real, Dim> of_a(part_a, a), of_b(part_b, b);
  const Real beyond = part_a.rounding() + part_b.rounding() + level;
  TurningNormal<Real, Dim> along{.normal = normal, .place = of_a.place[0], .velocity = of_a.velocity[0]};
  const Real curvature = motion.curvature(normal, motion.most);
  const auto time = [&](const Real& bent, const Real& most) {
    return time_above(CornerHeights<Real, Dim>(of_a, along, Real(-1)), CornerHeights<Real, Dim>(of_b, along, Real(1)),
                      beyond, bent, most);
  };
  const Real at_rest = time(curvature, longest);
  if (at_rest >= longest || part_a.is_wall() || !(at_rest > Real(0))) return at_rest;
  const auto heights = [&](const auto& corners, int sign) {
    return CornerHeights<Real, Dim>(corners, along, Real(sign)).least(Real(0))[0];
  };
  const Real gap = heights(of_a, -1) + heights(of_b, 1) - beyond;
  constexpr Real rounding = 1024 * std::numeric_limits<Real>::epsilon();
  along.change = change_of_normal(of_a, a, of_b, b, along,
                                  Real(gap / 8 + rounding * (part_a.convex->reach + part_b.convex->reach)));
  const Real w = length(along.change);
  if (!(w > Real(0))) return at_rest;
  const Real most_time = std::min({longest, 1 / w, 64 * at_rest});
  const auto [place_a, speed_a] = spread_of(of_a, along);
  const auto [place_b, speed_b] = spread_of(of_b, along);
  const Real pull = motion.most + length(motion.steady), speed = speed_a + speed_b + pull * most_time;
  const Real bent =
      w * w * (place_a + place_b + speed * most_time) + 2 * w * speed + w * length(motion.steady) * most_time;
  return std::max(at_rest, time(curvature - bent, most_time));
}

/// A time, at most `longest`, for which gap + rate t + bend t^2 / 2 - jerk t^3 / 6 stays above 0, to a hundredth. Where
/// the gap closes, a bend that slows it down does not count: then the coefficients change their sign once, and there is
/// one root (Descartes).
template <class Real>
[[nodiscard]] Real time_above(const Real& gap, const Real& rate, const Real& bend, const Real& jerk,
                              const Real& longest) {
  if (!(gap > Real(0))) return Real(0);
  const Real bent = rate < Real(0) ? std::min(bend, Real(0)) : bend;
  const auto is_above = [&](const Real& t) { return gap + t * (rate + t * (bent / 2 - t * (jerk / 6))) > Real(0); };
  if (is_above(longest)) return longest;
  Real high = longest, low = longest / 2;
  while (low > Real(0) && !is_above(low)) high = low, low /= 2;
  for (int round = 0; round < 6; ++round) (is_above((low + high) / 2) ? low : high) = (low + high) / 2;
  return low;
}

/// A body with what accelerates it now, and bounds of its motion from now on.
template <class Real, int Dim>
struct BodyInMotion {
  const ExactBody<Real, Dim>* body = nullptr;
  Accelerations<Real, Dim> now{};
  MotionBounds<Real, Dim> bounds{};
  Real reach{};  // of its points from its centre
};

/// A time, at most `longest`, for which the corners of a part surely stay above the plane of a face of another body by
/// more than `beyond`. With N the normal of the face, which turns with it by w, and d a corner from the centre of its
/// body, the height N . d has the derivatives N' . d + N . d' and N'' . d + 2 N' . d' + N . d'', and the third one is
/// bounded by those of N and d. What slides along a face after an impact, pressed by nothing, would else be followed by
/// steps in which its acceleration can do no harm, of the size of the square root of rounding.
template <class Real, int Dim>
[[nodiscard]] Real time_above_face(const MovingCorners<Real, Dim>& of_face, const BodyInMotion<Real, Dim>& face,
                                   const MovingCorners<Real, Dim>& corners, const BodyInMotion<Real, Dim>& other,
                                   const Vector<Real, Dim>& normal, const Real& beyond, const Real& longest) {
  using V = Vector<Real, Dim>;
  const ExactBody<Real, Dim>&f = *face.body, &o = *other.body;
  const Real w = face.bounds.spin, w_other = other.bounds.spin;
  const Real most = w + w_other > Real(0) ? std::min(longest, Real(1 / (w + w_other))) : longest;
  const V turns = turning(f.spin, normal), turns_on = turning(face.now.angular, normal) + turning(f.spin, turns);
  const Real jerk_of_place =
      face.bounds.jerk + other.bounds.jerk +
      other.reach * (w_other * w_other * w_other + 3 * w_other * other.bounds.turning_on + other.bounds.turning_change);
  const auto acceleration_of = [&](const V& arm) {
    return V(other.now.linear - face.now.linear + turning(other.now.angular, arm) +
             turning(o.spin, turning(o.spin, arm)));
  };
  Real way(0), speed(0), pull(0);
  for (std::size_t i = 0; i < corners.size; ++i) {
    way = std::max(way, length(V(corners.place[i] - f.x)));
    speed = std::max(speed, length(V(corners.velocity[i] - f.v)));
    pull = std::max(pull, length(acceleration_of(V(corners.place[i] - o.x))));
  }
  pull += jerk_of_place * most, speed += pull * most, way += speed * most;
  const Real bend_of_normal = w * w + face.bounds.turning_on;
  const Real jerk_of_normal = w * w * w + 3 * w * face.bounds.turning_on + face.bounds.turning_change;
  const Real jerk = jerk_of_normal * way + 3 * bend_of_normal * speed + 3 * w * pull + jerk_of_place;
  Real top = -std::numeric_limits<Real>::infinity(), time = most;
  for (std::size_t i = 0; i < of_face.size; ++i) top = std::max(top, Real(dot(normal, of_face.place[i] - f.x)));
  for (std::size_t i = 0; i < corners.size && time > Real(0); ++i) {
    const V d = corners.place[i] - f.x, moves = corners.velocity[i] - f.v;
    const V bends = acceleration_of(V(corners.place[i] - o.x));
    time = time_above(Real(dot(normal, d) - top - beyond), Real(dot(turns, d) + dot(normal, moves)),
                      Real(dot(turns_on, d) + 2 * dot(turns, moves) + dot(normal, bends)), jerk, time);
  }
  return time;
}

/// As `safe_time`, where a face of one is opposite the other, which is b of a wall; else 0.
template <class Real, int Dim>
[[nodiscard]] Real safe_time_at_face(const ExactPart<Real, Dim>& part_a, const BodyInMotion<Real, Dim>& a,
                                     const ExactPart<Real, Dim>& part_b, const BodyInMotion<Real, Dim>& b,
                                     const Separation<Real, Dim>& apart, const Real& level, const Real& longest) {
  const MovingCorners<Real, Dim> of_a(part_a, *a.body), of_b(part_b, *b.body);
  const Vector<Real, Dim>& normal = apart.normal;
  const Real beyond = part_a.rounding() + part_b.rounding() + level;
  const TurningNormal<Real, Dim> along{.normal = normal, .place = of_a.place[0], .velocity = of_a.velocity[0]};
  if (!part_a.is_wall()) {
    constexpr Real rounding = 1024 * std::numeric_limits<Real>::epsilon();
    const Real within =
        std::max(Real(apart.gap - level), Real(0)) / 8 + rounding * (part_a.convex->reach + part_b.convex->reach);
    const NearestCorners<Real, Dim> at_a(CornerHeights<Real, Dim>(of_a, along, Real(-1)), within);
    const NearestCorners<Real, Dim> at_b(CornerHeights<Real, Dim>(of_b, along, Real(1)), within);
    if (at_b.count >= Dim && at_b.count > at_a.count)
      return time_above_face(of_b, b, of_a, a, Vector<Real, Dim>(-normal), beyond, longest);
    if (at_a.count < Dim) return Real(0);
  }
  return time_above_face(of_a, a, of_b, b, normal, beyond, longest);
}

}  // namespace continuo
