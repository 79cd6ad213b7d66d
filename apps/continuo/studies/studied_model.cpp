// apps/continuo/studies/studied_model.cpp
// Prepares a model for the study of its equations, and prints its conserved quantities and events.
#include <algorithm>
#include <charconv>
#include <cmath>
#include <string_view>

#include <apps/continuo/studies/influences.hpp>
#include <apps/continuo/studies/studied_model.hpp>
#include <apps/continuo/terminal/interrupt.hpp>
#include <apps/continuo/terminal/terminal.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <continuo/results/summary.hpp>
#include <continuo/simulation/of_model.hpp>
#include <continuo/simulation/simulate.hpp>
#include <continuo/studies/equilibria/events_at.hpp>
#include <continuo/studies/support/unseen.hpp>

namespace continuo::app {

namespace {

std::optional<double> number_in(std::string_view text) {
  while (!text.empty() && text.front() == ' ') text.remove_prefix(1);
  while (!text.empty() && text.back() == ' ') text.remove_suffix(1);
  if (!text.empty() && text.front() == '+') text.remove_prefix(1);
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value)) return std::nullopt;
  return value;
}

bool fits(const Prepared& prepared, Equations equations) {
  if (has_no_start(prepared)) return false;
  if (equations == Equations::algebraic_too || !prepared.program->model.needs_dae_solver()) return true;
  say("the model has algebraic equations, which this verb cannot study yet");
  return false;
}

}  // namespace

Studied study(const ExperimentOptions& options, const std::string& mode, const std::vector<std::string>& constants,
              Equations equations) {
  Studied studied{.prepared = prepare(options)};
  if (studied.prepared.exit != done) return studied;
  const model::Model& model = studied.prepared.program->model;
  if (!fits(studied.prepared, equations)) {
    studied.prepared.exit = wrong_model;
    return studied;
  }
  studied.mode = model.start_mode;
  if (!mode.empty()) {
    studied.mode = model::find_mode(model, mode);
    if (studied.mode == model::npos) {
      std::vector<std::string> names;
      for (const model::Mode& known : model.modes) names.push_back(known.name);
      say(no_such("mode", mode, names));
      studied.prepared.exit = usage;
      return studied;
    }
  }
  for (const std::string& name : constants) {
    if (model::find_parameter(model, name) != model::npos) continue;
    std::vector<std::string> names;
    for (const model::Parameter& known : model.parameters) names.push_back(known.name);
    say(no_such("parameter", name, names));
    studied.prepared.exit = usage;
    return studied;
  }
  const model::Overrides& parameters = studied.prepared.experiment.parameters;
  studied.system = model::of_model(studied.prepared.program,
                                   {.constants = constants, .parameters = parameters, .mode = studied.mode});
  studied.start = model::start_of(model, parameters);
  return studied;
}

void hold_conserved(Studied& studied) {
  studied.laws = studies::conservation_laws_of(studied.system, studied.start);
  studied.system = holding_laws(studied, studied.system);
}

ParametricSystem holding_laws(const Studied& studied, const ParametricSystem& system) {
  if (studied.laws.empty()) return system;
  return studies::holding(system, studied.laws,
                          [program = studied.prepared.program, names = system.constant_names,
                           overrides = studied.prepared.experiment.parameters](Values p) {
                            model::Overrides moved = overrides;
                            for (std::size_t i = 0; i < names.size(); ++i) moved[names[i]] = p[i];
                            return model::start_of(program->model, moved);
                          });
}

std::string conserved_text(const Studied& studied, std::string_view head) {
  const std::string below(head.size(), ' ');
  std::string text;
  for (const studies::ConservationLaw& law : studied.laws)
    text += fmt::format("{}{} = {}\n", text.empty() ? head : below, studies::law_text(studied.system, law),
                        results::short_number(law.value));
  if (!text.empty() && !studied.prepared.program->model.events.empty())
    text += below + "by the equations; events, which may change it, are not considered\n";
  return text;
}

