// Many steps in one call: the sizes of the steps, their errors and the decision to accept them are in the machine code,
// and the state stays in registers. Internal to c_step.cpp.
//
// The operations are those of LaneSizes and StepControl (ensembles/lanes/, solve/steps/) in the same order, so the bits
// are the same. What they do seldom they do themselves: a step that is rejected, that ends at the limit of its run, or
// that does not change the time, is left to them.
#pragma once
#include <string>

#include <continuo/symbolic/native/step_text.hpp>

namespace continuo::model {

/// The function `take_steps` of LaneSteps, for a method that estimates its errors.
[[nodiscard]] std::string c_many_steps(const StepText& empty);

}  // namespace continuo::model
