// continuo/methods/symplectic/yoshida6.hpp
#pragma once
#include <string_view>

#include <continuo/methods/symplectic/symplectic_composition.hpp>

namespace continuo {

/// Seven steps of velocity Verlet that make one of order 6, symplectic and symmetric: solution A of H. Yoshida,
/// "Construction of higher order symplectic integrators", Phys. Lett. A 150 (1990) 262-268; there to 15 digits, here
/// the solution of the same equations to 45.
struct Yoshida6 : SymplecticComposition<Yoshida6> {
  static constexpr std::string_view name = "yoshida6";
  static constexpr int order = 6;
  static constexpr int dense_degree = 7, dense_order = 5, dense_rounds = 1;
  static constexpr SymplecticTableau<8> tableau = symmetric_composition(
      {0.7845136104775572638194976338663498757768244175_c, 0.2355732133593581336847931829785346016864680821_c,
       -1.177679984178871006946415680964315734639269253_c, 1.315186320683911218884249728238862514351953506_c});
};

}  // namespace continuo
