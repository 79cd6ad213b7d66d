// Instantiates the motion under forces of any kind for double precision.
#include <continuo/bodies/constrained/constrained_motion.hpp>

namespace continuo {

template std::unique_ptr<ContactEngine<double, 2>> constrained_motion(World<double, 2>&, const ExactOptions<double>&,
                                                                      Companions<double, 2>*);
template std::unique_ptr<ContactEngine<double, 3>> constrained_motion(World<double, 3>&, const ExactOptions<double>&,
                                                                      Companions<double, 3>*);

}  // namespace continuo
