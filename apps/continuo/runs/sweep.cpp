// Reads the values of a sweep, and runs its members on all cores.
#include <algorithm>
#include <atomic>
#include <cmath>
#include <mutex>
#include <string_view>
#include <thread>
#include <utility>

#include <apps/continuo/options/models.hpp>
#include <apps/continuo/runs/sweep.hpp>
#include <apps/continuo/runs/sweep_table.hpp>
#include <apps/continuo/terminal/interrupt.hpp>
#include <apps/continuo/terminal/terminal.hpp>
#include <fmt/format.h>

#include <continuo/language/load.hpp>
#include <continuo/results/plots.hpp>
#include <continuo/results/summary.hpp>
#include <continuo/runs/watched_run.hpp>

namespace continuo::app {
namespace {

constexpr std::size_t most_members = 100'000;

/// Where in the text the separator stands outside of brackets.
std::vector<std::size_t> places_of(std::string_view text, std::string_view separator) {
  std::vector<std::size_t> places;
  int depth = 0;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] == '(' || text[i] == '[') ++depth;
    if (text[i] == ')' || text[i] == ']') --depth;
    if (depth == 0 && text.substr(i, separator.size()) == separator) places.push_back(i);
  }
  return places;
}

std::vector<std::string> parts_of(std::string_view text) {
  std::vector<std::string> parts;
  std::size_t begin = 0;
  for (const std::size_t comma : places_of(text, ",")) {
    parts.emplace_back(text.substr(begin, comma - begin));
    begin = comma + 1;
  }
  parts.emplace_back(text.substr(begin));
  return parts;
}

std::string trimmed(std::string_view text) {
  const std::size_t begin = text.find_first_not_of(" \t"), end = text.find_last_not_of(" \t");
  return begin == std::string_view::npos ? std::string() : std::string(text.substr(begin, end - begin + 1));
}

/// A unit at the end of the text, with its brackets; it is taken from there.
std::string take_unit(std::string& text) {
  const std::size_t end = text.find_last_not_of(" \t");
  if (end == std::string::npos || text[end] != ']') return {};
  const std::size_t begin = text.rfind('[');
  if (begin == std::string::npos || begin == 0) return {};
  // Directly after a name it would be an index.
  const char before = text[begin - 1];
  if (before != ' ' && before != '\t' && !(before >= '0' && before <= '9') && before != ')') return {};
  std::string unit = text.substr(begin, end - begin + 1);
  text.erase(begin);
  return unit;
}

/// "1..5/9": both ends and how many values.
struct RangeText {
  std::string from, to;
  std::size_t count = 0;
};
enum class RangeKind { none, wrong, range };

RangeKind read_range(const std::string& part, RangeText& range, std::string& problem) {
  const auto dots = places_of(part, "..");
  if (dots.empty()) return RangeKind::none;
  const auto slashes = places_of(part, "/");
  const std::size_t slash = slashes.empty() ? 0 : slashes.back();
  problem = "write FROM..TO/COUNT, such as 1..5/9 for nine values from 1 to 5";
  if (dots.size() != 1 || slash < dots.front()) return RangeKind::wrong;
  range.from = trimmed(part.substr(0, dots.front()));
  range.to = trimmed(part.substr(dots.front() + 2, slash - dots.front() - 2));
  const std::string count = trimmed(part.substr(slash + 1));
  double number = 0;
  if (range.from.empty() || range.to.empty() || !CLI::detail::lexical_cast(count, number)) return RangeKind::wrong;
  if (!(number >= 2 && number <= static_cast<double>(most_members) && number == std::floor(number))) {
    problem = fmt::format("`{}` is no count of values: a whole number from 2 to {} is expected", count, most_members);
    return RangeKind::wrong;
  }
  range.count = static_cast<std::size_t>(number);
  return RangeKind::range;
}

/// One value by the rules of --set or --initial; what is wrong is shown.
std::optional<double> read_one(const model::Model& model, bool is_initial, const std::string& name,
                               const std::string& value) {
  const std::string text = fmt::format("{}={}", name, value);
  std::vector<model::Diagnostic> problems;
  std::optional<double> read;
  if (is_initial) {
    if (const auto initial = parse_initial(model, text, problems)) read = initial->value;
  } else {
    if (const auto setting = parse_setting(model, text, problems)) read = setting->value;
  }
  show(problems, model::Source(is_initial ? "--initial" : "--set", text));
  return read;
}

