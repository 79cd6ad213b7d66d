// continuo/model/integrate_second_order.cpp
#include <continuo/methods/central_difference.hpp>
#include <continuo/methods/semi_implicit_euler.hpp>
#include <continuo/methods/velocity_verlet.hpp>
#include <continuo/model/integrate_by.hpp>

namespace continuo::model {

template std::unique_ptr<Stepping> begin_integration_by<SemiImplicitEuler>(Integration, Interval<double>);
template std::unique_ptr<Stepping> begin_integration_by<CentralDifference>(Integration, Interval<double>);
template std::unique_ptr<Stepping> begin_integration_by<VelocityVerlet>(Integration, Interval<double>);

}  // namespace continuo::model
