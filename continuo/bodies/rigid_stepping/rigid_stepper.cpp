// Instantiates the steps of rigid bodies for double precision.
#include <continuo/bodies/rigid_stepping/rigid_stepper.hpp>

namespace continuo {

template class RigidStepper<double, 2>;
template class RigidStepper<double, 3>;

}  // namespace continuo
