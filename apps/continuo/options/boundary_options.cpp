// Adds and reads the options for boundary-value problems: solution, guess, --along, --family.
#include <string_view>
#include <utility>
#include <vector>

#include <apps/continuo/options/boundary_options.hpp>
#include <apps/continuo/options/command_line.hpp>
#include <apps/continuo/options/file_options.hpp>
#include <apps/continuo/options/models.hpp>
#include <apps/continuo/terminal/terminal.hpp>
#include <fmt/format.h>

#include <continuo/runs/kind.hpp>
#include <continuo/simulation/simulate.hpp>

namespace continuo::app {
namespace {

/// `eps=1..1e-3`, each end with a unit where the parameter has one.
std::optional<boundary::BoundaryRequest::Along> read_along(const std::string& option, const std::string& text,
                                                           const model::Model& model) {
  const std::size_t equals = text.find('='), dots = text.find("..");
  if (equals == std::string::npos || dots == std::string::npos || dots < equals) {
    say(fmt::format("{0} {1}: a parameter and two values are wanted, {0} eps=1..1e-3", option, text));
    return std::nullopt;
  }
  const std::string name = text.substr(0, equals);
  const auto value = [&](const std::string& number) {
    std::vector<model::Diagnostic> problems;
    const std::string setting = name + "=" + number;
    auto read = model::parse_setting(model, setting, problems);
    show(problems, model::Source(option, setting));
    return read;
  };
  const auto from = value(text.substr(equals + 1, dots - equals - 1));
  if (!from) return std::nullopt;
  const auto to = value(text.substr(dots + 2));
  if (!to) return std::nullopt;
  const std::size_t i = model::find_parameter(model, from->name);
  if (i != model::npos && model.parameters[i].structural) {
    say(fmt::format("{} {}: `{}` determines the number of states, so no solution can be followed along it", option,
                    text, name));
    return std::nullopt;
  }
  return boundary::BoundaryRequest::Along{from->name, from->value, to->value};
}

}  // namespace

void add_boundary(CLI::App& verb, BoundaryOptions& options) {
  verb.add_option("--solution", options.solution,
                  "Boundary-value problems with several solutions: the number of the one to show")
      ->type_name("N")
      ->check(count_from(1));
  verb.add_option("--along", options.along,
                  "Boundary-value problems: continuation from a parameter value for which the problem is easy: --along "
                  "eps=1..1e-4")
      ->type_name("NAME=A..B");
  reads_file(verb, verb.add_option("--guess", options.guess,
                                   "Boundary-value problems: initial guess, the CSV file of an earlier run (-o)"));
  auto* family = verb.add_option("--family", options.family,
                                 "Boundary-value problems: follows all solutions along a parameter, around folds and "
                                 "into crossing families; -o, --plot and --json then show these")
                     ->type_name("NAME=LOW..HIGH");
  verb.add_option("--of", options.of, "The state to plot over the parameter of --family")
      ->type_name("STATE")
      ->needs(family);
}

std::optional<boundary::BoundaryRequest> read_boundary(const BoundaryOptions& options, const Prepared& prepared) {
  boundary::BoundaryRequest request{.solution = options.solution};
  const model::Model& model = prepared.program->model;
  if (options.as_written() && options.guess.empty() && options.family.empty()) return request;
  if (runs::kind_of(model).has_start) {
    say(fmt::format("{} is for boundary-value problems; this model is an initial-value problem",
                    !options.along.empty()    ? "--along"
                    : !options.family.empty() ? "--family"
                    : !options.guess.empty()  ? "--guess"
                                              : "--solution"));
    return std::nullopt;
  }
  if (!options.along.empty()) {
    request.along = read_along("--along", options.along, model);
    if (!request.along) return std::nullopt;
  }
  if (!options.guess.empty()) {
    if (!readable(options.guess)) return std::nullopt;
    auto read = measurements_in(options.guess);
    if (!read) return std::nullopt;
    request.guess = {.name = std::move(read->file),
                     .columns = std::move(read->columns),
                     .times = std::move(read->times),
                     .values = std::move(read->values)};
  }
  return request;
}

std::optional<boundary::BoundaryRequest::Along> read_family(const BoundaryOptions& options, const Prepared& prepared) {
  if (!options.along.empty() || options.solution != 1) {
    say("--family follows all solutions: leave out --along and --solution");
    return std::nullopt;
  }
  return read_along("--family", options.family, prepared.program->model);
}

}  // namespace continuo::app
