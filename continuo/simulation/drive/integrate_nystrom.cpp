// continuo/simulation/drive/integrate_nystrom.cpp
// Instantiates the integration of models for the Nystrom methods.
#include <continuo/methods/nystrom/dormand_prince_nystrom12.hpp>
#include <continuo/methods/nystrom/dormand_prince_nystrom6.hpp>
#include <continuo/methods/nystrom/dormand_prince_nystrom8.hpp>
#include <continuo/simulation/drive/model_method_body.hpp>

namespace continuo::model {

template ModelMethod model_method<DormandPrinceNystrom12>();
template ModelMethod model_method<DormandPrinceNystrom6>();
template ModelMethod model_method<DormandPrinceNystrom8>();

}  // namespace continuo::model
