// continuo/model/integrate_multistep.cpp
#include <continuo/methods/adams.hpp>
#include <continuo/methods/bdf.hpp>
#include <continuo/methods/rkc2.hpp>
#include <continuo/model/model_method_body.hpp>

namespace continuo::model {

template ModelMethod model_method<Adams>();
template ModelMethod model_method<Bdf>();
template ModelMethod model_method<Rkc2>();

}  // namespace continuo::model
