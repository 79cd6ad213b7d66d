// continuo/model/integrate_rosenbrock.cpp
#include <continuo/methods/rodas4.hpp>
#include <continuo/methods/rodas5p.hpp>
#include <continuo/methods/rosenbrock23.hpp>
#include <continuo/model/integrate_by.hpp>

namespace continuo::model {

template std::unique_ptr<Stepping> begin_integration_by<Rodas4>(Integration, Interval<double>);
template std::unique_ptr<Stepping> begin_integration_by<Rodas5P>(Integration, Interval<double>);
template std::unique_ptr<Stepping> begin_integration_by<Rosenbrock23>(Integration, Interval<double>);

}  // namespace continuo::model
