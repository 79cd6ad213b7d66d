// Whole steps of an explicit Runge-Kutta method for several runs at once, written as C with the equations inside: the
// compiler knows how many states there are, and which registers this processor has.
//
//   const std::string text = c_lane_evaluation(tape, formula);   // a function `evaluate`: a NativeLaneEvaluation
//
// The operations are those of ExplicitRungeKutta (methods/explicit_rk/) in the same order, so the bits are the same.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include <continuo/symbolic/tape/tape.hpp>

namespace continuo::model {

/// The numbers of a method.
struct CStepFormula {
  std::vector<double> c{};               // where in the step each stage is
  std::vector<std::vector<double>> a{};  // of each stage, the weights of those before it
  std::vector<double> b{};               // the weights of the stages in the end; empty: no step is wanted
  std::vector<double> error{};           // their weights in the estimated error; empty where there is none
  std::vector<double> second_error{};    // of the second estimate that Dop853 has; else empty
  bool ends_with_f = false;              // the last stage is f at the end of the step
};

/// What is computed by fused operations: a product and a sum are rounded once, and the bits are others.
enum class Fusing : std::uint8_t {
  none,
  equations,
  steps,  // the equations, and the sums of stages and errors
};

/// What a step of eight runs, or of one, begins with and where it writes: of each quantity the numbers of all runs, one
/// after the other. The text of the C function has the same struct.
struct LaneStep {
  const double *t, *x, *h;
  long long evaluates_start;       // 0: stages[0] has f at the start already
  long long keeps_stages;          // 0: only the first stage is written, and the last one where it is f at the end
  double* const* stages;           // f at each stage
  double* x_new;                   // the state at its end
  double* square;                  // of the error in units of the tolerance, as M::error_square; null: not wanted
  const double *rtol, *atol;       // of a component, or of each
  long long rtol_each, atol_each;  // 0: one for all, 1: one for each component
};

/// Eight runs on their way, or one, each with a size of step of its own: what LaneSizes and StepControl have.
struct LaneMotion {
  double* registers;
  double *t, *next, *carried, *steps;   // next: the size of the next step; carried: what t lacks
  double* x;                            // the state at t
  float *last, *before_last, *rejects;  // logarithms of the last two errors, and how many steps were rejected
  const double *limit, *longest;        // of the run, and of a step
  const double* until;                  // a step that does not end before is not accepted
  const double* active;                 // 0 where there is no run
  double *x_new, *square;               // of a step that waits: its end, and its error as in LaneStep
  double *first_stage, *last_stage;     // f at its start, and where the method computes it, at its end
  long long evaluates_start;            // 0: first_stage has f at the start already
  long long waits;                      // a step was made that is to be judged
};

/// Steps of several motions, and how their sizes are chosen: the numbers of a Controller, see ErrorHistoryOf.
struct LaneSteps {
  LaneMotion* motions;
  long long count, most;           // most: steps that are accepted at once
  const double *rtol, *atol;       // as in LaneStep
  long long rtol_each, atol_each;  // as in LaneStep
  double forward;                  // the sign of all steps
  float beta2, beta3, minus_order, order_beta1, safety, least_factor, greatest_factor;
};

/// f at `states` where `step` and `steps` are null, otherwise the step, or steps: each motion goes on as long as all
/// its runs accept their steps and none has come to its limit. Then it waits, with a step that somebody else judges; or
/// it does not, and has accepted all, as another motion waits. One run alone never waits. Registers, states and outputs
/// are those of TapeLanes. Returns 0 for `steps` where there is only one step at a time, and else 1.
using NativeLaneEvaluation = long long (*)(double* registers, const double* states, double* outputs,
                                           const LaneStep* step, const LaneSteps* steps);

/// The text of the function `evaluate`, but for what every text for a C compiler of ours begins with.
[[nodiscard]] std::string c_lane_evaluation(const Tape& tape, const CStepFormula& formula,
                                            Fusing fusing = Fusing::none);
/// The same for one run, whose registers are those of the tape.
[[nodiscard]] std::string c_step(const Tape& tape, const CStepFormula& formula, Fusing fusing = Fusing::none);

/// Whether one run gains by it: a state that stays near to the processor from stage to stage.
[[nodiscard]] bool is_worth_a_step(const Tape& tape, const CStepFormula& formula);

}  // namespace continuo::model
