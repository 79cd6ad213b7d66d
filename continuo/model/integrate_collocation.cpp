// continuo/model/integrate_collocation.cpp
#include <continuo/methods/gauss4.hpp>
#include <continuo/methods/radau.hpp>
#include <continuo/model/model_method_body.hpp>

namespace continuo::model {

template ModelMethod model_method<Gauss4>();
template ModelMethod model_method<Radau5>();
template ModelMethod model_method<Radau>();

}  // namespace continuo::model
