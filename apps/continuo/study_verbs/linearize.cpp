// continuo linearize FILE: a model near one point as x' = A x + B u, y = C x + D u, and the modes of its motion.
#include <cmath>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <apps/continuo/options/command_line.hpp>
#include <apps/continuo/options/verb_list.hpp>
#include <apps/continuo/studies/studied_model.hpp>
#include <apps/continuo/terminal/answer.hpp>
#include <apps/continuo/terminal/terminal.hpp>
#include <apps/continuo/verbs.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <continuo/results/summary.hpp>
#include <continuo/studies/equilibrium.hpp>
#include <continuo/studies/linear_model.hpp>
#include <continuo/studies/support/unseen.hpp>

namespace continuo::app {
namespace {

struct LinearizeOptions {
  ExperimentOptions experiment;
  std::string mode;
  std::vector<std::string> at;
  std::optional<double> time;
  bool start = false, json = false;
};

std::string matrix_text(std::string_view name, const std::vector<double>& rows, const std::vector<std::string>& of,
                        const std::vector<std::string>& by) {
  if (rows.empty()) return "";
  std::string text = fmt::format("{}\n{:>14}", name, "");
  for (const std::string& column : by) text += fmt::format(" {:>12}", column);
  text += "\n";
  for (std::size_t i = 0; i < of.size(); ++i) {
    text += fmt::format("{:>14}", of[i]);
    for (std::size_t j = 0; j < by.size(); ++j)
      text += fmt::format(" {:>12}", results::short_number(rows[i * by.size() + j]));
    text += "\n";
  }
  return text;
}

std::string modes_text(const std::vector<studies::MotionMode>& modes, const model::Model& model) {
  const std::string unit = model.time_unit.empty() ? "" : " " + model.time_unit;
  std::string text = "modes\n";
  for (const studies::MotionMode& mode : modes) {
    text += fmt::format("  {:<28}", eigenvalue_text(mode.eigenvalue.real(), mode.eigenvalue.imag()));
    if (mode.frequency > 0) {
      text += fmt::format("frequency {}, damping {}", results::short_number(mode.frequency),
                          results::short_number(mode.damping));
    } else if (std::isfinite(mode.time_constant)) {
      text += fmt::format("{} with time constant {}{}", mode.time_constant > 0 ? "decays" : "grows",
                          results::short_number(std::abs(mode.time_constant)), unit);
    } else {
      text += "stays";
    }
    text += "\n";
  }
  return text;
}

nlohmann::json json_of(const studies::LinearModel& linear, const std::vector<double>& point, const Studied& studied,
                       const std::vector<studies::MotionMode>& modes) {
  const model::Model& model = studied.prepared.program->model;
  const auto matrix = [](const std::vector<double>& rows, std::size_t columns) {
    auto result = nlohmann::json::array();
    for (std::size_t i = 0; columns > 0 && i < rows.size(); i += columns)
      result.push_back(std::vector<double>(rows.begin() + static_cast<std::ptrdiff_t>(i),
                                           rows.begin() + static_cast<std::ptrdiff_t>(i + columns)));
    return result;
  };
  // The unknowns of algebraic equations stand behind the states.
  const auto end = point.begin() + static_cast<std::ptrdiff_t>(linear.states.size());
  const std::vector<double> x(point.begin(), end), z(end, point.end());
  nlohmann::json json{{"states", linear.states},
                      {"inputs", linear.inputs},
                      {"outputs", linear.outputs},
                      {"x", x},
                      {"A", matrix(linear.a, linear.states.size())},
                      {"B", matrix(linear.b, linear.inputs.size())},
                      {"C", matrix(linear.c, linear.states.size())},
                      {"D", matrix(linear.d, linear.inputs.size())}};
  for (std::size_t k = 0; k < z.size(); ++k) {
    json["unknowns"].push_back(model.states[x.size() + k].column);
    json["z"].push_back(z[k]);
  }
  for (const studies::MotionMode& mode : modes)
    json["modes"].push_back({{"eigenvalue", {mode.eigenvalue.real(), mode.eigenvalue.imag()}},
                             {"frequency", mode.frequency},
                             {"damping", mode.damping}});
  add_events(json, studied, point);
  return json;
}

ExitCode linearize(const LinearizeOptions& options) {
  const Studied studied = study(options.experiment, options.mode, {}, Equations::algebraic_too);
  if (studied.prepared.exit != done) return studied.prepared.exit;
  const model::Model& model = studied.prepared.program->model;
  std::vector<double> x = studied.start;
  const double time = options.time.value_or(0);
  if (!set_states(model, options.at, x)) return usage;
  if (options.at.empty() && !options.start) {
    if (!options.time && !stands_still_in_time(studied, "equilibria are searched for")) {
      say("--time T fixes the time in the equations; --start and --at NAME=VALUE linearize elsewhere");
      return wrong_model;
    }
    auto search = studies::find_equilibrium(studied.system, x, studied.system.constants, time);
    if (search.ending != studies::EquilibriumEnding::found) {
      say(fmt::format(
          "{}: no equilibrium was found near the start ({}; the residual of `{}` is {}); --start linearizes at "
          "the start, --at NAME=VALUE elsewhere",
          place_text(studied.prepared, model.states[search.worst].span), to_string(search.ending),
          studied.system.name(search.worst), results::short_number(search.residual)));
      return numerical_failure;
    }
    x = std::move(search.x);
  } else if (studied.system.algebraic > 0) {
    auto search = studies::find_unknowns(studied.system, x, studied.system.constants, time);
    if (search.ending != studies::EquilibriumEnding::found) {
      say(fmt::format("the algebraic equations have no solution near this point ({}); --at {}=VALUE is a better guess",
                      to_string(search.ending), studied.system.name(search.worst)));
      return numerical_failure;
    }
    x = std::move(search.x);
  }
  if (const auto jump =
          studies::jump_at(*studied.prepared.program, studied.mode, x, studied.prepared.experiment.parameters)) {
    say(fmt::format("the equations are discontinuous at this point, by `{}`, and cannot be linearized", *jump));
    return numerical_failure;
  }
  const auto linear =
      studies::linearize_model(studied.prepared.program, x, time, studied.prepared.experiment.parameters, studied.mode);
  if (!linear.undetermined.equations.empty()) {
    say(describe_undetermined(studied, linear.undetermined));
    return numerical_failure;
  }
  for (std::size_t i = 0; i < linear.a.size(); ++i) {
    if (std::isfinite(linear.a[i])) continue;
    const std::size_t row = i / linear.states.size(), column = i % linear.states.size();
    say(fmt::format("{}: the equation of `{}` has no derivative by `{}` at this point: that entry of A is not a number",
                    place_text(studied.prepared, model.states[row].span), linear.states[row], linear.states[column]));
    return numerical_failure;
  }
  const auto modes = studies::modes_of(linear.a, linear.states.size());
  if (options.json) {
    answer("continuo.linearize/1", json_of(linear, x, studied, modes));
    return done;
  }
  std::string text = options.at.empty() && !options.start ? "equilibrium:" : "at:";
  for (std::size_t i = 0; i < x.size(); ++i)
    text += fmt::format("{} {} = {}", i == 0 ? "" : ",", model.states[i].column,
                        results::short_number(std::abs(x[i]) < 1e-13 ? 0 : x[i]));
  text += "\n" + events_text(studied, x) + matrix_text("A", linear.a, linear.states, linear.states) +
          matrix_text("B", linear.b, linear.states, linear.inputs) +
          matrix_text("C", linear.c, linear.outputs, linear.states) +
          matrix_text("D", linear.d, linear.outputs, linear.inputs) + modes_text(modes, model);
  print(text);
  return done;
}

}  // namespace

void add_linearize(CLI::App& app, ExitCode& exit) {
  static constexpr std::string_view examples =
      "  continuo linearize models/mass_spring_damper.sim         at its equilibrium: A, B, C, D, frequency and "
      "damping\n"
      "  continuo linearize models/pendulum.sim --at theta=3.14159  at another point\n"
      "  continuo linearize models/lorenz.sim --start --json\n";
  Verb* verb = add_verb(app, listed("linearize"), examples, {wrong_model, numerical_failure});
  verb->json_examples = {"continuo linearize models/mass_spring_damper.sim --json"};
  auto options = std::make_shared<LinearizeOptions>();
  add_model(*verb, options->experiment);
  verb->add_option("--mode", options->mode, "The mode whose equations are used")->type_name("NAME");
  verb->add_option("--at", options->at, "The point, as values of single states; the others have their initial values")
      ->delimiter(',')
      ->type_name("NAME=VALUE");
  verb->add_option("--time", options->time, "The time, if the equations depend on it")
      ->check(finite_number())
      ->type_name("T");
  verb->add_flag("--start", options->start, "At the initial state instead of an equilibrium");
  verb->add_flag("--json", options->json, "Matrices and modes as one JSON object");
  verb->callback([&exit, options] { exit = linearize(*options); });
}

}  // namespace continuo::app
