// Help with the examples first, suggestions for mistyped names, and validators of numbers.
#include <charconv>
#include <cmath>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <apps/continuo/options/command_line.hpp>
#include <fmt/format.h>

#include <continuo/symbolic/graph/cells.hpp>
#include <continuo/symbolic/names/suggest.hpp>

namespace continuo::app {
namespace {

/// CLI11 prints examples (its footer) last; here they come first, where they are seen.
class ExamplesFirst : public CLI::Formatter {
 public:
  std::string make_help(const CLI::App* app, std::string name, CLI::AppFormatMode mode) const override {
    if (mode == CLI::AppFormatMode::Sub) return CLI::Formatter::make_help(app, std::move(name), mode);
    return app->get_footer() + "\n" + CLI::Formatter::make_help(app, std::move(name), mode);
  }
  std::string make_footer(const CLI::App*) const override { return {}; }
};

std::vector<std::string> option_names(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::Option* option : app.get_options()) {
    for (const auto& name : option->get_lnames()) names.push_back("--" + name);
  }
  return names;
}

std::vector<std::string> verb_names(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::App* verb : app.get_subcommands([](const CLI::App*) { return true; }))
    names.push_back(verb->get_name());
  return names;
}

template <class Allowed>
CLI::Validator numbers_that(Allowed allowed, const std::string& otherwise) {
  return {[allowed, otherwise](std::string& text) {
            const auto value = model::cell_number(text);
            return value && std::isfinite(*value) && allowed(*value) ? std::string()
                                                                     : fmt::format("{} is {}", text, otherwise);
          },
          ""};
}

std::string with_hint(std::string message, const std::string& hint) {
  return hint.empty() ? message : message + "; " + hint;
}

}  // namespace

Verb::Verb(CLI::App& app, std::string name, std::string description)
    : CLI::App(std::move(description), std::move(name), &app) {}

void Verb::callback(std::function<void()> act) {
  CLI::App::callback([this, act = std::move(act)] {
    const CLI::Option* json = get_option_no_throw("--json");
    const std::string fault = fault_of_files(files, json != nullptr && json->count() > 0);
    if (!fault.empty()) throw FileFault(fault);
    act();
  });
}

Verb* add_verb(CLI::App& app, const ListedVerb& listed, std::string_view examples, std::vector<ExitCode> failures) {
  auto verb = std::make_shared<Verb>(app, std::string(listed.name), std::string(listed.purpose));
  verb->examples = examples;
  verb->failures = std::move(failures);
  examples_first(*verb, examples);
  app.add_subcommand(verb);
  return verb.get();
}

void examples_first(CLI::App& app, std::string_view examples) {
  app.formatter(std::make_shared<ExamplesFirst>());
  app.footer(fmt::format("Examples:\n{}", examples));
  app.get_formatter()->column_width(34);
}

CLI::Validator quotients() {
  return {[](std::string& text) {
            const auto slash = text.find('/');
            if (slash == std::string::npos) return std::string();
            const auto above = model::cell_number(text.substr(0, slash)),
                       below = model::cell_number(text.substr(slash + 1));
            if (above && below && *below != 0) text = fmt::format("{}", *above / *below);
            return std::string();
          },
          ""};
}

CLI::Validator count_from(std::size_t least, std::size_t most) {
  return {[least, most](std::string& text) {
            std::size_t value = 0;
            const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
            const bool good =
                error == std::errc() && end == text.data() + text.size() && least <= value && value <= most;
            return good ? std::string() : fmt::format("{} is no whole number from {} to {}", text, least, most);
          },
          ""};
}

CLI::Validator finite_number() {
  return numbers_that([](double) { return true; }, "no number");
}
CLI::Validator number_from(double least) {
  return numbers_that([least](double value) { return value >= least; }, fmt::format("no number from {} on", least));
}
CLI::Validator number_above(double least) {
  return numbers_that([least](double value) { return value > least; }, fmt::format("no number above {}", least));
}

CLI::Validator number_between(double least, double below) {
  return numbers_that([=](double value) { return value >= least && value < below; },
                      fmt::format("no number from {} to less than {}", least, below));
}

void refuse_empty(CLI::App& verb) {
  const CLI::Validator not_empty(
      [](std::string& text) { return text.empty() ? "a value is missing: leave the option out, or give it one" : ""; },
      "");
  for (CLI::Option* option : verb.get_options())
    if (option->get_items_expected_max() > 0) option->check(not_empty);
}

std::string no_such_verb(const CLI::App& app, std::string_view word) {
  return with_hint(fmt::format("there is no verb `{}`", word), model::did_you_mean(word, verb_names(app)));
}

std::string unexpected(const CLI::App& app, int argc, char** argv) {
  const auto chosen = app.get_subcommands();
  if (chosen.empty()) {
    for (const char* word : std::span(argv, static_cast<std::size_t>(argc)).subspan(1)) {
      if (*word == '-') continue;
      return no_such_verb(app, word);
    }
  }
  const CLI::App& verb = chosen.empty() ? app : *chosen.front();
  for (const std::string& word : app.remaining(true)) {
    if (word.starts_with("-")) {
      const std::string name = word.substr(0, word.find('='));
      return with_hint(fmt::format("`{}` has no option {}", verb.get_name(), name),
                       model::did_you_mean(name, option_names(verb)));
    }
    return fmt::format("`{}` has no use for `{}`", verb.get_name(), word);
  }
  return "these arguments do not fit together";
}

}  // namespace continuo::app
