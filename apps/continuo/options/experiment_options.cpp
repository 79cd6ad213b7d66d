// Adds the options that change an experiment, and reads them into one.
#include <algorithm>
#include <cstdio>
#include <span>
#include <utility>

#include <apps/continuo/options/command_line.hpp>
#include <apps/continuo/options/experiment_options.hpp>
#include <apps/continuo/options/models.hpp>
#include <apps/continuo/terminal/interrupt.hpp>
#include <apps/continuo/terminal/terminal.hpp>
#include <fmt/format.h>

#include <continuo/language/text/diagnostic.hpp>
#include <continuo/runs/kind.hpp>
#include <continuo/runs/run.hpp>
#include <continuo/simulation/simulate.hpp>

namespace continuo::app {
namespace {

/// The settings as values; what is wrong with them stands in a text of its own, not in the model's.
std::optional<model::Overrides> read_settings(const model::Model& model, const std::vector<std::string>& settings) {
  model::Overrides values;
  bool fine = true;
  for (const std::string& text : settings) {
    std::vector<model::Diagnostic> problems;
    const auto setting = model::parse_setting(model, text, problems);
    show(problems, model::Source("--set", text));
    const bool new_one = setting && values.emplace(setting->name, setting->value).second;
    if (setting && !new_one) say(fmt::format("--set {}: `{}` is given twice", text, setting->name));
    fine = fine && new_one;
  }
  return fine ? std::optional(std::move(values)) : std::nullopt;
}

/// False, after saying why, where a text is no tolerance.
bool read_tolerances(const model::Model& model, const ExperimentOptions& options, model::Experiment& experiment) {
  bool fine = true;
  const auto read = [&](model::ToleranceKind kind, const char* option, const std::vector<std::string>& texts,
                        const auto& of_all, model::Overrides& of_each) {
    std::vector<std::string> names;
    for (const std::string& text : texts) {
      std::vector<model::Diagnostic> problems;
      const auto tolerance = model::parse_tolerance(model, kind, text, problems);
      show(problems, model::Source(option, text));
      fine = fine && tolerance.has_value();
      if (!tolerance) continue;
      if (std::ranges::find(names, tolerance->name) != names.end()) {
        say(fmt::format("{} {}: {} is given twice", option, text,
                        tolerance->name.empty() ? "the tolerance" : "`" + tolerance->name + "`"));
        fine = false;
      }
      names.push_back(tolerance->name);
      if (tolerance->name.empty()) {
        of_all(tolerance->value);
      } else {
        of_each[tolerance->name] = tolerance->value;
      }
    }
  };
  read(
      model::ToleranceKind::relative, "--tol", options.tolerances, [&](double rtol) { experiment.rtol = rtol; },
      experiment.rtol_of);
  read(
      model::ToleranceKind::absolute, "--atol", options.absolute_tolerances,
      [&](double atol) { experiment.atol = {atol}; }, experiment.atol_of);
  return fine;
}

bool decides_a_size(const model::Model& model, const model::Overrides& values) {
  return std::ranges::any_of(values, [&](const auto& value) {
    const std::size_t i = model::find_parameter(model, value.first);
    return i != model::npos && model.parameters[i].structural;
  });
}

}  // namespace

void add_model(CLI::App& verb, ExperimentOptions& options) {
  verb.add_option("file", options.file, "The model")->required()->type_name("");
  verb.add_option("--set", options.settings, "Sets a parameter: --set k=5 --set \"c=0.2 [N*s/m]\"")
      ->type_name("NAME=VALUE")
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
}

void add_experiment(CLI::App& verb, ExperimentOptions& options) {
  add_model(verb, options);
  verb.add_option("--until", options.until, "End time of the run")->type_name("T");
  verb.add_option("--output", options.output, "Output interval")->type_name("DT")->transform(quotients());
}

void add_tolerances(CLI::App& verb, ExperimentOptions& options) {
  const auto list = [&verb](const char* name, std::vector<std::string>& texts, const char* help) {
    return verb.add_option(name, texts, help)->expected(1)->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  };
  list("--tol,--rtol", options.tolerances, "The relative tolerance: --tol 1e-8 --tol y2=1e-10")
      ->type_name("[NAME=]RTOL");
  list("--atol", options.absolute_tolerances,
       "The absolute tolerance, in the unit of the state: --atol 1e-9 --atol \"h'=1e-12\"")
      ->type_name("[NAME=]ATOL");
}

void add_method(CLI::App& verb, ExperimentOptions& options) {
  verb.add_option("--method", options.method, "The integration method (continuo methods)")->type_name("NAME");
  add_tolerances(verb, options);
  verb.add_option("--step", options.step, "Fixed step size")
      ->type_name("H")
      ->transform(quotients())
      ->excludes(verb.get_option("--tol"))
      ->excludes(verb.get_option("--atol"));
}

void add_limits(CLI::App& verb, ExperimentOptions& options) {
  verb.add_option("--max-step", options.max_step, "Largest step size of an adaptive method")
      ->type_name("H")
      ->transform(quotients())
      ->excludes(verb.get_option("--step"));
  verb.add_option("--max-steps", options.max_steps, "Largest number of steps")
      ->check(count_from(1, 1'000'000'000'000))
      ->type_name("N");
}

void refuse_option(CLI::App& verb, const std::string& name, const std::string& why) {
  verb.add_option_function<std::string>(name,
                                        [name, why](const std::string&) { throw CLI::ValidationError(name, why); })
      ->group("");  // not in --help
}

std::string place_text(const Prepared& prepared, const model::Span& span) {
  const model::Source& source = prepared.loaded.source;
  return fmt::format("{}:{}", source.name(), source.place(span.begin).line);
}

bool has_no_start(const Prepared& prepared) {
  const model::Model& model = prepared.program->model;
  if (runs::kind_of(model).has_start) return false;
  say(fmt::format(
      "{}: the model is a boundary-value problem; `continuo run` solves it, this verb studies initial-value problems",
      place_text(prepared, model.boundary.front().span)));
  return true;
}

std::function<void(double)> watcher_of(const Prepared& prepared, Progress& progress) {
  const model::Model& model = prepared.program->model;
  if (!runs::kind_of(model).has_start) return progress.parts();
  std::vector<model::Diagnostic> problems;  // the run itself will tell of them
  const auto plan = runs::plan(model, prepared.experiment, problems);
  return plan ? progress.over(plan->from, plan->to) : progress.number("t");
}

void show(std::span<const model::Diagnostic> diagnostics, const model::Source& source) {
  if (!diagnostics.empty()) fmt::print(stderr, "{}", model::render(diagnostics, source, {.color = colors_wanted()}));
}

Prepared prepare(const ExperimentOptions& options, Worlds worlds) {
  if (!readable(options.file))
    return {.exit = usage, .loaded = {model::Source("", ""), {}, {}}, .program = {}, .experiment = {}};
  Prepared prepared{.exit = done, .loaded = load_model(options.file), .program = {}, .experiment = {}};
  if (!prepared.loaded) {
    prepared.exit = wrong_model;
    return prepared;
  }
  if (worlds == Worlds::refused) {
    if (const auto refused = runs::no_study_of_equations(*prepared.loaded.model)) {
      show(std::span(&*refused, 1), prepared.loaded.source);
      prepared.exit = wrong_model;
      return prepared;
    }
  }
  auto values = read_settings(*prepared.loaded.model, options.settings);
  if (!values) {
    prepared.exit = usage;
    return prepared;
  }
  if (decides_a_size(*prepared.loaded.model, *values)) {
    prepared.decides_size = true;
    prepared.loaded = load_model(options.file, {.overrides = *values});
    if (!prepared.loaded) {
      prepared.exit = wrong_model;
      return prepared;
    }
  }
  prepared.program = model::compile(*prepared.loaded.model);
  prepared.experiment = {.method = options.method,
                         .step = options.step,
                         .to = options.until,
                         .output = options.output,
                         .parameters = std::move(*values),
                         .max_step = options.max_step,
                         .max_steps = options.max_steps,
                         .interrupt = &interrupt_flag()};
  if (!read_tolerances(*prepared.loaded.model, options, prepared.experiment)) prepared.exit = usage;
  return prepared;
}

}  // namespace continuo::app
