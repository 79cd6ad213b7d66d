// Instantiates the fast motion for single precision.
#include <continuo/bodies/rigid_stepping/fast_motion_members.hpp>

namespace continuo {

template class FastMotion<float, 2>;
template class FastMotion<float, 3>;

}  // namespace continuo
