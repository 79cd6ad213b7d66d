// continuo/system/second_order.hpp
// Systems of the form q'' = a(t, q, v), v = q', made from the acceleration alone. The state is q, then v:
//
//   auto oscillator = second_order([](double t, const auto& q) { return std::array{-q[0]}; });
//   auto damped = second_order([](double t, const auto& q, const auto& v) { return std::array{-q[0] - 0.1 * v[0]}; });
//   auto chain = second_order([](double t, auto q, std::span<double> a) { for (...) a[i] = ...; });  // writes a
//
// For a fixed-size state q and v are `std::array`s of half its size, otherwise spans; a function that takes t, q (and
// v) returns the acceleration, one that takes a further argument and returns nothing writes it there.
#pragma once
#include <array>
#include <concepts>
#include <cstddef>
#include <span>
#include <string>
#include <tuple>
#include <type_traits>
#include <utility>

#include <continuo/numerics/state.hpp>
#include <continuo/system/system.hpp>

namespace continuo {

/// The system knows whether its accelerations ignore the velocities (x only tells the type of state). Methods for
/// x'' = a(t, x) then evaluate once where they would have to evaluate twice.
template <class F, class X>
concept KnowsIfVelocityCounts = requires(const F& f, const X& x) {
  { f.ignores_velocity(x) } -> std::convertible_to<bool>;
};

/// True only where the system says so.
template <class F, State X>
[[nodiscard]] bool ignores_velocity(const F& f, const X& x) {
  if constexpr (KnowsIfVelocityCounts<F, X>) {
    return f.ignores_velocity(x);
  } else {
    return false;
  }
}

/// body(position, velocity) for each pair of the system.
template <class F, State X, class Body>
void for_each_pair(const F& f, const X& x, Body&& body) {
  static_assert(SecondOrder<F>, "the system must say which components are positions and which velocities");
  const std::size_t size = dimension(x), count = f.pair_count(size);
  for (std::size_t n = 0; n < count; ++n) {
    const PositionVelocity pair = f.pair(n, size);
    body(pair.position, pair.velocity);
  }
}

/// A system of pairs (q, v) from the acceleration alone. The state has an even number of components: the positions,
/// then the velocities.
template <class Acceleration>
struct SecondOrderSystem {
  Acceleration acceleration;  // a(t, q) or a(t, q, v), as returned or as written

  /// dxdt = (v, a(t, q, v)).
  template <State X>
  void operator()(const Scalar<X>& t, const X& x, X& dxdt) {
    using Half = HalfOf<X>;
    const std::size_t n = dimension(x) / 2;
    const Half q = half(x, 0), v = half(x, n);
    for (std::size_t i = 0; i < n; ++i) dxdt.data()[i] = x.data()[n + i];
    if constexpr (std::invocable<Acceleration&, Scalar<X>, const Half&>) {
      put(acceleration(t, q), dxdt);
    } else if constexpr (std::invocable<Acceleration&, Scalar<X>, const Half&, OutOf<X>&>) {
      OutOf<X> out = room(dxdt);
      if constexpr (writes<X>()) {
        acceleration(t, q, out);
        put(out, dxdt);
      } else {
        put(acceleration(t, q, v), dxdt);
      }
    } else {
      OutOf<X> out = room(dxdt);
      acceleration(t, q, v, out);
      put(out, dxdt);
    }
  }

  /// Whether the acceleration can be called in one of the four ways.
  template <State X>
  [[nodiscard]] static consteval bool is_callable() {
    using Half = HalfOf<X>;
    using Out = OutOf<X>;
    return std::invocable<Acceleration&, Scalar<X>, const Half&> ||
           std::invocable<Acceleration&, Scalar<X>, const Half&, Out&> ||
           std::invocable<Acceleration&, Scalar<X>, const Half&, const Half&, Out&>;
  }
  /// Why there is no state of this size; empty where there is.
  [[nodiscard]] std::string size_problem(std::size_t size) const {
    if (size % 2 == 0) return {};
    return "a state of positions and velocities has an even number of components; this one has " + std::to_string(size);
  }
  /// The number of pairs: half the size of the state.
  [[nodiscard]] std::size_t pair_count(std::size_t size) const { return size / 2; }
  /// Pair i: components i and i + size / 2.
  [[nodiscard]] PositionVelocity pair(std::size_t i, std::size_t size) const { return {i, i + size / 2}; }

  /// Whether the acceleration takes no velocity.
  template <State X>
  [[nodiscard]] bool ignores_velocity(const X&) const {
    if constexpr (std::invocable<Acceleration&, Scalar<X>, const HalfOf<X>&>) {
      return true;
    } else if constexpr (std::invocable<Acceleration&, Scalar<X>, const HalfOf<X>&, OutOf<X>&>) {
      return writes<X>();
    } else {
      return false;
    }
  }

 private:
  template <class X>
  struct Halves {
    using In = std::span<const Scalar<X>>;
    using Out = std::span<Scalar<X>>;
  };
  template <class Real, std::size_t Size>
  struct Halves<std::array<Real, Size>> {
    static_assert(Size % 2 == 0, "a state of positions and velocities has an even number of components");
    using In = std::array<Real, Size / 2>;
    using Out = In;
  };
  template <class X>
  using HalfOf = typename Halves<X>::In;
  template <class X>
  using OutOf = typename Halves<X>::Out;

  template <State X>
  [[nodiscard]] static HalfOf<X> half(const X& x, std::size_t first) {
    if constexpr (requires { std::tuple_size<X>::value; }) {
      HalfOf<X> result;
      for (std::size_t i = 0; i < result.size(); ++i) result[i] = x[first + i];
      return result;
    } else {
      return HalfOf<X>(x.data() + first, dimension(x) / 2);
    }
  }
  /// Where the acceleration may be written: the span itself, or an array to be copied by `put`.
  template <State X>
  [[nodiscard]] static OutOf<X> room(X& dxdt) {
    if constexpr (requires { std::tuple_size<X>::value; }) {
      return OutOf<X>{};
    } else {
      return OutOf<X>(dxdt.data() + dimension(dxdt) / 2, dimension(dxdt) / 2);
    }
  }
  template <class From, State X>
  static void put(const From& from, X& dxdt) {
    const std::size_t n = dimension(dxdt) / 2;
    if (from.data() == dxdt.data() + n) return;
    if (from.size() != n) {
      detail::discard_result(dxdt, dxdt);
      return;
    }
    for (std::size_t i = 0; i < n; ++i) dxdt.data()[n + i] = from.data()[i];
  }
  template <class X>
  [[nodiscard]] static constexpr bool writes() {
    return std::is_void_v<std::invoke_result_t<Acceleration&, Scalar<X>, const HalfOf<X>&, OutOf<X>&>>;
  }
};

/// The system with state (q, v) of an acceleration a(t, q) or a(t, q, v).
template <class Acceleration>
[[nodiscard]] SecondOrderSystem<std::decay_t<Acceleration>> second_order(Acceleration&& acceleration) {
  return {std::forward<Acceleration>(acceleration)};
}

}  // namespace continuo
