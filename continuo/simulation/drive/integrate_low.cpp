// continuo/simulation/drive/integrate_low.cpp
// Instantiates the integration of models for the explicit methods with fixed steps.
#include <continuo/methods/explicit_rk/explicit_euler.hpp>
#include <continuo/methods/explicit_rk/heun.hpp>
#include <continuo/methods/explicit_rk/midpoint.hpp>
#include <continuo/methods/explicit_rk/rk38.hpp>
#include <continuo/methods/explicit_rk/rk4.hpp>
#include <continuo/simulation/drive/model_method_body.hpp>

namespace continuo::model {

template ModelMethod model_method<ExplicitEuler>();
template ModelMethod model_method<Midpoint>();
template ModelMethod model_method<Heun>();
template ModelMethod model_method<Rk4>();
template ModelMethod model_method<Rk38>();

}  // namespace continuo::model
