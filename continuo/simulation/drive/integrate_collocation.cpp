// continuo/simulation/drive/integrate_collocation.cpp
// Instantiates the integration of models for the collocation methods.
#include <continuo/methods/collocation/gauss4.hpp>
#include <continuo/methods/collocation/radau.hpp>
#include <continuo/simulation/drive/model_method_body.hpp>

namespace continuo::model {

template ModelMethod model_method<Gauss4>();
template ModelMethod model_method<Radau5>();
template ModelMethod model_method<Radau>();

}  // namespace continuo::model
