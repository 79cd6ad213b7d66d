// Instantiates the steps of rigid bodies for single precision.
#include <continuo/bodies/rigid_stepping/rigid_steps_members.hpp>

namespace continuo {

template class RigidSteps<float, 2>;
template class RigidSteps<float, 3>;

}  // namespace continuo
