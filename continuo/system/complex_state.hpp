// continuo/system/complex_state.hpp
// A state of complex components. To the methods it is its real and imaginary parts, one after the other, so that
// errors, tolerances and Jacobians are those of the parts:
//
//   using X = ComplexState<std::array<std::complex<double>, 1>>;
//   const auto rotation = [](double, const X& x) { return X{x[0] * std::complex(0.0, 1.0)}; };
//   solve(rotation, X{1.0}, {0, 10}, Dop853{});
//
// The container may be any array or vector of std::complex in contiguous memory.
#pragma once
#include <complex>
#include <cstddef>

namespace continuo {

/// A container of std::complex as a state of twice as many real components.
template <class Container>
struct ComplexState {
  using Number = typename Container::value_type;
  using value_type = typename Number::value_type;
  static_assert(sizeof(Number) == 2 * sizeof(value_type), "the container must contain std::complex");

  Container z;  // the complex components

  // An array of std::complex may be read as one of its parts: [complex.numbers.general] of the C++ standard.
  /// The parts, real and imaginary in turn.
  /// @{
  [[nodiscard]] value_type* data() { return reinterpret_cast<value_type*>(z.data()); }
  [[nodiscard]] const value_type* data() const { return reinterpret_cast<const value_type*>(z.data()); }
  /// @}
  /// The number of parts: twice that of the components.
  [[nodiscard]] std::size_t size() const { return 2 * static_cast<std::size_t>(z.size()); }

  /// Component i.
  /// @{
  [[nodiscard]] Number& operator[](std::size_t i) { return z.data()[i]; }
  [[nodiscard]] const Number& operator[](std::size_t i) const { return z.data()[i]; }
  /// @}
};

}  // namespace continuo
