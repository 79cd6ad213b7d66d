// continuo check FILES: are text, names and units in order? Nothing is computed, unless the derivatives are to be
// compared with differences (--jacobian).
#include <memory>
#include <span>
#include <string>
#include <vector>

#include <apps/continuo/options/command_line.hpp>
#include <apps/continuo/options/models.hpp>
#include <apps/continuo/options/verb_list.hpp>
#include <apps/continuo/terminal/answer.hpp>
#include <apps/continuo/terminal/interrupt.hpp>
#include <apps/continuo/terminal/terminal.hpp>
#include <apps/continuo/verbs.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <continuo/language/text/diagnostic.hpp>
#include <continuo/language/world.hpp>
#include <continuo/results/derivatives.hpp>
#include <continuo/runs/kind.hpp>
#include <continuo/simulation/check_derivatives.hpp>
#include <continuo/simulation/simulate.hpp>

namespace continuo::app {
namespace {

using Json = nlohmann::ordered_json;

struct CheckRequest {
  std::vector<std::string> files;
  bool json = false, jacobian = false;
};

std::string counted(std::size_t count, std::string_view noun) {
  return fmt::format("{} {}{}", count, noun, count == 1 ? "" : "s");
}

void print_verdict(const std::string& path, const model::Model& model) {
  if (model.has_world()) {
    const std::size_t bodies = model.world->bodies.size();
    const std::size_t states = model.world->first_measure - model.world->body_states();
    print(fmt::format(
        "{}: in order; {}, {}, {}, {}, {}\n", path, bodies == 1 ? "1 body" : fmt::format("{} bodies", bodies),
        counted(states, "state"), counted(model.parameters.size(), "parameter"),
        counted(model.events.size() + model.schedule.size(), "event"), counted(model.checks.size(), "check")));
    return;
  }
  print(fmt::format("{}: in order; {}, {}, {}, {}\n", path, counted(model.states.size(), "state"),
                    counted(model.parameters.size(), "parameter"),
                    counted(model.events.size() + model.schedule.size(), "event"),
                    counted(model.checks.size(), "check")));
}

/// The numbers of the verdict, for --json; `model` is null where there is none.
Json verdict_json(const std::string& path, const model::Model* model) {
  Json file{{"file", name_of_file(path)}, {"in_order", model != nullptr}};
  if (model == nullptr) return file;
  file.update({{"name", model->name},
               {"bodies", model->has_world() ? model->world->bodies.size() : 0},
               {"states", model->states.size()},
               {"parameters", model->parameters.size()},
               {"events", model->events.size() + model->schedule.size()},
               {"checks", model->checks.size()}});
  return file;
}

/// What --jacobian adds to the verdict: text, or a field of `file`.
ExitCode compare_derivatives(const CheckRequest& request, const model::Loaded& loaded, Json& file) {
  std::vector<model::Diagnostic> problems;
  if (const auto refused = runs::no_study_of_equations(*loaded.model)) {
    show(std::span(&*refused, 1), loaded.source);
    return wrong_model;
  }
  const auto report =
      model::check_derivatives(model::compile(*loaded.model), {.interrupt = &interrupt_flag()}, problems);
  show(problems, loaded.source);
  if (!report) return numerical_failure;
  if (request.json) {
    file["jacobian"] = Json::parse(results::derivatives_json(*report));
  } else {
    print(results::derivatives_text(*report));
  }
  if (report->interrupted) return interrupted;
  return report->agrees() ? done : check_failed;
}

ExitCode check(const CheckRequest& request) {
  const ModelFiles files = find_models(request.files);
  ExitCode exit = files.complete ? done : usage;
  Json verdicts = Json::array();
  for (const std::string& path : files.paths) {
    const model::Loaded loaded = load_model(path);
    verdicts.push_back(verdict_json(path, loaded ? &*loaded.model : nullptr));
    if (!loaded) {
      exit = wrong_model;
      continue;
    }
    if (!request.json) print_verdict(name_of_file(path), *loaded.model);
    if (!request.jacobian) continue;
    const ExitCode compared = compare_derivatives(request, loaded, verdicts.back());
    if (exit == done || compared == interrupted) exit = compared;
    if (compared == interrupted) break;
  }
  if (request.json && !files.paths.empty()) answer("continuo.check/1", {{"files", verdicts}});
  return exit;
}

}  // namespace

void add_check(CLI::App& app, ExitCode& exit) {
  static constexpr std::string_view examples =
      "  continuo check spring.sim\n"
      "  continuo check models/          every model of a folder\n"
      "  continuo check spring.sim --json\n"
      "  continuo check spring.sim --jacobian   df/dx and df/dt against differences, along a run\n";
  Verb* verb = add_verb(app, listed("check"), examples, {wrong_model, numerical_failure, check_failed, interrupted});
  verb->json_examples = {"continuo check models/pendulum.sim --jacobian --json"};
  auto request = std::make_shared<CheckRequest>();
  reads_file(
      *verb,
      verb->add_option("files", request->files, "Models, or folders of models (- for standard input)")->required());
  verb->add_flag("--json", request->json, "The verdict on every file, and all messages, as one JSON object");
  verb->add_flag(
      "--jacobian", request->jacobian,
      "Compares the exact derivatives with finite differences along a short run, and shows points without derivative");
  verb->callback([&exit, request] { exit = check(*request); });
}

}  // namespace continuo::app
