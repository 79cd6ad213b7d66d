// continuo/model/integrate_automatic.cpp
#include <continuo/methods/automatic.hpp>
#include <continuo/model/integrate_by.hpp>

namespace continuo::model {

template void integrate_by<Tsitouras5Rodas5P>(Integration, RunRecorder&, Run&);
template void integrate_by<Tsitouras5Bdf>(Integration, RunRecorder&, Run&);

}  // namespace continuo::model
