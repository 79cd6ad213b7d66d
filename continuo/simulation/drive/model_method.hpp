// A method as a run of a model drives it. Each is instantiated once, in one of the integrate_*.cpp, so that no
// translation unit has to compile them all.
#pragma once
#include <string>

#include <continuo/simulation/drive/state_archive.hpp>
#include <continuo/simulation/program/model_system.hpp>
#include <continuo/solve/any_method.hpp>
#include <continuo/solve/steps/consistent.hpp>
#include <continuo/solve/steps/steps.hpp>

// What the methods have in common is compiled in integrate.cpp, not with each of them.
namespace continuo {

extern template class Steps<model::ModelSystem, model::ModelSystem::X>;
extern template void Steps<model::ModelSystem, model::ModelSystem::X>::transfer_base(model::StateWriter&);
extern template void Steps<model::ModelSystem, model::ModelSystem::X>::transfer_base(model::StateReader&);
extern template Consistency make_consistent(model::ModelSystem&, const double&, model::ModelSystem::X&,
                                            const Tolerance<double>&, SolvedTo);
extern template std::string problem_of_result(model::ModelSystem&, const double&, const model::ModelSystem::X&);

}  // namespace continuo

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
