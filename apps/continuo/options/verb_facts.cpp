// Reads the declarations of a verb, and writes them as JSON.
#include <algorithm>
#include <array>
#include <utility>

#include <apps/continuo/options/verb_facts.hpp>
#include <nlohmann/json.hpp>

namespace continuo::app {
namespace {

struct ValueKind {
  std::string_view name, meaning;
};

constexpr std::array value_kinds{
    ValueKind{"T", "a time, in the unit of the model's times"},
    ValueKind{"DT", "a duration, in the unit of the model's times; a quotient such as 1/60 is possible"},
    ValueKind{"H", "a step size, in the unit of the model's times; a quotient such as 1/60 is possible"},
    ValueKind{"N", "a whole number"},
    ValueKind{"FILE", "the path of a file"},
    ValueKind{"RTOL", "a relative tolerance, without unit"},
    ValueKind{"[NAME=]RTOL", "a relative tolerance, without unit, for all states or for the state named"},
    ValueKind{"[NAME=]ATOL", "an absolute tolerance, in the unit of the state, for all states or for the state named"},
    ValueKind{"NAME=LOW..HIGH", "a name of the model and a range, in the unit of that quantity"},
};

std::vector<std::string> names_of(const CLI::Option& option) {
  if (option.get_positional()) return {option.get_name(true)};
  std::vector<std::string> names;
  for (const std::string& name : option.get_snames()) names.push_back("-" + name);
  for (const std::string& name : option.get_lnames()) names.push_back("--" + name);
  return names;
}

/// Sorted: CLI11 orders them by their addresses.
std::vector<std::string> names_of(const std::set<CLI::Option*>& options) {
  std::vector<std::string> names;
  for (const CLI::Option* option : options)
    for (std::string& name : names_of(*option)) names.push_back(std::move(name));
  std::ranges::sort(names);
  return names;
}

bool is_repeated(const CLI::Option& option) {
  return option.get_expected_max() == CLI::detail::expected_max_vector_size ||
         option.get_multi_option_policy() == CLI::MultiOptionPolicy::TakeAll;
}

std::vector<OptionFacts> options_of(const Verb& verb, bool positional) {
  std::vector<OptionFacts> facts;
  for (const CLI::Option* option : verb.get_options([positional](const CLI::Option* one) {
         return one->get_positional() == positional && !one->get_group().empty();
       }))
    facts.push_back({.names = names_of(*option),
                     .value = option->get_items_expected_max() > 0 ? option->get_type_name() : "",
                     .meaning = option->get_description(),
                     .required = option->get_required(),
                     .repeated = is_repeated(*option),
                     .needs = names_of(option->get_needs()),
                     .excludes = names_of(option->get_excludes())});
  return facts;
}

std::string synopsis_of(const VerbFacts& facts) {
  std::string text = "continuo " + facts.name;
  for (const OptionFacts& argument : facts.arguments) {
    const std::string name = argument.names.front() + (argument.repeated ? "..." : "");
    text += argument.required ? " " + name : " [" + name + "]";
  }
  return text + " [OPTIONS]";
}

nlohmann::ordered_json json_of(const std::vector<OptionFacts>& options) {
  auto list = nlohmann::ordered_json::array();
  for (const OptionFacts& option : options)
    list.push_back({{"names", option.names},
                    {"value", option.value},
                    {"meaning", option.meaning},
                    {"required", option.required},
                    {"repeated", option.repeated},
                    {"needs", option.needs},
                    {"excludes", option.excludes}});
  return list;
}

nlohmann::ordered_json json_of(const std::vector<ExitCode>& codes) {
  auto list = nlohmann::ordered_json::array();
  for (const ExitCode code : codes) list.push_back({{"code", static_cast<int>(code)}, {"meaning", meaning(code)}});
  return list;
}

}  // namespace

VerbFacts facts_of(const Verb& verb) {
  VerbFacts facts{.name = verb.get_name(),
                  .purpose = verb.get_description(),
                  .synopsis = {},
                  .examples = verb.examples,
                  .arguments = options_of(verb, true),
                  .options = options_of(verb, false),
                  .exit_codes = {done, usage}};
  facts.synopsis = synopsis_of(facts);
  facts.exit_codes.insert(facts.exit_codes.end(), verb.failures.begin(), verb.failures.end());
  return facts;
}

std::vector<ExitCode> all_exit_codes() {
  return {done, usage, wrong_model, numerical_failure, check_failed, interrupted};
}

std::string_view meaning_of_value(std::string_view word) {
  const auto kind = std::ranges::find(value_kinds, word, &ValueKind::name);
  return kind == value_kinds.end() ? "" : kind->meaning;
}

nlohmann::ordered_json verb_json(const VerbFacts& facts) {
  return {{"verb", facts.name},
          {"purpose", facts.purpose},
          {"synopsis", facts.synopsis},
          {"examples", facts.examples},
          {"arguments", json_of(facts.arguments)},
          {"options", json_of(facts.options)},
          {"exit_codes", json_of(facts.exit_codes)}};
}

nlohmann::ordered_json verbs_json(const CLI::App& app) {
  auto verbs = nlohmann::ordered_json::array();
  for (const CLI::App* verb : app.get_subcommands([](const CLI::App*) { return true; }))
    verbs.push_back({{"name", verb->get_name()}, {"purpose", verb->get_description()}});
  return {{"verbs", verbs}, {"exit_codes", json_of(all_exit_codes())}};
}

}  // namespace continuo::app
