// tests/hybrid/comparison.cpp
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <optional>

#include <fmt/format.h>
#include <tests/hybrid/comparison.hpp>
#include <tests/hybrid/shrink.hpp>
#include <unistd.h>

#include <continuo/language/load.hpp>
#include <continuo/simulation/simulate.hpp>

namespace continuo::hybrid {
namespace {

constexpr std::string_view refusal = "the text is refused";

/// The events with a mark of their own; sliding and the like are reported without one.
std::vector<model::RecordedEvent> marked(const model::Run& run) {
  std::vector<model::RecordedEvent> found;
  for (const model::RecordedEvent& event : run.events) {
    if (!event.mark.empty()) found.push_back(event);
  }
  return found;
}

std::string listed(const Expected& expected, const std::vector<model::RecordedEvent>& found) {
  std::string text;
  const std::size_t lines = std::max(expected.events.size(), found.size());
  std::size_t first = 0;
  const auto same = [&](std::size_t i) {
    return i < expected.events.size() && i < found.size() &&
           found[i].mark == fmt::format("e{}", expected.events[i].event) &&
           std::fabs(found[i].t - static_cast<double>(expected.events[i].t)) < 1e-9;
  };
  while (first < lines && same(first)) ++first;
  if (first > 2) text += fmt::format("  ... {} as expected\n", first - 2);
  for (std::size_t i = first > 2 ? first - 2 : 0; i < std::min(lines, first + 6); ++i) {
    text += i < expected.events.size()
                ? fmt::format("  e{} at {:.13f}", expected.events[i].event, static_cast<double>(expected.events[i].t))
                : fmt::format("  {:>21}", "nothing");
    text +=
        i < found.size() ? fmt::format("   found {} at {:.13f}\n", found[i].mark, found[i].t) : "   found nothing\n";
  }
  return text;
}

std::optional<std::string> different_event(const Occurrence& expected, const model::RecordedEvent& found,
                                           double error) {
  if (found.mark != fmt::format("e{}", expected.event)) return "another event";
  const double off = std::fabs(found.t - static_cast<double>(expected.t));
  if (expected.scheduled && off > 0) return fmt::format("a tick {:.2e} away from its decimal", off);
  if (!(off <= error)) return fmt::format("an event off by {:.2e}", off);
  return {};
}

std::string different_run(const HybridModel& abstract, const Expected& expected, const model::Run& run,
                          const Asked& asked) {
  const auto found = marked(run);
  for (std::size_t i = 0; i < std::min(found.size(), expected.events.size()); ++i) {
    if (const auto what = different_event(expected.events[i], found[i], asked.time_error))
      return *what + ":\n" + listed(expected, found);
  }
  if (found.size() != expected.events.size())
    return fmt::format("{} events in place of {}:\n", found.size(), expected.events.size()) + listed(expected, found);
  const auto last = run.motion.row(run.motion.rows() - 1);
  for (std::size_t i = 0; i < expected.end.size(); ++i) {
    const bool is_input = std::ranges::any_of(
        abstract.blocks, [&](const Block& b) { return b.is_input && b.state == static_cast<int>(i); });
    if (is_input) continue;
    // The columns are in an order of their own.
    const auto column = std::ranges::find(run.motion.columns, abstract.names[i], &model::Column::name);
    if (column == run.motion.columns.end()) return abstract.names[i] + " is no column\n";
    const double found_value = last[static_cast<std::size_t>(column - run.motion.columns.begin())];
    const double value = static_cast<double>(expected.end[i]), off = std::fabs(found_value - value);
    if (!(off <= asked.end_error * (1 + std::fabs(value))))
      return fmt::format("{} ends at {:.12g} in place of {:.12g}\n", abstract.names[i], found_value, value);
  }
  return {};
}

}  // namespace

std::span<const Asked> asked_methods() {
  static const std::array<Asked, 5> all{{
      {.method = "", .ability = {.algebraic = true, .stiff = true, .any_rate = true}},
      {.method = "rk4", .step = 1e-3, .ability = {.algebraic = false, .stiff = false, .any_rate = false}},
      {.method = "dop853", .ability = {.algebraic = false, .stiff = false, .any_rate = true}},
      {.method = "radau", .ability = {.algebraic = true, .stiff = true, .any_rate = true}},
      {.method = "bdf", .ability = {.algebraic = true, .stiff = true, .any_rate = true}},
  }};
  return all;
}

namespace {

/// Inputs are step functions from tables, whose files are written beside the text in a folder of this process.
model::Loaded loaded_from_files(const HybridModel& abstract) {
  const std::filesystem::path folder =
      std::filesystem::temp_directory_path() / fmt::format("continuo_hybrid_{}", ::getpid());
  std::filesystem::create_directories(folder);
  const std::filesystem::path path = folder / "hybrid.sim";
  std::ofstream(path) << text_of(abstract);
  for (const Block& block : abstract.blocks) {
    if (block.is_input) std::ofstream(folder / input_file(abstract, block)) << input_table(abstract, block);
  }
  model::Loaded loaded = model::load(path);
  std::filesystem::remove_all(folder);
  return loaded;
}

model::Loaded loaded_model(const HybridModel& abstract) {
  const bool reads_files = std::ranges::any_of(abstract.blocks, [](const Block& b) { return b.is_input; });
  return reads_files ? loaded_from_files(abstract) : model::load(model::Source("hybrid.sim", text_of(abstract)));
}

/// The text with the tables that it reads.
std::string whole_text(const HybridModel& abstract) {
  std::string text = text_of(abstract);
  for (const Block& block : abstract.blocks) {
    if (block.is_input) text += "# " + input_file(abstract, block) + ":\n" + input_table(abstract, block);
  }
  return text;
}

/// Whether the referee gives the same result with denser samples. If it does not, the difference is no error of the
/// library.
bool is_resolved(const HybridModel& model, const Expected& expected) {
  constexpr int closer = 32;
  const Expected finer = referee(model, closer);
  const auto same_event = [](const auto& a, const auto& b) {
    return a.event == b.event && std::fabs(a.t - b.t) < 1e-9;
  };
  const auto same_value = [](Real a, Real b) { return std::fabs(a - b) < 1e-9 * (1 + std::fabs(b)); };
  return finer.rejected.empty() && std::ranges::equal(finer.events, expected.events, same_event) &&
         std::ranges::equal(finer.end, expected.end, same_value);
}

}  // namespace

std::string difference(const HybridModel& abstract, const Expected& expected, const Asked& asked) {
  const model::Loaded loaded = loaded_model(abstract);
  if (!loaded) return std::string(refusal) + ":\n" + loaded.text();
  model::Experiment experiment;
  if (!asked.method.empty()) experiment.method = std::string(asked.method);
  if (asked.step > 0) {
    experiment.step = asked.step;
  } else {
    experiment.rtol = asked.tolerance;
    experiment.atol = {asked.tolerance};
  }
  experiment.keep_rows = false;
  experiment.max_steps = 100'000;
  const model::Simulated simulated = simulate(*loaded.model, experiment);
  if (!simulated.run) return "no run:\n" + render(simulated.diagnostics, loaded.source);
  const model::Run& run = *simulated.run;
  if (!succeeded(run.outcome.ending))
    return fmt::format("the run ends: {} ({})\n", describe(run.outcome), run.statistics.steps) +
           listed(expected, marked(run));
  return different_run(abstract, expected, run, asked);
}

Attack attack(const Asked& asked, std::size_t count, std::uint64_t seed, std::size_t failures_to_tell) {
  Attack result;
  const auto answer = [&](const HybridModel& model) -> std::string {
    const Expected expected = referee_of_well_conditioned(model);
    if (!expected.rejected.empty() || !is_resolved(model, expected)) return {};
    return difference(model, expected, asked);
  };
  while (result.asked < count) {
    // Neighbouring seeds of the generator give unrelated models.
    const HybridModel model = random_model(seed * 1'000'003 + result.asked + result.rejected, asked.ability);
    Expected expected = referee_of_well_conditioned(model);
    if (expected.rejected.empty() && expected.events.empty()) expected.rejected = "nothing happens";
    if (!expected.rejected.empty()) {
      ++result.rejected;
      ++result.reasons[expected.rejected];
      continue;
    }
    ++result.asked;
    result.events += expected.events.size();
    result.with_slides += expected.slides > 0;
    result.with_cascades += expected.most_rounds > 1;
    result.with_simultaneous += expected.simultaneous > 0;
    const std::string what = difference(model, expected, asked);
    if (what.empty()) continue;
    if (!is_resolved(model, expected)) {
      --result.asked;
      ++result.rejected;
      ++result.reasons["roots between the samples"];
      continue;
    }
    ++result.failed;
    if (result.failures.size() >= failures_to_tell) continue;
    const HybridModel small = shrink(model, [&](const HybridModel& smaller) {
      const std::string other = answer(smaller);
      return !other.empty() && other.starts_with(refusal) == what.starts_with(refusal);
    });
    result.failures.push_back(whole_text(small) + answer(small));
  }
  return result;
}

}  // namespace continuo::hybrid
