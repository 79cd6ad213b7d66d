// An exploration as text.
#include <algorithm>
#include <cmath>

#include <apps/continuo/orbits/bifurcation_text.hpp>
#include <apps/continuo/orbits/exploration.hpp>
#include <apps/continuo/studies/orbit_text.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <continuo/results/summary.hpp>

namespace continuo::app {
namespace {

using results::short_number;

constexpr std::size_t most_states = 12, most_parameters = 12;

std::string point_text(const model::Model& model, const std::vector<double>& x) {
  std::string text;
  for (std::size_t i = 0; i < std::min(x.size(), most_states); ++i)
    text += fmt::format("{}{} = {}", i == 0 ? "" : ", ", model.states[i].column,
                        short_number(std::abs(x[i]) < 1e-13 ? 0 : x[i]));
  return x.size() > most_states ? text + ", ..." : text;
}

std::string run_text(const model::Model& model, const Exploration& found) {
  if (!found.simulated.run) return "run      none: it could not begin\n";
  const model::Run& run = *found.simulated.run;
  std::string text =
      fmt::format("run      {} at t = {}\n", to_string(run.outcome.ending), short_number(run.final_time()));
  for (std::size_t i = 0; i < std::min(found.low.size(), most_states); ++i)
    text += fmt::format("         {} from {} to {}\n", model.states[i].column, short_number(found.low[i]),
                        short_number(found.high[i]));
  if (found.low.size() > most_states)
    text += fmt::format("         and {} more states\n", found.low.size() - most_states);
  if (found.comes_to)
    text += fmt::format("         it {} rest {}\n", found.comes_later ? "goes on to" : "ends at", *found.comes_to + 1);
  return text;
}

std::string rests_text(const model::Model& model, const Exploration& found) {
  if (found.searches == 0) return "";
  if (found.rests.empty()) return fmt::format("rests    none found from {} starts\n", found.searches);
  std::string text = fmt::format("rests    {} from {} starts\n", found.rests.size(), found.searches);
  const std::size_t shown = std::min<std::size_t>(found.rests.size(), 12);
  for (std::size_t k = 0; k < shown; ++k) {
    const Rest& rest = found.rests[k];
    text += fmt::format("      {:>2} {}: {}\n", k + 1,
                        rest.jump ? "undecided, the equations jump here" : to_string(rest.at.stability),
                        point_text(model, rest.at.x));
  }
  if (shown < found.rests.size()) text += "         and more: perhaps a whole curve of places is at rest\n";
  return text;
}

std::string orbit_text(const model::Model& model, const Exploration& found) {
  std::string text;
  if (found.orbit) {
    text = fmt::format("orbit    period {}, {}\n", with_time_unit(found.orbit->period, model),
                       found.orbit->stable ? "stable" : "not stable");
  }
  if (found.hybrid_orbit) {
    using Neighbours = studies::HybridOrbit::Neighbours;
    const studies::HybridOrbit& orbit = *found.hybrid_orbit;
    const std::string turns = orbit.turns > 1 ? fmt::format(", {} of the forcing's", orbit.turns) : "";
    text = fmt::format("orbit    period {}{}, {}\n", with_time_unit(orbit.period, model), turns,
                       orbit.neighbours == Neighbours::come_nearer ? "stable"
                       : orbit.neighbours == Neighbours::go_away   ? "not stable"
                       : orbit.family ? "one of a family: something is conserved, and each value of it has an orbit"
                                      : "undecided at first order");
    if (orbit.found_nearby) text += "         the motion does not converge to it, but passes near it\n";
  }
  if (!found.exponents) return text;
  text += "motion   Lyapunov exponents";
  for (std::size_t i = 0; i < found.exponents->exponents.size(); ++i)
    text += fmt::format("{} {} +- {:.1g}", i == 0 ? "" : ",", short_number(found.exponents->exponents[i]),
                        found.exponents->spread[i]);
  const double first = found.exponents->exponents[0], doubt = 3 * found.exponents->spread[0];
  return text + (first > doubt    ? ": the motion is chaotic\n"
                 : first < -doubt ? ": neighbouring motions converge\n"
                                  : ": neighbouring motions neither converge nor diverge measurably\n");
}

/// What rounding leaves of a zero is one.
double cleared(const Slider& slider, double value) {
  return std::abs(value) < 1e-12 * (slider.high - slider.low) ? 0 : value;
}

std::string slider_text(const Slider& slider, const model::Model& model) {
  std::string text =
      fmt::format("slider   {} from {} to {}\n", slider.name, short_number(slider.low), short_number(slider.high));
  bool any = false;
  for (std::size_t b = 0; b < slider.branches.size(); ++b) {
    const studies::BranchOfDiagram& one = slider.branches[b];
    std::string of = "a branch that crosses";
    for (std::size_t k = 0; k < one.starts.size(); ++k)
      of = k == 0 ? fmt::format("rest {}", one.starts[k] + 1) : fmt::format("{}, {}", of, one.starts[k] + 1);
    for (const studies::BifurcationPoint& point : one.branch.bifurcations) {
      if (is_listed_before(slider.branches, b, point)) continue;
      text += fmt::format("         {}: {} at {} = {}{}{}\n", of, to_string(point.kind), slider.name,
                          short_number(cleared(slider, point.at.constant)), state_text(slider.branches, point, model),
                          point.frequency > 0 ? fmt::format(", frequency {}", short_number(point.frequency)) : "");
      any = true;
    }
    if (!one.branch.complete)
      text += fmt::format("         {}: not followed to the end: {}\n", of, one.branch.message), any = true;
  }
  return any ? text : text + "         no place of rest changes its stability\n";
}

std::string influences_text(const Exploration& found) {
  std::string text;
  std::size_t shown = 0;
  for (const Influenced& one : found.influences) {
    if (shown++ == most_parameters) break;
    text += fmt::format("matters  {}: ", one.parameter);
    if (one.part == 0) {
      text += "not at all in this run\n";
    } else if (one.part > 100) {
      text += fmt::format("1 % more moves {} by more than its size, at t = {}\n", one.state, short_number(one.t));
    } else {
      text += fmt::format("1 % more moves {} by up to {:.2g} %, at t = {}\n", one.state, one.part, short_number(one.t));
    }
  }
  if (found.influences.size() > most_parameters)
    text += fmt::format("         and {} that matter less\n", found.influences.size() - most_parameters);
  return text;
}

}  // namespace

std::string exploration_text(const Studied& studied, const Exploration& found) {
  const model::Model& model = studied.prepared.program->model;
  std::string text = run_text(model, found) + conserved_text(studied, "kept     ") + rests_text(model, found) +
                     orbit_text(model, found);
  for (const Slider& slider : found.sliders) text += slider_text(slider, model);
  text += influences_text(found);
  if (!found.not_moved.empty())
    text += fmt::format("not moved: {}; a range behind a parameter (`in LOW..HIGH`) says how far it may go\n",
                        fmt::join(found.not_moved, ", "));
  for (const std::string& open : found.open) text += "open     " + open + "\n";
  if (!found.complete) text += "open     what comes after Ctrl-C\n";
  return text;
}

}  // namespace continuo::app
