// Instantiates the motion with islands for single precision.
#include <continuo/bodies/constrained/islands.hpp>

namespace continuo {

template std::unique_ptr<ExactEngine<float, 2>> islands(World<float, 2>&, const ExactOptions<float>&);
template std::unique_ptr<ExactEngine<float, 3>> islands(World<float, 3>&, const ExactOptions<float>&);

}  // namespace continuo
