// continuo/model/integrate_symplectic.cpp
#include <continuo/methods/kahan_li8.hpp>
#include <continuo/methods/mclachlan_atela4.hpp>
#include <continuo/methods/yoshida6.hpp>
#include <continuo/model/integrate_by.hpp>

namespace continuo::model {

template void integrate_by<KahanLi8>(Integration, RunRecorder&, Run&);
template void integrate_by<McLachlanAtela4>(Integration, RunRecorder&, Run&);
template void integrate_by<Yoshida6>(Integration, RunRecorder&, Run&);

}  // namespace continuo::model
