// `continuo orbit` of a model in which more happens than its equations say: events, modes, jumps, the time.
#pragma once
#include <cstddef>
#include <optional>
#include <string>

#include <apps/continuo/studies/studied_model.hpp>
#include <apps/continuo/terminal/exit_codes.hpp>

#include <continuo/studies/hybrid_orbit.hpp>

namespace continuo::app {

struct HybridOrbitRequest {
  double settle, duration, tolerance;
  bool patient = false;  // no time was named: longer ones may be tried
  std::optional<double> forcing{};
  std::size_t turns = 0;
  bool json = false;
  std::string plot{};
};

/// What the request asks for, with the period of what depends on the time; nothing where there is none that can be
/// relied on, which is said.
std::optional<studies::HybridOrbitOptions> search_of(const Studied& studied, const HybridOrbitRequest& request);
/// The orbit that the motion comes to; where it may take longer, it is looked for longer.
studies::HybridOrbit find_hybrid_orbit(const Studied& studied, const HybridOrbitRequest& request,
                                       studies::HybridOrbitOptions search);

ExitCode show_hybrid_orbit(const Studied& studied, const HybridOrbitRequest& request);

}  // namespace continuo::app
