// Closed orbits as zeros of what the flow over one period leaves: Newton's method from a motion that comes back.
// Internal to hybrid_orbit.
//
// Unknown are the state x where the orbit begins and, without a forcing, the period T:
//
//   flow(x, T) - x = 0,   f(x0) . (x - x0) = 0,
//
// with f = x' at the place x0 from which the search begins. The derivative of the flow by x is M, through all events;
// by T it is f at the end. Every state is measured by its size on the way. Where something is conserved there is an
// orbit for each value of it, the matrix is singular, and the smallest step is taken (by singular values): it leads to
// the orbit that is nearest to where the search began.
#pragma once
#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include <continuo/studies/orbits/hybrid/return_flow.hpp>

namespace continuo::studies::detail {

struct ShootingPoint {
  model::Instant start;
  double period;
};

struct Shot {
  FlowImage image;
  Eigen::VectorXd residual;
  Eigen::MatrixXd matrix;
};

class Shooting {
 public:
  /// `unknowns`: the states that are solved for; `held` must come back as they are. `sizes`: of all states.
  Shooting(const ReturnFlow& flow, std::vector<std::size_t> unknowns, std::vector<std::size_t> held,
           std::vector<double> sizes, bool forced, ShootingPoint from);

  /// Newton's method; singular values below `cut` of the largest count as none. Nothing where it does not converge to
  /// `tolerance`: `status` says why.
  [[nodiscard]] std::optional<ShootingPoint> solve(ShootingPoint point, double cut, double tolerance);
  [[nodiscard]] const Status& status() const { return status_; }
  [[nodiscard]] bool interrupted() const { return interrupted_; }

  /// Nothing where the flow is not defined there or comes to another mode.
  [[nodiscard]] std::optional<Shot> shoot(const ShootingPoint& point);
  [[nodiscard]] ShootingPoint moved(ShootingPoint point, const Eigen::VectorXd& step) const;
  [[nodiscard]] double distance(const ShootingPoint& a, const ShootingPoint& b) const;

 private:
  const ReturnFlow& flow_;
  std::vector<std::size_t> unknowns_, held_;
  std::vector<double> sizes_;
  bool forced_;
  ShootingPoint from_;
  Eigen::VectorXd phase_;
  Status status_;
  bool interrupted_ = false;
};

}  // namespace continuo::studies::detail
