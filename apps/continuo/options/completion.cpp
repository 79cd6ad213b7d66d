// Finds the words that may complete a command line, from the declarations of the verbs and from the model that is
// named.
#include <algorithm>
#include <array>
#include <filesystem>
#include <optional>
#include <sstream>
#include <string>
#include <string_view>
#include <utility>

#include <apps/continuo/options/completion.hpp>
#include <apps/continuo/options/verb_facts.hpp>
#include <apps/continuo/options/verb_page.hpp>

#include <continuo/language/load.hpp>
#include <continuo/language/text/codes.hpp>
#include <continuo/solve/catalogue.hpp>

namespace continuo::app {
namespace {

/// What the value of an option or an argument names.
enum class Names { nothing, files, models, methods, verbs, codes, parameters, states, modes };

struct NamedValue {
  std::string_view option;
  Names names;
  bool has_equals = false;  // `k=5`: what is completed ends with an equals sign
};

constexpr std::array named_values{
    NamedValue{"--set", Names::parameters, true},
    NamedValue{"--method", Names::methods},
    NamedValue{"--methods", Names::methods},
    NamedValue{"methods", Names::methods},
    NamedValue{"--model", Names::models},
    NamedValue{"--why", Names::models},
    NamedValue{"--along", Names::parameters, true},
    NamedValue{"--and", Names::parameters, true},
    NamedValue{"--family", Names::parameters, true},
    NamedValue{"--param", Names::parameters},
    NamedValue{"--log", Names::parameters},
    NamedValue{"--bounds", Names::parameters, true},
    NamedValue{"--prior", Names::parameters, true},
    NamedValue{"--initial", Names::states},
    NamedValue{"--of", Names::states},
    NamedValue{"--at", Names::states, true},
    NamedValue{"--box", Names::states, true},
    NamedValue{"--section", Names::states, true},
    NamedValue{"--mode", Names::modes},
    NamedValue{"verb", Names::verbs},
    NamedValue{"code", Names::codes},
    NamedValue{"file", Names::models},
    NamedValue{"files", Names::models},
    NamedValue{"data", Names::files},
};

class Completion {
 public:
  Completion(const CLI::App& app, std::vector<std::string> before, std::string typed)
      : app_(app), before_(std::move(before)), typed_(std::move(typed)) {}

  std::vector<std::string> find() {
    const auto verb = std::ranges::find_if(before_, [&](const std::string& word) { return is_verb(word); });
    if (verb == before_.end()) {
      offer_verbs();
      offer({"--help", "--version"});
      return std::move(found_);
    }
    const Verb* chosen = find_verb(app_, *verb);
    if (chosen == nullptr) return {};
    const VerbFacts facts = facts_of(*chosen);
    arguments_.assign(verb + 1, before_.end());
    if (const std::size_t equals = typed_.find('='); typed_.starts_with("--") && equals != std::string::npos) {
      prefix_ = typed_.substr(0, equals + 1);
      typed_.erase(0, equals + 1);
      offer_values(facts, option_named(facts, prefix_.substr(0, equals)));
    } else if (const OptionFacts* option = arguments_.empty() ? nullptr : option_named(facts, arguments_.back());
               option != nullptr && !option->value.empty()) {
      offer_values(facts, option);
    } else if (typed_.starts_with('-')) {
      for (const OptionFacts& one : facts.options) offer(one.names);
    } else {
      offer_values(facts, argument_at(facts));
    }
    return std::move(found_);
  }

 private:
  bool is_verb(const std::string& word) const {
    const auto verbs = app_.get_subcommands([](const CLI::App*) { return true; });
    return std::ranges::any_of(verbs, [&](const CLI::App* verb) { return verb->get_name() == word; });
  }

  static const OptionFacts* option_named(const VerbFacts& facts, const std::string& name) {
    for (const OptionFacts& option : facts.options)
      if (std::ranges::find(option.names, name) != option.names.end()) return &option;
    return nullptr;
  }

