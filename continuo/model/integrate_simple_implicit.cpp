// continuo/model/integrate_simple_implicit.cpp
#include <continuo/methods/bdf2.hpp>
#include <continuo/methods/implicit_euler.hpp>
#include <continuo/methods/implicit_midpoint.hpp>
#include <continuo/methods/trapezoidal.hpp>
#include <continuo/model/integrate_by.hpp>

namespace continuo::model {

template void integrate_by<Bdf2>(Integration, RunRecorder&, Run&);
template void integrate_by<ImplicitEuler>(Integration, RunRecorder&, Run&);
template void integrate_by<ImplicitMidpoint>(Integration, RunRecorder&, Run&);
template void integrate_by<Trapezoidal>(Integration, RunRecorder&, Run&);

}  // namespace continuo::model
