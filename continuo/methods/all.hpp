// continuo/methods/all.hpp
// Every method there is, as a list of types:
//
//   for_each_method([]<class M>() { fmt::print("{} {}\n", M::name, M::order); });
#pragma once
#include <cstddef>
#include <tuple>
#include <utility>

#include <continuo/methods/automatic.hpp>
#include <continuo/methods/collocation/gauss4.hpp>
#include <continuo/methods/collocation/radau.hpp>
#include <continuo/methods/dirk/implicit_euler.hpp>
#include <continuo/methods/dirk/implicit_midpoint.hpp>
#include <continuo/methods/dirk/kencarp4.hpp>
#include <continuo/methods/dirk/kvaerno5.hpp>
#include <continuo/methods/dirk/tr_bdf2.hpp>
#include <continuo/methods/dirk/trapezoidal.hpp>
#include <continuo/methods/explicit_rk/bogacki_shampine3.hpp>
#include <continuo/methods/explicit_rk/dop853.hpp>
#include <continuo/methods/explicit_rk/dormand_prince5.hpp>
#include <continuo/methods/explicit_rk/explicit_euler.hpp>
#include <continuo/methods/explicit_rk/heun.hpp>
#include <continuo/methods/explicit_rk/midpoint.hpp>
#include <continuo/methods/explicit_rk/rk38.hpp>
#include <continuo/methods/explicit_rk/rk4.hpp>
#include <continuo/methods/explicit_rk/rkc2.hpp>
#include <continuo/methods/explicit_rk/tsitouras5.hpp>
#include <continuo/methods/explicit_rk/verner7.hpp>
#include <continuo/methods/explicit_rk/verner9.hpp>
#include <continuo/methods/extrapolation/odex.hpp>
#include <continuo/methods/extrapolation/seulex.hpp>
#include <continuo/methods/multistep/adams.hpp>
#include <continuo/methods/multistep/bdf.hpp>
#include <continuo/methods/multistep/bdf2.hpp>
#include <continuo/methods/nystrom/dormand_prince_nystrom12.hpp>
#include <continuo/methods/nystrom/dormand_prince_nystrom6.hpp>
#include <continuo/methods/nystrom/dormand_prince_nystrom8.hpp>
#include <continuo/methods/rosenbrock/rodas4.hpp>
#include <continuo/methods/rosenbrock/rodas5p.hpp>
#include <continuo/methods/rosenbrock/rosenbrock23.hpp>
#include <continuo/methods/structural/central_difference.hpp>
#include <continuo/methods/structural/generalized_alpha.hpp>
#include <continuo/methods/structural/newmark.hpp>
#include <continuo/methods/symplectic/kahan_li8.hpp>
#include <continuo/methods/symplectic/mclachlan_atela4.hpp>
#include <continuo/methods/symplectic/semi_implicit_euler.hpp>
#include <continuo/methods/symplectic/symplectic_euler_position_first.hpp>
#include <continuo/methods/symplectic/velocity_verlet.hpp>
#include <continuo/methods/symplectic/yoshida6.hpp>
#include <continuo/methods/taylor_series/taylor_series.hpp>

namespace continuo {

/// By family, then by order.
using ExplicitMethods =
    std::tuple<ExplicitEuler, SemiImplicitEuler, SymplecticEulerPositionFirst, CentralDifference, VelocityVerlet,
               Midpoint, Heun, Rk4, Rk38, BogackiShampine3, DormandPrince5, Tsitouras5, Dop853, Verner7, Verner9>;
/// For x'' = a(t, x).
using AccelerationMethods = std::tuple<McLachlanAtela4, Yoshida6, KahanLi8, DormandPrinceNystrom6,
                                       DormandPrinceNystrom8, DormandPrinceNystrom12>;
/// For structures, M x'' + C x' + K x = f.
using StructuralMethods = std::tuple<Newmark, GeneralizedAlpha>;
/// For stiff systems; all but Rkc2 are implicit and solve algebraic equations.
using StiffMethods = std::tuple<ImplicitEuler, Trapezoidal, ImplicitMidpoint, Bdf2, TrBdf2, KenCarp4, Kvaerno5, Rkc2,
                                Rosenbrock23, Rodas4, Rodas5P, Gauss4, Radau5, Radau, Bdf, Seulex>;
/// Those that take f as it is: not Taylor series, for which it must be fit for numbers of any type.
using PlainMethods = decltype(std::tuple_cat(ExplicitMethods{}, AccelerationMethods{}, StructuralMethods{},
                                             std::tuple<Adams, Odex>{}, StiffMethods{}, AutomaticMethods{}));
/// All methods, in the order of the catalogue.
using AllMethods =
    decltype(std::tuple_cat(ExplicitMethods{}, AccelerationMethods{}, StructuralMethods{},
                            std::tuple<Adams, Odex, TaylorSeries>{}, StiffMethods{}, AutomaticMethods{}));

/// Calls visit.template operator()<M>() for every method M of the list.
template <class Methods = AllMethods, class Visit>
void for_each_method(Visit&& visit) {
  [&]<std::size_t... i>(std::index_sequence<i...>) {
    (visit.template operator()<std::tuple_element_t<i, Methods>>(), ...);
  }(std::make_index_sequence<std::tuple_size_v<Methods>>());
}

}  // namespace continuo
