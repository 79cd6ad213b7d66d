// continuo info FILE: what a model consists of.
#include <algorithm>
#include <iterator>
#include <memory>
#include <string>

#include <apps/continuo/command_line.hpp>
#include <apps/continuo/models.hpp>
#include <apps/continuo/terminal.hpp>
#include <apps/continuo/verbs.hpp>
#include <fmt/format.h>

#include <continuo/results/csv.hpp>

namespace continuo::app {
namespace {

using model::Model;
using results::number;

constexpr std::size_t most_lines = 30;

std::string with_unit(double value, std::string_view unit) {
  return unit.empty() ? number(value) : fmt::format("{} {}", number(value), unit);
}

/// A heading and one line per element; long lists are cut.
template <class List, class Line>
void append_list(std::string& text, std::string_view heading, const List& list, Line&& line) {
  if (list.empty()) return;
  text += fmt::format("\n{}\n", heading);
  std::size_t widest = 0, shown = 0;
  for (const auto& item : list) widest = std::max(widest, line(item).first.size());
  for (const auto& item : list) {
    if (++shown > most_lines) {
      text += fmt::format("  and {} more\n", list.size() - most_lines);
      return;
    }
    const auto [name, rest] = line(item);
    text += rest.empty() ? fmt::format("  {}\n", name) : fmt::format("  {:<{}}  {}\n", name, widest, rest);
  }
}

std::string range_of(const std::optional<model::Range>& range) {
  return range ? fmt::format("  in {}..{}", number(range->low), number(range->high)) : "";
}

std::string comment_of(const std::string& comment) {
  return comment.empty() ? "" : "  # " + comment;
}

using Line = std::pair<std::string, std::string>;

void append_variables(std::string& text, const Model& model) {
  const auto start = model::start_values(model);
  append_list(text, "states, at first", model.states, [&](const model::State& state) {
    return Line(state.column, "= " + with_unit(start[state.variable], state.unit));
  });
  append_list(text, "parameters", model.parameters, [](const model::Parameter& parameter) {
    return Line(parameter.name, "= " + with_unit(parameter.value, parameter.unit) + range_of(parameter.range) +
                                    comment_of(parameter.comment));
  });
  append_list(text, "inputs", model.inputs, [](const model::Input& input) {
    const std::string source = !input.file.empty() ? "  from " + input.file
                               : input.key.empty() ? ""
                                                   : "  key " + input.key;
    return Line(input.name, "= " + with_unit(input.value, input.unit) + range_of(input.range) + source);
  });
}

void append_quantities(std::string& text, const Model& model) {
  const auto line = [](const model::Quantity& quantity) {
    return Line(quantity.name, quantity.unit.empty() ? "" : "[" + quantity.unit + "]");
  };
  append_list(text, "outputs", model.outputs, line);
  append_list(text, "energies", model.energies, line);
}

void append_events(std::string& text, const Model& model) {
  if (model.modes.size() > 1) {
    append_list(text, "modes", model.modes, [&](const model::Mode& mode) {
      return Line(mode.name, &mode == &model.modes[model.start_mode] ? "at first" : "");
    });
  }
  append_list(text, "events", model.event_order, [&](const model::EventOrder& event) {
    return Line(event.scheduled ? model.schedule[event.index].name : model.events[event.index].name, "");
  });
}

void append_experiment(std::string& text, const Model& model) {
  const model::RunSettings& run = model.run;
  text += "\nrun\n";
  if (run.from && run.to) {
    text += fmt::format("  from {} to {}\n", number(run.from->value), with_unit(run.to->value, model.time_unit));
  }
  if (run.method) text += fmt::format("  method {}\n", *run.method);
  if (run.step) text += fmt::format("  step {}\n", with_unit(run.step->value, model.time_unit));
  if (run.rtol) text += fmt::format("  tol {}\n", number(*run.rtol));
  append_list(text, "checks", model.checks, [](const model::Check& check) { return Line(check.text, ""); });
}

ExitCode info(const std::string& path) {
  if (!readable(path)) return usage;
  const model::Loaded loaded = load_model(path);
  if (!loaded) return wrong_model;
  const Model& model = *loaded.model;
  std::string text = model.name + "\n";
  if (!model.heading.empty()) text += model.heading + (model.heading.ends_with('\n') ? "" : "\n");
  append_variables(text, model);
  append_quantities(text, model);
  append_events(text, model);
  append_experiment(text, model);
  print(text);
  return done;
}

}  // namespace

void add_info(CLI::App& app, ExitCode& exit) {
  CLI::App* verb = add_verb(app, "info", "Shows states, parameters, events and the experiment of a model",
                            "  continuo info models/bouncing_ball.sim\n");
  auto path = std::make_shared<std::string>();
  verb->add_option("file", *path, "The model")->required()->type_name("");
  verb->callback([&exit, path] { exit = info(*path); });
}

}  // namespace continuo::app
