// continuo/model/integrate_medium.cpp
#include <continuo/methods/bogacki_shampine3.hpp>
#include <continuo/methods/dormand_prince5.hpp>
#include <continuo/methods/tsitouras5.hpp>
#include <continuo/model/model_method_body.hpp>

namespace continuo::model {

template ModelMethod model_method<BogackiShampine3>();
template ModelMethod model_method<DormandPrince5>();
template ModelMethod model_method<Tsitouras5>();

}  // namespace continuo::model
