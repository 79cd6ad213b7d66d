// continuo help VERB: the help of a verb; with --markdown its page in the reference.
#include <memory>
#include <string>

#include <CLI/App.hpp>
#include <CLI/Formatter.hpp>
#include <apps/continuo/options/command_line.hpp>
#include <apps/continuo/options/verb_facts.hpp>
#include <apps/continuo/options/verb_list.hpp>
#include <apps/continuo/options/verb_manual.hpp>
#include <apps/continuo/options/verb_page.hpp>
#include <apps/continuo/terminal/answer.hpp>
#include <apps/continuo/terminal/terminal.hpp>
#include <apps/continuo/verbs.hpp>
#include <nlohmann/json.hpp>

namespace continuo::app {
namespace {

struct HelpRequest {
  std::string verb;
  bool markdown = false, manual = false, json = false;
};

void help_of_all(const CLI::App& app, const HelpRequest& request) {
  if (request.json) {
    answer("continuo.verbs/1", verbs_json(app));
  } else if (request.manual) {
    print(manual_of(app, CONTINUO_VERSION));
  } else {
    // app.help() would be the help of the verb that was chosen, which is this one.
    print(request.markdown ? verbs_page(app)
                           : app.get_formatter()->make_help(&app, app.get_name(), CLI::AppFormatMode::Normal));
  }
}

ExitCode help(const CLI::App& app, const HelpRequest& request) {
  if (request.verb.empty()) {
    help_of_all(app, request);
    return done;
  }
  const Verb* verb = find_verb(app, request.verb);
  if (verb == nullptr) {
    say(no_such_verb(app, request.verb) + " (continuo help lists the verbs)");
    return usage;
  }
  if (request.json) {
    answer("continuo.help/1", verb_json(facts_of(*verb)));
  } else if (request.manual) {
    print(manual_of(facts_of(*verb), CONTINUO_VERSION));
  } else {
    print(request.markdown ? verb_page(*verb) : verb->help("continuo"));
  }
  return done;
}

}  // namespace

void add_help(CLI::App& app, ExitCode& exit) {
  static constexpr std::string_view examples =
      "  continuo help             the verbs\n"
      "  continuo help run         the options of a verb, as does continuo run --help\n"
      "  continuo help run --markdown > run.md\n"
      "  continuo help run --man | man -l -        the same as a manual page\n";
  Verb* verb = add_verb(app, listed("help"), examples, {});
  verb->json_examples = {"continuo help info --json", "continuo help --json"};
  auto request = std::make_shared<HelpRequest>();
  verb->add_option("verb", request->verb, "The verb; without it, all verbs are listed")->type_name("");
  auto* markdown = verb->add_flag("--markdown", request->markdown, "As a page of the reference, with exit codes");
  auto* manual = verb->add_flag("--man", request->manual, "As a page for man")->excludes(markdown);
  verb->add_flag("--json", request->json, "The declarations of the verb, or all verbs, as one JSON object")
      ->excludes(markdown)
      ->excludes(manual);
  verb->callback([&app, &exit, request] { exit = help(app, *request); });
}

}  // namespace continuo::app
