// continuo/methods/symplectic/kahan_li8.hpp
#pragma once
#include <string_view>

#include <continuo/methods/symplectic/symplectic_composition.hpp>

namespace continuo {

/// Seventeen steps of velocity Verlet that make one of order 8, symplectic and symmetric.
/// W. Kahan, R.-C. Li, "Composition constants for raising the orders of unconventional schemes for ordinary
/// differential equations", Math. Comp. 66 (1997) 1089-1099, s17odr8a, there to 26 digits, here the nearest solution of
/// the order conditions to 46.
struct KahanLi8 : SymplecticComposition<KahanLi8> {
  static constexpr std::string_view name = "kahan_li8";
  static constexpr int order = 8;
  static constexpr int dense_degree = 9, dense_order = 7, dense_rounds = 2;
  static constexpr SymplecticTableau<18> tableau = symmetric_composition(
      {0.1302024830888900808788176320967005223572472338_c, 0.5611629817751083845619644077001505672661593543_c,
       -0.3894749626448472864080785982352483888360680468_c, 0.1588419065551556008962107457071524814121478094_c,
       -0.3959038941332375773362315393479389360267714854_c, 0.1845396409783157070918325415333754628189873442_c,
       0.258374387686322047293979109994939471813076209_c, 0.2950117236093102988709662402182281129765432303_c,
       -0.6055085338300345116989210793347185875626432977_c});
};

}  // namespace continuo
