// continuo/simulation/drive/integrate_second_order.cpp
// Instantiates the integration of models for the simple methods of second-order systems.
#include <continuo/methods/structural/central_difference.hpp>
#include <continuo/methods/symplectic/semi_implicit_euler.hpp>
#include <continuo/methods/symplectic/symplectic_euler_position_first.hpp>
#include <continuo/methods/symplectic/velocity_verlet.hpp>
#include <continuo/simulation/drive/model_method_body.hpp>

namespace continuo::model {

template ModelMethod model_method<SemiImplicitEuler>();
template ModelMethod model_method<SymplecticEulerPositionFirst>();
template ModelMethod model_method<CentralDifference>();
template ModelMethod model_method<VelocityVerlet>();

}  // namespace continuo::model
