// Steps that a system takes itself, many at once and with the choice of their sizes: one which has its equations as
// machine code spares the way through memory between two steps.
//
//   static constexpr std::size_t motions_at_once = 2;
//   template <class M>
//   bool can_take_steps();
//   template <class M, class Motion>
//   static void take_steps(std::array<Motion, motions_at_once>& motions, const StepSizeRules<Wide>& rules);
#pragma once
#include <cstddef>

#include <continuo/methods/method.hpp>
#include <continuo/solve/steps/controller.hpp>

namespace continuo::detail {

/// The runs in the lanes of a driver. The system does what LaneSizes and M::step do, to the same bits, as long as all
/// active lanes accept their steps and none comes to its limit, or stands still. Then `waits` is set and the next step
/// has been made, but not judged: x_new, the square of its error and f at its start are there, and f at its end where
/// the method computes it. Without `waits` it has accepted all steps that it has made.
template <class F, class Sizes, class WideX, class WideP>
struct MotionBySystem {
  F* system;
  typename Sizes::Numbers sizes;
  const WideP* p;
  WideX *x, *x_new;
  WideX *first_stage, *last_stage;
  typename Sizes::Wide* square;
  bool evaluates_start;
  bool waits = false;
};

/// What is the same for all motions.
template <class Wide>
struct StepSizeRules {
  const Tolerance<Wide>& tolerance;
  const Controller& controller;
  int error_order;
  double forward;
  std::size_t most;  // steps that are accepted
};

/// Whether drivers of the system take their steps together, so many at once.
template <class F>
concept TakesStepsTogether = requires { F::motions_at_once; };

}  // namespace continuo::detail
