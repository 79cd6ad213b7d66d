// continuo/model/integrate_high.cpp
#include <continuo/methods/dop853.hpp>
#include <continuo/methods/verner7.hpp>
#include <continuo/methods/verner9.hpp>
#include <continuo/model/integrate_by.hpp>

namespace continuo::model {

template void integrate_by<Dop853>(Integration, RunRecorder&, Run&);
template void integrate_by<Verner7>(Integration, RunRecorder&, Run&);
template void integrate_by<Verner9>(Integration, RunRecorder&, Run&);

}  // namespace continuo::model
