// tests/hybrid/jet.hpp
// A quantity along the motion with its first three derivatives in time, as Taylor coefficients in long double.
#pragma once
#include <array>
#include <cmath>
#include <cstddef>

namespace continuo::hybrid {

using Real = long double;

/// f(t + h) = c[0] + c[1] h + c[2] h^2 + c[3] h^3 + ...
struct Jet {
  std::array<Real, 4> c{};

  static Jet constant(Real value) { return {{value, 0, 0, 0}}; }
  Real value() const { return c[0]; }
  Real slope() const { return c[1]; }
};

inline Jet operator+(const Jet& a, const Jet& b) {
  return {{a.c[0] + b.c[0], a.c[1] + b.c[1], a.c[2] + b.c[2], a.c[3] + b.c[3]}};
}

inline Jet operator-(const Jet& a, const Jet& b) {
  return {{a.c[0] - b.c[0], a.c[1] - b.c[1], a.c[2] - b.c[2], a.c[3] - b.c[3]}};
}

inline Jet operator*(Real s, const Jet& a) {
  return {{s * a.c[0], s * a.c[1], s * a.c[2], s * a.c[3]}};
}

inline Jet operator*(const Jet& a, const Jet& b) {
  return {{a.c[0] * b.c[0], a.c[0] * b.c[1] + a.c[1] * b.c[0], a.c[0] * b.c[2] + a.c[1] * b.c[1] + a.c[2] * b.c[0],
           a.c[0] * b.c[3] + a.c[1] * b.c[2] + a.c[2] * b.c[1] + a.c[3] * b.c[0]}};
}

/// Sine and cosine together: s' = c u', c' = -s u', compared coefficient by coefficient.
struct SineCosine {
  Jet sine, cosine;
};

inline SineCosine sine_cosine(const Jet& u) {
  SineCosine r{Jet::constant(std::sin(u.c[0])), Jet::constant(std::cos(u.c[0]))};
  for (std::size_t k = 1; k < 4; ++k) {
    Real s = 0, c = 0;
    for (std::size_t i = 1; i <= k; ++i) {
      s += static_cast<Real>(i) * u.c[i] * r.cosine.c[k - i];
      c -= static_cast<Real>(i) * u.c[i] * r.sine.c[k - i];
    }
    r.sine.c[k] = s / static_cast<Real>(k);
    r.cosine.c[k] = c / static_cast<Real>(k);
  }
  return r;
}

/// The u with u + u^3 = s: the value by Newton's method, which converges from anywhere as u + u^3 is increasing and the
/// start lies beyond the root; the coefficients from u' (1 + 3 u^2) = s' and its derivatives.
inline Jet cubic_root(const Jet& s) {
  Real u = std::cbrt(s.c[0]);
  for (int i = 0; i < 100; ++i) {
    const Real next = u - (u + u * u * u - s.c[0]) / (1 + 3 * u * u);
    if (next == u) break;
    u = next;
  }
  const Real d = 1 + 3 * u * u;
  Jet r = Jet::constant(u);
  r.c[1] = s.c[1] / d;
  // (u^3)_2 = 3 u^2 u_2 + 3 u u_1^2 and (u^3)_3 = 3 u^2 u_3 + 6 u u_1 u_2 + u_1^3
  r.c[2] = (s.c[2] - 3 * u * r.c[1] * r.c[1]) / d;
  r.c[3] = (s.c[3] - 6 * u * r.c[1] * r.c[2] - r.c[1] * r.c[1] * r.c[1]) / d;
  return r;
}

}  // namespace continuo::hybrid
