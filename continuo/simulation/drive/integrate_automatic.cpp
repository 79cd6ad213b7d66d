// continuo/simulation/drive/integrate_automatic.cpp
// Instantiates the integration of models for the automatic methods of moderate tolerances.
#include <continuo/methods/automatic.hpp>
#include <continuo/simulation/drive/model_method_body.hpp>

namespace continuo::model {

template ModelMethod model_method<Tsitouras5Rodas5P>();
template ModelMethod model_method<Tsitouras5Bdf>();

}  // namespace continuo::model