  /// The argument without a dash that is being typed; the last one may have many.
  const OptionFacts* argument_at(const VerbFacts& facts) const {
    std::size_t place = 0;
    for (std::size_t i = 0; i < arguments_.size(); ++i) {
      if (arguments_[i].starts_with('-') && arguments_[i] != "-") continue;
      const OptionFacts* option = i > 0 ? option_named(facts, arguments_[i - 1]) : nullptr;
      if (option == nullptr || option->value.empty()) ++place;
    }
    if (facts.arguments.empty()) return nullptr;
    if (place < facts.arguments.size()) return &facts.arguments[place];
    return facts.arguments.back().repeated ? &facts.arguments.back() : nullptr;
  }

  void offer_values(const VerbFacts& facts, const OptionFacts* option) {
    if (option == nullptr) return;
    for (const std::string& name : option->names) {
      const auto known = std::ranges::find(named_values, name, &NamedValue::option);
      if (known == named_values.end()) continue;
      const bool is_recording = known->names == Names::models && (facts.name == "replay" || facts.name == "resume");
      return offer_names(is_recording ? Names::files : known->names, known->has_equals);
    }
    if (option->value == "FILE" || option->value == "PATH") offer_names(Names::files, false);
    if (option->value.find('|') == std::string::npos) return;
    // All that there are, watch|own, before what the parser says of them.
    std::istringstream words(option->value.substr(0, option->value.find(':')));
    for (std::string word; std::getline(words, word, '|');) offer({word});
  }

  void offer_names(Names names, bool has_equals) {
    switch (names) {
      case Names::nothing:
        return;
      case Names::files:
        found_.emplace_back(":files");
        return;
      case Names::models:
        found_.emplace_back(":files .sim");
        return;
      case Names::methods:
        skip_list();
        for (const MethodInfo& method : method_catalogue()) offer({std::string(method.name)});
        return;
      case Names::verbs:
        offer_verbs();
        return;
      case Names::codes:
        for (const auto family : {model::syntax_codes(), model::check_codes(), model::numerical_codes()})
          for (const model::Code& code : family) offer({std::string(code.code)});
        return;
      case Names::parameters:
      case Names::states:
      case Names::modes:
        skip_list();
        offer_from_model(names, has_equals ? "=" : "");
    }
  }

  /// Of `k,c`: the names before the last comma stay as they are.
  void skip_list() {
    const std::size_t comma = typed_.rfind(',');
    if (comma == std::string::npos) return;
    prefix_ += typed_.substr(0, comma + 1);
    typed_.erase(0, comma + 1);
  }

  void offer_from_model(Names names, const std::string& end) {
    const auto file = std::ranges::find_if(arguments_, [](const std::string& word) {
      std::error_code error;
      return word.ends_with(".sim") && std::filesystem::is_regular_file(word, error);
    });
    if (file == arguments_.end()) return;
    const model::Loaded loaded = model::load(*file);
    if (!loaded) return;
    if (names == Names::parameters)
      for (const model::Parameter& parameter : loaded.model->parameters) offer({parameter.name + end});
    if (names == Names::states)
      for (const model::State& state : loaded.model->states) offer({state.column + end});
    if (names == Names::modes)
      for (const model::Mode& mode : loaded.model->modes) offer({mode.name + end});
  }

  void offer_verbs() {
    for (const CLI::App* verb : app_.get_subcommands([](const CLI::App*) { return true; })) offer({verb->get_name()});
  }

  void offer(const std::vector<std::string>& words) {
    for (const std::string& word : words)
      if (!word.empty() && word.starts_with(typed_)) found_.push_back(prefix_ + word);
  }

  const CLI::App& app_;
  std::vector<std::string> before_, arguments_{};
  std::string typed_, prefix_{};
  std::vector<std::string> found_{};
};

}  // namespace

std::vector<std::string> completions(const CLI::App& app, std::span<char* const> words) {
  if (words.empty()) return {};
  std::vector<std::string> before(words.begin(), words.end());
  std::string typed = std::move(before.back());
  before.pop_back();
  return Completion(app, std::move(before), std::move(typed)).find();
}

}  // namespace continuo::app
