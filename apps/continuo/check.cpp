// continuo check FILES: are text, names and units in order? Nothing is computed.
#include <memory>
#include <string>
#include <vector>

#include <apps/continuo/command_line.hpp>
#include <apps/continuo/models.hpp>
#include <apps/continuo/terminal.hpp>
#include <apps/continuo/verbs.hpp>
#include <fmt/format.h>

#include <continuo/model/diagnostic.hpp>

namespace continuo::app {
namespace {

struct CheckRequest {
  std::vector<std::string> files;
  bool json = false;
};

std::string counted(std::size_t count, std::string_view noun) {
  return fmt::format("{} {}{}", count, noun, count == 1 ? "" : "s");
}

void print_verdict(const std::string& path, const model::Model& model) {
  print(fmt::format("{}: in order; {}, {}, {}, {}\n", path, counted(model.states.size(), "state"),
                    counted(model.parameters.size(), "parameter"),
                    counted(model.events.size() + model.schedule.size(), "event"),
                    counted(model.checks.size(), "check")));
}

ExitCode check(const CheckRequest& request) {
  const ModelFiles files = find_models(request.files);
  ExitCode exit = files.complete ? done : usage;
  for (const std::string& path : files.paths) {
    const model::Loaded loaded = request.json ? model::load(path) : load_model(path);
    if (request.json) {
      print(model::to_json(loaded.diagnostics, loaded.source) + "\n");
    } else if (loaded) {
      print_verdict(path, *loaded.model);
    }
    if (!loaded) exit = wrong_model;
  }
  return exit;
}

}  // namespace

void add_check(CLI::App& app, ExitCode& exit) {
  static constexpr std::string_view examples =
      "  continuo check spring.sim\n"
      "  continuo check models/          every model of a folder\n"
      "  continuo check spring.sim --json\n";
  CLI::App* verb = add_verb(app, "check", "Checks text, names and units of models; computes nothing", examples);
  auto request = std::make_shared<CheckRequest>();
  verb->add_option("files", request->files, "Models, or folders of models")->required()->type_name("");
  verb->add_flag("--json", request->json, "What is wrong as JSON, one array per file");
  verb->callback([&exit, request] { exit = check(*request); });
}

}  // namespace continuo::app
