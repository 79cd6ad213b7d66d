// A branch of equilibria or orbits as a picture shows it.
#pragma once
#include <span>
#include <vector>

#include <continuo/results/figure.hpp>

namespace continuo::app {

/// Values over a constant, in pieces of equal stability: a line where stable, dashed where not. Only the first branch
/// of a panel is named in the key.
void add_branch(results::Panel& panel, std::span<const double> constants, std::span<const double> values,
                const std::vector<bool>& stable);

}  // namespace continuo::app
