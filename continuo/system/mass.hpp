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

/// Whether M is not the identity. A type whose values differ in this (a model that may have algebraic equations) says
/// so by a member has_mass().
template <State X, class F>
[[nodiscard]] bool has_mass(const F& system) {
  if constexpr (requires {
                  { system.has_mass() } -> std::convertible_to<bool>;
                }) {
    return system.has_mass();
  } else {
    return HasMassMatrix<F, X> || HasMassDiagonal<F, X>;
  }
}

/// Whether component i is the unknown of an algebraic equation: row and column i of M are zero. Only a diagonal says
/// so.
template <State X, class F>
[[nodiscard]] bool is_algebraic(const F& system, std::size_t i) {
  if constexpr (HasMassDiagonal<F, X>) {
    return has_mass<X>(system) && system.mass(i) == Scalar<X>(0);
  } else {
    return false;
  }
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
    if (!has_mass<X>(system)) return;
    for (std::size_t i = 0; i < n; ++i)
      f.data()[i] = is_algebraic<X>(system, i) ? Real(0) : f.data()[i] / system.mass(i);
  }
}

}  // namespace continuo
