// continuo/model/integrate_high.cpp
#include <continuo/methods/dop853.hpp>
#include <continuo/methods/verner7.hpp>
#include <continuo/methods/verner9.hpp>
#include <continuo/model/model_method_body.hpp>

namespace continuo::model {

template ModelMethod model_method<Dop853>();
template ModelMethod model_method<Verner7>();
template ModelMethod model_method<Verner9>();

}  // namespace continuo::model
