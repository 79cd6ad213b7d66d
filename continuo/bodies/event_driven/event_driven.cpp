// Instantiates the event-driven motion for double precision.
#include <continuo/bodies/event_driven/event_driven.hpp>

namespace continuo {

template std::unique_ptr<ParabolicEngine<double, 2>> event_driven(World<double, 2>&, const ExactOptions<double>&);
template std::unique_ptr<ParabolicEngine<double, 3>> event_driven(World<double, 3>&, const ExactOptions<double>&);

}  // namespace continuo
