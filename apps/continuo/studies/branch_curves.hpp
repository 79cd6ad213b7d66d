// A branch of equilibria or orbits as a picture shows it.
#pragma once
#include <span>
#include <string>
#include <vector>

#include <continuo/results/figure.hpp>

namespace continuo::app {

/// Values over a constant, in pieces of equal stability: a line where stable, dashed where not, each from its first
/// point to the first of the next. Only the first branch of a panel is named in the key.
void add_branch(results::Panel& panel, std::span<const double> constants, std::span<const double> values,
                const std::vector<bool>& stable);
/// A point of a branch where something changes; in the key the first of its kind.
void add_bifurcation(results::Panel& panel, const std::string& kind, double constant, double value);

}  // namespace continuo::app
