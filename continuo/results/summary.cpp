// The lines of a run's summary: ending, states, events, energy, checks, error and cost.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <span>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include <continuo/results/csv_writer.hpp>
#include <continuo/results/summary.hpp>
#include <continuo/runs/kind.hpp>

namespace continuo::results {
namespace {

constexpr std::size_t most_states = 16, most_events = 8, most_checks = 8;

std::string with_unit(std::string text, std::string_view unit) {
  if (!unit.empty() && unit != "1") text.append(" ").append(unit);
  return text;
}

void append_ending(const model::Model& model, const model::Run& run, std::string& text) {
  text += fmt::format("{}: {} at t = {}", model.name, to_string(run.outcome.ending),
                      with_unit(number(run.final_time()), model.time_unit));
  if (!run.stop_text.empty()) {
    text += fmt::format(" ({})", run.stop_text);
  } else if (!run.outcome.event.empty()) {
    text += fmt::format(" ({})", run.outcome.event);
  }
  text += '\n';
}

/// What the error of one step at x may be.
double tolerance_of(const model::Run& run, std::size_t state, double x) {
  return run.plan.atol_of(state) + run.plan.rtol_of(state) * std::abs(x);
}

void append_states(const model::Run& run, std::string& text) {
  const std::span columns = std::span(run.motion.columns).subspan(1, run.motion.states);
  const auto values = run.final_state();
  std::size_t widest = 0;
  const std::size_t shown = values.size() <= most_states ? values.size() : most_states - 1;
  for (std::size_t i = 0; i < shown; ++i) widest = std::max(widest, columns[i].name.size());
  for (std::size_t i = 0; i < shown; ++i) {
    std::string value = short_number(values[i]);
    const bool estimated = run.error && i < run.error->at_end.size();
    if (estimated) value += fmt::format(" +- {:.1g}", run.error->at_end[i]);
    value = with_unit(std::move(value), columns[i].unit);
    if (estimated && run.plan.step == 0) value += fmt::format(" (tolerance {:.1g})", tolerance_of(run, i, values[i]));
    fmt::format_to(std::back_inserter(text), "  {:<{}} = {}\n", columns[i].name, widest, value);
  }
  if (shown < values.size()) {
    fmt::format_to(std::back_inserter(text), "  and {} more states (-o FILE writes them all)\n", values.size() - shown);
  }
}

struct EventCount {
  std::string name;
  std::size_t count;
  double first, last;
};

/// Of contacts between many bodies: `gas meets wall`, not each of its members.
std::string shown_name(const model::RecordedEvent& event) {
  std::string name;
  bool inside = false;
  for (const char c : event.name) {
    inside = (inside || (c == '[' && event.is_contact())) && c != ']';
    if (!inside && !(c == ']' && event.is_contact())) name += c;
  }
  return name;
}

/// In the order of their first firing.
std::vector<EventCount> count_events(const model::Run& run) {
  std::vector<EventCount> counts;
  for (const model::RecordedEvent& event : run.events) {
    std::string name = shown_name(event);
    const auto found = std::ranges::find(counts, name, &EventCount::name);
    if (found == counts.end()) {
      counts.push_back({std::move(name), 1, event.t, event.t});
    } else {
      ++found->count;
      found->last = event.t;
    }
  }
  return counts;
}

void append_events(const model::Model& model, const model::Run& run, std::string& text) {
  const auto counts = count_events(run);
  for (std::size_t i = 0; i < std::min(counts.size(), most_events); ++i) {
    const EventCount& event = counts[i];
    const std::string_view head = i == 0 ? "events" : "";
    auto out = std::back_inserter(text);
    const std::string last = with_unit(short_number(event.last), model.time_unit);
    if (event.count == 1) {
      fmt::format_to(out, "{:<8}{}: at t = {}\n", head, event.name, last);
    } else {
      fmt::format_to(out, "{:<8}{}: {} times, from t = {} to {}\n", head, event.name, event.count,
                     short_number(event.first), last);
    }
  }
  if (counts.size() > most_events)
    fmt::format_to(std::back_inserter(text), "        and {} more kinds\n", counts.size() - most_events);
}

void append_energy(const model::Run& run, std::string& text) {
  if (!run.energy) return;
  const model::EnergyBalance& energy = *run.energy;
  const std::string drift = fmt::format("{:.2g}", std::abs(energy.drift));  // no sign on a nan
  fmt::format_to(std::back_inserter(text), "energy  {} at first, {} at last; largest drift {}\n",
                 with_unit(short_number(energy.first), energy.unit), with_unit(short_number(energy.last), energy.unit),
                 energy.relative ? drift + ", relative" : with_unit(drift, energy.unit));
}

/// `all 9 passed`, or how many passed, failed, and could not be evaluated.
std::string counts_of(const std::vector<model::CheckResult>& checks) {
  const auto passed = static_cast<std::size_t>(std::ranges::count_if(checks, &model::CheckResult::passed));
  const auto open = static_cast<std::size_t>(std::ranges::count(checks, false, &model::CheckResult::evaluated));
  const std::size_t failed = checks.size() - passed - open;
  if (passed == checks.size()) return fmt::format("{}{} passed", passed > 1 ? "all " : "", passed);
  std::string text;
  for (const auto& [count, what] : {std::pair{passed, "passed"}, {failed, "failed"}, {open, "not evaluated"}})
    if (count > 0) text += fmt::format("{}{} {}", text.empty() ? "" : ", ", count, what);
  return text;
}

void append_checks(const model::Run& run, bool as_written, std::string& text) {
  if (run.checks.empty()) return;
  std::vector<const model::CheckResult*> failed;
  for (const model::CheckResult& check : run.checks) {
    if (!check.passed) failed.push_back(&check);
  }
  auto out = std::back_inserter(text);
  fmt::format_to(out, "checks  {}", counts_of(run.checks));
  text += as_written ? "\n" : "; they apply to the model as written in its file, and this run differs from it\n";
  if (as_written) return;  // then a failure is an error, and reported as one
  for (std::size_t i = 0; i < std::min(failed.size(), most_checks); ++i) {
    fmt::format_to(out, "        {}\n", failed_check(*failed[i]));
  }
  if (failed.size() > most_checks) fmt::format_to(out, "        and {} more\n", failed.size() - most_checks);
}

/// The state whose error is the most of its tolerance at its largest value; by a fixed step, the largest error.
struct Worst {
  std::size_t state = 0;
  double tolerance = 0;  // 0: there is none
};
Worst worst_state(const model::Run& run) {
  const std::vector<double>& errors = run.error->largest;
  if (run.plan.step > 0) {
    return {static_cast<std::size_t>(std::ranges::max_element(errors) - errors.begin())};
  }
  std::vector<double> sizes(errors.size(), 0.0);
  for (std::size_t row = 0; row < run.motion.rows(); ++row) {
    const auto state = run.motion.state(row);
    for (std::size_t i = 0; i < sizes.size(); ++i) sizes[i] = std::max(sizes[i], std::abs(state[i]));
  }
  Worst worst{0, tolerance_of(run, 0, sizes[0])};
  for (std::size_t i = 1; i < errors.size(); ++i) {
    const double tolerance = tolerance_of(run, i, sizes[i]);
    if (errors[i] * worst.tolerance > errors[worst.state] * tolerance) worst = {i, tolerance};
  }
  return worst;
}

void append_error(const model::Run& run, std::string& text) {
  if (!run.error) return;
  const model::ErrorEstimate& error = *run.error;
  auto out = std::back_inserter(text);
  if (error.at_end.empty()) {
    fmt::format_to(out, "error   no estimate: {}\n", error.message);
    return;
  }
  if (error.largest.empty()) {
    text += "error   at the end, against a run a hundred times as strict\n";
    return;
  }
  const auto [worst, tolerance] = worst_state(run);
  const model::Column& column = run.motion.columns[worst + 1];
  const std::string most = with_unit(fmt::format("{:.1g}", error.largest[worst]), column.unit);
  if (tolerance == 0) {
    fmt::format_to(out, "error   at most {} in {}, against a run by half the step\n", most, column.name);
  } else {
    fmt::format_to(out,
                   "error   at most {} in {}, {:.2g} times its tolerance, against a run a hundred times as strict\n",
                   most, column.name, error.largest[worst] / tolerance);
  }
}

void append_note(const model::Run& run, std::string& text) {
  if (succeeded(run.outcome.ending) && !run.outcome.hint.empty()) text += fmt::format("note    {}\n", run.outcome.hint);
}

std::string range_of(std::span<const double> each, double one) {
  if (each.empty()) return short_number(one);
  const auto [least, most] = std::ranges::minmax(each);
  return least == most ? short_number(least) : fmt::format("{}..{}", short_number(least), short_number(most));
}

void append_cost_of_world(const model::Model& model, const model::Run& run, std::string& text) {
  const std::string control = run.plan.step > 0 ? fmt::format(", step {}", short_number(run.plan.step)) : "";
  fmt::format_to(std::back_inserter(text), "cost    {} collisions, {} by {}{}\n",
                 short_number(runs::cost_of(model, run)), duration(run.statistics.seconds), run.plan.method, control);
}

void append_cost(const model::Model& model, const model::Run& run, std::string& text) {
  if (runs::kind_of(model).solver == runs::Solver::world) return append_cost_of_world(model, run, text);
  const Statistics& s = run.statistics;
  const std::string control = run.plan.step > 0 ? fmt::format("step {}", short_number(run.plan.step))
                                                : fmt::format("tol {}", range_of(run.plan.rtol_each, run.plan.rtol));
  const std::string limit =
      std::isfinite(run.plan.max_step) ? fmt::format(", max step {}", short_number(run.plan.max_step)) : "";
  fmt::format_to(std::back_inserter(text), "cost    {} steps, {} rejected, {} evaluations, {} by {}, {}{}\n", s.steps,
                 s.rejected, s.evaluations, duration(s.seconds), run.plan.method, control, limit);
}

}  // namespace

std::string short_number(double value) {
  if (std::isnan(value)) return "nan";
  return fmt::format("{:.6g}", value == 0 ? 0.0 : value);
}

std::string duration(double seconds) {
  if (seconds < 1e-3) return fmt::format("{:.3g} us", seconds * 1e6);
  if (seconds < 1) return fmt::format("{:.3g} ms", seconds * 1e3);
  return fmt::format("{:.3g} s", seconds);
}

std::string failed_check(const model::CheckResult& check) {
  const std::string why = !check.message.empty()    ? check.message
                          : std::isnan(check.value) ? "its value is not a number"
                                                    : "it is " + with_unit(number(check.value), check.unit);
  return fmt::format("{} {}: {}", check.text, check.evaluated ? "does not hold" : "was not evaluated", why);
}

std::string summary(const model::Model& model, const model::Run& run, bool as_written) {
  std::string text;
  append_ending(model, run, text);
  append_states(run, text);
  append_events(model, run, text);
  append_energy(run, text);
  append_checks(run, as_written, text);
  append_error(run, text);
  append_cost(model, run, text);
  append_note(run, text);
  return text;
}

}  // namespace continuo::results
