// The state of another number type: that of a state's dual or traced numbers.
#pragma once
#include <array>
#include <cstddef>
#include <tuple>
#include <vector>

#include <continuo/numerics/state.hpp>

namespace continuo {

namespace detail {
template <class X, class Number>
struct Rebound {
  using type = std::vector<Number>;
};
template <class X, class Number>
  requires requires { std::tuple_size<X>::value; }
struct Rebound<X, Number> {
  using type = std::array<Number, std::tuple_size<X>::value>;
};
}  // namespace detail

/// A state like X with components of another number type: an array of the same size, or a vector.
template <class X, class Number>
using ReboundState = typename detail::Rebound<X, Number>::type;

}  // namespace continuo
