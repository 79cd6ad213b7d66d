// continuo/model/integrate_second_order.cpp
#include <continuo/methods/central_difference.hpp>
#include <continuo/methods/semi_implicit_euler.hpp>
#include <continuo/methods/velocity_verlet.hpp>
#include <continuo/model/integrate_by.hpp>

namespace continuo::model {

template void integrate_by<SemiImplicitEuler>(Integration, RunRecorder&, Run&);
template void integrate_by<CentralDifference>(Integration, RunRecorder&, Run&);
template void integrate_by<VelocityVerlet>(Integration, RunRecorder&, Run&);

}  // namespace continuo::model
