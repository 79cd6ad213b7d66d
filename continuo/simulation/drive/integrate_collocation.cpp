// Instantiates the integration of models for the collocation methods, and for the automatic methods that go on by them:
// together, so that their stages are compiled once.
#include <continuo/methods/automatic.hpp>
#include <continuo/methods/collocation/gauss4.hpp>
#include <continuo/methods/collocation/radau.hpp>
#include <continuo/simulation/drive/model_method_body.hpp>

namespace continuo::model {

template ModelMethod model_method<Gauss4>();
template ModelMethod model_method<Radau5>();
template ModelMethod model_method<Radau>();
template ModelMethod model_method<Dop853Radau>();
template ModelMethod model_method<DormandPrinceNystrom8Radau>();
template ModelMethod model_method<DormandPrinceNystrom12Radau>();

}  // namespace continuo::model
