#include <continuo/methods/automatic.hpp>
#include <continuo/model/integrate_by.hpp>

namespace continuo::model {

template void integrate_by<DormandPrinceNystrom8Radau>(Integration, RunRecorder&, Run&);
template void integrate_by<DormandPrinceNystrom12Radau>(Integration, RunRecorder&, Run&);

}  // namespace continuo::model
