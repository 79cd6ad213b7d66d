// Gauss of order 4: two stages, symplectic, time-symmetric, A-stable. For Hamiltonian systems that do not separate,
// with a fixed step; its equations are solved to a thousandth of the tolerance, so a tight rtol keeps the invariants
// tightly. E. Hairer, C. Lubich, G. Wanner, "Geometric Numerical Integration", II.1.3 and VI.4.
#pragma once
#include <string_view>

#include <continuo/methods/collocation/collocation.hpp>

namespace continuo {

struct Gauss4 : CollocationMethod<collocation::Nodes::gauss, 2> {
  static constexpr std::string_view name = "gauss4";
};

}  // namespace continuo
