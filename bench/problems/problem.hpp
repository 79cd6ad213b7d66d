// bench/problems/problem.hpp
// What the problems are written with.
#pragma once
#include <algorithm>
#include <array>
#include <cstddef>
#include <initializer_list>
#include <span>

#include <continuo/numerics/coefficient.hpp>

namespace continuo::bench {

/// The exact state at a time, which is this double to the last bit.
template <class X>
struct Reference {
  double t;
  X x;
};

/// The exact state of a problem at the end of its run.
template <class Problem>
typename Problem::State end_of() {
  const auto known = Problem::reference();
  return std::ranges::find(known, Problem::duration, [](const auto& reference) { return reference.t; })->x;
}

/// Numbers written once, in the scalar asked for: `in<Real>({0.994_c, 0, -2.00158510637908252240537862224_c})`.
template <class Real, std::size_t Size>
constexpr std::array<Real, Size> in(const Coefficient (&digits)[Size]) {
  std::array<Real, Size> numbers{};
  for (std::size_t i = 0; i < Size; ++i) numbers[i] = digits[i].template as<Real>();
  return numbers;
}
template <class Real>
constexpr Real in(const Coefficient& digits) {
  return digits.as<Real>();
}

/// The entries of a small matrix, row by row.
template <class S>
void write(std::span<S> rows, std::initializer_list<S> entries) {
  std::copy(entries.begin(), entries.end(), rows.begin());
}

}  // namespace continuo::bench
