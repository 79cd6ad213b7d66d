// continuo/simulation/drive/integrate_automatic_strict.cpp
#include <continuo/methods/automatic.hpp>
#include <continuo/simulation/drive/model_method_body.hpp>

namespace continuo::model {

template ModelMethod model_method<Dop853Radau>();

}  // namespace continuo::model
