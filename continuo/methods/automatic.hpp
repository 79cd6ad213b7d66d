// continuo/methods/automatic.hpp
// The methods that take what comes: each an explicit one and a stiff one that hand over to each other, for moderate and
// for strict tolerances, for large systems, and for x'' = a(t, x). <continuo/solve/automatic.hpp> chooses among them.
#pragma once
#include <string_view>
#include <tuple>

#include <continuo/methods/collocation/radau.hpp>
#include <continuo/methods/explicit_rk/dop853.hpp>
#include <continuo/methods/explicit_rk/tsitouras5.hpp>
#include <continuo/methods/multistep/bdf.hpp>
#include <continuo/methods/nystrom/dormand_prince_nystrom12.hpp>
#include <continuo/methods/nystrom/dormand_prince_nystrom8.hpp>
#include <continuo/methods/rosenbrock/rodas5p.hpp>
#include <continuo/methods/switching.hpp>

namespace continuo {

/// The default for tolerances from 1e-6 up.
struct Tsitouras5Rodas5P : Switching<Tsitouras5, Rodas5P> {
  static constexpr std::string_view name = "tsitouras5_rodas5p";  // by which with_method finds it
};
/// The default for tolerances below 1e-6.
struct Dop853Radau : Switching<Dop853, Radau> {
  static constexpr std::string_view name = "dop853_radau";  // by which with_method finds it
};
/// The default for more than 100 states.
struct Tsitouras5Bdf : Switching<Tsitouras5, Bdf> {
  static constexpr std::string_view name = "tsitouras5_bdf";  // by which with_method finds it
};
/// The default for x'' = a(t, x) and tolerances from 1e-6 up.
struct DormandPrinceNystrom8Radau : Switching<DormandPrinceNystrom8, Radau> {
  static constexpr std::string_view name = "dprkn8_radau";  // by which with_method finds it
};
/// The default for x'' = a(t, x) and tolerances below 1e-6.
struct DormandPrinceNystrom12Radau : Switching<DormandPrinceNystrom12, Radau> {
  static constexpr std::string_view name = "dprkn12_radau";  // by which with_method finds it
};

/// What is taken where no method is named.
using AutomaticMethods =
    std::tuple<Tsitouras5Rodas5P, Dop853Radau, Tsitouras5Bdf, DormandPrinceNystrom8Radau, DormandPrinceNystrom12Radau>;

}  // namespace continuo
