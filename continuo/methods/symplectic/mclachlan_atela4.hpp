// continuo/methods/symplectic/mclachlan_atela4.hpp
#pragma once
#include <string_view>

#include <continuo/methods/symplectic/symplectic_composition.hpp>

namespace continuo {

/// The optimal method of order 4 with four accelerations a step for q'' = a(t, q), symplectic, not symmetric.
/// R. I. McLachlan, P. Atela, "The accuracy of symplectic integrators", Nonlinearity 5 (1992) 541-562; there to 19
/// digits, here the nearest solution of the order conditions to 46.
struct McLachlanAtela4 : SymplecticComposition<McLachlanAtela4> {
  static constexpr std::string_view name = "mclachlan_atela4";
  static constexpr int order = 4;
  static constexpr SymplecticTableau<4> tableau{
      .kick = {0.1344961992774310892055064604585957388524078874_c, -0.2248198030794208058171809489467871171358210835_c,
               0.7563200005156682911124975448405539605293661191_c, 0.3340036032863214254991769436476374177540470771_c},
      .drift = {
          0.5153528374311229364001750586248288441894529494_c, -0.08578201941297364607000340696020795067650442038_c,
          0.4415830236164665242530612821822822941240008645_c, 0.1288461583653841854167670661530968123630506065_c}};
};

}  // namespace continuo
