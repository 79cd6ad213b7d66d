// continuo/methods/automatic.hpp
// The methods that take what comes: each an explicit one and a stiff one that hand over to each other, for moderate and
// for strict tolerances, and for large systems. <continuo/solve/automatic.hpp> chooses among them.
#pragma once
#include <string_view>

#include <continuo/methods/bdf.hpp>
#include <continuo/methods/dop853.hpp>
#include <continuo/methods/radau.hpp>
#include <continuo/methods/rodas5p.hpp>
#include <continuo/methods/switching.hpp>
#include <continuo/methods/tsitouras5.hpp>

namespace continuo {

struct Tsitouras5Rodas5P : Switching<Tsitouras5, Rodas5P> {
  static constexpr std::string_view name = "tsitouras5_rodas5p";
};
struct Dop853Radau : Switching<Dop853, Radau> {
  static constexpr std::string_view name = "dop853_radau";
};
struct Tsitouras5Bdf : Switching<Tsitouras5, Bdf> {
  static constexpr std::string_view name = "tsitouras5_bdf";
};

}  // namespace continuo
