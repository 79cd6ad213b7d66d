// What the solver of manifolds reads and writes of bodies: numbers that it needs together are adjacent, four at a time,
// so that lanes load and store them together.
#pragma once
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

#include <continuo/bodies/support/large_array.hpp>
#include <continuo/numerics/vector.hpp>

namespace continuo {

/// A body of the plane in a step. `turn` is the sine of its rotation since the step began, and 1 minus the cosine.
/// One of space: `turn` is that rotation as a unit quaternion, the vector first.
template <class Real, int Dim>
struct alignas((Dim == 2 ? 8 : 16) * sizeof(Real)) SolverState {
  using Quad = std::array<Real, 4>;
  static constexpr std::size_t quads = Dim == 2 ? 2 : 4;
  std::array<Quad, quads> quad{};  // plane: v, spin, 1 / mass; moved, turn. Space: v, 1 / mass; spin; moved; turn

  [[nodiscard]] Vector<Real, Dim> v() const { return part<Dim>(quad[0], 0); }
  [[nodiscard]] Vector<Real, Dim> moved() const { return part<Dim>(quad[Dim == 2 ? 1 : 2], 0); }
  [[nodiscard]] Spin<Real, Dim> spin() const {
    return Dim == 2 ? part<Spin<Real, Dim>::size()>(quad[0], 2) : part<Spin<Real, Dim>::size()>(quad[1], 0);
  }
  [[nodiscard]] Real inverse_mass() const { return quad[0][3]; }

  void set_v(const Vector<Real, Dim>& v) { put(v, quad[0], 0); }
  void set_spin(const Spin<Real, Dim>& spin) { Dim == 2 ? put(spin, quad[0], 2) : put(spin, quad[1], 0); }
  void set_moved(const Vector<Real, Dim>& moved) { put(moved, quad[Dim == 2 ? 1 : 2], 0); }
  void set_inverse_mass(Real inverse_mass) { quad[0][3] = inverse_mass; }

  /// In space, with the scalar first.
  [[nodiscard]] Vector<Real, 4> turn() const { return {{quad[3][3], quad[3][0], quad[3][1], quad[3][2]}}; }
  void set_turn(const Vector<Real, 4>& q) { quad[3] = {q[1], q[2], q[3], q[0]}; }

 private:
  template <int Size>
  static Vector<Real, Size> part(const Quad& quad, std::size_t first) {
    Vector<Real, Size> x;
    for (std::size_t i = 0; i < x.size(); ++i) x[i] = quad[(first + i) % 4];
    return x;
  }
  template <int Size>
  static void put(const Vector<Real, Size>& x, Quad& quad, std::size_t first) {
    for (std::size_t i = 0; i < x.size(); ++i) quad[(first + i) % 4] = x[i];
  }
};

template <class Real, int Dim>
using SolverStates = LargeArray<SolverState<Real, Dim>>;

/// The rotation p and then q, as a quaternion (w, x, y, z) of length 1 up to rounding.
template <class Real>
[[nodiscard]] Vector<Real, 4> product(const Vector<Real, 4>& q, const Vector<Real, 4>& p) {
  const Vector<Real, 3> u{{q[1], q[2], q[3]}}, v{{p[1], p[2], p[3]}};
  const Vector<Real, 3> w = v * q[0] + u * p[0] + turning(u, v);
  return {{q[0] * p[0] - dot(u, v), w[0], w[1], w[2]}};
}

/// sin(x) / x and (1 - cos(x)) / x^2, as functions of the square of x.
template <class T>
struct SineQuotients {
  T sine, versine;
};
/// Up to which square their series are precise to rounding.
inline constexpr double most_square_of_series = 0.1;
/// The series, for numbers T that are Real or lanes of it.
template <class Real, class T>
[[nodiscard]] constexpr SineQuotients<T> series_of_sine(const T& square) {
  // What is left out is 0.1^4 / 9! or 0.1^7 / 15!, a hundredth of the rounding.
  constexpr int terms = std::numeric_limits<Real>::digits <= 24 ? 3 : 6;
  const T one(Real(1));
  T sine = one, versine = one;
  for (int k = terms; k > 0; --k) {
    sine = one - square * T(Real(1) / static_cast<Real>(2 * k * (2 * k + 1))) * sine;
    versine = one - square * T(Real(1) / static_cast<Real>((2 * k + 1) * (2 * k + 2))) * versine;
  }
  return {sine, versine * T(Real(0.5))};
}
template <class Real>
[[nodiscard]] SineQuotients<Real> sine_quotients(const Real& square) {
  if (!(square > Real(most_square_of_series))) return series_of_sine<Real>(square);
  const Real x = std::sqrt(square);
  return {std::sin(x) / x, (1 - std::cos(x)) / square};
}

/// Moves a body for h at its velocity and a spin.
template <class Real>
void move(SolverState<Real, 2>& body, const Vector<Real, 1>& spin, const Real& h, Real& angle) {
  body.set_moved(body.moved() + body.v() * h);
  angle += spin[0] * h;
  const SineQuotients<Real> of = sine_quotients<Real>(angle * angle);
  body.quad[1][2] = of.sine * angle, body.quad[1][3] = of.versine * (angle * angle);
}
template <class Real>
void move(SolverState<Real, 3>& body, const Vector<Real, 3>& spin, const Real& h) {
  body.set_moved(body.moved() + body.v() * h);
  const Vector<Real, 3> half = spin * (h / 2);
  const SineQuotients<Real> of = sine_quotients<Real>(squared(half));
  const Vector<Real, 3> r = half * of.sine;
  body.set_turn(product(Vector<Real, 4>{{1 - of.versine * squared(half), r[0], r[1], r[2]}}, body.turn()));
}

}  // namespace continuo
