#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>

#include <fmt/format.h>
#include <tests/hybrid/generator.hpp>
#include <tests/hybrid/random.hpp>
#include <tests/hybrid/referee.hpp>
#include <tests/hybrid/sensitivities.hpp>

#include <continuo/language/load.hpp>
#include <continuo/studies/sensitivity.hpp>

namespace continuo::hybrid {
namespace {

using Place = std::function<double&(HybridModel&)>;

/// The numbers of a model on which its motion depends smoothly.
std::vector<Place> places(const HybridModel& model) {
  std::vector<Place> all;
  for (std::size_t i = 0; i < model.initial.size(); ++i)
    all.push_back([i](HybridModel& m) -> double& { return m.initial[i]; });
  using Parameters = Block::Parameters;
  for (std::size_t b = 0; b < model.blocks.size(); ++b) {
    for (std::size_t mode = 0; mode < model.blocks[b].in_mode.size(); ++mode) {
      for (double Parameters::* rate :
           {&Parameters::a, &Parameters::b, &Parameters::c, &Parameters::k, &Parameters::w, &Parameters::mu})
        all.push_back([=](HybridModel& m) -> double& { return m.blocks[b].in_mode[mode].*rate; });
    }
    all.push_back([b](HybridModel& m) -> double& { return m.blocks[b].level; });
  }
  for (std::size_t c = 0; c < model.comparisons.size(); ++c) {
    if (model.comparisons[c].form != Comparison::Form::plain) continue;
    if (model.comparisons[c].right.kind != Expression::Kind::number) continue;
    all.push_back([c](HybridModel& m) -> double& { return m.comparisons[c].right.number; });
  }
  return all;
}

/// The text with a parameter `q` in place of one number; empty where the text does not show that number as it is.
std::string text_with_parameter(HybridModel model, const Place& place) {
  const double value = place(model);
  const double unlike_any = 7.7777771;
  place(model) = unlike_any;
  std::string text = text_of(model);
  const std::string shown = fmt::format("{}", unlike_any);
  bool any = false;
  for (auto at = text.find(shown); at != std::string::npos; at = text.find(shown, at))
    text.replace(at, shown.size(), "q"), any = true;
  return any ? fmt::format("param q = {}\n", value) + text : std::string();
}

Expected moved(HybridModel model, const Place& place, double by) {
  place(model) += by;
  return referee(model, 4);
}

bool same_events(const Expected& a, const Expected& b) {
  return b.rejected.empty() && a.slides == b.slides &&
         std::ranges::equal(a.events, b.events, {}, &Occurrence::event, &Occurrence::event);
}

struct Differences {
  std::vector<double> slope, doubt;
};

/// Derivatives by central differences over two distances, whose difference estimates their error. None where the events
/// differ between the two sides, or the derivative changes between them.
std::optional<Differences> differences(const HybridModel& model, const Place& place, const Expected& here) {
  std::vector<std::vector<double>> slopes;
  for (const double by : {1e-5, 2e-5}) {
    const Expected above = moved(model, place, by), below = moved(model, place, -by);
    if (!same_events(here, above) || !same_events(here, below)) return std::nullopt;
    std::vector<double>& slope = slopes.emplace_back();
    for (std::size_t i = 0; i < here.end.size(); ++i) {
      const Real right = (above.end[i] - here.end[i]) / by, left = (here.end[i] - below.end[i]) / by;
      const Real size = 1 + std::max(std::fabs(left), std::fabs(right));
      if (std::fabs(right - left) > 1e-2 * size) return std::nullopt;
      slope.push_back(static_cast<double>((right + left) / 2));
    }
  }
  Differences result;
  for (std::size_t i = 0; i < here.end.size(); ++i) {
    // The errors are c h^2 and 4 c h^2.
    result.slope.push_back((4 * slopes[0][i] - slopes[1][i]) / 3);
    result.doubt.push_back(std::abs(slopes[1][i] - slopes[0][i]));
  }
  return result;
}

}  // namespace

SensitivityAttack attack_sensitivities(std::size_t count, std::uint64_t seed, std::size_t failures_to_tell) {
  SensitivityAttack result;
  for (std::uint64_t number = 0; result.asked < count; ++number) {
    const HybridModel model = random_model(seed * 1'000'003 + number, {});
    Random random(seed * 1'000'033 + number);
    const Place place = random.any_of(places(model));
    const auto leave_out = [&](const std::string& reason) { ++result.left_out[reason]; };
    if (std::ranges::any_of(model.blocks, [](const Block& b) { return b.is_input; })) {
      leave_out("tables in files");
      continue;
    }
    const Expected here = referee_of_well_conditioned(model);
    const std::string text = here.rejected.empty() ? text_with_parameter(model, place) : std::string();
    const auto expected = text.empty() ? std::nullopt : differences(model, place, here);
    if (!expected) {
      leave_out(!here.rejected.empty() ? here.rejected : text.empty() ? "no such number" : "no derivative");
      continue;
    }
    const model::Loaded loaded = model::load(model::Source("hybrid.sim", text));
    if (!loaded) {
      leave_out("not a parameter");  // a number that may not be one
      continue;
    }
    ++result.asked;
    const auto program = model::compile(*loaded.model);
    const std::vector<studies::Influence> influences{{.index = model::find_parameter(program->model, "q")}};
    const studies::SensitivityStudy study(program, influences);
    const studies::SensitivityRun run = study.run({.experiment = {.rtol = 1e-11, .atol = {1e-11}}});
    if (!run.good()) {
      ++result.refused[!run.diagnostics.empty()  ? run.diagnostics.front().message
                       : run.has_no_derivative() ? run.status.message.substr(run.status.message.rfind('`') + 1)
                                                 : run.status.message.substr(0, 30)];
      continue;
    }
    result.through_events += !here.events.empty();
    result.through_slides += here.slides > 0;
    std::string wrong;
    bool any = false;
    for (std::size_t i = 0; i < here.end.size(); ++i) {
      const std::size_t state = model::find_state(program->model, model.names[i]);
      const double found = run.sensitivity(run.rows() - 1, state, 0), wanted = expected->slope[i];
      any = any || wanted != 0;
      // The error of the referee's differences, and the tolerance, amplified by events.
      const double allowed = 1e-6 * (1 + std::abs(wanted)) + expected->doubt[i];
      if (!(std::abs(found - wanted) <= allowed))
        wrong += fmt::format("d {} / d q is {} in place of {}\n", model.names[i], found, wanted);
    }
    result.not_zero += any;
    if (wrong.empty()) continue;
    ++result.failed;
    if (result.failures.size() < failures_to_tell) result.failures.push_back(text + wrong);
  }
  return result;
}

}  // namespace continuo::hybrid
