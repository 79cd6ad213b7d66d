// continuo/simulation/drive/integrate_high.cpp
// Instantiates the integration of models for the explicit methods of high order.
#include <continuo/methods/explicit_rk/dop853.hpp>
#include <continuo/methods/explicit_rk/verner7.hpp>
#include <continuo/methods/explicit_rk/verner9.hpp>
#include <continuo/simulation/drive/model_method_body.hpp>

namespace continuo::model {

template ModelMethod model_method<Dop853>();
template ModelMethod model_method<Verner7>();
template ModelMethod model_method<Verner9>();

}  // namespace continuo::model
