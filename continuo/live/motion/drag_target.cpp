// continuo/live/motion/drag_target.cpp
// Chooses the states that move a point, and moves them towards the hand.
#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include <continuo/live/motion/drag_target.hpp>
#include <continuo/symbolic/graph/derivative.hpp>

namespace continuo::live {

std::vector<std::size_t> DragTarget::held() const {
  std::vector<std::size_t> all = positions;
  all.insert(all.end(), velocities.begin(), velocities.end());
  std::ranges::sort(all);
  return all;
}

DragTarget make_drag_target(model::Model& model, std::span<const model::NodeId> point) {
  DragTarget drag_target;
  drag_target.dimension = point.size();
  const std::uint32_t first = model.layout.states;
  const auto is_velocity = [&](std::size_t i) {
    return std::ranges::any_of(model.pairs, [i](const PositionVelocity& pair) { return pair.velocity == i; });
  };
  std::vector<std::size_t> moved;
  for (const std::uint32_t variable : variables_of(model.graph, point)) {
    if (variable < first || variable >= first + model.states.size()) continue;
    const std::size_t i = variable - first;
    if (!model.states[i].algebraic) moved.push_back(i);
  }
  std::ranges::copy_if(moved, std::back_inserter(drag_target.positions),
                       [&](std::size_t i) { return !is_velocity(i); });
  if (drag_target.positions.empty()) drag_target.positions = moved;
  for (const PositionVelocity& pair : model.pairs) {
    if (std::ranges::find(drag_target.positions, pair.position) != drag_target.positions.end())
      drag_target.velocities.push_back(pair.velocity);
  }
  drag_target.nodes.assign(point.begin(), point.end());
  for (const model::NodeId coordinate : point) {
    for (const std::size_t i : drag_target.positions)
      drag_target.nodes.push_back(differentiate(model.graph, coordinate, model.states[i].variable));
  }
  return drag_target;
}

namespace {

using Matrix = Eigen::MatrixXd;
using Vector = Eigen::VectorXd;

struct Look {
  Vector miss;  // target - point
  Matrix slope;
};

Look look(const DragTarget& drag_target, model::Evaluation& evaluation, double t, std::span<const double> x,
          std::span<const double> target) {
  const std::vector<double> values = evaluation(t, x);
  const auto rows = static_cast<Eigen::Index>(drag_target.dimension),
             columns = static_cast<Eigen::Index>(drag_target.positions.size());
  Look seen{Vector(rows), Matrix(rows, columns)};
  std::size_t next = drag_target.dimension;
  for (Eigen::Index row = 0; row < rows; ++row) {
    const auto i = static_cast<std::size_t>(row);
    seen.miss(row) = target[i] - values[i];
    for (Eigen::Index column = 0; column < columns; ++column) seen.slope(row, column) = values[next++];
  }
  return seen;
}

}  // namespace

std::vector<double> pull(const DragTarget& drag_target, model::Evaluation& evaluation, double t, std::vector<double> x,
                         std::span<const double> target) {
  constexpr int most_steps = 60;
  constexpr double smallest_gain = 1e-14, stiffest = 1e12;  // relative; of the damping
  for (const std::size_t i : drag_target.velocities) x[i] = 0;
  Look now = look(drag_target, evaluation, t, x, target);
  double damping = 1e-6;
  for (int step = 0; step < most_steps && damping < stiffest && now.miss.squaredNorm() > 0; ++step) {
    // J^T (J J^T + damping*|J|^2)^-1 miss: of all changes that do the same, the smallest.
    Matrix normal = now.slope * now.slope.transpose();
    const double scale = normal.trace();
    if (!(scale > 0)) break;
    normal.diagonal().array() += damping * scale;
    const Vector change = now.slope.transpose() * normal.ldlt().solve(now.miss);
    std::vector<double> tried = x;
    for (std::size_t k = 0; k < drag_target.positions.size(); ++k)
      tried[drag_target.positions[k]] += change(static_cast<Eigen::Index>(k));
    const Look next = look(drag_target, evaluation, t, tried, target);
    const double before = now.miss.squaredNorm(), after = next.miss.squaredNorm();
    const double promised = before - (now.miss - now.slope * change).squaredNorm();
    if (after < before) {
      x = std::move(tried);
      now = next;
    }
    // Where the point bends away from what its derivatives promise, steps become shorter.
    if (before - after > 0.75 * promised) damping = std::max(damping / 10, 1e-15);
    if (before - after < 0.5 * promised) damping *= 10;
    if (after < before && before - after < smallest_gain * before) break;
  }
  return x;
}

}  // namespace continuo::live
