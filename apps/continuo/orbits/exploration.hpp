// An overview of a model: its run, equilibria and orbit, bifurcations along its sliders, the influence of its
// parameters; and what was not found, or not searched for, with the reason.
#pragma once
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <apps/continuo/studies/studied_model.hpp>
#include <nlohmann/json_fwd.hpp>

#include <continuo/results/figure.hpp>
#include <continuo/simulation/simulate.hpp>
#include <continuo/studies/continuation.hpp>
#include <continuo/studies/equilibrium.hpp>
#include <continuo/studies/hybrid_orbit.hpp>
#include <continuo/studies/lyapunov.hpp>
#include <continuo/studies/periodic_orbit.hpp>
#include <continuo/studies/sensitivity.hpp>

namespace continuo::app {

/// An equilibrium, and the jump of the equations that it lies at, if any: then nothing is known of its stability.
struct ExploredEquilibrium {
  studies::Equilibrium at;
  std::optional<std::string> jump;
};

/// A parameter with a range, and the branches along it that lead through the equilibria, each once.
struct Slider {
  std::string name;
  double low, high;
  std::vector<studies::BranchOfDiagram> branches;  // their starts: the equilibria, by number
};

/// The largest change of a state along the run by a change of the parameter, in parts of both.
struct Influenced {
  std::string parameter, state;
  double part, t;
};

struct Exploration {
  model::Simulated simulated;
  std::vector<double> low, high;  // of the states, over the run
  std::vector<ExploredEquilibrium> equilibria;
  std::size_t searches = 0;
  std::optional<std::size_t> comes_to;  // the equilibrium at which the run ends
  bool comes_later = false;             // it does so only when it goes on
  std::optional<studies::PeriodicOrbit> orbit;
  std::optional<studies::HybridOrbit> hybrid_orbit;  // instead, where events or the time have a part in the motion
  std::optional<studies::LyapunovExponents> exponents;
  std::vector<Slider> sliders;
  std::vector<std::string> not_varied;  // parameters without a range
  std::vector<Influenced> influences;   // by falling part
  std::vector<std::string> notes;       // what was not found or not searched for
  bool complete = true;                 // not interrupted
};

struct ExplorationLimits {
  std::size_t starts = 200, sliders = 8;
  // Of orbits; else as long as the model's run, and ten times as long where the motion does not come back by then.
  std::optional<double> settle{}, duration{};
};

Exploration explore(const Studied& studied, const ExplorationLimits& limits);

std::string exploration_text(const Studied& studied, const Exploration& found);
nlohmann::json exploration_json(const Studied& studied, const Exploration& found);
/// The run, the plane of the first two states with its equilibria and orbit, and a panel for each slider.
results::Figure exploration_figure(const Studied& studied, const Exploration& found);

}  // namespace continuo::app
