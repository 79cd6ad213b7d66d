// continuo/model/integrate_collocation.cpp
#include <continuo/methods/gauss4.hpp>
#include <continuo/methods/radau.hpp>
#include <continuo/model/integrate_by.hpp>

namespace continuo::model {

template std::unique_ptr<Stepping> begin_integration_by<Gauss4>(Integration, Interval<double>);
template std::unique_ptr<Stepping> begin_integration_by<Radau5>(Integration, Interval<double>);
template std::unique_ptr<Stepping> begin_integration_by<Radau>(Integration, Interval<double>);

}  // namespace continuo::model
