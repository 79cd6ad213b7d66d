// Builds the manifest of a run and the object of `--json`.
#include <cmath>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include <continuo/results/json.hpp>
#include <continuo/results/sha256.hpp>
#include <continuo/symbolic/native/native_compiler.hpp>

namespace continuo::results {
namespace {

using Json = nlohmann::ordered_json;

/// Model texts may hold bytes that are not UTF-8; they become U+FFFD.
std::string text_of(const Json& json) {
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + '\n';
}

Json statistics_of(const Statistics& statistics) {
  Json json{{"steps", statistics.steps},
            {"rejected", statistics.rejected},
            {"evaluations", statistics.evaluations},
            {"events", statistics.events},
            {"seconds", statistics.seconds}};
  if (statistics.factorizations > 0) {
    json["jacobians"] = statistics.jacobians;
    json["factorizations"] = statistics.factorizations;
    json["linear_solves"] = statistics.linear_solves;
  }
  return json;
}

/// What computed the equations; the results are the same unless operations were fused.
Json native_of(const model::Model& model) {
  if (!model.native) return nullptr;
  const model::NativeCompiler::Report report = model.native->report();
  Json json{{"compiled", report.compiled}, {"loaded", report.loaded}};
  if (model.native->use() == model::NativeUse::fused) json["fused"] = true;
  if (!report.trouble.empty()) json["trouble"] = report.trouble;
  return json;
}

Json outcome_of(const Outcome<double>& outcome) {
  Json json{{"ending", to_string(outcome.ending)}, {"t", outcome.t}};
  if (!outcome.event.empty()) json["event"] = outcome.event;
  if (!succeeded(outcome.ending)) {
    json["h"] = outcome.h;
    json["error"] = outcome.error;
    if (!outcome.component.empty()) json["component"] = outcome.component;
    if (outcome.ending == Ending::events_accumulate) json["limit_time"] = outcome.limit_time;
    json["message"] = describe(outcome);
    if (!outcome.hint.empty()) json["hint"] = outcome.hint;
  }
  return json;
}

/// What determines a run, but for its initial states.
Json plan_object(const model::Model& model, const model::Plan& plan, std::string_view version) {
  Json parameters = Json::object();
  for (const model::Parameter& parameter : model.parameters)
    parameters[parameter.name] = plan.variables[parameter.variable];
  const model::Text& text = model.text;
  Json json{
      {"continuo", version},
      {"model", {{"name", model.name}, {"path", text.path}, {"sha256", sha256(text.content)}, {"text", text.content}}},
      {"parameters", std::move(parameters)},
      {"from", plan.from},
      {"to", plan.to},
      {"time_unit", model.time_unit},
      {"method", plan.method}};
  if (!plan.initial.empty()) json["initial"] = plan.initial;
  if (plan.step > 0) {
    json["step"] = plan.step;
  } else {
    if (plan.rtol_each.empty()) {
      json["rtol"] = plan.rtol;
    } else {
      json["rtol"] = plan.rtol_each;
    }
    json["atol"] = plan.atol;
    if (std::isfinite(plan.max_step)) json["max_step"] = plan.max_step;
  }
  if (plan.max_steps != max_steps_of(plan)) json["max_steps"] = plan.max_steps;
  json["seed"] = nullptr;
  return json;
}

Json error_of(const model::Run& run) {
  Json json = Json::object();
  const model::ErrorEstimate& error = *run.error;
  if (!error.message.empty()) json["message"] = error.message;
  for (std::size_t i = 0; i < error.at_end.size(); ++i) {
    Json& state = json["states"][run.motion.columns[i + 1].name];
    state["at_end"] = error.at_end[i];
    if (!error.largest.empty()) state["largest"] = error.largest[i];
  }
  return json;
}

Json checks_of(const model::Run& run) {
  Json checks = Json::array();
  for (const model::CheckResult& check : run.checks) {
    Json json{{"check", check.text}, {"passed", check.passed}, {"evaluated", check.evaluated}};
    if (check.message.empty()) {
      json["value"] = check.value;
      json["expected"] = check.expected;
      json["tolerance"] = check.tolerance;
    } else {
      json["message"] = check.message;
    }
    checks.push_back(std::move(json));
  }
  return checks;
}

}  // namespace

std::string manifest(const model::Model& model, const model::Run& run, std::string_view version) {
  Json json = plan_object(model, run.plan, version);
  json["outcome"] = outcome_of(run.outcome);
  json["statistics"] = statistics_of(run.statistics);
  json["native"] = native_of(model);
  json["hash"] = manifest_hash(model, run.plan, run.first_state(), version);
  return text_of(json);
}

std::string manifest_hash(const model::Model& model, const model::Plan& plan, std::span<const double> first_state,
                          std::string_view version) {
  Json json = plan_object(model, plan, version);
  json["model"].erase("path");
  json["start"] = std::vector<double>(first_state.begin(), first_state.end());
  return sha256(text_of(json));
}

std::string run_json(const model::Run& run) {
  Json json{{"outcome", to_string(run.outcome.ending)}, {"t", run.final_time()}};
  if (!succeeded(run.outcome.ending)) json["failure"] = outcome_of(run.outcome);
  Json state = Json::object(), events = Json::array();
  const auto values = run.final_state();
  for (std::size_t i = 0; i < values.size(); ++i) state[run.motion.columns[1 + i].name] = values[i];
  for (const model::RecordedEvent& event : run.events) {
    events.push_back({{"name", event.name}, {"t", event.t}});
    if (event.impulse) events.back()["impulse"] = *event.impulse;
  }
  json["state"] = std::move(state);
  json["events"] = std::move(events);
  json["statistics"] = statistics_of(run.statistics);
  json["energy"] = run.energy
                       ? Json{{"first", run.energy->first}, {"last", run.energy->last}, {"drift", run.energy->drift}}
                       : Json();
  json["checks"] = checks_of(run);
  if (run.error) json["error"] = error_of(run);
  if (!run.outcome.hint.empty()) json["hint"] = run.outcome.hint;
  return text_of(json);
}

}  // namespace continuo::results
