// Instantiates the steps of rigid bodies for single precision.
#include <continuo/bodies/rigid_stepping/rigid_stepper.hpp>

namespace continuo {

template class RigidStepper<float, 2>;
template class RigidStepper<float, 3>;

}  // namespace continuo
