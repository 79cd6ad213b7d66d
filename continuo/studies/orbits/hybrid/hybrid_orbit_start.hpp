// Where a motion comes back to where it was: what the search for closed orbits begins from. Internal to hybrid_orbit.
#pragma once
#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include <continuo/studies/hybrid_orbit.hpp>

namespace continuo::studies::detail {

/// In the middle of the longest stretch in which nothing happens; the motion is near there again after `period`.
struct OrbitStart {
  model::Instant start;
  double period;
  std::size_t turns;  // of the forcing; 0 without
};

struct OrbitStarts {
  Outcome<double> outcome;  // its hint says why there are none
  bool wanders = false;     // the motion did not come back
  bool nearby = false;      // it did not settle: what comes back is only near
  std::vector<OrbitStart> starts;
  std::vector<double> low, high;  // where each state ranges after it has settled
};

[[nodiscard]] OrbitStarts orbit_starts(const std::shared_ptr<const model::ModelProgram>& program,
                                       const model::Experiment& experiment, const HybridOrbitOptions& options);

}  // namespace continuo::studies::detail
