// A run along a motion that is known already: rows, outputs, energies and checks as an integration gives them.
#pragma once
#include <functional>
#include <span>
#include <vector>

#include <continuo/simulation/experiment.hpp>
#include <continuo/simulation/program/model_program.hpp>
#include <continuo/simulation/run.hpp>

namespace continuo::model {

/// x(t) from plan.from to plan.to; `steps` are times between, in ascending order, at which rows stand where the plan
/// wants one at every step. The run has no statistics and its outcome is that the end was reached.
[[nodiscard]] Run run_along(const ModelProgram& program, Plan plan, std::span<const double> steps,
                            const std::function<void(double t, std::vector<double>& x)>& at);

}  // namespace continuo::model
