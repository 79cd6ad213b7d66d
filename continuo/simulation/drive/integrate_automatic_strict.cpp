// continuo/simulation/drive/integrate_automatic_strict.cpp
// Instantiates the integration of models for the automatic method of strict tolerances.
#include <continuo/methods/automatic.hpp>
#include <continuo/simulation/drive/model_method_body.hpp>

namespace continuo::model {

template ModelMethod model_method<Dop853Radau>();

}  // namespace continuo::model
