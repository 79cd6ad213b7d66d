// What of a model may have fused operations where they are asked for (NativeUse::fused), by a rule that is the same for
// a run alone and for runs together: both then have the same bits.
#pragma once
#include <continuo/language/model.hpp>
#include <continuo/simulation/program/model_program.hpp>
#include <continuo/symbolic/native/c_step.hpp>

namespace continuo::model {

/// A run in lanes whose neighbours are in other modes, or at an event, takes a step that the method computes, and so
/// does a run alone whose equations jump: steps are fused only where all of them are machine code.
[[nodiscard]] inline Fusing fusing_of(const ModelProgram& program) {
  const Model& model = program.model;
  const bool is_plain = model.modes.size() == 1 && model.events.empty() && model.schedule.empty() &&
                        program.step_inputs.empty() && !model.has_world();
  return is_plain ? Fusing::steps : Fusing::equations;
}

}  // namespace continuo::model
