// continuo/simulation/drive/integrate_simple_implicit.cpp
// Instantiates the integration of models for the simple implicit methods of order 1 and 2.
#include <continuo/methods/dirk/implicit_euler.hpp>
#include <continuo/methods/dirk/implicit_midpoint.hpp>
#include <continuo/methods/dirk/trapezoidal.hpp>
#include <continuo/methods/multistep/bdf2.hpp>
#include <continuo/simulation/drive/model_method_body.hpp>

namespace continuo::model {

template ModelMethod model_method<Bdf2>();
template ModelMethod model_method<ImplicitEuler>();
template ModelMethod model_method<ImplicitMidpoint>();
template ModelMethod model_method<Trapezoidal>();

}  // namespace continuo::model
