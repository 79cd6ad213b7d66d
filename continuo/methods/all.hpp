// continuo/methods/all.hpp
// Every method there is, as a list of types:
//
//   for_each_method([]<class M>() { fmt::print("{} {}\n", M::name, M::order); });
#pragma once
#include <cstddef>
#include <tuple>
#include <utility>

#include <continuo/methods/bdf.hpp>
#include <continuo/methods/bogacki_shampine3.hpp>
#include <continuo/methods/central_difference.hpp>
#include <continuo/methods/dop853.hpp>
#include <continuo/methods/dormand_prince5.hpp>
#include <continuo/methods/explicit_euler.hpp>
#include <continuo/methods/heun.hpp>
#include <continuo/methods/midpoint.hpp>
#include <continuo/methods/rk38.hpp>
#include <continuo/methods/rk4.hpp>
#include <continuo/methods/semi_implicit_euler.hpp>
#include <continuo/methods/tsitouras5.hpp>
#include <continuo/methods/velocity_verlet.hpp>
#include <continuo/methods/verner7.hpp>
#include <continuo/methods/verner9.hpp>

namespace continuo {

/// By family, then by order.
using ExplicitMethods = std::tuple<ExplicitEuler, SemiImplicitEuler, CentralDifference, VelocityVerlet, Midpoint, Heun,
                                   Rk4, Rk38, BogackiShampine3, DormandPrince5, Tsitouras5, Dop853, Verner7, Verner9>;
using StiffMethods = std::tuple<Bdf>;
using AllMethods = decltype(std::tuple_cat(ExplicitMethods{}, StiffMethods{}));

/// Calls visit.template operator()<M>() for every method M of the list.
template <class Methods = AllMethods, class Visit>
void for_each_method(Visit&& visit) {
  [&]<std::size_t... i>(std::index_sequence<i...>) {
    (visit.template operator()<std::tuple_element_t<i, Methods>>(), ...);
  }(std::make_index_sequence<std::tuple_size_v<Methods>>());
}

}  // namespace continuo
