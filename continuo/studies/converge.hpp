// Does a method converge, how fast, and how far? Its error against the step, from a handful of steps down to where
// rounding takes over.
//
//   const auto decay = convergence_problem(1, [](auto, auto x, auto dxdt) { dxdt[0] = -x[0]; }, {1}, {0, 1});
//   const Convergence study = require(converge(decay, {.methods = {"explicit_euler", "rk4"}}));
//   study.methods[1].global.order;  // 4.00
//
// Two errors stand side by side. The local one is that of a single step from a point of the true solution: it goes to
// zero with h^(p+1) where the method is consistent of order p. The global one is that of the whole run: with h^p, where
// the method is stable as well.
#pragma once
#include <atomic>
#include <cstddef>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <continuo/simulation/experiment.hpp>
#include <continuo/simulation/program/model_program.hpp>
#include <continuo/solve/outcome.hpp>
#include <continuo/status/result.hpp>
#include <continuo/studies/accuracy/kinks.hpp>
#include <continuo/studies/accuracy/observed_order.hpp>
#include <continuo/studies/support/named_solve.hpp>

namespace continuo::studies {

/// x' = f(t, x) in double, where it is there in float, and with something to compare with.
struct ConvergenceProblem {
  using LongValues = std::vector<long double>;
  NamedSystem<double> system{};
  NamedSystem<float> in_float{};              // no size: there is none
  NamedSystem<long double> in_long_double{};  // also for the reference, where there is no exact solution
  std::vector<double> x0{};
  Interval<double> interval{0, 1};
  std::function<LongValues(long double t)> exact{};                     // closed form; else a strict run
  std::function<double(double t, std::span<const double> x)> energy{};  // what the method should get right as well
};

/// f called as f(t, x, dxdt) with spans of any number.
template <class F>
[[nodiscard]] ConvergenceProblem convergence_problem(std::size_t size, F f, std::vector<double> x0,
                                                     Interval<double> interval) {
  return {.system = named_system<double>(size, f),
          .in_float = named_system<float>(size, f),
          .in_long_double = named_system<long double>(size, f),
          .x0 = std::move(x0),
          .interval = interval};
}
/// The same where the second half of the state are the velocities of the first, and f reads none of them but for that.
template <class F>
[[nodiscard]] ConvergenceProblem motion_problem(std::size_t size, F f, std::vector<double> x0,
                                                Interval<double> interval) {
  return {.system = named_motion<double>(size, f),
          .in_float = named_motion<float>(size, f),
          .in_long_double = named_motion<long double>(size, f),
          .x0 = std::move(x0),
          .interval = interval};
}
/// A model of one mode without events, schedule, algebraic equations or inputs from tables; nothing where it is
/// another.
[[nodiscard]] std::optional<ConvergenceProblem> convergence_problem(
    const std::shared_ptr<const model::ModelProgram>& program, const model::Overrides& parameters,
    Interval<double> interval);

/// Which methods are studied, and with which steps or tolerances.
struct ConvergeRequest {
  std::vector<std::string> methods{};
  std::size_t most_steps = 65536;                 // of the shortest step; the longest makes eight of the interval
  std::vector<double> tolerances{};               // then error against tolerance, by the methods' own step control
  bool in_float = false, in_long_double = false;  // again with numbers of 24 and of 64 bits
  const std::atomic<bool>* interrupt = nullptr;
  std::function<void(double part)> progress{};  // from 0 to 1
};

/// One step size (or tolerance), and the errors with it, relative to the largest value of each state, the worst
/// state's; not_measured where there is none.
constexpr double not_measured = std::numeric_limits<double>::quiet_NaN();
/// The errors of a method with one step size or tolerance.
struct StepErrors {
  double step, global, local, energy, in_float, in_long_double;  // the last two: global
  std::size_t evaluations = 0;
  double seconds = 0;
};

/// Where the error C h^p of a method and that of rounding should balance. Each of the T/h steps rounds the state by up
/// to epsilon/2: together by epsilon/2 T/h at worst, and by epsilon/2 sqrt(T/h / 3) where they are as often up as down.
struct FloorPrediction {
  Balance at_random, at_worst;
};

/// The convergence of one method.
struct MethodConvergence {
  std::string method;
  int nominal = 0;  // the order it claims for steps of a fixed size; 0 by tolerance, which has none
  std::vector<StepErrors> points{};
  ErrorCurve global{}, local{}, energy{}, in_float{}, in_long_double{};
  std::optional<FloorPrediction> floor{}, floor_in_float{};
  Status status{};  // a failure where the method cannot be studied
};

/// What takes a method's order from it: steps across a place where the equations jump or bend, or that end at an event.
struct SpoiledOrder {
  std::vector<Kink> kinks{};
  std::size_t events = 0;  // of a strict run
  double first_event = 0;
};

/// The convergence of several methods on one problem.
struct Convergence {
  std::vector<MethodConvergence> methods{};
  std::optional<SpoiledOrder> spoiled{};  // of a model, where some method keeps less than its order
  bool by_tolerance = false, interrupted = false;
  std::string reference{};  // what was compared with
};

/// A failure where there is no reference run.
[[nodiscard]] Result<Convergence> converge(const ConvergenceProblem& problem, const ConvergeRequest& request);

/// The same for any model. With events, modes, tables or algebraic equations: global and energy errors only, in rows at
/// output times, against a strict run in double; of a world of bodies against its exact motion, or where
/// only the fast one moves it, against that in steps of a sixteenth.
[[nodiscard]] Result<Convergence> converge(const std::shared_ptr<const model::ModelProgram>& program,
                                           const model::Experiment& experiment, const ConvergeRequest& request);

}  // namespace continuo::studies
