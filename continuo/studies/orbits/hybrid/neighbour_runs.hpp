// Whether neighbours that are run on both sides of an orbit go where its derivative says. Where an event is only
// touched (grazing), or two happen at once that neighbours pass in another order (a corner), they do not, and there is
// no derivative, whatever was computed. Internal to hybrid_orbit.
#pragma once
#include <Eigen/Core>
#include <cstddef>
#include <memory>
#include <vector>

#include <continuo/simulation/experiment.hpp>
#include <continuo/studies/orbits/hybrid/shooting.hpp>

namespace continuo::studies::detail {

struct NeighbourRuns {
  std::shared_ptr<const model::ModelProgram> program;
  model::Experiment exact;
  std::vector<std::size_t> directions;
  std::vector<std::size_t> held;
  std::vector<double> sizes;  // of all states
};

/// `m`: of the directions, in sizes.
[[nodiscard]] bool confirms(const NeighbourRuns& runs, const ShootingPoint& orbit, const Eigen::MatrixXd& m);

}  // namespace continuo::studies::detail
