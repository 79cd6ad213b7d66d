// continuo/model/integrate_medium.cpp
#include <continuo/methods/bogacki_shampine3.hpp>
#include <continuo/methods/dormand_prince5.hpp>
#include <continuo/methods/tsitouras5.hpp>
#include <continuo/model/integrate_by.hpp>

namespace continuo::model {

template void integrate_by<BogackiShampine3>(Integration, RunRecorder&, Run&);
template void integrate_by<DormandPrince5>(Integration, RunRecorder&, Run&);
template void integrate_by<Tsitouras5>(Integration, RunRecorder&, Run&);

}  // namespace continuo::model
