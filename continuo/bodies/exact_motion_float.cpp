// Instantiates the exact motion for single precision.
#include <continuo/bodies/event_driven/exact_motion_members.hpp>

namespace continuo {

template class ExactMotion<float, 2>;
template class ExactMotion<float, 3>;

}  // namespace continuo
