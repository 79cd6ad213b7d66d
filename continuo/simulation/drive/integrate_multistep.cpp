// continuo/simulation/drive/integrate_multistep.cpp
// Instantiates the integration of models for the multistep and stabilized methods.
#include <continuo/methods/explicit_rk/rkc2.hpp>
#include <continuo/methods/multistep/adams.hpp>
#include <continuo/methods/multistep/bdf.hpp>
#include <continuo/simulation/drive/model_method_body.hpp>

namespace continuo::model {

template ModelMethod model_method<Adams>();
template ModelMethod model_method<Bdf>();
template ModelMethod model_method<Rkc2>();

}  // namespace continuo::model
