// continuo/simulation/drive/integrate_structural.cpp
// Instantiates the integration of models for the methods of structural dynamics.
#include <continuo/methods/structural/generalized_alpha.hpp>
#include <continuo/methods/structural/newmark.hpp>
#include <continuo/simulation/drive/model_method_body.hpp>

namespace continuo::model {

template ModelMethod model_method<GeneralizedAlpha>();
template ModelMethod model_method<Newmark>();

}  // namespace continuo::model
