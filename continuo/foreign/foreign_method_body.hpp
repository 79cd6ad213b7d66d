// The body of foreign_method; included only by the methods_*.cpp.
#pragma once
#include <vector>

#include <continuo/foreign/foreign_method.hpp>

namespace continuo {

template <class M, class System>
[[nodiscard]] AnyMethod<System, std::vector<double>> foreign_method() {
  return any_method<M, System, std::vector<double>>();
}

}  // namespace continuo
