// continuo/methods/weighted_sum.hpp
// Sums of stages with weights known at compile time: zeros are skipped, the terms are written out by the compiler, and
// the loop over the components is unrolled for small fixed sizes and left to the vectoriser for the others.
#pragma once
#include <array>
#include <concepts>
#include <cstddef>
#include <tuple>
#include <utility>

#include <continuo/numerics/coefficient.hpp>
#include <continuo/numerics/state.hpp>

namespace continuo::detail {

/// The number of components is part of the type.
template <class X>
concept FixedSize = State<X> && requires { std::tuple_size<X>::value; };

/// body(i) for every component. The states that body reads and writes must not overlap.
template <State X, class Body>
inline void for_each_component(const X& x, Body&& body) {
  if constexpr (FixedSize<X> && requires { requires std::tuple_size<X>::value <= 8; }) {
    [&]<std::size_t... i>(std::index_sequence<i...>) {
      (body(i), ...);
    }(std::make_index_sequence<std::tuple_size<X>::value>());
  } else {
    const std::size_t size = dimension(x);
#if !defined(__clang__)  // which checks for overlap once, before the loop, and has no such word
#pragma GCC ivdep
#endif
    for (std::size_t i = 0; i < size; ++i) body(i);
  }
}

/// A row of coefficients: `Source` is a captureless function object, j -> Coefficient, for j < Size.
template <class Source, std::size_t Size>
struct Row {
  static constexpr std::size_t count = [] {
    std::size_t n = 0;
    for (std::size_t j = 0; j < Size; ++j) n += Source{}(j).is_zero() ? 0 : 1;
    return n;
  }();
  /// The places of the coefficients that are not zero.
  static constexpr std::array<std::size_t, count> place = [] {
    std::array<std::size_t, count> result{};
    std::size_t n = 0;
    for (std::size_t j = 0; j < Size; ++j) {
      if (!Source{}(j).is_zero()) result[n++] = j;
    }
    return result;
  }();

  /// Coefficient n of those that are not zero, as it multiplies a `Real`.
  template <class Real, std::size_t n>
  static decltype(auto) weight() {
    using Value = CoefficientOf<Real>;
    if constexpr (std::floating_point<Value>) {
      constexpr Value value = Source{}(place[n]).template as<Value>();
      return Value(value);
    } else {
      static const Value value = Source{}(place[n]).template as<Value>();
      return static_cast<const Value&>(value);
    }
  }
};

/// Pointers to the stages of a row, taken once before the loop over the components.
template <class R, class Stages>
inline auto pointers(const Stages& k) {
  using Real = typename Stages::value_type::value_type;
  return [&]<std::size_t... n>(std::index_sequence<n...>) {
    return std::array<const Real*, R::count>{k[R::place[n]].data()...};
  }(std::make_index_sequence<R::count>());
}

/// Component i of the sum of the terms First..Last-1 of row R.
template <class R, std::size_t First, std::size_t Last, class Real>
inline Real partial_sum(const std::array<const Real*, R::count>& k, std::size_t i) {
  return [&]<std::size_t... n>(std::index_sequence<n...>) {
    return (... + (R::template weight<Real, First + n>() * k[First + n][i]));
  }(std::make_index_sequence<Last - First>());
}

/// Component i of the sum of row R.
template <class R, class Real>
inline Real row_sum(const std::array<const Real*, R::count>& k, std::size_t i) {
  if constexpr (R::count == 0) {
    return Real(0);
  } else {
    return partial_sum<R, 0, R::count, Real>(k, i);
  }
}

/// y = x + h sum_j row_j k_j. The newest stage is added last and by itself: the rest of the sum does not have to wait
/// for it, so the way from one stage to the next is a product and a sum.
template <class R, State X, class Stages>
inline void advance(const X& x, const Scalar<X>& h, const Stages& k, X& y) {
  using Real = Scalar<X>;
  const auto stage = pointers<R>(k);
  const Real newest = h * R::template weight<Real, R::count - 1>();
  for_each_component(x, [&, from = x.data(), to = y.data()](std::size_t i) {
    if constexpr (R::count == 1) {
      to[i] = from[i] + newest * stage[0][i];
    } else {
      to[i] = (from[i] + h * partial_sum<R, 0, R::count - 1, Real>(stage, i)) + newest * stage[R::count - 1][i];
    }
  });
}

}  // namespace continuo::detail
