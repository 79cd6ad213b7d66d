// Instantiates runs in lanes for the explicit methods of high order.
#include <continuo/methods/explicit_rk/dop853.hpp>
#include <continuo/methods/explicit_rk/verner7.hpp>
#include <continuo/methods/explicit_rk/verner9.hpp>
#include <continuo/simulation/together/integrate_together_body.hpp>

namespace continuo::model {

template void integrate_together_by<Dop853>(const TogetherRuns& runs);
template void integrate_together_by<Verner7>(const TogetherRuns& runs);
template void integrate_together_by<Verner9>(const TogetherRuns& runs);

}  // namespace continuo::model
