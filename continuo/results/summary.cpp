#include <algorithm>
#include <cstddef>
#include <iterator>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include <continuo/results/csv.hpp>
#include <continuo/results/summary.hpp>

namespace continuo::results {
namespace {

constexpr std::size_t most_states = 16, most_events = 8;

std::string with_unit(std::string text, std::string_view unit) {
  if (!unit.empty()) text.append(" ").append(unit);
  return text;
}

void append_ending(const Record& record, std::string& text) {
  const Outcome<double>& outcome = record.outcome;
  text += record.setup.model + ": ";
  if (!succeeded(outcome.ending)) {
    text += describe(outcome);
  } else {
    text += fmt::format("{} at t = {}", to_string(outcome.ending),
                        with_unit(number(record.final_time()), record.setup.time_unit));
    if (!outcome.event.empty()) text += fmt::format(" ({})", outcome.event);
  }
  if (text.back() != '\n') text += '\n';
}

void append_states(const Record& record, std::string& text) {
  const auto columns = record.state_columns();
  const auto values = record.final_state();
  std::size_t widest = 0;
  const std::size_t shown = values.size() <= most_states ? values.size() : most_states - 1;
  for (std::size_t i = 0; i < shown; ++i) widest = std::max(widest, columns[i].name.size());
  for (std::size_t i = 0; i < shown; ++i) {
    fmt::format_to(std::back_inserter(text), "  {:<{}} = {}\n", columns[i].name, widest,
                   with_unit(short_number(values[i]), columns[i].unit));
  }
  if (shown < values.size()) {
    fmt::format_to(std::back_inserter(text), "  and {} more states (-o FILE writes them all)\n", values.size() - shown);
  }
}

struct EventCount {
  std::string_view name;
  std::size_t count;
  double first, last;
};

/// In the order of their first firing.
std::vector<EventCount> count_events(const Record& record) {
  std::vector<EventCount> counts;
  for (const EventRow& event : record.events) {
    const auto found = std::ranges::find(counts, std::string_view(event.name), &EventCount::name);
    if (found == counts.end()) {
      counts.push_back({event.name, 1, event.t, event.t});
    } else {
      ++found->count;
      found->last = event.t;
    }
  }
  return counts;
}

void append_events(const Record& record, std::string& text) {
  const auto counts = count_events(record);
  for (std::size_t i = 0; i < std::min(counts.size(), most_events); ++i) {
    const EventCount& event = counts[i];
    const std::string_view head = i == 0 ? "events" : "";
    auto out = std::back_inserter(text);
    const std::string last = with_unit(short_number(event.last), record.setup.time_unit);
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

void append_energy(const Record& record, std::string& text) {
  if (!record.energy) return;
  const EnergyBalance& energy = *record.energy;
  fmt::format_to(std::back_inserter(text), "energy  {} at first, {} at last; largest drift {}{}\n",
                 with_unit(short_number(energy.first), energy.unit), with_unit(short_number(energy.last), energy.unit),
                 fmt::format("{:.2g}", energy.drift), energy.first != 0 ? ", relative" : "");
}

void append_checks(const Record& record, std::string& text) {
  if (record.checks.empty()) return;
  const auto passed = std::ranges::count_if(record.checks, &CheckRow::passed);
  fmt::format_to(std::back_inserter(text), "checks  {} of {} hold\n", passed, record.checks.size());
}

void append_cost(const Record& record, std::string& text) {
  const Statistics& s = record.statistics;
  const std::string control = record.setup.step > 0 ? fmt::format("step {}", short_number(record.setup.step))
                                                    : fmt::format("tol {}", short_number(record.setup.rtol));
  fmt::format_to(std::back_inserter(text), "cost    {} steps, {} rejected, {} evaluations, {} by {}, {}\n", s.steps,
                 s.rejected, s.evaluations, duration(s.seconds), record.setup.method, control);
}

}  // namespace

std::string short_number(double value) {
  return fmt::format("{:.6g}", value == 0 ? 0.0 : value);
}

std::string duration(double seconds) {
  if (seconds < 1e-3) return fmt::format("{:.3g} us", seconds * 1e6);
  if (seconds < 1) return fmt::format("{:.3g} ms", seconds * 1e3);
  return fmt::format("{:.3g} s", seconds);
}

std::string summary(const Record& record) {
  std::string text;
  append_ending(record, text);
  append_states(record, text);
  append_events(record, text);
  append_energy(record, text);
  append_checks(record, text);
  append_cost(record, text);
  return text;
}

}  // namespace continuo::results
