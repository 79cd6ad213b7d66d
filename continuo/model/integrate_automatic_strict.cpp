// continuo/model/integrate_automatic_strict.cpp
#include <continuo/methods/automatic.hpp>
#include <continuo/model/integrate_by.hpp>

namespace continuo::model {

template void integrate_by<Dop853Radau>(Integration, RunRecorder&, Run&);

}  // namespace continuo::model
