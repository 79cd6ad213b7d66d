// continuo/language/check/run/run_settings.cpp
// `run ...`: the default experiment.
#include <algorithm>
#include <string>
#include <vector>

#include <fmt/format.h>

#include <continuo/language/check/names/checker.hpp>
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

bool has_units_inside(const ast::Expression& expression) {
  return std::visit(
      [](const auto& node) {
        using T = std::decay_t<decltype(node)>;
        if constexpr (std::is_same_v<T, ast::Quantity>) {
          return true;
        } else if constexpr (std::is_same_v<T, ast::Unary>) {
          return has_units_inside(*node.operand);
        } else if constexpr (std::is_same_v<T, ast::Binary>) {
          return has_units_inside(*node.left) || has_units_inside(*node.right);
        } else if constexpr (std::is_same_v<T, ast::Call>) {
          return std::ranges::any_of(node.arguments, has_units_inside);
        } else if constexpr (std::is_same_v<T, ast::Conditional>) {
          return has_units_inside(*node.condition) || has_units_inside(*node.when_true) ||
                 has_units_inside(*node.when_false);
        } else if constexpr (std::is_same_v<T, ast::Sum>) {
          return has_units_inside(*node.body);
        } else if constexpr (std::is_same_v<T, ast::List>) {
          return std::ranges::any_of(node.items, has_units_inside);
        } else {
          return false;
        }
      },
      expression.node);
}

bool has_units_in_world(const std::vector<ast::WorldItem>& items) {
  const auto in = [](const std::optional<ast::Expression>& value) { return value && has_units_inside(*value); };
  return std::ranges::any_of(items, [&](const ast::WorldItem& item) {
    return std::visit(
        [&](const auto& node) {
          if constexpr (requires { node.attributes; }) {
            if (std::ranges::any_of(node.attributes, [](const auto& one) { return has_units_inside(one.value); }))
              return true;
          }
          if constexpr (requires { node.value; }) return in(node.value);
          if constexpr (requires { node.offset; }) return has_units_inside(node.offset);
          if constexpr (requires { node.lower; }) return in(node.lower) || in(node.upper);
          if constexpr (requires { node.body; }) return has_units_in_world(node.body);
          return false;
        },
        item.node);
  });
}

/// Units in declarations, equations and initial values; those of the experiment alone do not make a model with units.
bool has_units(const std::vector<ast::Statement>& statements) {
  const auto defined = [](const std::vector<ast::Definition>& items) {
    return std::ranges::any_of(items, [](const ast::Definition& item) { return has_units_inside(item.value); });
  };
  return std::ranges::any_of(statements, [&](const ast::Statement& statement) {
    return std::visit(
        [&](const auto& node) {
          using T = std::decay_t<decltype(node)>;
          if constexpr (std::is_same_v<T, ast::Parameters> || std::is_same_v<T, ast::Lets>) {
            return defined(node.items);
          } else if constexpr (std::is_same_v<T, ast::Input>) {
            return has_units_inside(node.definition.value);
          } else if constexpr (std::is_same_v<T, ast::Equation>) {
            return has_units_inside(node.left) || has_units_inside(node.right);
          } else if constexpr (std::is_same_v<T, ast::Condition>) {
            return has_units_inside(node.value);
          } else if constexpr (std::is_same_v<T, ast::Unknown>) {
            return has_units_inside(node.guess);
          } else if constexpr (std::is_same_v<T, ast::Force>) {
            return has_units_inside(node.value);
          } else if constexpr (std::is_same_v<T, ast::World>) {
            return has_units_in_world(node.items);
          } else if constexpr (std::is_same_v<T, ast::Family> || std::is_same_v<T, ast::Mode>) {
            return has_units(node.body);
          } else {
            return false;
          }
        },
        statement.node);
  });
}

}  // namespace

