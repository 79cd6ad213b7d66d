// The program continuo: all verbs but the studies, for which it becomes the program continuo-studies.
#include <array>

#include <apps/continuo/command.hpp>
#include <apps/continuo/options/verb_list.hpp>
#include <apps/continuo/terminal/answer.hpp>
#include <apps/continuo/terminal/studies_program.hpp>
#include <apps/continuo/verbs.hpp>
#include <apps/continuo/verbs/run.hpp>

int main(int argc, char** argv) {
  using namespace continuo::app;
  if (program_for(argc, argv) == Program::studies) {
    become_studies_program(argv);
    if (wants_json(argc, argv)) print_answer("", usage);
    return usage;
  }
  const std::array verbs{
      OwnVerb{"run", [](CLI::App& app, ExitCode& exit) { add_run(app, exit, {.write_film = film}); }},
      OwnVerb{"replay", add_replay},
      OwnVerb{"resume", add_resume},
      OwnVerb{"view", add_view},
      OwnVerb{"check", add_check},
      OwnVerb{"info", add_info},
      OwnVerb{"verify", add_verify},
      OwnVerb{"report", add_report},
      OwnVerb{"methods", add_methods},
      OwnVerb{"explain", add_explain},
      OwnVerb{"export", add_export},
      OwnVerb{"new", add_new},
      OwnVerb{"help", add_help},
  };
  return run_command(argc, argv, verbs);
}
