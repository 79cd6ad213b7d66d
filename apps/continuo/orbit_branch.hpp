// continuo orbit FILE --along NAME=LOW..HIGH: how a closed orbit changes with a parameter.
#pragma once
#include <string>

#include <apps/continuo/studied_model.hpp>

#include <continuo/studies/periodic_orbit.hpp>

namespace continuo::app {

struct OrbitBranchOptions {
  NamedRange range;
  studies::PeriodicOrbitOptions search{};  // of the orbit to begin with
  bool from_hopf = false;                  // begin where places of rest begin to oscillate
  std::string of, out, plot;               // the state to draw; the files of the table and the picture
};

/// `studied` has the parameter as its one constant.
ExitCode show_orbit_branches(const Studied& studied, const OrbitBranchOptions& options);

}  // namespace continuo::app
