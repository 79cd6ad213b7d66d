// Instantiates the exact motion for double precision.
#include <continuo/bodies/event_driven/exact_motion_members.hpp>

namespace continuo {

template class ExactMotion<double, 2>;
template class ExactMotion<double, 3>;

}  // namespace continuo
