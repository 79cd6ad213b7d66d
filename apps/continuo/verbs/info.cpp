// continuo info FILE: what Continuo made of a model.
#include <memory>
#include <string>

#include <apps/continuo/options/command_line.hpp>
#include <apps/continuo/options/models.hpp>
#include <apps/continuo/options/verb_list.hpp>
#include <apps/continuo/terminal/terminal.hpp>
#include <apps/continuo/verbs.hpp>

#include <continuo/language/describe.hpp>

namespace continuo::app {
namespace {

ExitCode info(const std::string& path) {
  if (!readable(path)) return usage;
  const model::Loaded loaded = load_model(path);
  if (!loaded) return wrong_model;
  print(model::describe(*loaded.model));
  return done;
}

}  // namespace

void add_info(CLI::App& app, ExitCode& exit) {
  Verb* verb = add_verb(app, listed("info"), "  continuo info models/bouncing_ball.sim\n", {wrong_model});
  auto path = std::make_shared<std::string>();
  reads_file(*verb, verb->add_option("file", *path, "The model")->required(), files_of_model);
  verb->callback([&exit, path] { exit = info(*path); });
}

}  // namespace continuo::app
