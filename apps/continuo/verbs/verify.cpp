// continuo verify FILES: every model is run and every check of it judged.
#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include <apps/continuo/options/command_line.hpp>
#include <apps/continuo/options/experiment_options.hpp>
#include <apps/continuo/options/models.hpp>
#include <apps/continuo/options/verb_list.hpp>
#include <apps/continuo/terminal/interrupt.hpp>
#include <apps/continuo/terminal/terminal.hpp>
#include <apps/continuo/verbs.hpp>
#include <fmt/format.h>

#include <continuo/results/summary.hpp>
#include <continuo/runs/run.hpp>
#include <continuo/simulation/simulate.hpp>

namespace continuo::app {
namespace {

struct Verdict {
  ExitCode exit = done;
  std::size_t passed = 0, checks = 0;
  std::string remark;               // how it went wrong, if it did
  std::vector<std::string> failed;  // one line per check that does not hold
  double seconds = 0;
};

std::string failed_line(const model::CheckResult& check) {
  const std::string line = results::failed_check(check);
  if (!check.message.empty() || std::isnan(check.value)) return line;
  return line + fmt::format(", off by {:.2g}", check.value - check.expected);
}

Verdict verify(const std::string& path) {
  const model::Loaded loaded = load_model(path);
  if (!loaded) return {.exit = wrong_model, .remark = "not a model", .failed = {}};
  const model::Simulated simulated = runs::run(model::compile(*loaded.model), {.interrupt = &interrupt_flag()});
  if (!simulated.run) {
    show(simulated.diagnostics, loaded.source);
    return {.exit = numerical_failure, .remark = "cannot be run", .failed = {}};
  }
  const model::Run& run = *simulated.run;
  Verdict verdict{.checks = run.checks.size(), .remark = "", .failed = {}, .seconds = run.statistics.seconds};
  for (const model::CheckResult& check : run.checks) {
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

ExitCode verify_all(const std::vector<std::string>& places) {
  const ModelFiles files = find_models(places);
  ExitCode exit = files.complete ? done : usage;
  std::size_t widest = 5, checks = 0, passed = 0, good = 0;
  for (const std::string& path : files.paths) widest = std::max(widest, path.size());
  print(fmt::format("{:<{}}  {:>8}  {:>9}\n", "model", widest, "checks", "time"));
  for (const std::string& path : files.paths) {
    const Verdict verdict = verify(path);
    checks += verdict.checks;
    passed += verdict.passed;
    good += verdict.exit == done ? 1 : 0;
    exit = graver(exit, verdict.exit);
    print(fmt::format("{:<{}}  {:>8}  {:>9}{}\n", path, widest, fmt::format("{}/{}", verdict.passed, verdict.checks),
                      results::duration(verdict.seconds),
                      verdict.exit == done ? "" : "  " + (verdict.remark.empty() ? "FAILED" : verdict.remark)));
    for (const std::string& line : verdict.failed) print(fmt::format("  {}\n", line));
    if (verdict.exit == interrupted) break;
  }
  print(fmt::format("{} of {} models passed, {} of {} checks\n", good, files.paths.size(), passed, checks));
  return exit;
}

}  // namespace

void add_verify(CLI::App& app, ExitCode& exit) {
  static constexpr std::string_view examples =
      "  continuo verify models/            every model of a folder\n"
      "  continuo verify ball.sim spring.sim\n";
  Verb* verb = add_verb(app, listed("verify"), examples, {wrong_model, numerical_failure, check_failed, interrupted});
  auto places = std::make_shared<std::vector<std::string>>();
  reads_file(*verb, verb->add_option("files", *places, "Models, or folders of models")->required());
  verb->callback([&exit, places] { exit = verify_all(*places); });
}

}  // namespace continuo::app