/// Before anything is elaborated: is t a quantity, and in which unit? The unit of `run`, else seconds.
void Checker::find_time_unit() {
  model_.has_units = has_units(tree_.statements);
  for (const ast::Statement& statement : tree_.statements) {
    const auto* run = std::get_if<ast::Run>(&statement.node);
    if (!run || !run->interval) continue;
    if (run->interval->unit) stated_time_unit(*run->interval->unit);
    const auto* last = std::get_if<ast::Quantity>(&run->interval->last->node);
    if (last && !run->interval->unit) stated_time_unit(last->unit);
    break;
  }
  if (model_.has_units && !time_unit_) time_unit_ = parse_unit("s").unit;
  if (time_unit_) model_.time_unit = to_text(*time_unit_);
  t_is_known_ = model_.has_units;
}

void Checker::stated_time_unit(const ast::Unit& text) {
  const auto unit = unit_of(text);
  if (!unit) return;
  if (convertible(*unit, *parse_unit("s").unit) || !model_.has_units) {
    time_unit_ = unit;
  } else {
    fail("E201", text.span, "units do not match", fmt::format("time cannot be in {}", to_text(*unit)),
         "a unit of time, as in run 0..60 [s]");
  }
}

void Checker::make_run() {
  if (!run_) return;
  model_.run.span = run_span_;
  run_times(*run_);
  run_output(*run_);
  run_tolerances(*run_);
  run_limits(*run_);
  model_.run.realtime = run_->realtime;
  if (!run_->method) return;
  std::string name = run_->method->text;
  const auto names = method_names();
  if (std::ranges::find(names, name) == names.end()) {
    const std::string near = did_you_mean(name, names);
    std::string all;
    for (const std::string& known : names) all += (all.empty() ? "" : ", ") + known;
    fail("E260", run_->method->span, fmt::format("there is no method `{}`", name), {},
         near.empty() ? "the methods are " + all : near);
    return;
  }
  name = canonical_name(name);
  model_.run.method = name;
}

/// What a method for x'' = a(t, x) asks of the model; known when the equations are solved.
void Checker::check_method_fits() {
  if (world_.text && run_ && run_->method) {
    fail("E264", run_->method->span, "a world is moved by its own mode", {},
         "write `mode exact` or `mode fast step 1/60` in the world");
    return;
  }
  if (const auto& limit = run_ ? (run_->max_step ? run_->max_step : run_->max_steps) : std::nullopt; limit) {
    if (world_.text) fail("E264", limit->span, "the steps of a world are those of its mode", {}, "leave this out");
    if (model_.needs_boundary_solver())
      fail("E264", limit->span, "conditions at several times are met without steps in time", {}, "leave this out");
  }
  if (!model_.run.method || !is_second_order(*model_.run.method) || errors_ > 0) return;
  const Span span = run_->method->span;
  if (!model_.all_paired) {
    fail("E264", span, fmt::format("`{}` is for equations x'' = a(t, x)", *model_.run.method),
         "this model is not made of pairs of position and velocity", "take a general method such as tsitouras5");
  } else if (model_.accelerations_depend_on_velocities && needs_no_velocities(*model_.run.method)) {
    warn("E292", span, fmt::format("`{}` loses its order here", *model_.run.method),
         "an acceleration depends on a velocity", "a general method such as tsitouras5 keeps its order");
  }
}

void Checker::run_times(const ast::Run& run) {
  Scope scope;
  if (!run.interval) return;
  const ast::Range& range = *run.interval;
  model_.run.from = time_setting(*range.first, scope, "the start of the run");
  model_.run.to = time_setting(*range.last, scope, "the end of the run");
  if (model_.run.from && model_.run.to && !(model_.run.from->value < model_.run.to->value)) {
    fail("E261", range.span, "the run ends before it begins",
         fmt::format("from {:g} to {:g}", model_.run.from->value, model_.run.to->value));
  }
  if (!run.step) return;
  model_.run.step = time_setting(*run.step, scope, "the step");
  if (model_.run.step && !(model_.run.step->value > 0)) {
    fail("E261", run.step->span, "the step must be greater than zero",
         fmt::format("this is {:g}", model_.run.step->value));
  }
}

