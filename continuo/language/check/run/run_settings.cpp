// continuo/language/check/run/run_settings.cpp
// Times, output, tolerances and limits of the run; E260 to E264 where they make no sense.
#include <algorithm>
#include <string>
#include <vector>

#include <fmt/format.h>

#include <continuo/language/check/run/run_settings.hpp>
#include <continuo/solve/catalogue.hpp>
#include <continuo/symbolic/names/suggest.hpp>

namespace continuo::model::detail {

namespace {

std::vector<std::string> method_names() {
  std::vector<std::string> names{"euler"};
  for (const MethodInfo& method : method_catalogue()) names.emplace_back(method.name);
  return names;
}

bool is_second_order(std::string_view name) {
  const MethodInfo* method = find_method(name);
  return method && method->second_order;
}

/// Not those for structures, which take damping.
bool needs_no_velocities(std::string_view name) {
  const MethodInfo* method = find_method(name);
  return method && method->second_order && (!method->implicit || method->automatic);
}

}  // namespace

RunSettings RunReader::read() {
  const Declarations& declared = expressions_.workspace.declared;
  if (!declared.run) return {};
  made_.span = declared.run_span;
  read_times(*declared.run);
  read_output(*declared.run);
  read_tolerances(*declared.run);
  read_limits(*declared.run);
  made_.realtime = declared.run->realtime;
  if (declared.run->method) read_method(*declared.run->method);
  return std::move(made_);
}

void RunReader::read_method(const ast::Identifier& method) {
  const auto names = method_names();
  if (std::ranges::find(names, method.text) == names.end()) {
    const std::string near = did_you_mean(method.text, names);
    std::string all;
    for (const std::string& known : names) all += (all.empty() ? "" : ", ") + known;
    report_.fail("E260", method.span, fmt::format("there is no method `{}`", method.text), {},
                 near.empty() ? "the methods are " + all : near);
    return;
  }
  made_.method = canonical_name(method.text);
}

void RunReader::read_times(const ast::Run& run) {
  Scope scope;
  if (!run.interval) return;
  const ast::Range& range = *run.interval;
  made_.from = expressions_.values.time_setting(*range.first, scope, "the start of the run");
  made_.to = expressions_.values.time_setting(*range.last, scope, "the end of the run");
  if (made_.from && made_.to && !(made_.from->value < made_.to->value)) {
    report_.fail("E261", range.span, "the run ends before it begins",
                 fmt::format("from {:g} to {:g}", made_.from->value, made_.to->value));
  }
  if (!run.step) return;
  made_.step = expressions_.values.time_setting(*run.step, scope, "the step");
  if (made_.step && !(made_.step->value > 0)) {
    report_.fail("E261", run.step->span, "the step must be greater than zero",
                 fmt::format("this is {:g}", made_.step->value));
  }
}

void RunReader::read_limits(const ast::Run& run) {
  Scope scope;
  if (run.max_step) {
    const Span span = run.max_step->span;
    made_.max_step = expressions_.values.time_setting(*run.max_step, scope, "the longest step");
    if (made_.max_step && !(made_.max_step->value > 0)) {
      report_.fail("E261", span, "the longest step must be greater than zero",
                   fmt::format("this is {:g}", made_.max_step->value));
    }
    if (run.step)
      report_.fail("E261", span, "steps that are given have no longest one", {}, "leave out `step` or `max step`");
  }
  if (!run.max_steps) return;
  const auto count = expressions_.indices.whole_number(*run.max_steps, scope, "the number of steps");
  if (count && *count < 1) {
    report_.fail("E261", run.max_steps->span, "at least one step is wanted", fmt::format("this is {}", *count));
  } else if (count) {
    made_.max_steps = static_cast<std::size_t>(*count);
  }
}

void RunReader::read_output(const ast::Run& run) {
  if (!run.output) return;
  Scope scope;
  const auto positive_time = [&](const ast::Expression& text, std::string_view what) {
    auto time = expressions_.values.time_setting(text, scope, what);
    if (time && !(time->value > 0)) {
      report_.fail("E261", text.span, fmt::format("{} must be greater than zero", what),
                   fmt::format("this is {:g}", time->value));
    }
    return time;
  };
  if (const auto* every = std::get_if<ast::OutputEvery>(&*run.output)) {
    made_.output = OutputPlan{OutputPlan::Kind::every, positive_time(every->interval, "the output interval"), 0, {}};
  } else if (const auto* log = std::get_if<ast::OutputLogarithmic>(&*run.output)) {
    const auto count = expressions_.indices.whole_number(log->per_decade, scope, "the number of outputs per decade");
    if (count && (*count < 1 || *count > 1'000'000)) {
      report_.fail("E261", log->per_decade.span, "at least one output per decade is wanted");
    }
    made_.output = OutputPlan{OutputPlan::Kind::logarithmic,
                              {},
                              static_cast<int>(count.value_or(1)),
                              positive_time(log->from, "the first output")};
  } else {
    made_.output = OutputPlan{OutputPlan::Kind::steps, {}, 0, {}};
  }
}

void RunReader::read_tolerances(const ast::Run& run) {
  Scope scope;
  const auto positive = [&](const ast::Expression& text, const Measured& wanted) -> std::optional<double> {
    const auto value = expressions_.values.constant(text, scope, wanted, "a tolerance");
    if (!value || *value > 0) return value;
    report_.fail("E261", text.span, "a tolerance must be greater than zero", fmt::format("this is {:g}", *value));
    return std::nullopt;
  };
  if (run.relative_tolerance) {
    made_.rtol = positive(*run.relative_tolerance, Measured::known(Unit()));
    if (made_.rtol && !(*made_.rtol < 1))
      report_.fail("E261", run.relative_tolerance->span,
                   "a relative tolerance is a part of the state's size, less than 1",
                   fmt::format("this is {:g}", *made_.rtol));
  }
  const auto& each = run.absolute_tolerance;
  const std::size_t states = expressions_.workspace.layout.unknowns - expressions_.workspace.layout.states;
  if (each.size() > 1 && each.size() != states) {
    report_.fail("E263", cover(each.front().span, each.back().span),
                 "one absolute tolerance is wanted, or one per state",
                 fmt::format("here are {}, the model has {} state{}", each.size(), states, states == 1 ? "" : "s"));
    return;
  }
  for (std::size_t i = 0; i < each.size(); ++i) {
    const Measured wanted = each.size() > 1 ? expressions_.workspace.units.of_state(i) : Measured::known(Unit());
    if (const auto value = positive(each[i], wanted)) made_.atol.push_back(*value);
  }
}

/// What a method for x'' = a(t, x) asks of the model; known when the equations are solved.
void check_method_fits(const Model& model, Expressions& expressions) {
  Report& report = expressions.report;
  const ast::Run* run = expressions.workspace.declared.run;
  const bool has_world = expressions.workspace.declared.world.text != nullptr;
  if (has_world && run && run->method) {
    report.fail("E264", run->method->span, "a world is moved by its own mode", {},
                "write `mode exact` or `mode fast step 1/60` in the world");
    return;
  }
  if (const auto& limit = run ? (run->max_step ? run->max_step : run->max_steps) : std::nullopt; limit) {
    if (has_world) report.fail("E264", limit->span, "the steps of a world are those of its mode", {}, "leave this out");
    if (model.needs_boundary_solver())
      report.fail("E264", limit->span, "conditions at several times are met without steps in time", {},
                  "leave this out");
  }
  if (!model.run.method || !is_second_order(*model.run.method) || report.errors() > 0) return;
  const Span span = run->method->span;
  if (!model.all_paired) {
    report.fail("E264", span, fmt::format("`{}` is for equations x'' = a(t, x)", *model.run.method),
                "this model is not made of pairs of position and velocity", "take a general method such as tsitouras5");
  } else if (model.accelerations_depend_on_velocities && needs_no_velocities(*model.run.method)) {
    report.warn("E292", span, fmt::format("`{}` loses its order here", *model.run.method),
                "an acceleration depends on a velocity", "a general method such as tsitouras5 keeps its order");
  }
}

}  // namespace continuo::model::detail
