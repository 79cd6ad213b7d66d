// What a surface that never moves must be: enough facets, of finite numbers, each with a length or an area.
#pragma once
#include <array>

#include <continuo/shapes/mesh_shape.hpp>
#include <continuo/status/status.hpp>

namespace continuo {

/// Whether corners are finite, and make a facet: the height over its longest side is more than rounding.
template <class Real, int Dim>
[[nodiscard]] bool is_facet(const std::array<Vector<Real, Dim>, static_cast<std::size_t>(Dim)>& corners);

/// Fails for a surface without facets, for numbers that are not finite, and for facets without length or area; the
/// message says which, counted from 0. O(n).
/// @{
template <class Real>
[[nodiscard]] Status check(const Chain<Real>& chain);
template <class Real>
[[nodiscard]] Status check(const TriangleMesh<Real>& mesh);
template <class Real, int Dim>
[[nodiscard]] Status check(const HeightField<Real, Dim>& field);
/// @}

}  // namespace continuo
