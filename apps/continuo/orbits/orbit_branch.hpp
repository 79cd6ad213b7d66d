// continuo orbit FILE --along NAME=LOW..HIGH: how a closed orbit changes with a parameter.
#pragma once
#include <optional>
#include <string>

#include <apps/continuo/orbits/hybrid_orbit.hpp>
#include <apps/continuo/studies/branch_steps.hpp>
#include <apps/continuo/studies/studied_model.hpp>

#include <continuo/studies/periodic_orbit.hpp>

namespace continuo::app {

struct OrbitBranchOptions {
  NamedRange range;
  std::optional<NamedRange> second{};          // then both parameters move
  std::optional<NamedRange> third{};           // then all three do
  studies::PeriodicOrbitOptions search{};      // of the orbit to begin with
  std::optional<HybridOrbitRequest> hybrid{};  // instead, where events or the time have a part in the motion
  bool patient = false;                        // look for it ten times and a hundred times as long, too
  bool from_hopf = false;                      // begin where equilibria begin to oscillate
  bool json = false;
  std::size_t others = 0;  // so many branches more, that begin on those that were found
  BranchSteps steps{};
  std::string of, out, plot;  // the state to draw; the files of the table and the picture
};

/// The orbit that the motion comes to.
studies::PeriodicOrbit find_orbit(const Studied& studied, studies::PeriodicOrbitOptions search, bool patient);

/// `studied` has the parameter as its constant, and the second and the third one behind it.
ExitCode show_orbit_branches(const Studied& studied, const OrbitBranchOptions& options);

}  // namespace continuo::app