/// False after saying what is wrong.
bool read_axis(const model::Model& model, const SweepText& asked, SweepAxis& axis) {
  const std::size_t equals = asked.text.find('=');
  std::string given = asked.text.substr(equals + 1);
  const char* const option = asked.is_initial ? "--initial" : "--set";
  axis = {.name = trimmed(asked.text.substr(0, equals)), .is_initial = asked.is_initial, .values = {}};
  // A unit at the end is that of all values; where each has its own, it is only the last one's.
  std::string unit = take_unit(given);
  std::vector<std::string> parts = parts_of(given);
  const bool each_has_one = std::ranges::any_of(std::span(parts).first(parts.size() - 1),
                                                [](std::string part) { return !take_unit(part).empty(); });
  if (each_has_one) parts.back() += " " + std::exchange(unit, {});
  const auto add = [&](const std::string& value) {
    const auto read = read_one(model, asked.is_initial, axis.name, unit.empty() ? value : value + " " + unit);
    if (read) axis.values.push_back(*read);
    return read.has_value();
  };
  for (const std::string& part : parts) {
    RangeText range;
    std::string problem;
    switch (read_range(part, range, problem)) {
      case RangeKind::wrong:
        say(fmt::format("{} {}: `{}` is no range: {}", option, asked.text, part, problem));
        return false;
      case RangeKind::none:
        if (!add(part)) return false;
        break;
      case RangeKind::range: {
        if (!add(range.from) || !add(range.to)) return false;
        const double to = axis.values.back(), from = *(axis.values.end() - 2);
        axis.values.pop_back();
        for (std::size_t i = 1; i + 1 < range.count; ++i)
          axis.values.push_back(from + (to - from) * (static_cast<double>(i) / static_cast<double>(range.count - 1)));
        axis.values.push_back(to);
        break;
      }
    }
  }
  return true;
}

/// The parameters of a member, and whether one of them decides how many equations there are.
model::Overrides parameters_of(const Sweep& sweep, std::size_t member, const Prepared& base, bool& decides_size) {
  model::Overrides parameters = base.experiment.parameters;
  for (std::size_t a = 0; a < sweep.axes.size(); ++a) {
    if (sweep.axes[a].is_initial) continue;
    parameters[sweep.axes[a].name] = sweep.value(member, a);
    const std::size_t i = find_parameter(base.program->model, sweep.axes[a].name);
    decides_size = decides_size || (i != model::npos && base.program->model.parameters[i].structural);
  }
  return parameters;
}

void run_member(const Sweep& sweep, std::size_t index, const Prepared& base, const results::MotionCurves* curves,
                SweepTable& table, SweepMember& member) {
  model::Experiment experiment = base.experiment;
  experiment.progress = nullptr;
  bool decides_size = false;
  experiment.parameters = parameters_of(sweep, index, base, decides_size);
  member.begun = true;
  member.program = base.program;
  if (decides_size) {
    static std::mutex reading;  // one at a time: units are read by a library
    const std::scoped_lock lock(reading);
    model::Loaded loaded = model::load(base.loaded.source, {.overrides = experiment.parameters});
    if (!loaded.model) {
      member.simulated.diagnostics = std::move(loaded.diagnostics);
      return;
    }
    member.program = model::compile(*std::move(loaded.model));
  }
  const model::Model& model = member.program->model;
  for (std::size_t a = 0; a < sweep.axes.size(); ++a) {
    if (!sweep.axes[a].is_initial) continue;
    for (const std::size_t i : states_named(model, sweep.axes[a].name))
      experiment.initial[model.states[i].column] = sweep.value(index, a);
  }
  experiment.keep_rows = curves || experiment.estimate_error;
  runs::RunRequest asked;
  asked.on_row = [&table, index](const model::RunRow& row) { return table.add(index, row); };
  if (!curves) {
    member.simulated = runs::run(member.program, experiment, asked);
    return;
  }
  const auto begun = [&] {
    return decides_size ? std::make_unique<results::MotionCurves>(member.program, results::plot_requests(model))
                        : std::make_unique<results::MotionCurves>(*curves);
  };
  member.curves = begun();
  runs::WatchedRun watched = runs::run(member.program, experiment, asked, *member.curves);
  if (!watched.is_shown) member.curves = begun();  // the picture shows the rows
  member.simulated = std::move(watched.simulated);
}

}  // namespace

