// An exploration as JSON.
#include <vector>

#include <apps/continuo/orbits/exploration.hpp>
#include <apps/continuo/orbits/steady_branches.hpp>
#include <nlohmann/json.hpp>

namespace continuo::app {
namespace {

using nlohmann::json;

json equilibria_json(const std::vector<ExploredEquilibrium>& equilibria) {
  json list = json::array();
  for (const ExploredEquilibrium& equilibrium : equilibria) {
    list.push_back({{"x", equilibrium.at.x}, {"eigenvalues", app::json_of(equilibrium.at.eigenvalues)}});
    list.back()["stability"] = equilibrium.jump ? "undecided" : std::string(to_string(equilibrium.at.stability));
    if (equilibrium.jump) list.back()["jump"] = *equilibrium.jump;
  }
  return list;
}

json slider_json(const Slider& slider) {
  json branches = json::array();
  for (const auto& [branch, starts, crossed] : slider.branches) {
    json points = json::array();
    for (const studies::BifurcationPoint& point : branch.bifurcations)
      points.push_back({{"kind", to_string(point.kind)},
                        {"at", point.at.constant},
                        {"x", point.at.x},
                        {"frequency", point.frequency}});
    branches.push_back({{"equilibria", starts},
                        {"complete", static_cast<bool>(branch.status)},
                        {"points", branch.points.size()},
                        {"bifurcations", points}});
    if (crossed) branches.back()["crosses"] = *crossed;
  }
  return {{"name", slider.name}, {"low", slider.low}, {"high", slider.high}, {"branches", branches}};
}

}  // namespace

nlohmann::json exploration_json(const Studied& studied, const Exploration& found) {
  json states = json::array(), sliders = json::array(), influences = json::array();
  for (const model::State& state : studied.prepared.program->model.states) states.push_back(state.column);
  for (const Slider& slider : found.sliders) sliders.push_back(slider_json(slider));
  for (const Influenced& one : found.influences)
    influences.push_back({{"parameter", one.parameter}, {"state", one.state}, {"part", one.part}, {"t", one.t}});
  json result{{"states", states},
              {"low", found.low},
              {"high", found.high},
              {"equilibria", equilibria_json(found.equilibria)},
              {"searches", found.searches},
              {"parameters", sliders},
              {"sensitivities", influences},
              {"not_varied", found.not_varied},
              {"notes", found.notes},
              {"complete", found.complete}};
  add_conserved(result, studied);
  if (found.simulated.run)
    result["run"] = {{"ending", to_string(found.simulated.run->outcome.ending)},
                     {"t", found.simulated.run->final_time()}};
  if (found.comes_to) result["converges_to"] = *found.comes_to;
  if (found.orbit)
    result["orbit"] = {{"period", found.orbit->period},
                       {"stable", found.orbit->stable},
                       {"multipliers", json_of(found.orbit->multipliers)}};
  if (found.hybrid_orbit)
    result["orbit"] = {{"period", found.hybrid_orbit->period},
                       {"stable", found.hybrid_orbit->neighbours == studies::HybridOrbit::Neighbours::come_nearer},
                       {"multipliers", json_of(found.hybrid_orbit->multipliers)}};
  if (found.exponents)
    result["exponents"] = {{"values", found.exponents->exponents}, {"spread", found.exponents->spread}};
  return result;
}

}  // namespace continuo::app
