// Adds the options that change an experiment, and reads them into one.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <span>
#include <utility>

#include <apps/continuo/options/command_line.hpp>
#include <apps/continuo/options/experiment_options.hpp>
#include <apps/continuo/options/file_options.hpp>
#include <apps/continuo/options/models.hpp>
#include <apps/continuo/terminal/interrupt.hpp>
#include <apps/continuo/terminal/terminal.hpp>
#include <fmt/format.h>

#include <continuo/language/text/diagnostic.hpp>
#include <continuo/results/csv_writer.hpp>
#include <continuo/results/measurements.hpp>
#include <continuo/runs/kind.hpp>
#include <continuo/runs/run.hpp>
#include <continuo/simulation/native.hpp>
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

/// "other.csv@2.5": the file, and the time of the row. A file of that very name is what it is.
std::pair<std::string, std::string> file_and_time(const std::string& text) {
  const std::size_t at = text.rfind('@');
  if (at == std::string::npos || std::filesystem::exists(text)) return {text, {}};
  return {text.substr(0, at), text.substr(at + 1)};
}

/// The row of a table that a run begins at; nothing after saying why.
std::optional<std::size_t> row_at(const results::Measurements& table, const std::string& time) {
  if (table.times.empty()) {
    say(fmt::format("{} has no rows to begin at", table.file));
    return std::nullopt;
  }
  if (time.empty()) return table.times.size() - 1;
  double t = 0;
  if (!CLI::detail::lexical_cast(time, t)) {
    say(fmt::format("--initial-from {}@{}: the time of a row is expected behind @, as in {}@2.5", table.file, time,
                    table.file));
    return std::nullopt;
  }
  // Of two rows of one time, before and after an event, the second.
  const auto after = std::ranges::upper_bound(table.times, t);
  if (after != table.times.begin() && *(after - 1) == t)
    return static_cast<std::size_t>(after - table.times.begin()) - 1;
  std::string near;
  if (after != table.times.begin()) near = results::number(*(after - 1));
  if (after != table.times.end()) near += (near.empty() ? "" : " and ") + results::number(*after);
  say(fmt::format("--initial-from: {} has no row at t = {}; the nearest are at t = {}", table.file, time, near));
  return std::nullopt;
}

bool is_quantity(const model::Model& model, const std::string& column) {
  const auto is_it = [&](const model::Quantity& quantity) { return quantity.name == column; };
  return std::ranges::any_of(model.outputs, is_it) || std::ranges::any_of(model.energies, is_it);
}

/// False, after saying why, where the table cannot be used. What of it does not fit is said as well.
bool read_initial_table(const model::Model& model, const std::string& text, model::Overrides& values) {
  const auto [file, time] = file_and_time(text);
  if (!readable(file)) return false;
  const auto table = measurements_in(file);
  if (!table) return false;
  const auto row = row_at(*table, time);
  if (!row) return false;
  std::vector<std::string> unknown;
  for (std::size_t c = 0; c < table->columns.size(); ++c) {
    const std::string& column = table->columns[c];
    const double value = table->values[c][*row];
    const bool is_state = std::ranges::any_of(model.states, [&](const auto& state) { return state.column == column; });
    if (!is_state && !is_quantity(model, column)) unknown.push_back(column);
    if (!is_state || std::isnan(value)) continue;
    if (table->units.empty() || table->units[c].empty()) {
      values[column] = value;
      continue;
    }
    std::vector<model::Diagnostic> problems;
    const std::string setting = fmt::format("{} = {} [{}]", column, results::number(value), table->units[c]);
    const auto given = model::parse_initial(model, setting, problems);
    show(problems, model::Source(file, setting));
    if (!given) return false;
    values[column] = given->value;
  }
  std::vector<std::string> missing;
  for (const model::State& state : model.states)
    if (!state.in_world && !values.contains(state.column)) missing.push_back(state.column);
  if (values.empty()) {
    say(fmt::format("--initial-from: {} has no column with the name of a state: {}", file,
                    fmt::join(std::span(missing).first(std::min<std::size_t>(missing.size(), 8)), ", ")));
    return false;
  }
  const auto list = [](const std::vector<std::string>& names) {
    constexpr std::size_t most = 8;
    return fmt::format("{}{}", fmt::join(std::span(names).first(std::min(names.size(), most)), ", "),
                       names.size() > most ? ", ..." : "");
  };
  if (!missing.empty())
    say(fmt::format("--initial-from: {} has no value for {}: the model's own start is taken", file, list(missing)));
  if (!unknown.empty()) say(fmt::format("--initial-from: no state is called {}: passed over", list(unknown)));
  return true;
}

/// Where states begin, by their columns.
std::optional<model::Overrides> read_initial(const model::Model& model, const ExperimentOptions& options) {
  model::Overrides values;
  if (options.initial.empty() && options.initial_from.empty()) return values;
  if (!runs::kind_of(model).has_start) {
    say("--initial: a boundary-value problem has no start; --guess gives a first guess of its solution");
    return std::nullopt;
  }
  bool fine = options.initial_from.empty() || read_initial_table(model, options.initial_from, values);
  std::vector<std::string> names;
  for (const std::string& text : options.initial) {
    std::vector<model::Diagnostic> problems;
    const auto initial = model::parse_initial(model, text, problems);
    show(problems, model::Source("--initial", text));
    fine = fine && initial.has_value();
    if (!initial) continue;
    if (std::ranges::find(names, initial->name) != names.end()) {
      say(fmt::format("--initial {}: `{}` is given twice", text, initial->name));
      fine = false;
    }
    names.push_back(initial->name);
    for (const std::size_t i : states_named(model, initial->name)) values[model.states[i].column] = initial->value;
  }
  return fine ? std::optional(std::move(values)) : std::nullopt;
}

