// continuo/model/integrate_symplectic.cpp
#include <continuo/methods/kahan_li8.hpp>
#include <continuo/methods/mclachlan_atela4.hpp>
#include <continuo/methods/yoshida6.hpp>
#include <continuo/model/integrate_by.hpp>

namespace continuo::model {

template std::unique_ptr<Stepping> begin_integration_by<KahanLi8>(Integration, Interval<double>);
template std::unique_ptr<Stepping> begin_integration_by<McLachlanAtela4>(Integration, Interval<double>);
template std::unique_ptr<Stepping> begin_integration_by<Yoshida6>(Integration, Interval<double>);

}  // namespace continuo::model
