// continuo/model/integrate_automatic_strict.cpp
#include <continuo/methods/automatic.hpp>
#include <continuo/model/model_method_body.hpp>

namespace continuo::model {

template ModelMethod model_method<Dop853Radau>();

}  // namespace continuo::model
