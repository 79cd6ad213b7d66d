// continuo/model/integrate_nystrom.cpp
#include <continuo/methods/dormand_prince_nystrom12.hpp>
#include <continuo/methods/dormand_prince_nystrom6.hpp>
#include <continuo/methods/dormand_prince_nystrom8.hpp>
#include <continuo/model/integrate_by.hpp>

namespace continuo::model {

template void integrate_by<DormandPrinceNystrom12>(Integration, RunRecorder&, Run&);
template void integrate_by<DormandPrinceNystrom6>(Integration, RunRecorder&, Run&);
template void integrate_by<DormandPrinceNystrom8>(Integration, RunRecorder&, Run&);

}  // namespace continuo::model
