// continuo new NAME: a commented model to start from.
#include <algorithm>
#include <array>
#include <cctype>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include <apps/continuo/options/command_line.hpp>
#include <apps/continuo/options/verb_list.hpp>
#include <apps/continuo/terminal/answer.hpp>
#include <apps/continuo/terminal/terminal.hpp>
#include <apps/continuo/verbs.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include <continuo/results/output_file.hpp>
#include <continuo/symbolic/names/suggest.hpp>

namespace continuo::app {
namespace {

/// What a new file begins as; {0} is its name, {1} that of the model.
struct Template {
  std::string_view name, words, text;
};

constexpr std::string_view spring =
    R"(# A mass on a spring, pulled out and let go. Change it into the system you care about.
#
#   continuo view {0}                       live in the browser: drag the mass, move the sliders
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

# The picture of the live view; `drag` lets the mouse take hold of the mass.
draw {{ floor -0.1; spring (-1, 0) to (x, 0); box (x, 0) size (0.2, 0.2) drag }}

# The model's own referee: `continuo verify {0}`. Damped, the mass never gets out again as far as it began.
check always x <= 0.5 [m]
)";

constexpr std::string_view ball =
    R"(# A ball falls, bounces and comes to rest. Change it into the system you care about.
#
#   continuo view {0}                       live in the browser: throw the ball
#   continuo run {0} --set e=1              without a loss
model {1}
param g = 9.81 [m/s^2] in 0..25, e = 0.8 in 0..1, r = 0.1 [m]

# A mode has equations of its own; `go` changes the mode.
mode flight {{ y'' = -g }}
mode rest   {{ y'' = 0 [m/s^2] }}
y(0) = 2 [m];  y'(0) = 0 [m/s]

# An impact is where the lowest point falls through the floor. A ball that hardly leaves it comes to rest.
when y - r falls through 0 in flight {{
  y := r
  if -e*y' > 0.01 [m/s] {{ y' := -e*y' }}
  else {{ y' := 0; go rest }}
}}

energy kinetic = 1/2*y'^2, potential = g*y
run 0..10 [s] output 0.02
plot y, energy against t
draw {{ floor 0; ball (0, y) radius r drag }}

# From rest the ball falls sqrt(2*1.9/g) until it touches the floor.
check time of event 1 = sqrt(2*1.9/9.81) [s] within 1e-9
check always y > r - 1e-9 [m]
)";

constexpr std::string_view pendulum =
    R"(# A pendulum in the plane. Change it into the system you care about.
#
#   continuo view {0}                       live in the browser: drag the bob
#   continuo run {0} --set theta0=3         almost upside down
model {1}
param g = 9.81 [m/s^2] in 0..25, l = 1 [m] in 0.1..5, theta0 = 1 in -3.1..3.1

theta'' = -g/l*sin(theta)
theta(0) = theta0;  theta'(0) = 0 [1/s]

energy kinetic = 1/2*l^2*theta'^2, potential = g*l*(1 - cos(theta))
run 0..20 [s] output 0.02
plot theta, theta' against t
plot theta' against theta

# Where the bob is, for the drawing.
let x = l*sin(theta), y = -l*cos(theta)
draw {{ rod (0, 0) to (x, y); ball (x, y) radius 0.08 drag; trail (x, y) length 1 }}

# Without friction it never gets higher than it began.
check always theta < 1.0001
check energy drift < 1e-4
)";

constexpr std::string_view world =
    R"(# Bodies that collide: three balls between walls, two of them on a spring. Change it into the system you care about.
#
#   continuo view {0}                       live in the browser: throw the balls, draw others
#   continuo run {0} --plot out.svg
model {1}
param g = 9.81 [m/s^2] in 0..25, r = 0.3 [m]

world {{
  gravity (0, -g)
  material restitution 0.8 friction 0.2
  wall floor (0, 1) at 0
  wall left (1, 0) at -4
  wall right (-1, 0) at -4
  body ball at (-2, 3) [m] velocity (2, 0) [m/s] radius r mass 1 [kg]
  body first at (0.5, 1) radius r mass 1 [kg]
  body second at (2, 1) radius r mass 1 [kg]
  spring first to second stiffness 40 [N/m] damping 0.5 [N*s/m]
}}

run 0..20 [s] output 0.05
plot ball.y, first.y, second.y against t

# A world draws its bodies and walls by itself; what else there is to see is said here.
draw {{ spring (first.x, first.y) to (second.x, second.y) width 0.2; trail (ball.x, ball.y) length 1 }}

# Nothing falls through the floor.
check always ball.y > r - 1e-6 [m]
)";

constexpr std::array templates{
    Template{"spring", "a mass on a spring", spring},
    Template{"ball", "a ball that bounces: events and modes", ball},
    Template{"pendulum", "a pendulum in the plane", pendulum},
    Template{"world", "bodies that collide", world},
};

std::vector<std::string> template_names() {
  std::vector<std::string> names;
  for (const Template& each : templates) names.emplace_back(each.name);
  return names;
}

std::string template_fault(const std::string& name) {
  if (std::ranges::find(templates, name, &Template::name) != templates.end()) return "";
  const std::vector<std::string> names = template_names();
  const std::string near = model::did_you_mean(name, names);
  return fmt::format("there is no template {}{}{}; the templates are {}", name, near.empty() ? "" : "; ", near,
                     fmt::join(names, ", "));
}

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

struct NewModel {
  std::string name, based_on = "spring";
  bool json = false;
};

ExitCode write_starter(const NewModel& wanted) {
  if (wanted.name == "-") {
    say("new takes the name of the model's file, and does not write to standard output");
    return usage;
  }
  std::filesystem::path path(wanted.name);
  if (path.extension() != ".sim") path += ".sim";
  if (std::filesystem::exists(path)) {
    say(fmt::format("{} already exists, and was not changed", path.string()));
    return usage;
  }
  const Template& chosen = *std::ranges::find(templates, wanted.based_on, &Template::name);
  const std::string text = fmt::format(fmt::runtime(chosen.text), path.string(), model_name(path.stem().string()));
  if (const Status status = results::write_file(path.string(), text); !status) {
    say(status.message);
    return usage;
  }
  mention(fmt::format("wrote {0}; next: continuo view {0}", path.string()));
  if (wanted.json) answer("continuo.new/1", {{"file", path.string()}, {"model", model_name(path.stem().string())}});
  return done;
}

}  // namespace

void add_new(CLI::App& app, ExitCode& exit) {
  static constexpr std::string_view examples =
      "  continuo new spring                         writes spring.sim\n"
      "  continuo new table --template world         bodies that collide\n";
  Verb* verb = add_verb(app, listed("new"), examples, {});
  verb->json_examples = {"continuo new spring --json"};
  auto wanted = std::make_shared<NewModel>();
  verb->add_option("name", wanted->name, "Name of the file, with or without .sim")->required()->type_name("");
  std::string words = "What it begins as:";
  for (const Template& each : templates)
    words += fmt::format("{} {} ({})", each.name == templates.front().name ? "" : ",", each.name, each.words);
  verb->add_option("--template", wanted->based_on, words)->type_name("NAME")->check(CLI::Validator(template_fault, ""));
  verb->add_flag("--json", wanted->json, "The file that was written, as a JSON object");
  verb->callback([&exit, wanted] { exit = write_starter(*wanted); });
}

}  // namespace continuo::app