bool decides_a_size(const model::Model& model, const model::Overrides& values) {
  return std::ranges::any_of(values, [&](const auto& value) {
    const std::size_t i = model::find_parameter(model, value.first);
    return i != model::npos && model.parameters[i].structural;
  });
}

}  // namespace

void add_model(CLI::App& verb, ExperimentOptions& options) {
  reads_file(verb, verb.add_option("file", options.file, "The model (- for standard input)")->required(),
             files_of_model);
  verb.add_option("--set", options.settings, "Sets a parameter: --set k=5 --set \"c=0.2 [N*s/m]\"")
      ->type_name("NAME=VALUE")
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  verb.add_option(
          "--native", options.native,
          "Machine code for the equations, with the same results to the bit: auto (as soon as it pays), always, never; "
          "fused: always, and a product and a sum are rounded once, which takes less time and gives other last digits")
      ->type_name("WHEN")
      ->check(CLI::IsMember({"auto", "always", "fused", "never"}));
}

void add_experiment(CLI::App& verb, ExperimentOptions& options) {
  add_model(verb, options);
  verb.add_option("--until", options.until, "End time of the run")->type_name("T");
  verb.add_option("--output", options.output, "Output interval")->type_name("DT")->transform(quotients());
}

void add_initial(CLI::App& verb, ExperimentOptions& options) {
  verb.add_option("--initial", options.initial, "Sets where a state begins: --initial x=3 --initial \"x'=0.5 [m/s]\"")
      ->type_name("NAME=VALUE")
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  reads_file(verb,
             verb.add_option("--initial-from", options.initial_from,
                             "Begins at the last row of a table of results, or at its row of time T"),
             [](const std::string& text) { return std::vector{file_and_time(text).first}; })
      ->type_name("FILE[@T]");
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

namespace {

/// False after saying why this machine cannot do what was asked for.
bool set_compiler(const ExperimentOptions& options, model::Model& model) {
  const model::NativeUse use = *model::native_use_named(options.native);
  if (const std::string why = model::why_not(use); !why.empty()) {
    say(fmt::format("--native {}: {}", options.native, why));
    return false;
  }
  if (use != model::NativeUse::never)
    model.native = std::make_shared<model::NativeCompiler>(model::NativeOptions{.use = use});
  return true;
}

}  // namespace

bool lacks_fused_code(const model::Model& model) {
  const std::string missing = model.native ? model.native->missing() : std::string();
  if (missing.empty()) return false;
  say(fmt::format("--native fused: {}; without machine code the results are others: mend that, or take --native auto",
                  missing));
  return true;
}

Prepared prepare(const ExperimentOptions& options, Worlds worlds) {
  if (!readable(options.file))
    return {.exit = usage, .loaded = {model::Source("", ""), {}, {}}, .program = {}, .experiment = {}};
  Prepared prepared{
      .exit = done,
      .loaded = options.sweep.empty() ? load_model(options.file) : load_with_sweep(options.file, options.sweep),
      .program = {},
      .experiment = {}};
  if (!prepared.loaded) {
    prepared.exit = prepared.loaded.diagnostics.empty() ? usage : wrong_model;
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
  const bool decides_size = decides_a_size(*prepared.loaded.model, *values);
  const bool decides_sweep = options.sweep.is_wanted && !values->empty();
  if (decides_size || decides_sweep) {
    prepared.decides_size = decides_size;
    prepared.loaded = load_model(prepared.loaded.source, {.overrides = *values});
    if (!prepared.loaded) {
      prepared.exit = wrong_model;
      return prepared;
    }
  }
  if (!set_compiler(options, *prepared.loaded.model)) {
    prepared.exit = usage;
    return prepared;
  }
  // The program has the only copy: that of a grid takes half a gigabyte.
  prepared.program = model::compile(*std::exchange(prepared.loaded.model, std::nullopt));
  const model::Model& model = prepared.program->model;
  if (lacks_fused_code(model)) {
    prepared.exit = usage;
    return prepared;
  }
  if (options.native == "always") {
    if (const std::string trouble = model.native->report().trouble; !trouble.empty())
      say(fmt::format("without machine code: {}", trouble));
  }
  prepared.experiment = {.method = options.method,
                         .step = options.step,
                         .to = options.until,
                         .output = options.output,
                         .parameters = std::move(*values),
                         .max_step = options.max_step,
                         .max_steps = options.max_steps,
                         .interrupt = &interrupt_flag()};
  auto initial = read_initial(model, options);
  if (initial) prepared.experiment.initial = std::move(*initial);
  if (!initial || !read_tolerances(model, options, prepared.experiment)) prepared.exit = usage;
  return prepared;
}

}  // namespace continuo::app
