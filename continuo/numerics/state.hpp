// continuo/numerics/state.hpp
// What may serve as the state x of a system: `std::array<double, 3>` (registers, no heap), `std::vector<double>`
// (size known at run time), an Eigen vector, or any copyable type with contiguous components.
#pragma once
#include <cmath>
#include <concepts>
#include <cstddef>
#include <span>
#include <tuple>
#include <type_traits>

namespace continuo {

/// A copyable block of components of one scalar type, contiguous in memory. The scalar is a real number or behaves like
/// one; it is neither a whole number nor complex.
template <class X>
concept State = std::copyable<X> && requires(X& x, const X& constant) {
  typename X::value_type;
  { x.data() } -> std::convertible_to<typename X::value_type*>;
  { constant.data() } -> std::convertible_to<const typename X::value_type*>;
  { constant.size() } -> std::convertible_to<std::size_t>;
  requires !std::integral<typename X::value_type>;
};

/// A state whose size is part of its type.
template <class X>
concept FixedSize = State<X> && requires { std::tuple_size<X>::value; };

/// The scalar of a state: float, double, long double, a quad type, a dual number or Lanes<double, W>.
template <State X>
using Scalar = typename X::value_type;

/// The number of components.
template <State X>
[[nodiscard]] constexpr std::size_t dimension(const X& x) {
  return static_cast<std::size_t>(x.size());
}

/// The components as a span.
template <State X>
[[nodiscard]] constexpr std::span<const Scalar<X>> components(const X& x) {
  return {x.data(), dimension(x)};
}
template <State X>
[[nodiscard]] constexpr std::span<Scalar<X>> components(X& x) {
  return {x.data(), dimension(x)};
}

/// The root of the sum of the squares of the components. Overflows where a square does.
template <State X>
[[nodiscard]] Scalar<X> euclidean_norm(const X& x) {
  using std::sqrt;
  Scalar<X> sum(0);
  for (std::size_t i = 0; i < dimension(x); ++i) sum += x.data()[i] * x.data()[i];
  return sqrt(sum);
}

}  // namespace continuo
