// continuo/model/integrate_multistep.cpp
#include <continuo/methods/adams.hpp>
#include <continuo/methods/bdf.hpp>
#include <continuo/methods/rkc2.hpp>
#include <continuo/model/integrate_by.hpp>

namespace continuo::model {

template void integrate_by<Adams>(Integration, RunRecorder&, Run&);
template void integrate_by<Bdf>(Integration, RunRecorder&, Run&);
template void integrate_by<Rkc2>(Integration, RunRecorder&, Run&);

}  // namespace continuo::model
