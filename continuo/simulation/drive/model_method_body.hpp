// The body of model_method; included only by the integrate_*.cpp.
#pragma once
#include <continuo/simulation/drive/model_method.hpp>

namespace continuo::model {

template <class M>
[[nodiscard]] ModelMethod model_method() {
  return any_method<M, ModelSystem, ModelSystem::X>();
}

}  // namespace continuo::model
