// The program continuo-studies: the verbs of the command that need the module studies.
#include <array>

#include <apps/continuo/command.hpp>
#include <apps/continuo/options/verb_list.hpp>
#include <apps/continuo/studies/boundary_families.hpp>
#include <apps/continuo/studies/run_of_sweep.hpp>
#include <apps/continuo/terminal/answer.hpp>
#include <apps/continuo/terminal/terminal.hpp>
#include <apps/continuo/verbs.hpp>
#include <apps/continuo/verbs/run.hpp>

int main(int argc, char** argv) {
  using namespace continuo::app;
  if (program_for(argc, argv) != Program::studies) {
    say("this is the part of the command for studies, and these words are for the other one: call continuo");
    if (wants_json(argc, argv)) print_answer("", usage);
    return usage;
  }
  const std::array verbs{
      OwnVerb{"run",
              [](CLI::App& app, ExitCode& exit) {
                add_run(app, exit, {.show_families = show_families, .take_sweep_run = take_sweep_run});
              }},
      OwnVerb{"compare", add_compare},
      OwnVerb{"converge", add_converge},
      OwnVerb{"stability", add_stability},
      OwnVerb{"steady", add_steady},
      OwnVerb{"linearize", add_linearize},
      OwnVerb{"phase", add_phase},
      OwnVerb{"orbit", add_orbit},
      OwnVerb{"explore", add_explore},
      OwnVerb{"sense", add_sense},
      OwnVerb{"sweep", [](CLI::App& app, ExitCode& exit) { add_sweep(app, exit); }},
      OwnVerb{"fit", add_fit},
      OwnVerb{"help", add_help},
  };
  return run_command(argc, argv, verbs);
}
