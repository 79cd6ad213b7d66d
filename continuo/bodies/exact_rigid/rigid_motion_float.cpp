// Instantiates the exact motion of rigid bodies for single precision.
#include <continuo/bodies/exact_rigid/rigid_motion.hpp>

namespace continuo {

template std::unique_ptr<ExactEngine<float, 2>> rigid_motion(World<float, 2>&, const ExactOptions<float>&);
template std::unique_ptr<ExactEngine<float, 3>> rigid_motion(World<float, 3>&, const ExactOptions<float>&);

}  // namespace continuo
