// continuo/model/integrate_structural.cpp
#include <continuo/methods/generalized_alpha.hpp>
#include <continuo/methods/newmark.hpp>
#include <continuo/model/model_method_body.hpp>

namespace continuo::model {

template ModelMethod model_method<GeneralizedAlpha>();
template ModelMethod model_method<Newmark>();

}  // namespace continuo::model
