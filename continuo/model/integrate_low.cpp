// continuo/model/integrate_low.cpp
#include <continuo/methods/explicit_euler.hpp>
#include <continuo/methods/heun.hpp>
#include <continuo/methods/midpoint.hpp>
#include <continuo/methods/rk38.hpp>
#include <continuo/methods/rk4.hpp>
#include <continuo/model/integrate_by.hpp>

namespace continuo::model {

template void integrate_by<ExplicitEuler>(Integration, RunRecorder&, Run&);
template void integrate_by<Midpoint>(Integration, RunRecorder&, Run&);
template void integrate_by<Heun>(Integration, RunRecorder&, Run&);
template void integrate_by<Rk4>(Integration, RunRecorder&, Run&);
template void integrate_by<Rk38>(Integration, RunRecorder&, Run&);

}  // namespace continuo::model
