#include <string>

#include <nlohmann/json.hpp>

#include <continuo/results/json.hpp>
#include <continuo/results/sha256.hpp>

namespace continuo::results {
namespace {

using Json = nlohmann::ordered_json;

/// Model texts may hold bytes that are not UTF-8; they become U+FFFD.
std::string text_of(const Json& json) {
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + '\n';
}

Json statistics_of(const Statistics& statistics) {
  return {{"steps", statistics.steps},
          {"rejected", statistics.rejected},
          {"evaluations", statistics.evaluations},
          {"events", statistics.events},
          {"seconds", statistics.seconds}};
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

Json manifest_object(const Record& record, std::string_view version) {
  const Setup& setup = record.setup;
  Json json{
      {"continuo", version},
      {"model", {{"name", setup.model}, {"path", setup.path}, {"sha256", sha256(setup.text)}, {"text", setup.text}}},
      {"parameters", setup.parameters},
      {"from", setup.from},
      {"to", setup.to},
      {"time_unit", setup.time_unit},
      {"method", setup.method}};
  if (setup.step > 0) {
    json["step"] = setup.step;
  } else {
    json["rtol"] = setup.rtol;
    json["atol"] = setup.atol;
  }
  json["seed"] = setup.seed ? Json(*setup.seed) : Json();
  json["outcome"] = outcome_of(record.outcome);
  json["statistics"] = statistics_of(record.statistics);
  return json;
}

Json checks_of(const Record& record) {
  Json checks = Json::array();
  for (const CheckRow& check : record.checks) {
    Json json{{"check", check.text}, {"passed", check.passed}};
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

std::string manifest(const Record& record, std::string_view version) {
  Json json = manifest_object(record, version);
  json["hash"] = manifest_hash(record, version);
  return text_of(json);
}

std::string manifest_hash(const Record& record, std::string_view version) {
  Json json = manifest_object(record, version);
  json["model"].erase("path");
  json["statistics"].erase("seconds");
  return sha256(text_of(json));
}

std::string run_json(const Record& record) {
  Json json{{"outcome", to_string(record.outcome.ending)}, {"t", record.final_time()}};
  if (!succeeded(record.outcome.ending)) json["failure"] = outcome_of(record.outcome);
  Json state = Json::object(), events = Json::array();
  const auto values = record.final_state();
  for (std::size_t i = 0; i < values.size(); ++i) state[record.state_columns()[i].name] = values[i];
  for (const EventRow& event : record.events) events.push_back({{"name", event.name}, {"t", event.t}});
  json["state"] = std::move(state);
  json["events"] = std::move(events);
  json["statistics"] = statistics_of(record.statistics);
  json["energy"] =
      record.energy
          ? Json{{"first", record.energy->first}, {"last", record.energy->last}, {"drift", record.energy->drift}}
          : Json();
  json["checks"] = checks_of(record);
  return text_of(json);
}

}  // namespace continuo::results
