// Closed orbits through events, modes and jumps, or of a forced model: found, printed and drawn.
#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include <apps/continuo/orbits/hybrid_orbit.hpp>
#include <apps/continuo/orbits/orbit_figure.hpp>
#include <apps/continuo/orbits/steady_branches.hpp>
#include <apps/continuo/studies/orbit_text.hpp>
#include <apps/continuo/terminal/answer.hpp>
#include <apps/continuo/terminal/interrupt.hpp>
#include <apps/continuo/terminal/progress.hpp>
#include <apps/continuo/terminal/terminal.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <continuo/results/figure.hpp>
#include <continuo/results/summary.hpp>
#include <continuo/studies/hybrid_orbit.hpp>
#include <continuo/studies/support/forcing_period.hpp>

namespace continuo::app {
namespace {

constexpr double longer = 10;
constexpr double longest_forcing = 10;  // in times of the run that looks for the orbit

/// The period of what depends on the time: that of the text, or the one that was given where it fits. False where there
/// is none that can be relied on, which is said.
bool set_forcing(const Studied& studied, const HybridOrbitRequest& request, studies::HybridOrbitOptions& search) {
  const model::ModelProgram& program = *studied.prepared.program;
  const model::Overrides& parameters = studied.prepared.experiment.parameters;
  const studies::Forcing forcing = studies::forcing_of(program, parameters);
  search.forcing = forcing.period;
  if (request.forcing) {
    const double ratio = forcing.period ? *request.forcing / *forcing.period : 1;
    if (std::abs(ratio - std::round(ratio)) > 1e-9 * ratio || std::round(ratio) < 1) {
      say(fmt::format("--period {:.10g} is not a multiple of {:.10g}, the period of the model according to its text",
                      *request.forcing, *forcing.period));
      return false;
    }
    if (*request.forcing > longest_forcing * (request.settle + request.duration)) {
      say(fmt::format("--period {:.10g} is far longer than the run that searches for the orbit (--settle, --duration)",
                      *request.forcing));
      return false;
    }
    std::vector<double> low, high;
    for (const double x : studied.start) low.push_back(x - 1 - std::abs(x)), high.push_back(x + 1 + std::abs(x));
    if (!studies::repeats_after(program, *request.forcing, low, high, parameters)) {
      say(fmt::format("the model is not periodic with the period {:.10g} (--period)", *request.forcing));
      return false;
    }
    if (!forcing.period && forcing.status) {
      say("--period: the model does not depend on time, so the period is computed");
      return false;
    }
    search.forcing = request.forcing;
  } else if (!forcing.status) {
    say(fmt::format("{}: {}; --period T gives it", place_text(studied.prepared, forcing.span), forcing.status.message));
    return false;
  }
  if (search.forcing || request.turns == 0) return true;
  say("--turns counts periods of a forcing, but the model does not depend on time");
  return false;
}

results::Figure figure_of(const model::Model& model, const studies::HybridOrbit& found) {
  std::vector<double> times;
  for (const double t : found.t) times.push_back(t - found.start.t);
  return orbit_figure(model, times, found.x);
}

const char* neighbours_text(const studies::HybridOrbit& found) {
  using Neighbours = studies::HybridOrbit::Neighbours;
  if (found.neighbours == Neighbours::go_away) return "unstable";
  if (found.neighbours == Neighbours::come_nearer) return "stable";
  return "neutral at first order";
}

std::string text_of(const model::Model& model, const studies::HybridOrbit& found,
                    const std::optional<double>& forcing) {
  std::string text = fmt::format("period {}, ", with_time_unit(found.period, model));
  if (forcing && found.turns > 1) text += fmt::format("{} periods of the forcing ({:.10g}), ", found.turns, *forcing);
  text += fmt::format("{}\n", neighbours_text(found)) + multipliers_text(found.multipliers);
  if (found.family) text += fmt::format("  {}\n", one_of_a_family);
  text += extents_text(model, found.low, found.high);
  std::vector<std::pair<std::string, std::size_t>> counts;
  for (const studies::SensitivityEvent& event : found.events) {
    const auto known = std::ranges::find(counts, event.name, &std::pair<std::string, std::size_t>::first);
    if (known == counts.end()) {
      counts.emplace_back(event.name, 1);
    } else {
      ++known->second;
    }
  }
  for (const auto& [name, count] : counts)
    text += fmt::format("  `{}` {} a period\n", name, count == 1 ? "once" : fmt::format("{} times", count));
  for (const std::size_t i : found.aside)
    text += fmt::format("  {} does not return; nothing depends on it\n", model.states[i].column);
  if (found.found_nearby) text += "  the motion does not converge to it, but passes near it\n";
  return text;
}

nlohmann::json json_of(const model::Model& model, const studies::HybridOrbit& found,
                       const std::optional<double>& forcing) {
  auto states = nlohmann::json::array(), events = nlohmann::json::array(), aside = nlohmann::json::array();
  for (const model::State& state : model.states) states.push_back(state.column);
  for (const studies::SensitivityEvent& event : found.events) events.push_back({{"name", event.name}, {"t", event.t}});
  for (const std::size_t i : found.aside) aside.push_back(model.states[i].column);
  nlohmann::json object{{"states", states},
                        {"period", found.period},
                        {"t", found.start.t},
                        {"x", found.start.x},
                        {"min", found.low},
                        {"max", found.high},
                        {"multipliers", app::json_of(found.multipliers)},
                        {"stable", found.neighbours == studies::HybridOrbit::Neighbours::come_nearer},
                        {"family", found.family},
                        {"settled", !found.found_nearby},
                        {"events", events},
                        {"aside", aside}};
  if (model.modes.size() > 1) object["mode"] = model.modes[found.start.mode].name;
  if (forcing) object.update({{"forcing", *forcing}, {"turns", found.turns}});
  return object;
}

}  // namespace

std::optional<studies::HybridOrbitOptions> search_of(const Studied& studied, const HybridOrbitRequest& request) {
  studies::HybridOrbitOptions search{.settle = request.settle,
                                     .duration = request.duration,
                                     .tolerance = request.tolerance,
                                     .turns = request.turns,
                                     .interrupt = &interrupt_flag()};
  if (!set_forcing(studied, request, search)) return std::nullopt;
  return search;
}

studies::HybridOrbit find_hybrid_orbit(const Studied& studied, const HybridOrbitRequest& request,
                                       studies::HybridOrbitOptions search) {
  const auto look = [&] {
    return studies::find_hybrid_orbit(studied.prepared.program, studied.prepared.experiment, search);
  };
  studies::HybridOrbit first = look();
  if (first.outcome || !first.wanders || !request.patient) return first;
  search.settle *= longer;
  search.duration *= longer;
  return look();
}

ExitCode show_hybrid_orbit(const Studied& studied, const HybridOrbitRequest& request) {
  const model::Model& model = studied.prepared.program->model;
  std::optional<studies::HybridOrbitOptions> search = search_of(studied, request);
  if (!search) return wrong_model;
  const studies::HybridOrbit found = [&] {
    Progress progress;
    search->progress = progress.parts();
    return find_hybrid_orbit(studied, request, *search);
  }();
  if (!found.outcome) return failed_exit(found.outcome);
  if (request.json) {
    answer("continuo.orbit/1", json_of(model, found, search->forcing));
  } else {
    print(text_of(model, found, search->forcing));
  }
  if (!request.plot.empty() && !written(results::draw(figure_of(model, found), request.plot))) return usage;
  return done;
}

}  // namespace continuo::app
