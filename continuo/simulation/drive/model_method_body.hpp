// The body of model_method; included only by the integrate_*.cpp.
#pragma once
#include <continuo/numerics/polynomial_enclosure.hpp>
#include <continuo/simulation/drive/model_method.hpp>

namespace continuo::model {

/// M's dense output is among those that guards can be enclosed over.
template <class M>
[[nodiscard]] consteval bool is_enclosed() {
  if constexpr (requires { M::dense_degree; }) return M::dense_degree <= greatest_enclosed_degree;
  return true;
}

template <class M, class Archive>
void transfer_steps(Steps<ModelSystem, ModelSystem::X>& steps, Archive& archive) {
  static_cast<StepControl<ModelSystem, ModelSystem::X, M>&>(steps).transfer(archive);
}

template <class M>
[[nodiscard]] ModelMethod model_method() {
  static_assert(is_enclosed<M>(), "greatest_enclosed_degree is the greatest degree of dense output of all methods");
  return {any_method<M, ModelSystem, ModelSystem::X>(), transfer_steps<M, StateWriter>, transfer_steps<M, StateReader>};
}

}  // namespace continuo::model
