// continuo/methods/support/weighted_sum.hpp
// Sums of stages with weights known at compile time: zeros are skipped and the terms are written out by the compiler.
#pragma once
#include <array>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <utility>

#include <continuo/methods/support/simd_state.hpp>
#include <continuo/numerics/coefficient.hpp>
#include <continuo/numerics/state.hpp>

namespace continuo::detail {

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

/// Pointers to the units of the stages of a row, taken once before the loop over the units.
template <class R, State X>
using StagePointers = std::array<const Unit<X>*, R::count>;
template <class R, State X, std::size_t Slots>
[[nodiscard]] [[gnu::always_inline]] inline StagePointers<R, X> stages_of(const std::array<Kept<X>, Slots>& k) {
  return [&]<std::size_t... n>(std::index_sequence<n...>) __attribute__((always_inline)) {
    return StagePointers<R, X>{units_of<X>(k[R::place[n]])...};
  }(std::make_index_sequence<R::count>());
}

/// Unit i of the sum of the first Count terms of row R.
template <class R, State X, std::size_t Count = R::count>
[[nodiscard]] [[gnu::always_inline]] inline Unit<X> row_sum(const StagePointers<R, X>& k, std::size_t i) {
  if constexpr (Count == 0) {
    return Unit<X>{};
  } else {
    return [&]<std::size_t... n>(std::index_sequence<n...>) __attribute__((always_inline)) {
      return (... + (R::template weight<Scalar<X>, n>() * k[n][i]));
    }(std::make_index_sequence<Count>());
  }
}

/// |h sum_j row_j k_j| of one component.
template <class R, State X, std::size_t Slots>
[[nodiscard]] inline Scalar<X> size_of_sum(const std::array<Kept<X>, Slots>& k, const Scalar<X>& h, std::size_t i) {
  using std::abs;
  const Unit<X> sum = row_sum<R, X>(stages_of<R, X>(k), i / unit_width<X>);
  return abs(h * component<X>(sum, i % unit_width<X>));
}

/// y = x + h sum_j row_j k_j. The newest stage is added last and by itself: the rest of the sum does not have to wait
/// for it, so the way from one stage to the next is a product and a sum.
template <class R, State X, std::size_t Slots>
[[gnu::always_inline]] inline void advance(const X& x, const Scalar<X>& h, const std::array<Kept<X>, Slots>& k, X& y) {
  const auto stage = stages_of<R, X>(k);
  const Scalar<X> newest = h * R::template weight<Scalar<X>, R::count - 1>();
  for_each_unit(x, [&, from = x.data(), to = y.data()](std::size_t i) __attribute__((always_inline)) {
    const Unit<X> start = load<X>(from, i), last = newest * stage[R::count - 1][i];
    Unit<X> sum;
    if constexpr (R::count == 1) {
      sum = start + last;
    } else {
      sum = (start + h * row_sum<R, X, R::count - 1>(stage, i)) + last;
    }
    if constexpr (Packed<X>) {
      scatter<X>(sum, i, to);
    } else {
      to[i] = sum;
    }
  });
}

}  // namespace continuo::detail
