// continuo/model/integrate_structural.cpp
#include <continuo/methods/generalized_alpha.hpp>
#include <continuo/methods/newmark.hpp>
#include <continuo/model/integrate_by.hpp>

namespace continuo::model {

template std::unique_ptr<Stepping> begin_integration_by<GeneralizedAlpha>(Integration, Interval<double>);
template std::unique_ptr<Stepping> begin_integration_by<Newmark>(Integration, Interval<double>);

}  // namespace continuo::model
