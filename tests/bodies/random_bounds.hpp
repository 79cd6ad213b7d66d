// Random bounds of many kinds, and pairs of them.
#pragma once
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <random>
#include <utility>
#include <vector>

#include <continuo/bodies/bounds/bounds.hpp>

namespace continuo::bounds_test {

using Pairs = std::vector<std::pair<std::uint32_t, std::uint32_t>>;

template <class Real>
inline constexpr Real infinity = std::numeric_limits<Real>::infinity();
template <class Real>
inline constexpr Real nan = std::numeric_limits<Real>::quiet_NaN();

enum class Kind { uniform, six_decades, one_point, line, unbounded, empty, all_empty };
inline constexpr Kind kinds[] = {Kind::uniform,   Kind::six_decades, Kind::one_point, Kind::line,
                                 Kind::unbounded, Kind::empty,       Kind::all_empty};

template <class Real, int Dim>
Bounds<Real, Dim> around(const Vector<Real, Dim>& x, Real size) {
  return grown(Bounds<Real, Dim>{x, x}, size);
}

template <class Real, int Dim>
Bounds<Real, Dim> random_bounds(std::mt19937& engine, Kind kind) {
  std::uniform_real_distribution<Real> uniform(-1, 1);
  Vector<Real, Dim> x;
  for (std::size_t axis = 0; axis < x.size(); ++axis) x[axis] = kind == Kind::one_point ? Real(2) : uniform(engine);
  if (kind == Kind::line)
    for (std::size_t axis = 1; axis < x.size(); ++axis) x[axis] = 1;
  if (kind == Kind::six_decades) return around(x, std::pow(Real(10), -3 + 3 * uniform(engine)));
  Bounds<Real, Dim> box = around(x, Real(0.1) + Real(0.1) * uniform(engine));
  const std::size_t axis = engine() % x.size();
  if (kind == Kind::unbounded) {
    if (engine() % 4 == 0) box.upper[axis] = infinity<Real>;
    if (engine() % 8 == 0) box.lower[axis] = -infinity<Real>;
    if (engine() % 8 == 0) box.lower[axis] = nan<Real>;
    if (engine() % 8 == 0) box.upper[axis] = nan<Real>;
  }
  if (kind == Kind::all_empty || (kind == Kind::empty && engine() % 3 == 0)) std::swap(box.lower, box.upper);
  return box;
}
template <class Real, int Dim>
std::vector<Bounds<Real, Dim>> random_set(std::mt19937& engine, Kind kind, std::size_t count) {
  std::vector<Bounds<Real, Dim>> set(count);
  for (auto& box : set) box = random_bounds<Real, Dim>(engine, kind);
  return set;
}

}  // namespace continuo::bounds_test
