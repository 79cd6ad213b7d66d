// continuo export FILE --c: the equations of a model as C functions.
#include <memory>
#include <string>

#include <apps/continuo/options/command_line.hpp>
#include <apps/continuo/options/experiment_options.hpp>
#include <apps/continuo/terminal/answer.hpp>
#include <apps/continuo/terminal/terminal.hpp>
#include <apps/continuo/verbs.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <continuo/results/output_file.hpp>
#include <continuo/simulation/c_export.hpp>

namespace continuo::app {
namespace {

struct ExportRequest {
  ExperimentOptions experiment;
  std::string target;
  bool c = false, json = false;
};

ExitCode write(const ExportRequest& request) {
  Prepared prepared = prepare(request.experiment, Worlds::welcome);
  if (prepared.exit != done) return prepared.exit;
  const Result<std::string> text = model::c_text(*prepared.program);
  if (!text) {
    say(fmt::format("{}: {}", request.experiment.file, text.status().message));
    return wrong_model;
  }
  if (request.json) {
    answer("continuo.export/1", {{"model", prepared.program->model.name}, {"language", "c"}, {"text", *text}});
    return done;
  }
  if (request.target.empty()) {
    print(*text);
    return done;
  }
  if (const Status written = results::write_file(request.target, *text); !written) {
    say(describe(written));
    return usage;
  }
  return done;
}

}  // namespace

void add_export(CLI::App& app, ExitCode& exit) {
  static constexpr std::string_view examples =
      "  continuo export models/pendulum.sim --c              on standard output\n"
      "  continuo export models/pendulum.sim --c -o pendulum.c\n";
  Verb* verb = add_verb(app, listed("export"), examples, {wrong_model});
  verb->json_examples = {"continuo export models/pendulum.sim --c --json"};
  auto request = std::make_shared<ExportRequest>();
  add_model(*verb, request->experiment);
  verb->add_flag("--c", request->c, "As C11: right-hand side, Jacobian, guards and outputs")->required();
  writes_file(*verb,
              verb->add_option("-o,--out", request->target, "The C file; without it the text goes to standard output"),
              {".c", ".h"});
  verb->add_flag("--json", request->json, "The text within one JSON object");
  verb->callback([&exit, request] { exit = write(*request); });
}

}  // namespace continuo::app
