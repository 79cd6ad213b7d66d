// continuo/model/integrate_collocation.cpp
#include <continuo/methods/gauss4.hpp>
#include <continuo/methods/radau.hpp>
#include <continuo/model/integrate_by.hpp>

namespace continuo::model {

template void integrate_by<Gauss4>(Integration, RunRecorder&, Run&);
template void integrate_by<Radau5>(Integration, RunRecorder&, Run&);
template void integrate_by<Radau>(Integration, RunRecorder&, Run&);

}  // namespace continuo::model
