// The solution of a boundary-value problem as a motion that somebody watches between its rows.
#pragma once
#include <memory>

#include <continuo/boundary/boundary_of_model.hpp>
#include <continuo/simulation/motion_watcher.hpp>

namespace continuo::boundary {

/// As without a watcher, who sees the solution that is asked for: the polynomials between the points of its mesh.
[[nodiscard]] model::Simulated simulate_boundary(const std::shared_ptr<const model::ModelProgram>& program,
                                                 const model::Experiment& experiment, const BoundaryRequest& request,
                                                 model::MotionWatcher& watcher);

}  // namespace continuo::boundary
