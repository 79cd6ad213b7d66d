// continuo phase FILE: the plane of a model with two states.
#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <apps/continuo/options/command_line.hpp>
#include <apps/continuo/options/models.hpp>
#include <apps/continuo/options/verb_list.hpp>
#include <apps/continuo/studies/studied_model.hpp>
#include <apps/continuo/studies/study_json.hpp>
#include <apps/continuo/terminal/answer.hpp>
#include <apps/continuo/terminal/interrupt.hpp>
#include <apps/continuo/terminal/progress.hpp>
#include <apps/continuo/terminal/terminal.hpp>
#include <apps/continuo/verbs.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <continuo/results/figure.hpp>
#include <continuo/results/summary.hpp>
#include <continuo/simulation/simulate.hpp>
#include <continuo/studies/phase_portrait.hpp>
#include <continuo/studies/support/unseen.hpp>

namespace continuo::app {
namespace {

using studies::PhasePlane;
using studies::PhasePortrait;
using studies::PlaneCurve;
using studies::PlanePoint;

struct PhaseOptions {
  ExperimentOptions experiment;
  std::string mode, plot;
  std::vector<std::string> box, starts;
  std::size_t spread = 16;
  std::optional<double> time;
  bool json = false;
};

/// What the model's own run passes through, half as wide again; the ranges that were asked for.
bool set_plane(const Studied& studied, const PhaseOptions& options, PhasePlane& plane) {
  const model::Model& model = studied.prepared.program->model;
  model::Experiment experiment = studied.prepared.experiment;
  experiment.interrupt = &interrupt_flag();
  const model::Simulated simulated = model::simulate(studied.prepared.program, experiment);
  plane.low = plane.high = {studied.start[0], studied.start[1]};
  if (simulated.run) {
    plane.duration = std::max(simulated.run->plan.to - simulated.run->plan.from, 1e-300);
    for (std::size_t row = 0; row < simulated.run->motion.rows(); ++row) {
      for (std::size_t i = 0; i < 2; ++i) {
        const double x = simulated.run->motion.state(row)[i];
        plane.low[i] = std::min(plane.low[i], x);
        plane.high[i] = std::max(plane.high[i], x);
      }
    }
  }
  for (std::size_t i = 0; i < 2; ++i) {
    const double wide = std::max(plane.high[i] - plane.low[i], 1e-6 * std::max(1.0, std::abs(plane.high[i])));
    plane.low[i] -= wide / 4;
    plane.high[i] += wide / 4;
  }
  for (const std::string& text : options.box) {
    const auto range = parse_range(text);
    const auto i = range ? state_named(model, range->name) : std::nullopt;
    if (!i) return false;
    plane.low[*i] = range->low;
    plane.high[*i] = range->high;
  }
  return true;
}

/// `x=1;y=2`: the states that are not named begin as the model says.
bool set_starts(const Studied& studied, const std::vector<std::string>& texts, PhasePlane& plane) {
  for (const std::string& text : texts) {
    std::vector<std::string> parts;
    for (std::size_t from = 0; from <= text.size();) {
      const std::size_t end = std::min(text.find(';', from), text.size());
      parts.push_back(text.substr(from, end - from));
      from = end + 1;
    }
    std::vector<double> state = studied.start;
    if (!set_states(studied.prepared.program->model, parts, state)) return false;
    plane.starts.push_back({state[0], state[1]});
  }
  return true;
}

void append(results::Curve& curve, const PlaneCurve& points) {
  for (const PlanePoint& point : points) {
    curve.x.push_back(point[0]);
    curve.y.push_back(point[1]);
  }
  curve.x.push_back(std::nan(""));
  curve.y.push_back(std::nan(""));
}

/// Strokes with heads, all of one length on the picture.
results::Curve field_of(const PhasePortrait& portrait, const PhasePlane& plane) {
  results::Curve curve{
      .label = "direction", .x = {}, .y = {}, .color = "#bbbbbb", .style = results::Curve::Style::thin_line};
  const double length = 0.6 / static_cast<double>(plane.arrows);
  const PlanePoint size{plane.high[0] - plane.low[0], plane.high[1] - plane.low[1]};
  for (const studies::FieldArrow& arrow : portrait.field) {
    const auto at = [&](double along, double aside) -> PlanePoint {
      return {arrow.at[0] + size[0] * length * (along * arrow.direction[0] - aside * arrow.direction[1]),
              arrow.at[1] + size[1] * length * (along * arrow.direction[1] + aside * arrow.direction[0])};
    };
    append(curve, {at(-0.5, 0), at(0.5, 0), at(0.15, 0.18)});
    append(curve, {at(0.5, 0), at(0.15, -0.18)});
  }
  return curve;
}

results::Figure figure_of(const model::Model& model, const PhasePortrait& portrait, const PhasePlane& plane) {
  const auto label = [&](std::size_t i) {
    const model::State& state = model.states[i];
    return state.unit.empty() || state.unit == "1" ? state.column : fmt::format("{} [{}]", state.column, state.unit);
  };
  results::Panel panel{.x_label = label(0), .y_label = label(1), .curves = {field_of(portrait, plane)}, .tall = true};
  const auto add = [&](std::string name, std::string color, const std::vector<PlaneCurve>& curves,
                       results::Curve::Style style) {
    results::Curve curve{.label = std::move(name), .x = {}, .y = {}, .color = std::move(color), .style = style};
    for (const PlaneCurve& points : curves) append(curve, points);
    if (!curve.x.empty()) panel.curves.push_back(std::move(curve));
  };
  using enum results::Curve::Style;
  add("motions", "#0072b2", portrait.motions, thin_line);
  add("nullcline of " + model.states[0].column, "#009e73", portrait.nullclines[0], line);
  add("nullcline of " + model.states[1].column, "#e69f00", portrait.nullclines[1], line);
  add("separatrices", "#d55e00", portrait.separatrices, line);
  std::vector<PlaneCurve> stable, undecided, others;
  for (const studies::Equilibrium& e : portrait.equilibria) {
    const bool is_stable = e.stability == studies::Stability::asymptotically_stable;
    auto& places = is_stable ? stable : e.stability == studies::Stability::undecided ? undecided : others;
    places.push_back({{e.x[0], e.x[1]}});
  }
  add("equilibrium, stable", "#000000", stable, full_points);
  add("equilibrium, undecided", "#888888", undecided, full_points);
  add("equilibrium, not stable", "#000000", others, empty_points);
  return {.title = model.name, .panels = {std::move(panel)}};
}

std::string summary_of(const model::Model& model, const PhasePortrait& portrait, const PhasePlane& plane) {
  std::string text =
      fmt::format("{} from {} to {}, {} from {} to {}\n", model.states[0].column, results::short_number(plane.low[0]),
                  results::short_number(plane.high[0]), model.states[1].column, results::short_number(plane.low[1]),
                  results::short_number(plane.high[1]));
  for (const studies::Equilibrium& e : portrait.equilibria) {
    text += fmt::format("equilibrium ({}, {}): {}, {}", results::short_number(std::abs(e.x[0]) < 1e-13 ? 0 : e.x[0]),
                        results::short_number(std::abs(e.x[1]) < 1e-13 ? 0 : e.x[1]), to_string(e.stability),
                        e.eigenvalues.empty() ? "the equations jump here" : "eigenvalues");
    for (std::size_t i = 0; i < e.eigenvalues.size(); ++i)
      if (e.eigenvalues[i].imag() >= 0)
        text +=
            fmt::format("{} {}", i == 0 ? "" : ",", eigenvalue_text(e.eigenvalues[i].real(), e.eigenvalues[i].imag()));
    text += "\n";
  }
  return text + fmt::format("{} motions, {} separatrices\n", portrait.motions.size(), portrait.separatrices.size());
}

ExitCode phase(const PhaseOptions& options) {
  if (!drawable(options.plot)) return usage;
  const Studied studied = study(options.experiment, options.mode);
  if (studied.prepared.exit != done) return studied.prepared.exit;
  const model::Model& model = studied.prepared.program->model;
  if (model.states.size() != 2) {
    say(fmt::format("a phase plane needs two states, this model has {}; `continuo steady` finds its equilibria",
                    model.states.size()));
    return wrong_model;
  }
  if (!options.time && !stands_still_in_time(studied, "a portrait is drawn")) {
    say("--time T fixes the time in the equations");
    return wrong_model;
  }
  const auto event = studies::changes_by_event(model, studied.mode);
  if (event && options.mode.empty() && !options.time) {
    say(fmt::format(
        "{}: a portrait is drawn of equations alone, and this event changes the motion; --time 0 draws it "
        "without{}",
        place_text(studied.prepared, *event), model.modes.size() > 1 ? ", and so does --mode NAME of one mode" : ""));
    return wrong_model;
  }
  PhasePlane plane{
      .low = {}, .high = {}, .spread = options.spread, .t = options.time.value_or(0), .interrupt = &interrupt_flag()};
  if (!set_plane(studied, options, plane) || !set_starts(studied, options.starts, plane)) return usage;
  PhasePortrait portrait = [&] {
    Progress progress;
    plane.progress = progress.parts();
    return studies::phase_portrait(studied.system, plane);
  }();
  for (studies::Equilibrium& e : portrait.equilibria) {
    if (!studies::jump_at(*studied.prepared.program, studied.mode, e.x, studied.prepared.experiment.parameters))
      continue;
    e.stability = studies::Stability::undecided;
    e.eigenvalues.clear();
  }
  if (options.json) {
    answer("continuo.phase/1", portrait_json(model, portrait, plane));
  } else {
    print(summary_of(model, portrait, plane));
  }
  if (!options.plot.empty()) {
    if (!written(results::draw(figure_of(model, portrait, plane), options.plot))) return usage;
  }
  return portrait.complete ? done : interrupted;
}

}  // namespace

void add_phase(CLI::App& app, ExitCode& exit) {
  static constexpr std::string_view examples =
      "  continuo phase models/pendulum.sim --plot pendulum.svg\n"
      "  continuo phase models/predator_prey.sim --box hares=0..4,lynxes=0..3 --plot plane.svg\n"
      "  continuo phase models/pendulum.sim --start \"theta=1;theta'=0\" --plot one.svg\n";
  Verb* verb = add_verb(app, listed("phase"), examples, {wrong_model, interrupted});
  verb->json_examples = {"continuo phase models/pendulum.sim --json"};
  auto options = std::make_shared<PhaseOptions>();
  add_model(*verb, options->experiment);
  verb->add_option("--mode", options->mode, "The mode whose equations are used")->type_name("NAME");
  verb->add_option("--box", options->box, "The region of the plane")->delimiter(',')->type_name("NAME=LOW..HIGH");
  verb->add_option("--start", options->starts, "Initial state of a trajectory; may be repeated")
      ->type_name("NAME=VALUE;...")
      ->allow_extra_args(false);
  verb->add_option("--spread", options->spread, "Without --start: number of trajectories")
      ->check(count_from(0, 10'000))
      ->type_name("N");
  verb->add_option("--time", options->time, "The time, if the equations depend on it")
      ->check(finite_number())
      ->type_name("T");
  verb->add_flag("--json", options->json, "Prints equilibria, nullclines and trajectories as one JSON object");
  writes_file(*verb, verb->add_option("--plot", options->plot, "The picture, .svg or .png"));
  verb->callback([&exit, options] { exit = phase(*options); });
}

}  // namespace continuo::app
