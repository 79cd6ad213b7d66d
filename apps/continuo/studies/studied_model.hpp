// What the verbs that study a model's equations share: the model as a parametric system, states by name.
#pragma once
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <apps/continuo/options/experiment_options.hpp>
#include <nlohmann/json_fwd.hpp>

#include <continuo/studies/conservation_laws.hpp>
#include <continuo/studies/equilibrium.hpp>
#include <continuo/system/parametric_system.hpp>

namespace continuo::app {

/// What a study can do with: x' = f alone, or also 0 = g.
enum class Equations { differential, algebraic_too };

/// A model whose equations can be studied: not a boundary-value problem, algebraic equations only where the study takes
/// them. Says why not.
struct Studied {
  Prepared prepared;
  std::size_t mode = 0;
  ParametricSystem system{};
  std::vector<double> start{};                   // the initial state
  std::vector<studies::ConservationLaw> laws{};  // that the system holds (hold_conserved)
};
/// `constants`: parameters that the study moves. exit in `prepared` where the verb ends here.
Studied study(const ExperimentOptions& options, const std::string& mode, const std::vector<std::string>& constants = {},
              Equations equations = Equations::differential);

/// Holds what the equations conserve at its value at the start: of equilibria and orbits, which else fill whole
/// families, those that a motion from there may come to.
void hold_conserved(Studied& studied);
/// The same for the model with other constants that move.
ParametricSystem holding_laws(const Studied& studied, const ParametricSystem& system);
/// A line for each law that is held: "conserved: a + c = 1".
std::string conserved_text(const Studied& studied, std::string_view head = "conserved: ");
/// The same as a member "conserved"; "events_may_change_conserved" is true where there are events, as nobody looks at
/// what they do to it.
void add_conserved(nlohmann::json& object, const Studied& studied);

/// Whether neither the equations of the studied mode depend on the time nor anything happens at set times; says what
/// does, and where, if not. `what` is the study's: "an orbit is solved for".
bool stands_still_in_time(const Studied& studied, std::string_view what);
/// Whether beside that no event of the model changes the motion and no equation jumps. Who has named a mode means its
/// equations alone.
bool can_be_studied_alone(const Studied& studied, const std::string& mode, std::string_view what);

/// What the events of the model have to do with a point of the studied mode, a line for each, and which mode that is
/// where there are several. Empty where there is nothing to say.
std::string events_text(const Studied& studied, const std::vector<double>& x);
/// The same as members "mode" and "events" of an object.
void add_events(nlohmann::json& object, const Studied& studied, const std::vector<double>& x);

/// Which equations, by their text and line, and which unknowns.
std::string describe_undetermined(const Studied& studied, const studies::Undetermined& open);

/// How long the model's own run is, which says on which scale of time it moves; 100 where it says nothing.
double run_length(const model::Model& model);

/// `x=1`, `x'=-2` in the states' units: sets them in `state`. Says what is wrong with them.
bool set_states(const model::Model& model, const std::vector<std::string>& texts, std::vector<double>& state);

/// `NAME=LOW..HIGH`.
struct NamedRange {
  std::string name;
  double low, high;
};
std::optional<NamedRange> parse_range(const std::string& text);

/// Which state has this name; says so where none has.
std::optional<std::size_t> state_named(const model::Model& model, const std::string& name);

/// Where to look for equilibria: what the run passes through, twice as wide; the ranges that were asked for.
bool set_box(const Studied& studied, const std::vector<std::string>& ranges, studies::EquilibriumBox& box);

/// "-0.5 +- 2.1 i"
std::string eigenvalue_text(double real, double imaginary);

}  // namespace continuo::app
