// Instantiates the event-driven motion for single precision.
#include <continuo/bodies/event_driven/event_driven.hpp>

namespace continuo {

template std::unique_ptr<ParabolicEngine<float, 2>> event_driven(World<float, 2>&, const ExactOptions<float>&);
template std::unique_ptr<ParabolicEngine<float, 3>> event_driven(World<float, 3>&, const ExactOptions<float>&);

}  // namespace continuo