std::size_t Sweep::size() const {
  std::size_t size = 1;
  for (const SweepAxis& axis : axes) size *= axis.values.size();
  return size;
}

double Sweep::value(std::size_t member, std::size_t axis) const {
  for (std::size_t a = axes.size() - 1; a > axis; --a) member /= axes[a].values.size();
  return axes[axis].values[member % axes[axis].values.size()];
}

std::vector<double> Sweep::values(std::size_t member) const {
  std::vector<double> all;
  for (std::size_t a = 0; a < axes.size(); ++a) all.push_back(value(member, a));
  return all;
}

std::vector<std::string> Sweep::columns() const {
  std::vector<std::string> all;
  for (const SweepAxis& axis : axes) all.push_back(axis.column());
  return all;
}

std::string Sweep::label(std::size_t member) const {
  std::string text;
  for (std::size_t a = 0; a < axes.size(); ++a)
    text += fmt::format("{}{} = {}", a == 0 ? "" : ", ", axes[a].column(), results::short_number(value(member, a)));
  return text;
}

std::vector<SweepText> take_sweep(ExperimentOptions& options) {
  std::vector<SweepText> taken;
  for (auto* list : {&options.settings, &options.initial}) {
    std::erase_if(*list, [&](const std::string& text) {
      const std::size_t equals = text.find('=');
      if (equals == std::string::npos) return false;
      const std::string_view given = std::string_view(text).substr(equals + 1);
      if (places_of(given, ",").empty() && places_of(given, "..").empty()) return false;
      taken.push_back({text, list == &options.initial});
      return true;
    });
  }
  return taken;
}

std::optional<Sweep> read_sweep(const std::vector<SweepText>& texts, const Prepared& base) {
  Sweep sweep;
  double size = 1;
  for (const SweepText& text : texts) {
    SweepAxis axis;
    if (!read_axis(base.program->model, text, axis)) return std::nullopt;
    const bool is_set =
        text.is_initial ? base.experiment.initial.contains(axis.name) : base.experiment.parameters.contains(axis.name);
    if (is_set || std::ranges::find(sweep.axes, axis.column(), &SweepAxis::column) != sweep.axes.end()) {
      say(fmt::format("{} {}: `{}` is given twice", text.is_initial ? "--initial" : "--set", text.text, axis.name));
      return std::nullopt;
    }
    size *= static_cast<double>(axis.values.size());
    sweep.axes.push_back(std::move(axis));
  }
  if (size <= static_cast<double>(most_members)) return sweep;
  say(fmt::format("these are {:.0f} runs; at most {} can be swept at once", size, most_members));
  return std::nullopt;
}

std::vector<SweepMember> run_sweep(const Sweep& sweep, const Prepared& base, const results::MotionCurves* curves,
                                   SweepTable& table, const std::function<void(double)>& watch) {
  std::vector<SweepMember> members(sweep.size());
  std::atomic<std::size_t> next = 0, done_so_far = 0;
  std::mutex watching;
  const auto work = [&] {
    for (std::size_t i = next++; i < members.size() && !interrupt_flag() && !table.is_refused(); i = next++) {
      run_member(sweep, i, base, curves, table, members[i]);
      table.end(i, members[i].simulated.run);
      ++done_so_far;
      if (!watch) continue;
      const std::scoped_lock lock(watching);
      watch(static_cast<double>(done_so_far) / static_cast<double>(members.size()));
    }
  };
  const std::size_t cores = std::max(1U, std::thread::hardware_concurrency());
  std::vector<std::jthread> threads;
  for (std::size_t i = 1; i < std::min(cores, members.size()); ++i) threads.emplace_back(work);
  work();
  threads.clear();
  return members;
}

}  // namespace continuo::app
