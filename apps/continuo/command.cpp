// Parses the command line and runs the verb that it names.
#include <algorithm>
#include <exception>
#include <iterator>
#include <string>
#include <string_view>

#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <apps/continuo/command.hpp>
#include <apps/continuo/options/command_line.hpp>
#include <apps/continuo/options/completion.hpp>
#include <apps/continuo/options/verb_list.hpp>
#include <apps/continuo/terminal/answer.hpp>
#include <apps/continuo/terminal/terminal.hpp>
#include <fmt/format.h>

namespace continuo::app {
namespace {

constexpr std::string_view command_examples =
    "  continuo run models/bouncing_ball.sim                     the motion in a few lines\n"
    "  continuo view models/spring_pendulum.sim                  the motion live in the browser: drag the mass, slide "
    "k\n"
    "  continuo run models/kepler.sim -o orbit.csv --plot orbit.svg\n"
    "  continuo compare models/mass_spring.sim --methods euler,rk4 --step 0.1,0.05\n"
    "  continuo new spring                                       a commented model to start from\n"
    "  continuo verify models/                                   tests every check of every model\n"
    "  continuo explain E201                                     the explanation of a message\n";

/// All verbs in the order of their list; those of the other program have no more than their names and purposes.
void add_verbs(CLI::App& app, ExitCode& exit, std::span<const OwnVerb> verbs) {
  for (const ListedVerb& listed : all_verbs) {
    const auto own = std::ranges::find(verbs, listed.name, &OwnVerb::name);
    if (own != verbs.end())
      own->add(app, exit);
    else
      app.add_subcommand(std::string(listed.name), std::string(listed.purpose));
  }
}

/// How a command line ended: the verb is empty where none was understood.
struct Ended {
  int exit = usage;
  std::string verb{};
  bool showed_help = false;
};

Ended command(int argc, char** argv, std::span<const OwnVerb> verbs) {
  CLI::App app(
      "Simulates continuous systems from their differential equations, with located events and error estimates.",
      "continuo");
  examples_first(app, command_examples);
  app.set_version_flag("--version", "continuo " CONTINUO_VERSION);
  app.require_subcommand(1);
  ExitCode exit = done;
  add_verbs(app, exit, verbs);

  for (CLI::App* verb : app.get_subcommands({})) refuse_empty(*verb);
  if (argc > 1 && argv[1] == completion_request) {
    for (const std::string& word : completions(app, std::span(argv, static_cast<std::size_t>(argc)).subspan(2)))
      print(word + "\n");
    return {.exit = done, .showed_help = true};
  }
  if (argc == 1) {
    print(app.help());
    return {};
  }
  const auto verb = [&] {
    const auto chosen = app.get_subcommands();
    return chosen.empty() ? std::string() : chosen.front()->get_name();
  };
  const auto advice = [&] { return fmt::format("continuo {}--help shows how", verb().empty() ? "" : verb() + " "); };
  try {
    app.parse(argc, argv);
    return {.exit = exit, .verb = verb()};
  } catch (const CLI::Success& success) {  // --help, --version
    return {.exit = app.exit(success), .verb = verb(), .showed_help = true};
  } catch (const FileFault& fault) {
    say(fault.what());
  } catch (const CLI::ExtrasError&) {
    say(fmt::format("{} ({})", unexpected(app, argc, argv), advice()));
  } catch (const CLI::ParseError& error) {
    say(fmt::format("{} ({})", verb().empty() ? unexpected(app, argc, argv) : error.what(), advice()));
  }
  return {.verb = verb()};
}

/// What the verb did, or how it broke off.
Ended call(int argc, char** argv, std::span<const OwnVerb> verbs) {
  try {
    return command(argc, argv, verbs);
  } catch (const std::exception& error) {
    say(fmt::format("internal error: {}", error.what()));
    return {.exit = numerical_failure};
  }
}

}  // namespace

int run_command(int argc, char** argv, std::span<const OwnVerb> verbs) {
  if (wants_json(argc, argv)) {
    const std::string_view verb = argv[1];
    answer_even_if_interrupted(std::ranges::find(all_verbs, verb, &ListedVerb::name) == std::end(all_verbs) ? ""
                                                                                                            : verb);
  }
  const Ended ended = call(argc, argv, verbs);
  if (wants_json(argc, argv) && !ended.showed_help) print_answer(ended.verb, ended.exit);
  if (ended.exit != done) return ended.exit;
  return all_printed() ? done : usage;
}

}  // namespace continuo::app
