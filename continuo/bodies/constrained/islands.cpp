// Instantiates the motion with islands for double precision.
#include <continuo/bodies/constrained/islands.hpp>

namespace continuo {

template std::unique_ptr<ExactEngine<double, 2>> islands(World<double, 2>&, const ExactOptions<double>&);
template std::unique_ptr<ExactEngine<double, 3>> islands(World<double, 3>&, const ExactOptions<double>&);

}  // namespace continuo
