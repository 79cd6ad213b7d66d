// Reads a sweep; the axes are sweep_axes.cpp, and what a run is read for is what a check reads it for.
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include <continuo/language/check/views/checks.hpp>
#include <continuo/language/check/views/sweep.hpp>
#include <continuo/language/check/views/sweep_axes.hpp>

namespace continuo::model::detail {

namespace {

constexpr std::array<std::string_view, 3> own_columns = {"run", "outcome", "ended"};
constexpr std::size_t most_times = 1'000'000;  // of one series
constexpr std::size_t most_states_by_themselves = 100;
constexpr double largest_seed = 9007199254740992.0;  // all whole numbers up to here are doubles

SweepSampling sampling_of(std::string_view word) {
  for (const SweepSampling one :
       {SweepSampling::latin_hypercube, SweepSampling::monte_carlo, SweepSampling::indices, SweepSampling::morris})
    if (to_string(one) == word) return one;
  return SweepSampling::sobol;
}

/// Empty for a pure number.
std::string unit_of_column(const Measured& measured) {
  return measured.is_known() && !(measured.unit == Unit()) ? to_text(measured.unit) : std::string();
}

std::string text_of(const Report& report, Span span) {
  const std::string quoted = report.quote(span);
  return quoted.substr(1, quoted.size() - 2);
}

}  // namespace

void SweepReader::read_axis(const ast::SweepAxis& text, Span span) {
  auto axis = SweepAxes(expressions_, model_).axis(text, span);
  if (!axis) return;
  const auto same = std::ranges::find(made_.axes, axis->column(), &SweepAxis::column);
  if (same == made_.axes.end()) {
    made_.axes.push_back(*std::move(axis));
  } else if (auto* said = report_.fail("E283", span, fmt::format("`{}` is varied twice", axis->column()))) {
    said->related.push_back({same->span, "first here"});
  }
}

void SweepReader::read_runs(const ast::SweepRuns& text, Span span) {
  if (runs_span_.end > 0) {
    if (auto* said = report_.fail("E262", span, "`runs` stands twice"))
      said->related.push_back({runs_span_, "first here"});
    return;
  }
  runs_span_ = span;
  Scope scope;
  const Measured pure = Measured::known(Unit());
  const auto count = expressions_.values.setting(text.count, scope, pure, "the number of runs");
  if (count && !(count->value >= 1 && count->value == std::floor(count->value))) {
    report_.fail("E285", text.count.span, "the number of runs is a whole number from 1 on",
                 fmt::format("this is {:g}", count->value));
  } else if (count && count->value > static_cast<double>(most_sweep_runs)) {
    report_.fail("E285", text.count.span, fmt::format("{:g} runs are too many", count->value),
                 fmt::format("at most {} can be made", most_sweep_runs));
  } else if (count) {
    made_.runs = static_cast<std::size_t>(count->value);
  }
  made_.sampling = text.sampling ? sampling_of(text.sampling->text) : SweepSampling::sobol;
  if (!text.seed) return;
  const auto seed = expressions_.values.setting(*text.seed, scope, pure, "a seed");
  if (seed && !(seed->value >= 0 && seed->value <= largest_seed && seed->value == std::floor(seed->value))) {
    report_.fail("E285", text.seed->span, "a seed is a whole number from 0 on",
                 fmt::format("this is {:g}", seed->value));
  } else if (seed) {
    made_.seed = static_cast<std::uint64_t>(seed->value);
  }
}

void SweepReader::read_keeps(const ast::SweepKeeps& text) {
  has_keeps_ = true;
  for (const ast::SweepKeep& item : text.items) read_keep(item);
}

/// `max(x)`, `min(x)` and `mean(x)` of one quantity: over the run.
bool SweepReader::read_extreme(const ast::SweepKeep& text, Scope& scope, SweepKeep& keep) {
  const auto* value = std::get_if<ast::ValueOf>(&text.measure);
  const auto* call = value ? std::get_if<ast::Call>(&value->expression.node) : nullptr;
  if (!call || text.times || call->arguments.size() != 1 || call->callee.primes > 0 || !call->callee.indices.empty())
    return false;
  const std::string& name = call->callee.text;
  if (name != "max" && name != "min" && name != "mean") return false;
  keep.kind = name == "max"   ? SweepKeep::Kind::maximum
              : name == "min" ? SweepKeep::Kind::minimum
                              : SweepKeep::Kind::mean;
  const Value of = expressions_.values.number_of(call->arguments.front(), scope);
  keep.node = of.node;
  keep.unit = unit_of_column(of.measured);
  return true;
}

bool SweepReader::read_times(const ast::SweepKeep::Times& text, Scope& scope, SweepKeep& keep) {
  const auto time = [&](const ast::Expression& of, std::string_view what) {
    return expressions_.values.time_setting(of, scope, what);
  };
  const auto first = time(*text.range.first, "the first time"), last = time(*text.range.last, "the last time"),
             interval = time(text.interval, "the time between two values");
  if (!first || !last || !interval) return false;
  expressions_.values.check_time_in_run(*first, text.range.first->span);
  expressions_.values.check_time_in_run(*last, text.range.last->span);
  const double count = (last->value - first->value) / interval->value;
  if (!(interval->value > 0) || !(last->value >= first->value) || !(count < static_cast<double>(most_times))) {
    report_.fail("E286", cover(text.range.span, text.interval.span), "these are no times",
                 fmt::format("from {:g} to {:g} by {:g}", first->value, last->value, interval->value),
                 fmt::format("the times ascend, and there are at most {} of them", most_times));
    return false;
  }
  keep.kind = SweepKeep::Kind::series;
  keep.times = {.first = first->value,
                .interval = interval->value,
                .count = static_cast<std::size_t>(std::floor(count * (1 + 1e-12) + 1e-9)) + 1};
  return true;
}

void SweepReader::read_keep(const ast::SweepKeep& text) {
  SweepKeep keep;
  keep.span = text.span;
  keep.name = text.name ? text.name->text : text_of(report_, text.span);
  Scope scope;
  if (read_extreme(text, scope, keep)) return add(std::move(keep));
  if (text.times) {
    if (!read_times(*text.times, scope, keep)) return;
    const Value of = expressions_.values.number_of(std::get<ast::ValueOf>(text.measure).expression, scope);
    keep.node = of.node;
    keep.unit = unit_of_column(of.measured);
    return add(std::move(keep));
  }
  std::vector<Sample> samples;
  scope.samples = &samples;
  Check& reading = keep.reading;
  reading.span = text.span;
  reading.text = keep.name;
  reading.value = expressions_.workspace.graph.constant(0);
  const Value value = Checks(expressions_, model_).measure(text.measure, text.span, scope, reading);
  reading.samples = std::move(samples);
  keep.unit = reading.unit = unit_of_column(value.measured);
  if (reading.measure != Measure::always) return add(std::move(keep));
  report_.fail("E286", text.span, "`always` gives no number", {}, "keep max(x), min(x) or mean(x)");
}

void SweepReader::add(SweepKeep keep) {
  const auto same = std::ranges::find(made_.keeps, keep.name, &SweepKeep::name);
  const auto varied = std::ranges::find(made_.axes, keep.name, &SweepAxis::column);
  if (std::ranges::find(own_columns, keep.name) != own_columns.end()) {
    report_.fail("E286", keep.span, fmt::format("every table has a column `{}` already", keep.name), {},
                 "give it another name, as in max(x) as peak");
  } else if (same == made_.keeps.end() && varied == made_.axes.end()) {
    made_.keeps.push_back(std::move(keep));
  } else if (auto* said = report_.fail("E286", keep.span, fmt::format("`{}` is the name of another column", keep.name),
                                       {}, "give it another name, as in max(x) as peak")) {
    said->related.push_back({same != made_.keeps.end() ? same->span : varied->span, "this one"});
  }
}

/// Where nothing says what is kept it is every state at the end.
void SweepReader::keep_last_states() {
  if (model_.states.size() > most_states_by_themselves) {
    report_.fail("E286", made_.span, fmt::format("the model has {} states", model_.states.size()), {},
                 "say what is kept of each run: keep x at end");
    return;
  }
  for (const State& state : model_.states) {
    SweepKeep keep;
    keep.name = state.column + " at end";
    keep.span = made_.span;
    keep.unit = state.unit;
    keep.reading.text = keep.name;
    keep.reading.measure = Measure::value;
    keep.reading.node = expressions_.workspace.graph.variable(state.variable);
    keep.reading.value = expressions_.workspace.graph.constant(0);
    keep.reading.unit = state.unit;
    keep.reading.span = made_.span;
    add(std::move(keep));
  }
}

/// Without `runs` all combinations of the values.
void SweepReader::count_runs() {
  if (runs_span_.end > 0) return;
  double runs = 1;
  std::vector<std::pair<std::string, std::size_t>> files;
  for (const SweepAxis& axis : made_.axes) {
    const auto* points = std::get_if<SweepPoints>(&axis.values);
    if (!points) {
      report_.fail("E285", axis.span, fmt::format("`{}` is drawn at random, and nothing says how often", axis.column()),
                   {}, "add a line such as runs 1000, or runs 10000 sobol seed 7");
      return;
    }
    if (const auto same = std::ranges::find(files, points->file, &std::pair<std::string, std::size_t>::first);
        !points->file.empty() && same != files.end()) {
      if (same->second == points->values.size()) continue;
      report_.fail("E284", axis.span, "columns of one file have the same number of rows",
                   fmt::format("here are {}, before there were {}", points->values.size(), same->second));
      return;
    }
    if (!points->file.empty()) files.emplace_back(points->file, points->values.size());
    runs *= static_cast<double>(points->values.size());
  }
  if (runs > static_cast<double>(most_sweep_runs)) {
    report_.fail("E285", made_.span, fmt::format("these are {:g} runs, at most {} can be made", runs, most_sweep_runs),
                 {}, "ask for fewer values, or draw some of the combinations: runs 10000 sobol");
    return;
  }
  made_.runs = static_cast<std::size_t>(runs);
}

std::shared_ptr<const SweepPlan> SweepReader::read() {
  const Declarations& declared = expressions_.workspace.declared;
  if (!declared.sweep) return nullptr;
  made_.span = declared.sweep_span;
  for (const ast::SweepItem& item : declared.sweep->items)
    if (const auto* axis = std::get_if<ast::SweepAxis>(&item.node)) read_axis(*axis, item.span);
  for (const ast::SweepItem& item : declared.sweep->items) {
    if (const auto* runs = std::get_if<ast::SweepRuns>(&item.node)) read_runs(*runs, item.span);
    if (const auto* keeps = std::get_if<ast::SweepKeeps>(&item.node)) read_keeps(*keeps);
  }
  count_runs();
  if (!has_keeps_) keep_last_states();
  return std::make_shared<const SweepPlan>(std::move(made_));
}

}  // namespace continuo::model::detail
