// continuo/simulation/drive/integrate_rosenbrock.cpp
// Instantiates the integration of models for the Rosenbrock methods.
#include <continuo/methods/rosenbrock/rodas4.hpp>
#include <continuo/methods/rosenbrock/rodas5p.hpp>
#include <continuo/methods/rosenbrock/rosenbrock23.hpp>
#include <continuo/simulation/drive/model_method_body.hpp>

namespace continuo::model {

template ModelMethod model_method<Rodas4>();
template ModelMethod model_method<Rodas5P>();
template ModelMethod model_method<Rosenbrock23>();

}  // namespace continuo::model
