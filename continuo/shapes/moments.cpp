// A rounded polytope is its core, a prism on each face, a sector of a cylinder on each edge, and a sector of a ball at
// each corner (Steiner's decomposition). In the plane: the core, a rectangle on each side, a sector at each corner. The
// moments of each part are elementary; those of a sector of a ball are integrals of 1, u and u u^T over a spherical
// polygon, which by Stokes' theorem are sums over its arcs (J. Arvo, "Applications of irradiance tensors to the
// simulation of non-Lambertian phenomena", SIGGRAPH 1995, 335-342).
#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include <continuo/shapes/moments.hpp>

namespace continuo {
namespace {

using Plane = Vector<double, 2>;
using Space = Vector<double, 3>;

template <int Dim>
Matrix<double, Dim> symmetric_outer(const Vector<double, Dim>& a, const Vector<double, Dim>& b) {
  return outer(a, b) + outer(b, a);
}

// The simplex of the origin and Dim corners: with determinant D and sum s of the corners, the integrals are D / Dim!,
// D s / (Dim + 1)! and D (sum p p^T + s s^T) / (Dim + 2)!.
template <int Dim>
void add_simplex(const std::array<Vector<double, Dim>, Dim>& corners, double determinant, Moments<Dim>& sum) {
  constexpr double first = Dim == 2 ? 2 : 6, second = first * (Dim + 1), third = second * (Dim + 2);
  Vector<double, Dim> total{};
  Matrix<double, Dim> products{};
  for (const auto& corner : corners) total += corner, products += outer(corner, corner);
  sum.volume += determinant / first;
  sum.first += total * (determinant / second);
  sum.second += (products + outer(total, total)) * (determinant / third);
}

// Integrals over an arc of directions u from a to b of length `angle`, where `beside` is the direction a quarter turn
// from a: of u and u u^T by the arc.
template <int Dim>
struct Arc {
  double angle;
  Vector<double, Dim> first;
  Matrix<double, Dim> second;

