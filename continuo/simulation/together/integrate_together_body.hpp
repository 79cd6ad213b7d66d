// The body of integrate_together_by; included only by the integrate_together_*.cpp.
#pragma once
#include <variant>

#include <continuo/ensembles/ensemble.hpp>
#include <continuo/simulation/together/integrate_together.hpp>
#include <continuo/simulation/together/run_of_model.hpp>

namespace continuo::model {

template <class M>
void integrate_together_by(const TogetherRuns& runs) {
  const auto integrate = [&](const auto* equations) {
    static_cast<void>(ensemble<LaneEquations::Wide::width>(*equations, starts(runs.count, runs.start), runs.interval,
                                                           M{}, runs.options));
  };
  std::visit(integrate, runs.equations);
}

}  // namespace continuo::model
