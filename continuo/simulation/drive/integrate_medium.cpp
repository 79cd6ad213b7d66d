// continuo/simulation/drive/integrate_medium.cpp
// Instantiates the integration of models for the explicit methods of medium order.
#include <continuo/methods/explicit_rk/bogacki_shampine3.hpp>
#include <continuo/methods/explicit_rk/dormand_prince5.hpp>
#include <continuo/methods/explicit_rk/tsitouras5.hpp>
#include <continuo/simulation/drive/model_method_body.hpp>

namespace continuo::model {

template ModelMethod model_method<BogackiShampine3>();
template ModelMethod model_method<DormandPrince5>();
template ModelMethod model_method<Tsitouras5>();

}  // namespace continuo::model