  Arc(const Vector<double, Dim>& a, const Vector<double, Dim>& beside, double length)
      : angle(length),
        first(a * std::sin(length) + beside * (1 - std::cos(length))),
        second(outer(a, a) * (length / 2 + std::sin(2 * length) / 4) +
               outer(beside, beside) * (length / 2 - std::sin(2 * length) / 4) +
               symmetric_outer(a, beside) * (std::sin(length) * std::sin(length) / 2)) {}
};
template <int Dim>
double angle_between(const Vector<double, Dim>& a, const Vector<double, Dim>& b) {
  return 2 * std::atan2(length(a - b), length(a + b));  // exact for small and for large angles
}

// The sector of a ring of radius r about `corner`, of the directions of an arc.
void add_sector(const Plane& corner, const Arc<2>& arc, double r, Moments<2>& sum) {
  sum.volume += arc.angle * r * r / 2;
  sum.first += corner * (arc.angle * r * r / 2) + arc.first * (r * r * r / 3);
  sum.second += outer(corner, corner) * (arc.angle * r * r / 2) + symmetric_outer(corner, arc.first) * (r * r * r / 3) +
                arc.second * (r * r * r * r / 4);
}
// The sector of a cylinder of radius r about the segment from p to q.
void add_cylinder(const Space& p, const Space& q, const Arc<3>& arc, double r, Moments<3>& sum) {
  const double along = length(q - p), disc = arc.angle * r * r / 2;
  const Space middle = (p + q) * (along / 2);
  const Matrix<double, 3> square = (outer(p, p) + outer(q, q) + symmetric_outer(p, q) * 0.5) * (along / 3);
  sum.volume += disc * along;
  sum.first += middle * disc + arc.first * (along * r * r * r / 3);
  sum.second +=
      square * disc + symmetric_outer(middle, arc.first) * (r * r * r / 3) + arc.second * (along * r * r * r * r / 4);
}

// Integrals of 1, u and u u^T over a region of directions.
struct Directions {
  double angle = 0;  // solid
  Space first{};
  Matrix<double, 3> second{};
};
void add_ball_sector(const Space& corner, const Directions& directions, double r, Moments<3>& sum) {
  const double r3 = r * r * r / 3, r4 = r * r * r * r / 4, r5 = r * r * r * r * r / 5;
  sum.volume += directions.angle * r3;
  sum.first += corner * (directions.angle * r3) + directions.first * r4;
  sum.second += outer(corner, corner) * (directions.angle * r3) + symmetric_outer(corner, directions.first) * r4 +
                directions.second * r5;
}

// The prism of height r on a polygon of area A, with first moment m and second moment Y.
void add_prism(double area, const Space& m, const Matrix<double, 3>& second, const Space& n, double r,
               Moments<3>& sum) {
  sum.volume += area * r;
  sum.first += m * r + n * (area * r * r / 2);
  sum.second += second * r + symmetric_outer(m, n) * (r * r / 2) + outer(n, n) * (area * r * r * r / 3);
}

// A quarter turn from a towards b, which is not parallel to it.
Space quarter_turn(const Space& a, const Space& b) {
  const Space beside = b - a * dot(a, b);
  return beside * (1 / length(beside));
}

constexpr double whole_turn = 2 * std::numbers::pi;

Moments<2> rounded_segment(const std::vector<Plane>& ends, double r) {
  Moments<2> sum;
  const Plane p = ends.front(), q = ends.back();
  if (p == q) {
    add_sector(p, Arc<2>({{1, 0}}, {{0, 1}}, whole_turn), r, sum);
    return sum;
  }
  const Plane along = (q - p) * (1 / length(q - p)), left{{-along[1], along[0]}};
  add_sector(q, Arc<2>(-left, along, whole_turn / 2), r, sum);
  add_sector(p, Arc<2>(left, -along, whole_turn / 2), r, sum);
  // The rectangle between them, as two triangles about the origin of each half.
  const double area = 2 * r * length(q - p);
  const Plane middle = (p + q) * 0.5, half = (q - p) * 0.5;
  sum.volume += area;
  sum.first += middle * area;
  sum.second += (outer(middle, middle) + outer(half, half) * (1.0 / 3) + outer(left, left) * (r * r / 3)) * area;
  return sum;
}
Moments<3> rounded_segment(const std::vector<Space>& ends, double r) {
  Moments<3> sum;
  const Space p = ends.front(), q = ends.back();
  // All directions, or those of one half of the ball about u: 1, u / 2 and 1 / 3 of the identity, by the angle.
  const auto half_ball = [&](const Space& corner, const Space& u) {
    add_ball_sector(corner, {whole_turn, u * (whole_turn / 2), identity_matrix<double, 3>() * (whole_turn / 3)}, r,
                    sum);
  };
  const Space along = p == q ? Space{{1, 0, 0}} : (q - p) * (1 / length(q - p));
  half_ball(q, along);
  half_ball(p, -along);
  if (p == q) return sum;
  const Space axis = std::abs(along[0]) < 0.6 ? Space{{1, 0, 0}} : Space{{0, 1, 0}};
  const Space a = quarter_turn(along, axis);
  add_cylinder(p, q, Arc<3>(a, moment(along, a), whole_turn), r, sum);
  return sum;
}

// The prisms on the faces, with the angles of the faces at the corners taken from the solid angles of these.
void add_faces(const Polytope<double, 3>& polytope, double r, std::vector<Directions>& at_corner, Moments<3>& sum) {
  for (std::size_t face = 0; face < polytope.faces.size(); ++face) {
    const auto loop = polytope.loop(face);
    const Space n = polytope.faces[face].normal, p0 = polytope.corners[loop[0]];
    double area = 0;
    Space first{};
    Matrix<double, 3> second{};
    for (std::size_t k = 1; k + 1 < loop.size(); ++k) {
      const Space p1 = polytope.corners[loop[k]], p2 = polytope.corners[loop[k + 1]], total = p0 + p1 + p2;
      const double piece = dot(moment(p1 - p0, p2 - p0), n) / 2;
      area += piece;
      first += total * (piece / 3);
      second += (outer(p0, p0) + outer(p1, p1) + outer(p2, p2) + outer(total, total)) * (piece / 12);
      add_simplex<3>({p0, p1, p2}, dot(p0, moment(p1, p2)), sum);
    }
    add_prism(area, first, second, n, r, sum);
    for (std::size_t k = 0; k < loop.size(); ++k) {
      const Space here = polytope.corners[loop[k]];
      const Space to = polytope.corners[loop[(k + 1) % loop.size()]] - here;
      const Space back = polytope.corners[loop[(k + loop.size() - 1) % loop.size()]] - here;
      at_corner[loop[k]].angle -= angle_between(to * (1 / length(to)), back * (1 / length(back)));
    }
  }
}

// The solid angle of the normals at a corner is a whole turn less the angles of its faces (Gauss and Bonnet). With the
// unit normal m of the plane of an arc, to the left of its direction, and the boundary counter-clockwise:
// 2 int u = sum angle m, 3 int u u^T = (int 1) I + sum (int u along the arc) m^T.
void add_edges(const Polytope<double, 3>& polytope, double r, std::vector<Directions>& at_corner, Moments<3>& sum) {
  for (const Edge& edge : polytope.edges) {
    const Space left = polytope.faces[edge.left].normal, right = polytope.faces[edge.right].normal;
    const double angle = angle_between(left, right);
    const Arc<3> arc(right, quarter_turn(right, left), angle);
    const Space m = moment(right, quarter_turn(right, left));
    add_cylinder(polytope.corners[edge.from], polytope.corners[edge.to], arc, r, sum);
    Directions& from = at_corner[edge.from];  // around it, the arc goes from right to left
    Directions& to = at_corner[edge.to];      // and around this one from left to right
    from.first += m * (angle / 2);
    to.first -= m * (angle / 2);
    from.second += outer(arc.first, m) * (1.0 / 3);
    to.second += outer(arc.first, -m) * (1.0 / 3);
  }
}

}  // namespace

Moments<2> moments_of(const Polytope<double, 2>& polytope, double r) {
  if (polytope.faces.empty()) return rounded_segment(polytope.corners, r);
  Moments<2> sum;
  const std::size_t n = polytope.corners.size();
  for (std::size_t i = 0; i < n; ++i) {
    const Plane p = polytope.corners[i], q = polytope.corners[(i + 1) % n];
    add_simplex<2>({p, q}, moment(p, q)[0], sum);
    const Plane normal = polytope.faces[i].normal, next = polytope.faces[(i + 1) % n].normal;
    const double area = length(q - p) * r;
    const Plane middle = (p + q) * 0.5 + normal * (r / 2), half = (q - p) * 0.5;
    sum.volume += area;
    sum.first += middle * area;
    sum.second += (outer(middle, middle) + outer(half, half) * (1.0 / 3) + outer(normal, normal) * (r * r / 12)) * area;
    add_sector(q, Arc<2>(normal, {{-normal[1], normal[0]}}, angle_between(normal, next)), r, sum);
  }
  return sum;
}

Moments<3> moments_of(const Polytope<double, 3>& polytope, double r) {
  if (polytope.faces.empty()) return rounded_segment(polytope.corners, r);
  Moments<3> sum;
  std::vector<Directions> at_corner(polytope.corners.size(), {.angle = whole_turn});
  add_faces(polytope, r, at_corner, sum);
  add_edges(polytope, r, at_corner, sum);
  for (std::size_t i = 0; i < at_corner.size(); ++i) {
    at_corner[i].second += identity_matrix<double, 3>() * (at_corner[i].angle / 3);
    add_ball_sector(polytope.corners[i], at_corner[i], r, sum);
  }
  return sum;
}

}  // namespace continuo
