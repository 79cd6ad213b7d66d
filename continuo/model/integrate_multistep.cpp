// continuo/model/integrate_multistep.cpp
#include <continuo/methods/adams.hpp>
#include <continuo/methods/bdf.hpp>
#include <continuo/methods/rkc2.hpp>
#include <continuo/model/integrate_by.hpp>

namespace continuo::model {

template std::unique_ptr<Stepping> begin_integration_by<Adams>(Integration, Interval<double>);
template std::unique_ptr<Stepping> begin_integration_by<Bdf>(Integration, Interval<double>);
template std::unique_ptr<Stepping> begin_integration_by<Rkc2>(Integration, Interval<double>);

}  // namespace continuo::model
