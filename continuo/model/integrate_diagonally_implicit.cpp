// continuo/model/integrate_diagonally_implicit.cpp
#include <continuo/methods/kencarp4.hpp>
#include <continuo/methods/kvaerno5.hpp>
#include <continuo/methods/tr_bdf2.hpp>
#include <continuo/model/integrate_by.hpp>

namespace continuo::model {

template void integrate_by<KenCarp4>(Integration, RunRecorder&, Run&);
template void integrate_by<Kvaerno5>(Integration, RunRecorder&, Run&);
template void integrate_by<TrBdf2>(Integration, RunRecorder&, Run&);

}  // namespace continuo::model
