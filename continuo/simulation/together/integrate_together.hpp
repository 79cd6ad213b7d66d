// Runs of a model in the lanes of registers, by an explicit Runge-Kutta method or rodas5p. Internal to ManyRuns.
#pragma once
#include <cstddef>
#include <functional>
#include <span>
#include <string_view>
#include <variant>
#include <vector>

#include <continuo/ensembles/ensemble_options.hpp>
#include <continuo/ensembles/run_start.hpp>
#include <continuo/simulation/together/lane_equations.hpp>
#include <continuo/simulation/together/mode_equations.hpp>
#include <continuo/symbolic/native/c_step.hpp>

namespace continuo::model {

/// What the runs have in common, and where each begins.
struct TogetherRuns {
  using X = std::vector<double>;

  using Equations = std::variant<const LaneEquations*, const ModeEquations*>;  // without and with events

  Equations equations;
  Interval<double> interval;
  EnsembleOptions<X, X> options;
  std::size_t count;
  std::function<RunStart<X, X>(std::size_t run)> start;
};

/// What decides about lanes besides the method.
struct RunTraits {
  bool has_fixed_steps;
  std::size_t states;
};
/// Whether there are lanes for this method. Of a pair they are those of its explicit method, and only where the error
/// decides about the steps; runs that it would continue by its stiff one end as `cannot_continue`. Those of a stiff
/// method have matrices that one run decomposes as dense ones.
[[nodiscard]] bool has_lanes(std::string_view method, const RunTraits& runs);
/// Whether the method asks for df/dx.
[[nodiscard]] bool asks_for_derivatives(std::string_view method);

/// The numbers of a method that has lanes.
[[nodiscard]] CStepFormula step_formula(std::string_view method);

/// Makes the runs on this thread; options.finished gets the results.
void integrate_together(std::string_view method, const TogetherRuns& runs);

/// For the method M; each is instantiated in one of the integrate_together_*.cpp.
template <class M>
void integrate_together_by(const TogetherRuns& runs);

}  // namespace continuo::model
