// continuo/model/integrate_high.cpp
#include <continuo/methods/dop853.hpp>
#include <continuo/methods/verner7.hpp>
#include <continuo/methods/verner9.hpp>
#include <continuo/model/integrate_by.hpp>

namespace continuo::model {

template std::unique_ptr<Stepping> begin_integration_by<Dop853>(Integration, Interval<double>);
template std::unique_ptr<Stepping> begin_integration_by<Verner7>(Integration, Interval<double>);
template std::unique_ptr<Stepping> begin_integration_by<Verner9>(Integration, Interval<double>);

}  // namespace continuo::model