void add_conserved(nlohmann::json& object, const Studied& studied) {
  if (!studied.laws.empty()) object["events_may_change_conserved"] = !studied.prepared.program->model.events.empty();
  for (const studies::ConservationLaw& law : studied.laws)
    object["conserved"].push_back({{"sum", studies::law_text(studied.system, law)}, {"value", law.value}});
}

double run_length(const model::Model& model) {
  return model.run.to && model.run.from ? model.run.to->value - model.run.from->value : 100;
}

bool stands_still_in_time(const Studied& studied, std::string_view what) {
  const model::ModelProgram& program = *studied.prepared.program;
  const auto follow = "`continuo orbit --section` and `--lyapunov` follow the motion as it is";
  if (const auto i = studies::depends_on_time(program, studied.mode)) {
    const model::State& state = program.model.states[*i];
    say(fmt::format("{}: {} only if no equation depends on time, and that of `{}` does; {}",
                    place_text(studied.prepared, state.span), what, state.algebraic ? state.column : state.column + "'",
                    follow));
    return false;
  }
  if (const auto span = studies::changes_at_set_times(program.model)) {
    say(fmt::format("{}: {} only without scheduled events, but this is one; {}", place_text(studied.prepared, *span),
                    what, follow));
    return false;
  }
  return true;
}

bool can_be_studied_alone(const Studied& studied, const std::string& mode, std::string_view what) {
  if (!stands_still_in_time(studied, what)) return false;
  const auto unseen =
      mode.empty() ? studies::unseen_of(*studied.prepared.program, studied.mode) : std::optional<studies::Unseen>();
  if (!unseen) return true;
  const bool has_modes = studied.prepared.program->model.modes.size() > 1;
  say(fmt::format(
      "{}: {} from the equations alone, and here {}; `continuo orbit --section` and `--lyapunov` follow the "
      "motion as it is{}",
      place_text(studied.prepared, unseen->span), what, unseen->what,
      has_modes ? ", and --mode NAME studies one mode's equations by themselves" : ""));
  return false;
}

std::string events_text(const Studied& studied, const std::vector<double>& x) {
  const model::ModelProgram& program = *studied.prepared.program;
  const model::Model& model = program.model;
  std::string text;
  if (model.modes.size() > 1) text += fmt::format("   in mode {}\n", model.modes[studied.mode].name);
  for (const studies::EventAt& at :
       studies::events_at(program, studied.mode, x, studied.prepared.experiment.parameters)) {
    if (at.where == studies::EventAt::Where::on_surface) {
      text += fmt::format("   on the surface of the event `{}`: neighbours on one side meet it\n", at.event);
    } else {
      text += fmt::format("   {} `{}`: a motion from elsewhere meets that event before it comes here\n",
                          at.is_condition ? "inside of" : "beyond", at.event);
    }
  }
  return text;
}

void add_events(nlohmann::json& object, const Studied& studied, const std::vector<double>& x) {
  const model::ModelProgram& program = *studied.prepared.program;
  if (program.model.modes.size() > 1) object["mode"] = program.model.modes[studied.mode].name;
  const auto events = studies::events_at(program, studied.mode, x, studied.prepared.experiment.parameters);
  for (const studies::EventAt& at : events)
    object["events"].push_back(
        {{"name", at.event}, {"where", at.where == studies::EventAt::Where::on_surface ? "on" : "beyond"}});
}

