// Instantiates the motion under forces of any kind for single precision.
#include <continuo/bodies/constrained/constrained_motion.hpp>

namespace continuo {

template std::unique_ptr<ContactEngine<float, 2>> constrained_motion(World<float, 2>&, const ExactOptions<float>&,
                                                                     Companions<float, 2>*);
template std::unique_ptr<ContactEngine<float, 3>> constrained_motion(World<float, 3>&, const ExactOptions<float>&,
                                                                     Companions<float, 3>*);

}  // namespace continuo
