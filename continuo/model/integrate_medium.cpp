// continuo/model/integrate_medium.cpp
#include <continuo/methods/bogacki_shampine3.hpp>
#include <continuo/methods/dormand_prince5.hpp>
#include <continuo/methods/tsitouras5.hpp>
#include <continuo/model/integrate_by.hpp>

namespace continuo::model {

template std::unique_ptr<Stepping> begin_integration_by<BogackiShampine3>(Integration, Interval<double>);
template std::unique_ptr<Stepping> begin_integration_by<DormandPrince5>(Integration, Interval<double>);
template std::unique_ptr<Stepping> begin_integration_by<Tsitouras5>(Integration, Interval<double>);

}  // namespace continuo::model
