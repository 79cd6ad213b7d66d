#include <continuo/methods/automatic.hpp>
#include <continuo/model/integrate_by.hpp>

namespace continuo::model {

template std::unique_ptr<Stepping> begin_integration_by<DormandPrinceNystrom8Radau>(Integration, Interval<double>);
template std::unique_ptr<Stepping> begin_integration_by<DormandPrinceNystrom12Radau>(Integration, Interval<double>);

}  // namespace continuo::model
