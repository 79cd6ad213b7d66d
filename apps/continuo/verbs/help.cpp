// continuo help VERB: the help of a verb; with --markdown its page in the reference.
#include <memory>
#include <string>

#include <CLI/App.hpp>
#include <CLI/Formatter.hpp>
#include <apps/continuo/options/command_line.hpp>
#include <apps/continuo/options/verb_list.hpp>
#include <apps/continuo/options/verb_page.hpp>
#include <apps/continuo/terminal/terminal.hpp>
#include <apps/continuo/verbs.hpp>

namespace continuo::app {
namespace {

struct HelpRequest {
  std::string verb;
  bool markdown = false;
};

ExitCode help(const CLI::App& app, const HelpRequest& request) {
  if (request.verb.empty()) {
    // app.help() would be the help of the verb that was chosen, which is this one.
    print(request.markdown ? verbs_page(app)
                           : app.get_formatter()->make_help(&app, app.get_name(), CLI::AppFormatMode::Normal));
    return done;
  }
  const Verb* verb = find_verb(app, request.verb);
  if (verb == nullptr) {
    say(no_such_verb(app, request.verb) + " (continuo help lists the verbs)");
    return usage;
  }
  print(request.markdown ? verb_page(*verb) : verb->help("continuo"));
  return done;
}

}  // namespace

void add_help(CLI::App& app, ExitCode& exit) {
  static constexpr std::string_view examples =
      "  continuo help             the verbs\n"
      "  continuo help run         the options of a verb, as does continuo run --help\n"
      "  continuo help run --markdown > run.md\n";
  Verb* verb = add_verb(app, listed("help"), examples, {});
  auto request = std::make_shared<HelpRequest>();
  verb->add_option("verb", request->verb, "The verb; without it, all verbs are listed")->type_name("");
  verb->add_flag("--markdown", request->markdown, "As a page of the reference, with exit codes");
  verb->callback([&app, &exit, request] { exit = help(app, *request); });
}

}  // namespace continuo::app
