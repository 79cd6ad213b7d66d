// The direction of a vector of any length.
#pragma once
#include <algorithm>
#include <cmath>

#include <continuo/numerics/vector.hpp>

namespace continuo {

/// The vector of length 1 in the direction of one that is finite, also where the squares of its components are beyond
/// the numbers; 0 of 0. The power of two by which it is scaled changes no digit of the result.
template <class Real, int Size>
[[nodiscard]] Vector<Real, Size> direction_of(Vector<Real, Size> v) {
  Real largest(0);
  for (const Real& part : v.components) largest = std::max(largest, std::abs(part));
  if (!(largest > Real(0))) return {};
  int exponent = 0;
  static_cast<void>(std::frexp(largest, &exponent));
  for (Real& part : v.components) part = std::ldexp(part, -exponent);
  return v * (1 / length(v));
}

}  // namespace continuo
