// continuo/simulation/drive/integrate_extrapolation.cpp
// Instantiates the integration of models for the extrapolation methods and for Taylor series.
#include <continuo/methods/extrapolation/odex.hpp>
#include <continuo/methods/extrapolation/seulex.hpp>
#include <continuo/methods/taylor_series/taylor_series.hpp>
#include <continuo/simulation/drive/model_method_body.hpp>

namespace continuo::model {

template ModelMethod model_method<Odex>();
template ModelMethod model_method<Seulex>();
template ModelMethod model_method<TaylorSeries>();

}  // namespace continuo::model
