// Instantiates runs in lanes for the stiff method that has them.
#include <continuo/methods/rosenbrock/rodas5p.hpp>
#include <continuo/simulation/together/integrate_together_body.hpp>

namespace continuo::model {

template void integrate_together_by<Rodas5P>(const TogetherRuns& runs);

}  // namespace continuo::model
