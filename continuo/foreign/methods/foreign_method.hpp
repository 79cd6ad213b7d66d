// A method as a run of a foreign system drives it. Each is instantiated once, in one of the sources of this folder, so
// that no translation unit has to compile them all.
#pragma once
#include <continuo/foreign/foreign_system.hpp>
#include <continuo/solve/any_method.hpp>

namespace continuo {

/// The method M for this type of foreign system.
template <class M, class System = ForeignSystem>
[[nodiscard]] AnyMethod<System, std::vector<double>> foreign_method();

}  // namespace continuo
