// Instantiates the integration of models for the automatic Nystrom methods.
#include <continuo/methods/automatic.hpp>
#include <continuo/simulation/drive/model_method_body.hpp>

namespace continuo::model {

template ModelMethod model_method<DormandPrinceNystrom8Radau>();
template ModelMethod model_method<DormandPrinceNystrom12Radau>();

}  // namespace continuo::model
