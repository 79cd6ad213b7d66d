// continuo/model/integrate_diagonally_implicit.cpp
#include <continuo/methods/kencarp4.hpp>
#include <continuo/methods/kvaerno5.hpp>
#include <continuo/methods/tr_bdf2.hpp>
#include <continuo/model/model_method_body.hpp>

namespace continuo::model {

template ModelMethod model_method<KenCarp4>();
template ModelMethod model_method<Kvaerno5>();
template ModelMethod model_method<TrBdf2>();

}  // namespace continuo::model
