// continuo/model/integrate_nystrom.cpp
#include <continuo/methods/dormand_prince_nystrom12.hpp>
#include <continuo/methods/dormand_prince_nystrom6.hpp>
#include <continuo/methods/dormand_prince_nystrom8.hpp>
#include <continuo/model/integrate_by.hpp>

namespace continuo::model {

template std::unique_ptr<Stepping> begin_integration_by<DormandPrinceNystrom12>(Integration, Interval<double>);
template std::unique_ptr<Stepping> begin_integration_by<DormandPrinceNystrom6>(Integration, Interval<double>);
template std::unique_ptr<Stepping> begin_integration_by<DormandPrinceNystrom8>(Integration, Interval<double>);

}  // namespace continuo::model
