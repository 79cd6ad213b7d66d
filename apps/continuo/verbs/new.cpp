// continuo new NAME: a commented model to start from.
#include <cctype>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

#include <apps/continuo/options/command_line.hpp>
#include <apps/continuo/options/verb_list.hpp>
#include <apps/continuo/terminal/answer.hpp>
#include <apps/continuo/terminal/terminal.hpp>
#include <apps/continuo/verbs.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <continuo/results/output_file.hpp>

namespace continuo::app {
namespace {

constexpr std::string_view starter =
    R"(# A mass on a spring, pulled out and let go. Change it into the system you care about.
#
#   continuo run {0}                        the motion in a few lines
#   continuo run {0} -o out.csv --plot out.svg
#   continuo run {0} --set k=4              another spring
#   continuo check {0}                      are the equations and units in order?
model {1}

# What can be changed: a value, its unit, and the range of its slider.
param k = 2 [N/m] in 0..10, c = 0.1 [N*s/m] in 0..2
param m = 1 [kg]

# The equation as on the blackboard. The primes say that x needs x(0) and x'(0).
x'' = (-k*x - c*x')/m
x(0) = 0.5 [m];  x'(0) = 0 [m/s]

# What happens on the way: here the instants at which the mass turns round.
when x' falls through 0 {{ mark "outermost" }}

# Damping takes energy: the drift in the summary shows how much.
energy kinetic = 1/2*m*x'^2, potential = 1/2*k*x^2

run 0..20 [s] output 0.05
plot x, energy against t

# The model's own referee: `continuo verify {0}`. Damped, the mass never gets out again as far as it began.
check always x <= 0.5 [m]
)";

/// "my_spring-2" -> "MySpring2": a name as models have them.
std::string model_name(std::string_view stem) {
  std::string name;
  bool capital = true;
  for (const char c : stem) {
    if (std::isalnum(static_cast<unsigned char>(c)) == 0) {
      capital = true;
      continue;
    }
    name += capital ? static_cast<char>(std::toupper(static_cast<unsigned char>(c))) : c;
    capital = false;
  }
  const bool starts_well = !name.empty() && std::isalpha(static_cast<unsigned char>(name.front())) != 0;
  return starts_well ? name : "Model" + name;
}

struct NewRequest {
  std::string name;
  bool json = false;
};

ExitCode write_starter(const NewRequest& request) {
  const std::string& name = request.name;
  std::filesystem::path path(name);
  if (path.extension() != ".sim") path += ".sim";
  if (std::filesystem::exists(path)) {
    say(fmt::format("{} already exists, and was not changed", path.string()));
    return usage;
  }
  const std::string text = fmt::format(starter, path.string(), model_name(path.stem().string()));
  if (const Status status = results::write_file(path.string(), text); !status) {
    say(status.message);
    return usage;
  }
  mention(fmt::format("wrote {0}; next: continuo run {0}", path.string()));
  if (request.json) answer("continuo.new/1", {{"file", path.string()}, {"model", model_name(path.stem().string())}});
  return done;
}

}  // namespace

void add_new(CLI::App& app, ExitCode& exit) {
  static constexpr std::string_view examples = "  continuo new spring       writes spring.sim\n";
  Verb* verb = add_verb(app, listed("new"), examples, {});
  verb->json_examples = {"continuo new spring --json"};
  auto request = std::make_shared<NewRequest>();
  verb->add_option("name", request->name, "Name of the file, with or without .sim")->required()->type_name("");
  verb->add_flag("--json", request->json, "The file that was written, as a JSON object");
  verb->callback([&exit, request] { exit = write_starter(*request); });
}

}  // namespace continuo::app
