// continuo/model/integrate_simple_implicit.cpp
#include <continuo/methods/bdf2.hpp>
#include <continuo/methods/implicit_euler.hpp>
#include <continuo/methods/implicit_midpoint.hpp>
#include <continuo/methods/trapezoidal.hpp>
#include <continuo/model/integrate_by.hpp>

namespace continuo::model {

template std::unique_ptr<Stepping> begin_integration_by<Bdf2>(Integration, Interval<double>);
template std::unique_ptr<Stepping> begin_integration_by<ImplicitEuler>(Integration, Interval<double>);
template std::unique_ptr<Stepping> begin_integration_by<ImplicitMidpoint>(Integration, Interval<double>);
template std::unique_ptr<Stepping> begin_integration_by<Trapezoidal>(Integration, Interval<double>);

}  // namespace continuo::model
