// continuo/model/integrate_second_order.cpp
#include <continuo/methods/central_difference.hpp>
#include <continuo/methods/semi_implicit_euler.hpp>
#include <continuo/methods/velocity_verlet.hpp>
#include <continuo/model/model_method_body.hpp>

namespace continuo::model {

template ModelMethod model_method<SemiImplicitEuler>();
template ModelMethod model_method<CentralDifference>();
template ModelMethod model_method<VelocityVerlet>();

}  // namespace continuo::model
