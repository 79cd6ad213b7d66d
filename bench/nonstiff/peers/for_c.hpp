// bench/nonstiff/peers/for_c.hpp
// A problem as the peers written in C call it: by pointers, without a copy.
#pragma once
#include <array>
#include <cstddef>

namespace continuo::bench {

template <class Problem>
void evaluate_by_pointers(double t, const double* x, double* dxdt) {
  using State = std::array<double, Problem::size>;
  Problem{}(t, *reinterpret_cast<const State*>(x), *reinterpret_cast<State*>(dxdt));
}

template <class Problem>
std::array<double, Problem::size> state_at(const double* x) {
  std::array<double, Problem::size> state;
  for (std::size_t i = 0; i < state.size(); ++i) state[i] = x[i];
  return state;
}

}  // namespace continuo::bench
