// continuo/model/integrate_diagonally_implicit.cpp
#include <continuo/methods/kencarp4.hpp>
#include <continuo/methods/kvaerno5.hpp>
#include <continuo/methods/tr_bdf2.hpp>
#include <continuo/model/integrate_by.hpp>

namespace continuo::model {

template std::unique_ptr<Stepping> begin_integration_by<KenCarp4>(Integration, Interval<double>);
template std::unique_ptr<Stepping> begin_integration_by<Kvaerno5>(Integration, Interval<double>);
template std::unique_ptr<Stepping> begin_integration_by<TrBdf2>(Integration, Interval<double>);

}  // namespace continuo::model
