// continuo/model/integrate_rosenbrock.cpp
#include <continuo/methods/rodas4.hpp>
#include <continuo/methods/rodas5p.hpp>
#include <continuo/methods/rosenbrock23.hpp>
#include <continuo/model/integrate_by.hpp>

namespace continuo::model {

template void integrate_by<Rodas4>(Integration, RunRecorder&, Run&);
template void integrate_by<Rodas5P>(Integration, RunRecorder&, Run&);
template void integrate_by<Rosenbrock23>(Integration, RunRecorder&, Run&);

}  // namespace continuo::model
