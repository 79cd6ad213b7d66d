// continuo/model/integrate_structural.cpp
#include <continuo/methods/generalized_alpha.hpp>
#include <continuo/methods/newmark.hpp>
#include <continuo/model/integrate_by.hpp>

namespace continuo::model {

template void integrate_by<GeneralizedAlpha>(Integration, RunRecorder&, Run&);
template void integrate_by<Newmark>(Integration, RunRecorder&, Run&);

}  // namespace continuo::model
