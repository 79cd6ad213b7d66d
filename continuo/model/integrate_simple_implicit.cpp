// continuo/model/integrate_simple_implicit.cpp
#include <continuo/methods/bdf2.hpp>
#include <continuo/methods/implicit_euler.hpp>
#include <continuo/methods/implicit_midpoint.hpp>
#include <continuo/methods/trapezoidal.hpp>
#include <continuo/model/model_method_body.hpp>

namespace continuo::model {

template ModelMethod model_method<Bdf2>();
template ModelMethod model_method<ImplicitEuler>();
template ModelMethod model_method<ImplicitMidpoint>();
template ModelMethod model_method<Trapezoidal>();

}  // namespace continuo::model
