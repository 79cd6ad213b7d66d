// A method as a run of a model drives it. Each is instantiated once, in one of the integrate_*.cpp, so that no
// translation unit has to compile them all.
#pragma once
#include <continuo/simulation/drive/state_archive.hpp>
#include <continuo/simulation/program/model_system.hpp>
#include <continuo/solve/any_method.hpp>

namespace continuo::model {

struct ModelMethod {
  using X = ModelSystem::X;

  AnyMethod<ModelSystem, X> method;
  // The state of its steps: see state_archive.hpp.
  void (*write)(Steps<ModelSystem, X>& steps, StateWriter& archive);
  void (*read)(Steps<ModelSystem, X>& steps, StateReader& archive);
};

template <class M>
[[nodiscard]] ModelMethod model_method();

}  // namespace continuo::model
