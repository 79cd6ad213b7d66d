// Instantiates the integration of sensitivities for moderate tolerances.
#include <continuo/methods/automatic.hpp>
#include <continuo/studies/sensitivity/sensitive_integration.hpp>

namespace continuo::studies::detail {

template <>
SensitiveEnding integrate_sensitive<Tsitouras5Rodas5P>(SensitiveIntegration integration, SensitiveRows& rows) {
  return integrate_sensitive_by<Tsitouras5Rodas5P>(std::move(integration), rows);
}

}  // namespace continuo::studies::detail
