// Instantiates the integration of sensitivities for large systems.
#include <continuo/methods/automatic.hpp>
#include <continuo/studies/sensitivity/sensitive_integration.hpp>

namespace continuo::studies::detail {

template <>
SensitiveEnding integrate_sensitive<Tsitouras5Bdf>(SensitiveIntegration integration, SensitiveRows& rows) {
  return integrate_sensitive_by<Tsitouras5Bdf>(std::move(integration), rows);
}

}  // namespace continuo::studies::detail
