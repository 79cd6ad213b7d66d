// The command continuo. Each verb has a file of its own.
#include <exception>

#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <apps/continuo/options/command_line.hpp>
#include <apps/continuo/terminal/terminal.hpp>
#include <apps/continuo/verbs.hpp>
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

int command(int argc, char** argv) {
  CLI::App app(
      "Simulates continuous systems from their differential equations, with located events and error estimates.",
      "continuo");
  examples_first(app, command_examples);
  app.set_version_flag("--version", "continuo " CONTINUO_VERSION);
  app.require_subcommand(1);
  ExitCode exit = done;
  add_run(app, exit);
  add_replay(app, exit);
  add_resume(app, exit);
  add_view(app, exit);
  add_check(app, exit);
  add_info(app, exit);
  add_verify(app, exit);
  add_compare(app, exit);
  add_converge(app, exit);
  add_stability(app, exit);
  add_steady(app, exit);
  add_linearize(app, exit);
  add_phase(app, exit);
  add_orbit(app, exit);
  add_report(app, exit);
  add_explore(app, exit);
  add_sense(app, exit);
  add_fit(app, exit);
  add_methods(app, exit);
  add_explain(app, exit);
  add_new(app, exit);
  add_help(app, exit);

  for (CLI::App* verb : app.get_subcommands({})) refuse_empty(*verb);
  if (argc == 1) {
    print(app.help());
    return usage;
  }
  const auto advice = [&] {
    const auto chosen = app.get_subcommands();
    return fmt::format("continuo {}--help shows how", chosen.empty() ? "" : chosen.front()->get_name() + " ");
  };
  try {
    app.parse(argc, argv);
    return exit;
  } catch (const CLI::Success& success) {  // --help, --version
    return app.exit(success);
  } catch (const CLI::ExtrasError&) {
    say(fmt::format("{} ({})", unexpected(app, argc, argv), advice()));
  } catch (const CLI::ParseError& error) {
    const bool no_verb = app.get_subcommands().empty();
    say(fmt::format("{} ({})", no_verb ? unexpected(app, argc, argv) : error.what(), advice()));
  }
  return usage;
}

}  // namespace
}  // namespace continuo::app

int main(int argc, char** argv) {
  try {
    const int exit = continuo::app::command(argc, argv);
    if (exit != continuo::app::done) return exit;
    return continuo::app::all_printed() ? continuo::app::done : continuo::app::usage;
  } catch (const std::exception& error) {
    continuo::app::say(fmt::format("internal error: {}", error.what()));
    return continuo::app::numerical_failure;
  }
}
