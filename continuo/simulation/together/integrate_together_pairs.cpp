// Instantiates runs in lanes for the explicit methods of the pairs that are taken where no method is named.
#include <continuo/simulation/together/explicit_part.hpp>
#include <continuo/simulation/together/integrate_together_body.hpp>

namespace continuo::model {

template void integrate_together_by<ExplicitPart<Tsitouras5Rodas5P, Tsitouras5>>(const TogetherRuns& runs);
template void integrate_together_by<ExplicitPart<Dop853Radau, Dop853>>(const TogetherRuns& runs);

}  // namespace continuo::model
