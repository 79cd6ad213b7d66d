// continuo/methods/nystrom/pairs.hpp
// Positions and velocities of q'' = a(t, q) for the Runge-Kutta-Nystrom steppers. Of a state kept in registers they are
// put in the order of the pairs, positions for themselves and velocities for themselves, so that a register holds what
// is treated alike and never has to wait for numbers that were stored one by one. Any other state is left as it is.
#pragma once
#include <array>
#include <cstddef>
#include <tuple>

#include <continuo/methods/support/simd_state.hpp>
#include <continuo/methods/support/weighted_sum.hpp>
#include <continuo/system/second_order.hpp>

namespace continuo::detail {

/// How one number for each pair is kept: in the order of the pairs, or in the places of the velocities.
template <State X>
struct OnePerPair {
  using type = X;
};
template <Packed X>
struct OnePerPair<X> {
  using type = std::array<Scalar<X>, std::tuple_size<X>::value / 2>;
};
template <State X>
using PerPair = typename OnePerPair<X>::type;

template <State X>
using Accelerations = Kept<PerPair<X>>;

template <State X>
[[nodiscard]] Accelerations<X> no_accelerations(const X& x) {
  if constexpr (Packed<X>) {
    static_cast<void>(x);
    return keep(PerPair<X>{});
  } else {
    return x;
  }
}

/// Of pair n.
template <State X>
[[nodiscard]] Scalar<X> acceleration(const Accelerations<X>& k, std::size_t n, PositionVelocity pair) {
  if constexpr (Packed<X>) {
    constexpr std::size_t width = unit_width<PerPair<X>>;
    static_cast<void>(pair);
    return component<PerPair<X>>(units_of<PerPair<X>>(k)[n / width], n % width);
  } else {
    static_cast<void>(n);
    return k.data()[pair.velocity];
  }
}

/// The member `part` of each pair of x.
template <class System, Packed X>
[[nodiscard]] [[gnu::always_inline]] inline Accelerations<X> pick(const System& system, const X& x,
                                                                  std::size_t PositionVelocity::* part) {
  PerPair<X> result{};
  const std::size_t pairs = system.pair_count(x.size());
  for (std::size_t n = 0; n < result.size() && n < pairs; ++n) result[n] = x[system.pair(n, x.size()).*part];
  return keep(result);
}

template <class System, State X>
[[gnu::always_inline]] inline void evaluate_accelerations(System& system, const Scalar<X>& t, const X& x,
                                                          Accelerations<X>& k) {
  if constexpr (Packed<X>) {
    X local{};
    evaluate(system, t, x, local);
    k = pick(system, local, &PositionVelocity::velocity);
  } else {
    evaluate(system, t, x, k);
  }
}

/// The state a step starts from.
template <State X>
struct StartOfPairs {
  const X& x;
};
template <Packed X>
struct StartOfPairs<X> {
  Accelerations<X> position, velocity;
};
template <class System, State X>
[[nodiscard]] [[gnu::always_inline]] inline StartOfPairs<X> start_of_pairs(const System& system, const X& x) {
  if constexpr (Packed<X>) {
    return {pick(system, x, &PositionVelocity::position), pick(system, x, &PositionVelocity::velocity)};
  } else {
    return {x};
  }
}

/// to[part of each pair] = rule(position, velocity at the start, i), where i is the place of the pair's accelerations;
/// all of them a unit at a time.
template <class System, State X, class Rule>
[[gnu::always_inline]] inline void set_pairs(const System& system, const StartOfPairs<X>& start, X& to,
                                             std::size_t PositionVelocity::* part, Rule&& rule) {
  const std::size_t size = dimension(to), pairs = system.pair_count(size);
  if constexpr (Packed<X>) {
    using P = PerPair<X>;
    P result{};
    const auto* position = units_of<P>(start.position);
    const auto* velocity = units_of<P>(start.velocity);
    for (std::size_t i = 0; i * unit_width<P> < result.size(); ++i) {
      const Unit<P> unit = rule(position[i], velocity[i], i);
      if constexpr (Packed<P>) {
        scatter<P>(unit, i, result.data());
      } else {
        result[i] = unit;
      }
    }
    for (std::size_t n = 0; n < result.size() && n < pairs; ++n) to[system.pair(n, size).*part] = result[n];
  } else {
    for (std::size_t n = 0; n < pairs; ++n) {
      const PositionVelocity pair = system.pair(n, size);
      to.data()[pair.*part] = rule(start.x.data()[pair.position], start.x.data()[pair.velocity], pair.velocity);
    }
  }
}

}  // namespace continuo::detail