std::string describe_undetermined(const Studied& studied, const studies::Undetermined& open) {
  const model::Model& model = studied.prepared.program->model;
  const model::Source& source = studied.prepared.loaded.source;
  std::vector<const model::AlgebraicEquation*> own;
  for (const model::AlgebraicEquation& equation : model.algebraic)
    if (equation.mode == studied.mode) own.push_back(&equation);
  std::string unknowns, equations;
  for (const std::size_t k : open.unknowns)
    unknowns +=
        fmt::format("{}`{}`", unknowns.empty() ? "" : ", ", model.states[studied.system.differential() + k].column);
  for (const std::size_t k : open.equations) {
    const model::Span span = own[k]->span;
    equations +=
        fmt::format("{}`{}` (line {})", equations.empty() ? "" : ", ",
                    model.text.content.substr(span.begin, span.end - span.begin), source.place(span.begin).line);
  }
  return fmt::format("the algebraic equations do not determine {} here: {} {} nothing that the others do not say",
                     unknowns, equations, open.equations.size() == 1 ? "says" : "say");
}

std::optional<std::size_t> state_named(const model::Model& model, const std::string& name) {
  const std::size_t i = model::find_state(model, name);
  if (i != model::npos) return i;
  std::vector<std::string> names;
  for (const model::State& known : model.states) names.push_back(known.column);
  say(no_such("state", name, names));
  return std::nullopt;
}

bool set_states(const model::Model& model, const std::vector<std::string>& texts, std::vector<double>& state) {
  for (const std::string& text : texts) {
    const auto equals = text.find('=');
    const auto value =
        equals == std::string::npos ? std::nullopt : number_in(std::string_view(text).substr(equals + 1));
    if (!value) {
      say(fmt::format("`{}` is not NAME=NUMBER", text));
      return false;
    }
    const auto i = state_named(model, text.substr(0, equals));
    if (!i) return false;
    state[*i] = *value;
  }
  return true;
}

std::optional<NamedRange> parse_range(const std::string& text) {
  const auto equals = text.find('='), dots = text.find("..", equals == std::string::npos ? 0 : equals);
  if (equals != std::string::npos && dots != std::string::npos) {
    const auto low = number_in(std::string_view(text).substr(equals + 1, dots - equals - 1));
    const auto high = number_in(std::string_view(text).substr(dots + 2));
    if (low && high && *low < *high) return NamedRange{text.substr(0, equals), *low, *high};
  }
  say(fmt::format("`{}` is not NAME=LOW..HIGH", text));
  return std::nullopt;
}

bool set_box(const Studied& studied, const std::vector<std::string>& ranges, studies::EquilibriumBox& box) {
  const model::Model& model = studied.prepared.program->model;
  box.low = box.high = box.first = studied.start;
  model::Experiment experiment = studied.prepared.experiment;
  experiment.interrupt = &interrupt_flag();
  const model::Simulated simulated = model::simulate(studied.prepared.program, experiment);
  for (std::size_t row = 0; simulated.run && row < simulated.run->motion.rows(); ++row) {
    const auto x = simulated.run->motion.state(row);
    for (std::size_t i = 0; i < x.size(); ++i) {
      if (!std::isfinite(x[i])) continue;
      box.low[i] = std::min(box.low[i], x[i]);
      box.high[i] = std::max(box.high[i], x[i]);
    }
  }
  for (std::size_t i = 0; i < box.low.size(); ++i) {
    const double wide = std::max(box.high[i] - box.low[i], std::max(1.0, std::abs(box.high[i])));
    box.low[i] -= wide / 2;
    box.high[i] += wide / 2;
  }
  std::vector<std::size_t> named;
  for (const std::string& text : ranges) {
    const auto range = parse_range(text);
    const auto i = range ? state_named(model, range->name) : std::nullopt;
    if (!i) return false;
    if (std::ranges::find(named, *i) != named.end()) {
      say(fmt::format("--box {}: `{}` is given twice", text, range->name));
      return false;
    }
    named.push_back(*i);
    box.low[*i] = range->low;
    box.high[*i] = range->high;
  }
  return true;
}

std::string eigenvalue_text(double real, double imaginary) {
  const std::string head = results::short_number(real);
  if (imaginary == 0) return head;
  return fmt::format("{} +- {} i", head, results::short_number(std::abs(imaginary)));
}

}  // namespace continuo::app
