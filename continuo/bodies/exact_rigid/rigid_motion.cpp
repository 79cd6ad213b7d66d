// Instantiates the exact motion of rigid bodies for double precision.
#include <continuo/bodies/exact_rigid/rigid_motion.hpp>

namespace continuo {

template std::unique_ptr<ExactEngine<double, 2>> rigid_motion(World<double, 2>&, const ExactOptions<double>&);
template std::unique_ptr<ExactEngine<double, 3>> rigid_motion(World<double, 3>&, const ExactOptions<double>&);

}  // namespace continuo
