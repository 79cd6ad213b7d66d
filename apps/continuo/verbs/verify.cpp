// continuo verify FILES: every model is run and every check of it judged.
#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <apps/continuo/options/command_line.hpp>
#include <apps/continuo/options/experiment_options.hpp>
#include <apps/continuo/options/models.hpp>
#include <apps/continuo/options/verb_list.hpp>
#include <apps/continuo/terminal/answer.hpp>
#include <apps/continuo/terminal/interrupt.hpp>
#include <apps/continuo/terminal/terminal.hpp>
#include <apps/continuo/verbs.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <continuo/results/summary.hpp>
#include <continuo/runs/run.hpp>
#include <continuo/simulation/simulate.hpp>

namespace continuo::app {
namespace {

using Json = nlohmann::ordered_json;

struct VerifyRequest {
  std::vector<std::string> places;
  bool json = false;
};

struct Verdict {
  ExitCode exit = done;
  std::size_t passed = 0, checks = 0;
  std::string remark;               // how it went wrong, if it did
  std::vector<std::string> failed;  // one line per check that does not hold
  double seconds = 0;
  Json judged = Json::array();  // each check with its values, for --json
};

/// What --json says of a check.
Json check_json(const model::CheckResult& check) {
  Json json{{"check", check.text}, {"passed", check.passed}, {"evaluated", check.evaluated}};
  if (check.message.empty()) {
    json.update({{"value", check.value}, {"expected", check.expected}, {"tolerance", check.tolerance}});
  } else {
    json["message"] = check.message;
  }
  return json;
}

std::string failed_line(const model::CheckResult& check) {
  const std::string line = results::failed_check(check);
  if (!check.message.empty() || std::isnan(check.value)) return line;
  return line + fmt::format(", off by {:.2g}", check.value - check.expected);
}

Verdict verify(const std::string& path) {
  model::Loaded loaded = load_model(path);
  if (!loaded) return {.exit = wrong_model, .remark = "not a model", .failed = {}};
  const model::Simulated simulated =
      runs::run(model::compile(*std::move(loaded.model)), {.interrupt = &interrupt_flag()});
  if (!simulated.run) {
    show(simulated.diagnostics, loaded.source);
    return {.exit = numerical_failure, .remark = "cannot be run", .failed = {}};
  }
  const model::Run& run = *simulated.run;
  Verdict verdict{.checks = run.checks.size(), .remark = "", .failed = {}, .seconds = run.statistics.seconds};
  for (const model::CheckResult& check : run.checks) {
    verdict.judged.push_back(check_json(check));
    if (check.passed) {
      ++verdict.passed;
    } else {
      verdict.failed.push_back(failed_line(check));
    }
  }
  if (!succeeded(run.outcome.ending)) {
    show(simulated.diagnostics, loaded.source);
    verdict.exit = run.outcome.ending == Ending::interrupted ? interrupted : numerical_failure;
    verdict.remark = to_string(run.outcome.ending);
  } else if (!verdict.failed.empty()) {
    verdict.exit = check_failed;
  }
  return verdict;
}

/// What ends the verb where models end differently: the first of these.
ExitCode graver(ExitCode a, ExitCode b) {
  for (const ExitCode code : {interrupted, wrong_model, numerical_failure, check_failed, usage}) {
    if (a == code || b == code) return code;
  }
  return done;
}

/// Lines for people as the models are run, one object for programs at the end.
ExitCode verify_all(const VerifyRequest& request) {
  const auto say_line = [&](const std::string& text) {
    if (!request.json) print(text);
  };
  const ModelFiles files = find_models(request.places);
  Json models = Json::array();
  ExitCode exit = files.complete ? done : usage;
  std::size_t widest = 5, checks = 0, passed = 0, good = 0;
  for (const std::string& path : files.paths) widest = std::max(widest, name_of_file(path).size());
  say_line(fmt::format("{:<{}}  {:>8}  {:>9}\n", "model", widest, "checks", "time"));
  for (const std::string& path : files.paths) {
    const Verdict verdict = verify(path);
    checks += verdict.checks;
    passed += verdict.passed;
    good += verdict.exit == done ? 1 : 0;
    exit = graver(exit, verdict.exit);
    models.push_back({{"file", name_of_file(path)},
                      {"passed", verdict.exit == done},
                      {"exit", static_cast<int>(verdict.exit)},
                      {"remark", verdict.remark},
                      {"seconds", verdict.seconds},
                      {"checks", verdict.judged}});
    say_line(fmt::format("{:<{}}  {:>8}  {:>9}{}\n", name_of_file(path), widest,
                         fmt::format("{}/{}", verdict.passed, verdict.checks), results::duration(verdict.seconds),
                         verdict.exit == done ? "" : "  " + (verdict.remark.empty() ? "FAILED" : verdict.remark)));
    for (const std::string& line : verdict.failed) say_line(fmt::format("  {}\n", line));
    if (verdict.exit == interrupted) break;
  }
  say_line(fmt::format("{} of {} models passed, {} of {} checks\n", good, files.paths.size(), passed, checks));
  if (request.json && !files.paths.empty())
    answer("continuo.verify/1", {{"models", models},
                                 {"models_passed", good},
                                 {"models_found", files.paths.size()},
                                 {"checks_passed", passed},
                                 {"checks_found", checks}});
  return exit;
}

}  // namespace

void add_verify(CLI::App& app, ExitCode& exit) {
  static constexpr std::string_view examples =
      "  continuo verify models/            every model of a folder\n"
      "  continuo verify ball.sim spring.sim\n";
  Verb* verb = add_verb(app, listed("verify"), examples, {wrong_model, numerical_failure, check_failed, interrupted});
  verb->json_examples = {"continuo verify models/pendulum.sim --json"};
  auto request = std::make_shared<VerifyRequest>();
  reads_file(
      *verb,
      verb->add_option("files", request->places, "Models, or folders of models (- for standard input)")->required());
  verb->add_flag("--json", request->json, "Every check with its values as one JSON object");
  verb->callback([&exit, request] { exit = verify_all(*request); });
}

}  // namespace continuo::app
