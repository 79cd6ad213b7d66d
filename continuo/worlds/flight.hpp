// A world between two instants, for those who watch: what flies freely follows the cubic through both ends with their
// velocities, which is exact under gravity and constant forces. Internal to worlds.
#pragma once
#include <vector>

#include <continuo/language/model.hpp>

namespace continuo::worlds {

/// A piece of the motion of a world.
struct Flight {
  double from = 0, to = 0;
  std::vector<double> start, end;  // the states at both
  bool is_straight = false;        // by straight lines: with steps, or where something has been hit

  /// The states at t. Those of equations, measures and spins are on straight lines.
  void at(const model::Model& model, double t, std::vector<double>& x) const;
};

/// When a watcher looks at the motion of a run, ascending: at even times, and on both sides of every contact.
[[nodiscard]] std::vector<double> looks_at(double from, double to, const std::vector<double>& contacts);

}  // namespace continuo::worlds
