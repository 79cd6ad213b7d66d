// The body of integrate_together_by; included only by the integrate_together_*.cpp.
#pragma once
#include <continuo/ensembles/ensemble.hpp>
#include <continuo/simulation/together/integrate_together.hpp>

namespace continuo::model {

template <class M>
void integrate_together_by(const TogetherRuns& runs) {
  static_cast<void>(ensemble<LaneEquations::Wide::width>(runs.equations, starts(runs.count, runs.start), runs.interval,
                                                         M{}, runs.options));
}

}  // namespace continuo::model
