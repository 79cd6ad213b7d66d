// continuo/model/integrate_low.cpp
#include <continuo/methods/explicit_euler.hpp>
#include <continuo/methods/heun.hpp>
#include <continuo/methods/midpoint.hpp>
#include <continuo/methods/rk38.hpp>
#include <continuo/methods/rk4.hpp>
#include <continuo/model/integrate_by.hpp>

namespace continuo::model {

template std::unique_ptr<Stepping> begin_integration_by<ExplicitEuler>(Integration, Interval<double>);
template std::unique_ptr<Stepping> begin_integration_by<Midpoint>(Integration, Interval<double>);
template std::unique_ptr<Stepping> begin_integration_by<Heun>(Integration, Interval<double>);
template std::unique_ptr<Stepping> begin_integration_by<Rk4>(Integration, Interval<double>);
template std::unique_ptr<Stepping> begin_integration_by<Rk38>(Integration, Interval<double>);

}  // namespace continuo::model
