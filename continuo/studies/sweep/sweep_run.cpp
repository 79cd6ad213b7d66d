// Finds the values of a run by its number, runs the model with them, and reads what is kept.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <mutex>
#include <utility>

#include <fmt/format.h>

#include <continuo/language/load.hpp>
#include <continuo/results/csv_writer.hpp>
#include <continuo/runs/watched_run.hpp>
#include <continuo/simulation/drive/run_checks.hpp>
#include <continuo/simulation/native.hpp>
#include <continuo/simulation/recorded_run.hpp>
#include <continuo/studies/sweep/sweep_run.hpp>

namespace continuo::studies {
namespace {

using model::SweepAxis;
using model::SweepKeep;
using model::SweepPoints;

constexpr double no_value = std::numeric_limits<double>::quiet_NaN();

/// The first error, with its code.
std::string first_error(const std::vector<model::Diagnostic>& diagnostics) {
  for (const model::Diagnostic& diagnostic : diagnostics)
    if (diagnostic.severity == model::Severity::error)
      return fmt::format("{} [{}]", diagnostic.message, diagnostic.code);
  return {};
}

void append(std::string& text, const model::Overrides& values) {
  for (const auto& [name, value] : values) text += name + '=' + results::number(value) + '\n';
}

/// All of an experiment that changes what a run leaves.
std::string text_of(const model::Experiment& asked) {
  std::string text = asked.method.value_or("") + '\n';
  for (const std::optional<double>& number :
       {asked.rtol, asked.step, asked.from, asked.to, asked.output, asked.max_step})
    text += (number ? results::number(*number) : std::string()) + '\n';
  text += std::to_string(asked.max_steps.value_or(0)) + (asked.output_steps ? " steps\n" : "\n");
  for (const double tolerance : asked.atol) text += results::number(tolerance) + '\n';
  for (const model::Overrides* values : {&asked.rtol_of, &asked.atol_of, &asked.parameters, &asked.initial}) {
    text += ':';
    append(text, *values);
  }
  return text;
}

}  // namespace

PreparedSweep::Readable PreparedSweep::readable(model::Model model) {
  const std::shared_ptr<const model::SweepPlan> plan = model.sweep;
  model.checks.clear();
  for (const SweepKeep& keep : plan->keeps)
    if (keep.kind == SweepKeep::Kind::reading) model.checks.push_back(keep.reading);
  Readable made;
  made.program = model::compile(std::move(model));
  made.nodes = std::make_shared<const KeptNodes>(made.program, plan->keeps);
  return made;
}

Status PreparedSweep::add_dimensions() {
  std::vector<std::pair<std::string, std::size_t>> files;
  for (std::size_t a = 0; a < plan_->axes.size(); ++a) {
    const SweepAxis& axis = plan_->axes[a];
    if (axis.kind == SweepAxis::Kind::parameter) {
      const std::size_t i = find_parameter(model(), axis.name);
      decides_size_ = decides_size_ || model().parameters[i].structural;
    }
    Dimension dimension{.axes = {a}};
    if (const auto* points = std::get_if<SweepPoints>(&axis.values)) {
      dimension.count = points->values.size();
      const auto same = std::ranges::find(files, points->file, &std::pair<std::string, std::size_t>::first);
      if (!points->file.empty() && same != files.end()) {
        dimensions_[same->second].axes.push_back(a);
        continue;
      }
      if (!points->file.empty()) files.emplace_back(points->file, dimensions_.size());
    } else {
      const auto& [kind, numbers] = std::get<model::SweepDistribution>(axis.values);
      auto made = distribution_named(to_string(kind), numbers);
      if (!made) return {made.status().ending, made.status().message, axis.column()};
      dimension.distribution = *made;
    }
    dimensions_.push_back(std::move(dimension));
  }
  if (plan_->sampling == model::SweepSampling::grid || dimensions_.empty()) return {};
  auto design = SweepDesign::create(plan_->sampling, plan_->runs, dimensions_.size(), plan_->seed);
  if (!design) return design.status();
  design_ = *std::move(design);
  auto plan = std::make_shared<model::SweepPlan>(*plan_);
  plan->runs = static_cast<std::size_t>(design_->runs());
  plan_ = std::move(plan);
  return {};
}

Result<PreparedSweep> PreparedSweep::create(model::Model model, model::Experiment experiment) {
  if (!model.sweep) return invalid_input("the model has no sweep: write sweep { k from 1 to 10 count 50 }");
  PreparedSweep made;
  made.plan_ = model.sweep;
  for (const SweepKeep& keep : made.plan_->keeps) made.width_ += keep.width();
  made.readable_ = readable(std::move(model));
  made.many_ = std::make_shared<const model::ManyRuns>(made.readable_.program);
  made.experiment_ = std::move(experiment);
  made.experiment_.keep_rows = false;
  made.experiment_.progress = nullptr;
  if (Status status = made.add_dimensions(); !status) return status;
  return made;
}

std::vector<std::string> PreparedSweep::dimension_names() const {
  std::vector<std::string> names;
  for (const Dimension& dimension : dimensions_) {
    std::string& name = names.emplace_back();
    for (const std::size_t a : dimension.axes) name += (name.empty() ? "" : ", ") + plan_->axes[a].column();
  }
  return names;
}

template <class Set>
void PreparedSweep::for_each_value(std::uint64_t run, const Set& set) const {
  std::uint64_t rest = run;
  for (std::size_t d = dimensions_.size(); d-- > 0;) {
    const Dimension& dimension = dimensions_[d];
    const double u = design_ ? design_->at(run, d) : 0;
    if (dimension.distribution) {
      set(dimension.axes.front(), quantile(*dimension.distribution, u));
      continue;
    }
    const auto drawn = static_cast<std::size_t>(u * static_cast<double>(dimension.count));
    const std::size_t place =
        design_ ? std::min(drawn, dimension.count - 1) : static_cast<std::size_t>(rest % dimension.count);
    rest /= dimension.count;
    for (const std::size_t a : dimension.axes) set(a, std::get<SweepPoints>(plan_->axes[a].values).values[place]);
  }
}

std::vector<double> PreparedSweep::values(std::uint64_t run) const {
  std::vector<double> values(plan_->axes.size());
  for_each_value(run, [&](std::size_t axis, double value) { values[axis] = value; });
  return values;
}

void PreparedSweep::set_run(std::uint64_t run, model::Experiment& experiment) const {
  for_each_value(run, [&](std::size_t a, double value) {
    const SweepAxis& axis = plan_->axes[a];
    (axis.kind == SweepAxis::Kind::initial ? experiment.initial : experiment.parameters)[axis.name] = value;
  });
}

model::Experiment PreparedSweep::experiment(std::uint64_t run) const {
  model::Experiment made = experiment_;
  set_run(run, made);
  return made;
}

/// One at a time: units are read by a library that knows no threads.
std::optional<PreparedSweep::Readable> PreparedSweep::read_anew(const model::Experiment& experiment,
                                                                SweepOutcome& outcome) const {
  static std::mutex reading;
  const std::scoped_lock lock(reading);
  const model::Text& text = model().text;
  model::CheckOptions options;
  for (const auto& [name, value] : experiment.parameters)
    if (find_parameter(model(), name) != model::npos) options.overrides.emplace(name, value);
  model::Loaded loaded = model::load(model::Source(text.path, text.content), options);
  if (loaded.model && loaded.model->sweep) {
    loaded.model->native = model().native;
    return readable(*std::move(loaded.model));
  }
  outcome.message = first_error(loaded.diagnostics);
  return std::nullopt;
}

std::vector<double> PreparedSweep::kept_of(const Readable& readable, std::vector<double> readings,
                                           const KeptValues* watched) const {
  if (readable.nodes->empty() && readings.size() == width_) return readings;
  std::vector<double> kept;
  kept.reserve(width_);
  std::size_t reading = 0, seen = 0;
  for (const SweepKeep& keep : readable.program->model.sweep->keeps) {
    if (keep.kind == SweepKeep::Kind::reading) {
      kept.push_back(readings[reading++]);
    } else {
      const auto values = watched->of(seen++);
      kept.insert(kept.end(), values.begin(), values.end());
    }
  }
  kept.resize(width_, no_value);
  return kept;
}

SweepOutcome PreparedSweep::nothing() const {
  return {.ending = Ending::invalid_input, .t = no_value, .kept = std::vector(width_, no_value), .message = {}};
}

void PreparedSweep::take(const Readable& readable, const Outcome<double>& end, std::vector<double> readings,
                         const KeptValues* watched, SweepOutcome& outcome) const {
  outcome.ending = end.ending;
  outcome.t = end.t;
  if (succeeded(end.ending)) outcome.kept = kept_of(readable, std::move(readings), watched);
}

SweepOutcome PreparedSweep::run(std::uint64_t number) const {
  SweepOutcome outcome = nothing();
  const model::Experiment asked = experiment(number);
  const auto anew = decides_size_ ? read_anew(asked, outcome) : std::nullopt;
  if (decides_size_ && !anew) return outcome;
  const Readable& used = anew ? *anew : readable_;
  KeptValues watched(*used.nodes);
  bool is_shown = true;
  model::Simulated simulated;
  if (used.nodes->empty()) {
    simulated = runs::run(used.program, asked);
  } else {
    runs::WatchedRun seen = runs::run(used.program, asked, {}, watched);
    is_shown = seen.is_shown;
    simulated = std::move(seen.simulated);
  }
  outcome.message = first_error(simulated.diagnostics);
  if (!simulated.run) return outcome;
  take(used, simulated.run->outcome, model::readings_of(simulated.run->checks), &watched, outcome);
  if (succeeded(outcome.ending) && !is_shown) {
    outcome.kept.assign(width_, no_value);
    outcome.ending = Ending::cannot_continue;
    outcome.message = "the motion between its rows cannot be seen: keep values at times or events instead";
  }
  return outcome;
}

void PreparedSweep::run_each(std::span<const std::uint64_t> runs, const OnOutcome& done) const {
  if (!goes_together()) {
    for (const std::uint64_t number : runs)
      if (!done(run(number))) return;
    return;
  }
  std::vector<KeptValues> watched(readable_.nodes->empty() ? 0 : runs.size(), KeptValues(*readable_.nodes));
  std::vector<model::MotionWatcher*> watchers;
  for (KeptValues& one : watched) watchers.push_back(&one);
  const auto set = [&](std::size_t i, model::Experiment& one) { set_run(runs[i], one); };
  many_->make({.count = runs.size(), .common = experiment_, .set = set}, watchers,
              [&](std::size_t i, model::JudgedRun judged) {
                SweepOutcome outcome{.ending = Ending::invalid_input, .t = no_value};
                const KeptValues* const seen = watched.empty() ? nullptr : &watched[i];
                if (judged.outcome) take(readable_, *judged.outcome, std::move(judged.readings), seen, outcome);
                if (!judged.outcome || !succeeded(judged.outcome->ending)) outcome.kept.assign(width_, no_value);
                outcome.message = first_error(judged.diagnostics);
                return done(std::move(outcome));
              });
}

std::string PreparedSweep::identity() const {
  std::string text = model().text.content;
  text += '\n' + std::to_string(model::checksum_of_tables(*readable_.program)) + '\n' + text_of(experiment_);
  text += fmt::format("{} {} {}\n", plan_->runs, to_string(plan_->sampling), plan_->seed);
  if (model().native && model().native->use() == model::NativeUse::fused) text += "fused operations\n";
  for (const SweepAxis& axis : plan_->axes) {
    text += axis.column() + ':';
    if (const auto* points = std::get_if<SweepPoints>(&axis.values)) {
      for (const double value : points->values) text += ' ' + results::number(value);
    } else {
      const auto& drawn = std::get<model::SweepDistribution>(axis.values);
      text += to_string(drawn.kind);
      for (const double number : drawn.numbers) text += ' ' + results::number(number);
    }
    text += '\n';
  }
  return text;
}

}  // namespace continuo::studies
