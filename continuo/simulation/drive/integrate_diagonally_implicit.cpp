// continuo/simulation/drive/integrate_diagonally_implicit.cpp
// Instantiates the integration of models for the adaptive diagonally implicit methods.
#include <continuo/methods/dirk/kencarp4.hpp>
#include <continuo/methods/dirk/kvaerno5.hpp>
#include <continuo/methods/dirk/tr_bdf2.hpp>
#include <continuo/simulation/drive/model_method_body.hpp>

namespace continuo::model {

template ModelMethod model_method<KenCarp4>();
template ModelMethod model_method<Kvaerno5>();
template ModelMethod model_method<TrBdf2>();

}  // namespace continuo::model
