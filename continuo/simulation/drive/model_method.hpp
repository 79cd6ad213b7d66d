// A method as a run of a model drives it. Each is instantiated once, in one of the integrate_*.cpp, so that no
// translation unit has to compile them all.
#pragma once
#include <continuo/simulation/program/model_system.hpp>
#include <continuo/solve/any_method.hpp>

namespace continuo::model {

using ModelMethod = AnyMethod<ModelSystem, ModelSystem::X>;

template <class M>
[[nodiscard]] ModelMethod model_method();

}  // namespace continuo::model
