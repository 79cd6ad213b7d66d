// Instantiates runs in lanes for the explicit methods of low and medium order.
#include <continuo/methods/explicit_rk/bogacki_shampine3.hpp>
#include <continuo/methods/explicit_rk/dormand_prince5.hpp>
#include <continuo/methods/explicit_rk/rk4.hpp>
#include <continuo/methods/explicit_rk/tsitouras5.hpp>
#include <continuo/simulation/together/integrate_together_body.hpp>

namespace continuo::model {

template void integrate_together_by<BogackiShampine3>(const TogetherRuns& runs);
template void integrate_together_by<DormandPrince5>(const TogetherRuns& runs);
template void integrate_together_by<Rk4>(const TogetherRuns& runs);
template void integrate_together_by<Tsitouras5>(const TogetherRuns& runs);

}  // namespace continuo::model
