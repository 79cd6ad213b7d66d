// continuo info FILE: what Continuo made of a model.
#include <memory>
#include <string>
#include <string_view>

#include <apps/continuo/options/command_line.hpp>
#include <apps/continuo/options/models.hpp>
#include <apps/continuo/options/verb_list.hpp>
#include <apps/continuo/terminal/answer.hpp>
#include <apps/continuo/terminal/terminal.hpp>
#include <apps/continuo/verbs.hpp>
#include <apps/continuo/verbs/model_json.hpp>
#include <nlohmann/json.hpp>

#include <continuo/language/describe.hpp>

namespace continuo::app {
namespace {

struct InfoRequest {
  std::string file;
  bool json = false;
};

ExitCode info(const InfoRequest& request) {
  if (!readable(request.file)) return usage;
  const model::Loaded loaded = load_model(request.file);
  if (!loaded) return wrong_model;
  if (request.json) {
    answer("continuo.info/1", model_json(*loaded.model));
  } else {
    print(model::describe(*loaded.model));
  }
  return done;
}

}  // namespace

void add_info(CLI::App& app, ExitCode& exit) {
  static constexpr std::string_view examples =
      "  continuo info models/bouncing_ball.sim\n"
      "  continuo info models/bouncing_ball.sim --json        the same for programs\n";
  Verb* verb = add_verb(app, listed("info"), examples, {wrong_model});
  verb->json_examples = {"continuo info models/bouncing_ball.sim --json"};
  auto request = std::make_shared<InfoRequest>();
  reads_file(*verb, verb->add_option("file", request->file, "The model (- for standard input)")->required(),
             files_of_model);
  verb->add_flag("--json", request->json, "The parts of the model as one JSON object");
  verb->callback([&exit, request] { exit = info(*request); });
}

}  // namespace continuo::app
