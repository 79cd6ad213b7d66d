// continuo/model/integrate_low.cpp
#include <continuo/methods/explicit_euler.hpp>
#include <continuo/methods/heun.hpp>
#include <continuo/methods/midpoint.hpp>
#include <continuo/methods/rk38.hpp>
#include <continuo/methods/rk4.hpp>
#include <continuo/model/model_method_body.hpp>

namespace continuo::model {

template ModelMethod model_method<ExplicitEuler>();
template ModelMethod model_method<Midpoint>();
template ModelMethod model_method<Heun>();
template ModelMethod model_method<Rk4>();
template ModelMethod model_method<Rk38>();

}  // namespace continuo::model
