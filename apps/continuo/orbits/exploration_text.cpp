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

/// One line; those that belong to the line above have no label.
std::string line(std::string_view label, std::string_view text) {
  return fmt::format("{:<12}{}\n", label, text);
}

std::string run_text(const model::Model& model, const Exploration& found) {
  if (!found.simulated.run) return line("run", "none: it could not begin");
  const model::Run& run = *found.simulated.run;
  std::string text =
      line("run", fmt::format("{} at t = {}", to_string(run.outcome.ending), short_number(run.final_time())));
  for (std::size_t i = 0; i < std::min(found.low.size(), most_states); ++i)
    text += line("", fmt::format("{} from {} to {}", model.states[i].column, short_number(found.low[i]),
                                 short_number(found.high[i])));
  if (found.low.size() > most_states)
    text += line("", fmt::format("and {} more states", found.low.size() - most_states));
  if (found.comes_to)
    text += line("", fmt::format("{} equilibrium {}", found.comes_later ? "later converges to" : "converges to",
                                 *found.comes_to + 1));
  return text;
}

std::string equilibria_text(const model::Model& model, const Exploration& found) {
  if (found.searches == 0) return "";
  if (found.equilibria.empty()) return line("equilibria", fmt::format("none found from {} starts", found.searches));
  std::string text = line("equilibria", fmt::format("{} from {} starts", found.equilibria.size(), found.searches));
  const std::size_t shown = std::min<std::size_t>(found.equilibria.size(), 12);
  for (std::size_t k = 0; k < shown; ++k) {
    const ExploredEquilibrium& equilibrium = found.equilibria[k];
    text += fmt::format("{:>11} {}: {}\n", k + 1,
                        equilibrium.jump ? "undecided, the equations jump here" : to_string(equilibrium.at.stability),
                        point_text(model, equilibrium.at.x));
  }
  if (shown < found.equilibria.size()) text += line("", "and more: perhaps a curve of equilibria");
  return text;
}

std::string orbit_text(const model::Model& model, const Exploration& found) {
  std::string text;
  if (found.orbit) {
    text = line("orbit", fmt::format("period {}, {}", with_time_unit(found.orbit->period, model),
                                     found.orbit->stable ? "stable" : "not stable"));
  }
  if (found.hybrid_orbit) {
    using Neighbours = studies::HybridOrbit::Neighbours;
    const studies::HybridOrbit& orbit = *found.hybrid_orbit;
    const std::string turns = orbit.turns > 1 ? fmt::format(", {} periods of the forcing", orbit.turns) : "";
    text = line("orbit", fmt::format("period {}{}, {}", with_time_unit(orbit.period, model), turns,
                                     orbit.neighbours == Neighbours::come_nearer ? "stable"
                                     : orbit.neighbours == Neighbours::go_away   ? "not stable"
                                     : orbit.family                              ? one_of_a_family
                                                                                 : "undecided at first order"));
    if (orbit.found_nearby) text += line("", "the motion does not converge to it, but passes near it");
  }
  if (!found.exponents) return text;
  std::string exponents = "Lyapunov exponents";
  for (std::size_t i = 0; i < found.exponents->exponents.size(); ++i)
    exponents += fmt::format("{} {} +- {:.1g}", i == 0 ? "" : ",", short_number(found.exponents->exponents[i]),
                             found.exponents->spread[i]);
  const double first = found.exponents->exponents[0], doubt = 3 * found.exponents->spread[0];
  return text + line("motion",
                     exponents + (first > doubt    ? ": the motion is chaotic"
                                  : first < -doubt ? ": neighbouring motions converge"
                                                   : ": neighbouring motions neither converge nor diverge measurably"));
}

/// What rounding leaves of a zero is one.
double cleared(const Slider& slider, double value) {
  return std::abs(value) < 1e-12 * (slider.high - slider.low) ? 0 : value;
}

std::string slider_text(const Slider& slider, const model::Model& model) {
  std::string text = line(
      "parameter", fmt::format("{} from {} to {}", slider.name, short_number(slider.low), short_number(slider.high)));
  bool any = false;
  for (std::size_t b = 0; b < slider.branches.size(); ++b) {
    const studies::BranchOfDiagram& one = slider.branches[b];
    std::string of = "crossing branch";
    for (std::size_t k = 0; k < one.starts.size(); ++k)
      of = k == 0 ? fmt::format("{} {}", one.starts.size() == 1 ? "equilibrium" : "equilibria", one.starts[k] + 1)
                  : fmt::format("{}, {}", of, one.starts[k] + 1);
    for (const studies::BifurcationPoint& point : one.branch.bifurcations) {
      if (is_listed_before(slider.branches, b, point)) continue;
      text += line(
          "", fmt::format("{}: {} at {} = {}{}{}", of, to_string(point.kind), slider.name,
                          short_number(cleared(slider, point.at.constant)), state_text(slider.branches, point, model),
                          point.frequency > 0 ? ", frequency " + short_number(point.frequency) : ""));
      any = true;
    }
    if (!one.branch.status)
      text += line("", fmt::format("{} ends early: {}", of, one.branch.status.message)), any = true;
  }
  return any ? text : text + line("", "no equilibrium changes its stability");
}

std::string influences_text(const Exploration& found) {
  std::string text;
  for (const Influenced& one : std::span(found.influences).first(std::min(found.influences.size(), most_parameters)))
    text += line("sensitivity", one.part == 0
                                    ? one.parameter + ": none in this run"
                                    : fmt::format("{}: +1 % changes {} by {}, at t = {}", one.parameter, one.state,
                                                  one.part > 100 ? "more than its largest value"
                                                                 : fmt::format("up to {:.2g} %", one.part),
                                                  short_number(one.t)));
  if (found.influences.size() > most_parameters)
    text += line("", fmt::format("and {} parameters of less influence", found.influences.size() - most_parameters));
  return text;
}

}  // namespace

std::string exploration_text(const Studied& studied, const Exploration& found) {
  const model::Model& model = studied.prepared.program->model;
  std::string text = run_text(model, found) + conserved_text(studied, fmt::format("{:<12}", "conserved")) +
                     equilibria_text(model, found) + orbit_text(model, found);
  for (const Slider& slider : found.sliders) text += slider_text(slider, model);
  text += influences_text(found);
  if (!found.not_varied.empty())
    text += line("not varied", fmt::format("{}: a range after a parameter (`in LOW..HIGH`) declares how far to vary it",
                                           fmt::join(found.not_varied, ", ")));
  for (const std::string& note : found.notes) text += line("note", note);
  if (!found.complete) text += line("note", "interrupted before all was computed");
  return text;
}

}  // namespace continuo::app
