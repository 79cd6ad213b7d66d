// Instantiates the steps of rigid bodies for double precision.
#include <continuo/bodies/rigid_stepping/rigid_steps_members.hpp>

namespace continuo {

template class RigidSteps<double, 2>;
template class RigidSteps<double, 3>;

}  // namespace continuo
