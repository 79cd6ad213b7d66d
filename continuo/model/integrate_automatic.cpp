// continuo/model/integrate_automatic.cpp
#include <continuo/methods/automatic.hpp>
#include <continuo/model/integrate_by.hpp>

namespace continuo::model {

template std::unique_ptr<Stepping> begin_integration_by<Tsitouras5Rodas5P>(Integration, Interval<double>);
template std::unique_ptr<Stepping> begin_integration_by<Tsitouras5Bdf>(Integration, Interval<double>);

}  // namespace continuo::model
