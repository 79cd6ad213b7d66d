// The bodies of a world where they are at the end of a run, with the ways of a few: in the plane as they lie, in space
// seen along (-1, 1, -1), the nearer before the farther.
#pragma once
#include <continuo/language/model.hpp>
#include <continuo/results/figure.hpp>
#include <continuo/results/motion_curves.hpp>
#include <continuo/simulation/run.hpp>

namespace continuo::results {

/// Of a model with a world, and a run with a row. The ways go through its rows, or are those of the curves.
[[nodiscard]] Panel bodies_panel(const model::Model& model, const model::Run& run,
                                 const MotionCurves* curves = nullptr);

}  // namespace continuo::results
