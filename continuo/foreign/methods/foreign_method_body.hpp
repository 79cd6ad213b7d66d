// The body of foreign_method; included only by the sources of this folder.
#pragma once
#include <vector>

#include <continuo/foreign/methods/foreign_method.hpp>

namespace continuo {

template <class M, class System>
[[nodiscard]] AnyMethod<System, std::vector<double>> foreign_method() {
  return any_method<M, System, std::vector<double>>();
}

}  // namespace continuo
