// Boxes, and rounded polytopes in the frames of their centres of mass.
#include <algorithm>
#include <cmath>
#include <string>

#include <continuo/shapes/convex.hpp>
#include <continuo/shapes/moments.hpp>

namespace continuo {
namespace {

template <class Real, int Dim>
Vector<Real, Dim> rounded_to(const Vector<double, Dim>& x) {
  Vector<Real, Dim> result;
  for (std::size_t i = 0; i < x.size(); ++i) result[i] = static_cast<Real>(x[i]);
  return result;
}

// About the centre of mass: the trace of the second moment less its matrix; in the plane the trace alone.
template <int Dim>
Inertia<double, Dim> inertia_of(const Matrix<double, Dim>& second) {
  double trace = 0;
  for (std::size_t i = 0; i < Dim; ++i) trace += second[i][i];
  if constexpr (Dim == 2) {
    return {{{{{trace}}}}};
  } else {
    return identity_matrix<double, 3>() * trace + second * -1.0;
  }
}

}  // namespace

template <class Real, int Dim>
Result<Convex<Real, Dim>> convex_body(const Polytope<double, Dim>& core, double rounding) {
  if (!(rounding >= 0) || !std::isfinite(rounding))
    return invalid_input("the rounding of a shape must be 0 or greater, and finite");
  if (core.faces.empty() && !(rounding > 0)) return invalid_input("a point or a segment needs a radius greater than 0");
  const Moments<Dim> moments = moments_of(core, rounding);
  if (!(moments.volume > 0) || !std::isfinite(moments.volume))
    return invalid_input("the shape has no volume that can be computed with");
  Convex<Real, Dim> body;
  body.centre = moments.first * (1 / moments.volume);
  Matrix<double, Dim> second = moments.second * (1 / moments.volume);
  second += outer(body.centre, -body.centre);
  const Inertia<double, Dim> inertia = inertia_of<Dim>(second);
  for (std::size_t j = 0; j < inertia.columns.size(); ++j)
    for (std::size_t i = 0; i < inertia.columns.size(); ++i) body.inertia[j][i] = static_cast<Real>(inertia[j][i]);
  double farthest = 0;
  for (const auto& corner : core.corners) {
    const Vector<double, Dim> x = corner - body.centre;
    farthest = std::max(farthest, length(x));
    body.core.corners.push_back(rounded_to<Real>(x));
  }
  for (const auto& face : core.faces)
    body.core.faces.push_back(
        {rounded_to<Real>(face.normal), static_cast<Real>(face.offset - dot(face.normal, body.centre))});
  body.core.loops = core.loops, body.core.loop_begin = core.loop_begin, body.core.edges = core.edges;
  body.rounding = static_cast<Real>(rounding);
  body.reach = static_cast<Real>(farthest + rounding);
  body.volume = static_cast<Real>(moments.volume);
  return body;
}

template <int Dim>
Result<Polytope<double, Dim>> box(const Vector<double, Dim>& size) {
  for (const double side : size.components)
    if (!(side > 0) || !std::isfinite(side))
      return invalid_input("the sides of a box must be greater than 0, and finite, not " + std::to_string(side));
  Polytope<double, Dim> result;
  if constexpr (Dim == 2) {
    const double x = size[0] / 2, y = size[1] / 2;
    result.corners = {{{-x, -y}}, {{x, -y}}, {{x, y}}, {{-x, y}}};
    result.faces = {{{{0, -1}}, y}, {{{1, 0}}, x}, {{{0, 1}}, y}, {{{-1, 0}}, x}};
  } else {
    // Bit i of the number of a corner is set where its coordinate i is positive.
    for (unsigned k = 0; k < 8; ++k)
      result.corners.push_back(
          {{(k & 1 ? 0.5 : -0.5) * size[0], (k & 2 ? 0.5 : -0.5) * size[1], (k & 4 ? 0.5 : -0.5) * size[2]}});
    result.loops = {0, 4, 6, 2, 1, 3, 7, 5, 0, 1, 5, 4, 2, 6, 7, 3, 0, 2, 3, 1, 4, 5, 7, 6};
    result.loop_begin = {0, 4, 8, 12, 16, 20, 24};
    for (std::size_t face = 0; face < 6; ++face) {
      Vector<double, 3> normal{};
      normal[face / 2] = face % 2 ? 1 : -1;
      result.faces.push_back({normal, size[face / 2] / 2});
    }
    result.edges = {{0, 4, 0, 2}, {4, 6, 0, 5}, {2, 6, 3, 0}, {0, 2, 4, 0}, {1, 3, 1, 4}, {3, 7, 1, 3},
                    {5, 7, 5, 1}, {1, 5, 2, 1}, {0, 1, 2, 4}, {4, 5, 5, 2}, {6, 7, 3, 5}, {2, 3, 4, 3}};
  }
  return result;
}

template Result<Convex<float, 2>> convex_body(const Polytope<double, 2>&, double);
template Result<Convex<float, 3>> convex_body(const Polytope<double, 3>&, double);
template Result<Convex<double, 2>> convex_body(const Polytope<double, 2>&, double);
template Result<Convex<double, 3>> convex_body(const Polytope<double, 3>&, double);
template Result<Polytope<double, 2>> box(const Vector<double, 2>&);
template Result<Polytope<double, 3>> box(const Vector<double, 3>&);

}  // namespace continuo
