// All verbs of the command, and which of its two programs has each.
#pragma once
#include <algorithm>
#include <array>
#include <string_view>

namespace continuo::app {

/// The command is divided as git is: most verbs are in the program `continuo`, and those that need the module studies
/// in a second one, `continuo-studies`, which the first one becomes when it is asked for them
/// (terminal/studies_program.hpp). So the first takes half the time to build.
enum class Program { command, studies };

struct ListedVerb {
  std::string_view name, purpose;
  Program program = Program::command;
};

/// In the order of `continuo --help`.
inline constexpr std::array all_verbs{
    ListedVerb{"run", "Runs a model and shows, plots or writes its motion"},
    ListedVerb{"replay", "Shows, plots or writes a recorded run, without simulating"},
    ListedVerb{"resume", "Continues a recorded run, with bitwise the same results as without interruption"},
    ListedVerb{"view", "Shows a model live in the browser"},
    ListedVerb{"check", "Checks text, names and units of models, and their derivatives"},
    ListedVerb{"info", "Shows the equations, states, parameters, events and experiment of a model"},
    ListedVerb{"verify", "Runs models and tests all of their checks"},
    ListedVerb{"compare", "Compares errors and cost of several methods and steps on a model", Program::studies},
    ListedVerb{"converge", "Measures the order of methods, and the limit set by rounding", Program::studies},
    ListedVerb{"stability", "Computes regions of stability and the largest stable step", Program::studies},
    ListedVerb{"steady", "Finds the equilibria of a model and their stability", Program::studies},
    ListedVerb{"linearize", "Linearizes a model at a point, and prints its modes", Program::studies},
    ListedVerb{"phase", "Draws the phase plane of a model with two states", Program::studies},
    ListedVerb{"orbit", "Finds periodic orbits, Poincare sections, or Lyapunov exponents", Program::studies},
    ListedVerb{"report", "Writes a page with a model, its run and studies of it"},
    ListedVerb{"explore", "Gives an overview of a model: run, equilibria, orbits, parameters", Program::studies},
    ListedVerb{"sense", "Computes sensitivities: derivatives of a motion by parameters and initial values",
               Program::studies},
    ListedVerb{"sweep", "Runs a model many times with varied parameters, and computes statistics", Program::studies},
    ListedVerb{"fit", "Finds parameters and initial values from measurements", Program::studies},
    ListedVerb{"methods", "Lists the integration methods"},
    ListedVerb{"explain", "Explains the code of a message"},
    ListedVerb{"export", "Writes the equations of a model as C functions"},
    ListedVerb{"new", "Writes a commented model to start from"},
    ListedVerb{"help", "Shows the options of a verb"},
};

/// The verb of this name; a name that is not listed is refused by the compiler.
consteval const ListedVerb& listed(std::string_view name) {
  return *std::ranges::find(all_verbs, name, &ListedVerb::name);
}

/// The program that parses this command line: that of the first word that names a verb, which is also the verb that
/// CLI11 takes. `help` and `run` are in both programs: the help of a study, families of solutions and runs of a
/// sweep are for the second.
Program program_for(int argc, char** argv);

}  // namespace continuo::app
