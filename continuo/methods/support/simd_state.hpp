// continuo/methods/support/simd_state.hpp
// How a stepper keeps and walks a state. A small array of float or double is kept as SIMD registers of 16 bytes (every
// machine we run on has them), so that two or four components cost one instruction; any other state is kept as it is.
// The steppers are written once, over "units": a unit is a register of components, or one component.
//
// f writes components one by one; a register loaded from where they were just written would have to wait for the
// stores. Therefore f writes to a local state, and what is kept is put together from registers.
#pragma once
#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstring>
#include <tuple>
#include <type_traits>
#include <utility>

#include <continuo/methods/method.hpp>
#include <continuo/numerics/state.hpp>
#include <continuo/system/system.hpp>

namespace continuo::detail {

/// The number of components is part of the type.
template <class X>
concept FixedSize = State<X> && requires { std::tuple_size<X>::value; };

template <class Real>
struct Register;  // none, but for
template <>
struct Register<double> {
  using type [[gnu::vector_size(16)]] = double;
  using bits [[gnu::vector_size(16)]] = long long;
  static constexpr std::size_t width = 2;
  static constexpr long long without_sign = 0x7fffffffffffffff;
};
template <>
struct Register<float> {
  using type [[gnu::vector_size(16)]] = float;
  using bits [[gnu::vector_size(16)]] = int;
  static constexpr std::size_t width = 4;
  static constexpr int without_sign = 0x7fffffff;
};

/// States kept in registers: beyond some twelve components code and spills grow faster than what is won.
template <class X>
concept Packed = FixedSize<X> && (std::is_same_v<Scalar<X>, double> || std::is_same_v<Scalar<X>, float>) &&
                 requires { requires std::tuple_size<X>::value >= 2 && std::tuple_size<X>::value <= 12; };

/// A packed state; the components beyond the last are zero.
template <Packed X>
struct SimdState {
  using Unit = typename Register<Scalar<X>>::type;
  static constexpr std::size_t size = std::tuple_size<X>::value, width = Register<Scalar<X>>::width;
  static constexpr std::size_t units = (size + width - 1) / width;
  Unit unit[units];
};

/// What is kept of a derivative, and its units.
template <State X>
struct Keeping {
  using Kept = X;
  using Unit = Scalar<X>;
};
template <Packed X>
struct Keeping<X> {
  using Kept = SimdState<X>;
  using Unit = typename SimdState<X>::Unit;
};
template <State X>
using Kept = typename Keeping<X>::Kept;
template <State X>
using Unit = typename Keeping<X>::Unit;

template <State X>
[[nodiscard]] const Unit<X>* units_of(const Kept<X>& x) {
  if constexpr (Packed<X>) {
    return x.unit;
  } else {
    return x.data();
  }
}

/// The components first, first + 1, ... of x in a register, `beyond` behind the last one; and back. One by one: a state
/// that f reads or writes stays in registers that way.
template <Packed X>
[[nodiscard]] [[gnu::always_inline]] inline Unit<X> gather(const Scalar<X>* x, std::size_t i, Scalar<X> beyond) {
  return [&]<std::size_t... j>(std::index_sequence<j...>) __attribute__((always_inline)) {
    const std::size_t first = i * SimdState<X>::width;
    return Unit<X>{(first + j < SimdState<X>::size ? x[first + j] : beyond)...};
  }(std::make_index_sequence<SimdState<X>::width>());
}
template <Packed X>
[[gnu::always_inline]] inline void scatter(const Unit<X>& unit, std::size_t i, Scalar<X>* x) {
  [&]<std::size_t... j>(std::index_sequence<j...>) __attribute__((always_inline)) {
    const std::size_t first = i * SimdState<X>::width;
    ((first + j < SimdState<X>::size ? void(x[first + j] = unit[j]) : void()), ...);
  }(std::make_index_sequence<SimdState<X>::width>());
}

/// Unit i of a state in memory, read and written in one piece where it is whole.
template <State X>
[[nodiscard]] [[gnu::always_inline]] inline Unit<X> load(const Scalar<X>* from, std::size_t i) {
  if constexpr (Packed<X>) {
    Unit<X> result;
    const std::size_t first = i * SimdState<X>::width;
    if (first + SimdState<X>::width > SimdState<X>::size) return gather<X>(from, i, Scalar<X>(0));
    std::memcpy(&result, from + first, sizeof result);
    return result;
  } else {
    return from[i];
  }
}
template <State X>
[[gnu::always_inline]] inline void store(const Unit<X>& unit, std::size_t i, Scalar<X>* to) {
  if constexpr (Packed<X>) {
    const std::size_t first = i * SimdState<X>::width;
    if (first + SimdState<X>::width > SimdState<X>::size) return scatter<X>(unit, i, to);
    std::memcpy(to + first, &unit, sizeof unit);
  } else {
    to[i] = unit;
  }
}

/// body(i) for every unit. The states that body reads and writes must not overlap.
template <State X, class Body>
[[gnu::always_inline]] inline void for_each_unit(const X& x, Body&& body) {
  if constexpr (Packed<X>) {
    [&]<std::size_t... i>(std::index_sequence<i...>)
        __attribute__((always_inline)) { (body(i), ...); }(std::make_index_sequence<SimdState<X>::units>());
  } else {
    const std::size_t size = dimension(x);
#if !defined(__clang__)  // which checks for overlap once, before the loop, and has no such word
#pragma GCC ivdep
#endif
    for (std::size_t i = 0; i < size; ++i) body(i);
  }
}

/// A state as it is kept, and back.
template <State X>
[[nodiscard]] [[gnu::always_inline]] inline Kept<X> keep(const X& x) {
  if constexpr (Packed<X>) {
    SimdState<X> result;
    for (std::size_t i = 0; i < SimdState<X>::units; ++i) result.unit[i] = gather<X>(x.data(), i, Scalar<X>(0));
    return result;
  } else {
    return x;
  }
}
template <State X>
decltype(auto) unpack(const Kept<X>& kept) {
  if constexpr (Packed<X>) {
    X result{};
    for (std::size_t i = 0; i < SimdState<X>::units; ++i) scatter<X>(kept.unit[i], i, result.data());
    return result;
  } else {
    return (kept);
  }
}

/// f(t, x), kept.
template <State X, class System>
[[gnu::always_inline]] inline void evaluate_kept(System& system, const Scalar<X>& t, const X& x, Kept<X>& derivative) {
  if constexpr (Packed<X>) {
    X local{};
    evaluate(system, t, x, local);
    derivative = keep(local);
  } else {
    evaluate(system, t, x, derivative);
  }
}

template <State X>
inline constexpr std::size_t unit_width = [] {
  if constexpr (Packed<X>) {
    return SimdState<X>::width;
  } else {
    return std::size_t{1};
  }
}();

/// Component i of a unit.
template <State X>
[[nodiscard]] Scalar<X> component(const Unit<X>& unit, std::size_t i) {
  if constexpr (Packed<X>) {
    return unit[i];
  } else {
    return unit;
  }
}

/// 1 / n, a constant where the size is: the mean of squares stands between one step and the next.
template <State X>
[[nodiscard]] Scalar<X> one_over_dimension(const X& x) {
  if constexpr (FixedSize<X>) {
    static_cast<void>(x);
    return Scalar<X>(1.0 / static_cast<double>(std::max<std::size_t>(std::tuple_size<X>::value, 1)));
  } else {
    return Scalar<X>(1.0 / static_cast<double>(std::max<std::size_t>(dimension(x), 1)));
  }
}

/// The sum of the components of a unit.
template <State X>
[[nodiscard]] Scalar<X> total(const Unit<X>& unit) {
  if constexpr (Packed<X>) {
    Scalar<X> sum = unit[0];
    for (std::size_t i = 1; i < SimdState<X>::width; ++i) sum += unit[i];
    return sum;
  } else {
    return unit;
  }
}

/// The size of each component.
template <State X>
[[nodiscard]] [[gnu::always_inline]] inline Unit<X> sizes(const Unit<X>& u) {
  if constexpr (Packed<X>) {
    using Bits = typename Register<Scalar<X>>::bits;
    return std::bit_cast<Unit<X>>(std::bit_cast<Bits>(u) & Register<Scalar<X>>::without_sign);
  } else {
    using std::abs;
    return abs(u);
  }
}

/// What an error is measured against (Tolerance::scale) for a unit; 1 beyond the last component.
template <State X>
[[nodiscard]] [[gnu::always_inline]] inline Unit<X> error_scale(const Tolerance<Scalar<X>>& tolerance, std::size_t i,
                                                                const X& x, const X& x_new) {
  if constexpr (Packed<X>) {
    std::array<Scalar<X>, SimdState<X>::size> atol, rtol;
    for (std::size_t j = 0; j < SimdState<X>::size; ++j) {
      atol[j] = tolerance.atol_each ? tolerance.atol_each[j] : tolerance.atol;
      rtol[j] = tolerance.rtol_each ? tolerance.rtol_each[j] : tolerance.rtol;
    }
    const Unit<X> start = sizes<X>(load<X>(x.data(), i));
    const Unit<X> end = sizes<X>(load<X>(x_new.data(), i));
    return gather<X>(atol.data(), i, 1) + gather<X>(rtol.data(), i, 0) * (start < end ? end : start);
  } else {
    return tolerance.scale(i, x.data()[i], x_new.data()[i]);
  }
}
/// The same of a step (Tolerance::scale_of_step).
template <State X>
[[nodiscard]] [[gnu::always_inline]] inline Unit<X> step_scale(const Tolerance<Scalar<X>>& tolerance, std::size_t i,
                                                               const X& x, const X& x_new) {
  const Unit<X> change = load<X>(x_new.data(), i) - load<X>(x.data(), i);
  return error_scale<X>(tolerance, i, x, x_new) + tolerance.rounding_of_time * sizes<X>(change);
}

}  // namespace continuo::detail
