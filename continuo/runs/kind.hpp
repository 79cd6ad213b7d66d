// What a model needs to be run, and what follows from that for whoever asks something of its runs. Above the modules
// that run models this is the one place that tells equations, conditions at several times and bodies apart.
//
//   const runs::Kind kind = runs::kind_of(model);
//   if (!kind.has_start) return refuse("nothing moves before all is known");
//   fmt::print("{} {}\n", runs::cost_of(model, run), kind.cost);
#pragma once
#include <optional>
#include <string_view>

#include <continuo/language/model.hpp>
#include <continuo/language/text/diagnostic.hpp>
#include <continuo/simulation/run.hpp>

namespace continuo::runs {

/// Who finds the motion: integration of equations from their start, collocation under conditions at several times, or
/// the world that moves its bodies and the equations beside them.
enum class Solver { integration, collocation, world };

/// Its name for programs that read it: "integration", "collocation", "world".
[[nodiscard]] std::string_view name_of(Solver solver);

/// The properties of a model's runs.
struct Kind {
  Solver solver = Solver::integration;
  bool has_start = true;                  // the motion follows from its start; false: all of it is found at once
  bool has_exact_derivatives = true;      // by parameters and initial values; false: differences of whole runs
  bool has_absolute_tolerances = true;    // false: one relative tolerance for all
  bool has_rows_at_any_time = true;       // false: moved in steps, at the first end of one that is not before it
  bool can_be_recorded = false;           // runs/recording.hpp
  std::string_view cost = "evaluations";  // what is counted of a run
};

/// The kind of a model, from its statements alone.
[[nodiscard]] Kind kind_of(const model::Model& model);

/// How many evaluations, or whatever Kind::cost names, the run has taken.
[[nodiscard]] double cost_of(const model::Model& model, const model::Run& run);

/// E323 where a study of its equations would not see all that moves the model; nothing where it can be studied so.
[[nodiscard]] std::optional<model::Diagnostic> no_study_of_equations(const model::Model& model);

}  // namespace continuo::runs
