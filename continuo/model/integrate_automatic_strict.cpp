// continuo/model/integrate_automatic_strict.cpp
#include <continuo/methods/automatic.hpp>
#include <continuo/model/integrate_by.hpp>

namespace continuo::model {

template std::unique_ptr<Stepping> begin_integration_by<Dop853Radau>(Integration, Interval<double>);

}  // namespace continuo::model
