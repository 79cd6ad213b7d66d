// continuo/system/mass.hpp
// The mass of M x' = f(t, x) outside of implicit methods: whether there is one, and x' where M can be divided by.
#pragma once
#include <cstddef>
#include <span>
#include <vector>

#include <continuo/numerics/dense_lu.hpp>
#include <continuo/numerics/state.hpp>
#include <continuo/system/system.hpp>

namespace continuo {

template <class F, State X>
constexpr bool has_mass() {
  return HasMassMatrix<F, X> || HasMassDiagonal<F, X>;
}

/// f becomes M^-1 f. A component whose equation is algebraic becomes 0; of a full matrix that is singular, all do: its
/// x' is not known without solving for it.
template <class F, State X>
void divide_by_mass(const F& system, X& f) {
  using Real = Scalar<X>;
  const std::size_t n = dimension(f);
  if constexpr (HasMassMatrix<F, X>) {
    DenseLU<Real> mass(n);
    system.mass_matrix(std::span<Real>(mass.matrix()));
    if (mass.factor()) {
      mass.solve(f.data());
    } else {
      for (std::size_t i = 0; i < n; ++i) f.data()[i] = Real(0);
    }
  } else if constexpr (HasMassDiagonal<F, X>) {
    for (std::size_t i = 0; i < n; ++i)
      f.data()[i] = system.mass(i) == Real(0) ? Real(0) : f.data()[i] / system.mass(i);
  }
}

}  // namespace continuo