void Checker::run_limits(const ast::Run& run) {
  Scope scope;
  if (run.max_step) {
    const Span span = run.max_step->span;
    model_.run.max_step = time_setting(*run.max_step, scope, "the longest step");
    if (model_.run.max_step && !(model_.run.max_step->value > 0)) {
      fail("E261", span, "the longest step must be greater than zero",
           fmt::format("this is {:g}", model_.run.max_step->value));
    }
    if (run.step) fail("E261", span, "steps that are given have no longest one", {}, "leave out `step` or `max step`");
  }
  if (!run.max_steps) return;
  const auto count = whole_number(*run.max_steps, scope, "the number of steps");
  if (count && *count < 1) {
    fail("E261", run.max_steps->span, "at least one step is wanted", fmt::format("this is {}", *count));
  } else if (count) {
    model_.run.max_steps = static_cast<std::size_t>(*count);
  }
}

void Checker::run_output(const ast::Run& run) {
  if (!run.output) return;
  Scope scope;
  const auto positive_time = [&](const ast::Expression& text, std::string_view what) {
    auto time = time_setting(text, scope, what);
    if (time && !(time->value > 0)) {
      fail("E261", text.span, fmt::format("{} must be greater than zero", what),
           fmt::format("this is {:g}", time->value));
    }
    return time;
  };
  if (const auto* every = std::get_if<ast::OutputEvery>(&*run.output)) {
    model_.run.output =
        OutputPlan{OutputPlan::Kind::every, positive_time(every->interval, "the output interval"), 0, {}};
  } else if (const auto* log = std::get_if<ast::OutputLogarithmic>(&*run.output)) {
    const auto count = whole_number(log->per_decade, scope, "the number of outputs per decade");
    if (count && (*count < 1 || *count > 1'000'000)) {
      fail("E261", log->per_decade.span, "at least one output per decade is wanted");
    }
    model_.run.output = OutputPlan{OutputPlan::Kind::logarithmic,
                                   {},
                                   static_cast<int>(count.value_or(1)),
                                   positive_time(log->from, "the first output")};
  } else {
    model_.run.output = OutputPlan{OutputPlan::Kind::steps, {}, 0, {}};
  }
}

void Checker::run_tolerances(const ast::Run& run) {
  Scope scope;
  const auto positive = [&](const ast::Expression& text, const Measured& wanted) -> std::optional<double> {
    const auto value = constant(text, scope, wanted, "a tolerance");
    if (!value || *value > 0) return value;
    fail("E261", text.span, "a tolerance must be greater than zero", fmt::format("this is {:g}", *value));
    return std::nullopt;
  };
  if (run.relative_tolerance) {
    model_.run.rtol = positive(*run.relative_tolerance, Measured::known(Unit()));
    if (model_.run.rtol && !(*model_.run.rtol < 1))
      fail("E261", run.relative_tolerance->span, "a relative tolerance is a part of the state's size, less than 1",
           fmt::format("this is {:g}", *model_.run.rtol));
  }
  const auto& each = run.absolute_tolerance;
  if (each.size() > 1 && each.size() != model_.states.size()) {
    fail("E263", cover(each.front().span, each.back().span), "one absolute tolerance is wanted, or one per state",
         fmt::format("here are {}, the model has {} state{}", each.size(), model_.states.size(),
                     model_.states.size() == 1 ? "" : "s"));
    return;
  }
  for (std::size_t i = 0; i < each.size(); ++i) {
    const Measured wanted = each.size() > 1 ? measures_[i] : Measured::known(Unit());
    if (const auto value = positive(each[i], wanted)) model_.run.atol.push_back(*value);
  }
}

}  // namespace continuo::model::detail
