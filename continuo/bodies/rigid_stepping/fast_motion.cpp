// Instantiates the fast motion for double precision.
#include <continuo/bodies/rigid_stepping/fast_motion_members.hpp>

namespace continuo {

template class FastMotion<double, 2>;
template class FastMotion<double, 3>;

}  // namespace continuo
