// Instantiates the integration of sensitivities for strict tolerances.
#include <continuo/methods/automatic.hpp>
#include <continuo/studies/sensitivity/sensitive_integration.hpp>

namespace continuo::studies::detail {

template <>
SensitiveEnding integrate_sensitive<Dop853Radau>(SensitiveIntegration integration, SensitiveRows& rows) {
  return integrate_sensitive_by<Dop853Radau>(std::move(integration), rows);
}

}  // namespace continuo::studies::detail
