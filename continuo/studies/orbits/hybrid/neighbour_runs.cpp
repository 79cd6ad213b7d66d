// Compares runs beside an orbit with the derivative of the return.
#include <algorithm>
#include <cmath>
#include <optional>

#include <continuo/studies/orbits/hybrid/neighbour_runs.hpp>
#include <continuo/studies/support/hybrid_run.hpp>

namespace continuo::studies::detail {

namespace {

// Runs at a tolerance of 1e-12 leave an error of 1e-5 at the smallest distance; bending, and the events that a
// neighbour at the largest one does not share, become less with it.
constexpr double distances[] = {1e-5, 1e-6, 1e-7};
constexpr double alike = 1e-3;

class Neighbours {
 public:
  Neighbours(const NeighbourRuns& runs, const model::Plan& plan, const ShootingPoint& orbit)
      : runs_(runs), orbit_(orbit), run_(runs.program, plan, runs.exact) {
    const std::optional<Eigen::VectorXd> end = end_of(Eigen::VectorXd::Zero(size()));
    if (end) end_ = *end;
  }
  bool runs() const { return end_.size() > 0 || size() == 0; }

  /// Whether both neighbours at this distance end where M d says.
  bool agree(const Eigen::VectorXd& direction, const Eigen::VectorXd& image, double distance) {
    const double growth = std::max(1.0, image.norm());
    for (const double part : {distance / growth, -distance / growth}) {
      const std::optional<Eigen::VectorXd> end = end_of(part * direction);
      if (!end || !(((*end - end_) / part - image).norm() <= alike * growth)) return false;
    }
    return true;
  }

 private:
  Eigen::Index size() const { return static_cast<Eigen::Index>(runs_.directions.size()); }
  std::optional<Eigen::VectorXd> end_of(const Eigen::VectorXd& away) {
    model::Instant instant = orbit_.start;
    for (std::size_t k = 0; k < runs_.directions.size(); ++k)
      instant.x[runs_.directions[k]] += away[static_cast<Eigen::Index>(k)] * runs_.sizes[runs_.directions[k]];
    run_.go_on(instant);
    if (!run_.advance_to(orbit_.start.t + orbit_.period)) return std::nullopt;
    const auto differs = [&](std::size_t i) { return run_.x()[i] != orbit_.start.x[i]; };
    if (run_.instant().mode != orbit_.start.mode || std::ranges::any_of(runs_.held, differs)) return std::nullopt;
    Eigen::VectorXd end(size());
    for (std::size_t k = 0; k < runs_.directions.size(); ++k)
      end[static_cast<Eigen::Index>(k)] = run_.x()[runs_.directions[k]] / runs_.sizes[runs_.directions[k]];
    return end;
  }

  const NeighbourRuns& runs_;
  const ShootingPoint& orbit_;
  HybridRun run_;
  Eigen::VectorXd end_;
};

}  // namespace

bool confirms(const NeighbourRuns& runs, const ShootingPoint& orbit, const Eigen::MatrixXd& m) {
  Outcome<double> outcome;
  std::optional<model::Plan> plan = plan_of(*runs.program, runs.exact, outcome);
  if (!plan) return false;
  plan->to = orbit.start.t + orbit.period;
  Neighbours neighbours(runs, *plan, orbit);
  if (!neighbours.runs()) return false;
  // Directions along none of the axes: 1, 1/2, 1/3, ... with two patterns of signs.
  for (const Eigen::Index sign : {2, 3}) {
    Eigen::VectorXd direction(m.rows());
    for (Eigen::Index i = 0; i < m.rows(); ++i)
      direction[i] = (i % sign == 0 ? 1.0 : -1.0) / static_cast<double>(sign == 2 ? i + 1 : m.rows() - i);
    direction.normalize();
    const Eigen::VectorXd image = m * direction;
    const bool any =
        std::ranges::any_of(distances, [&](double distance) { return neighbours.agree(direction, image, distance); });
    if (!any) return false;
  }
  return true;
}

}  // namespace continuo::studies::detail
