// continuo/studies/equilibria/branch_diagram.cpp
// Follows all branches that cross a branch of equilibria.
#include <algorithm>
#include <utility>

#include <continuo/studies/continuation.hpp>

namespace continuo::studies {

std::vector<BranchOfDiagram> continue_equilibria(const ParametricSystem& system, const std::vector<BranchStart>& starts,
                                                 const ContinuationOptions& options, std::size_t most_branches) {
  std::vector<BranchOfDiagram> diagram;
  const auto passing = [&](const std::vector<double>& x, double constant) {
    return std::ranges::find_if(diagram, [&](const BranchOfDiagram& known) {
      return passes_through(system, known.branch, {constant, x}, options);
    });
  };
  for (std::size_t k = 0; k < starts.size() && diagram.size() < most_branches; ++k) {
    if (const auto known = passing(starts[k].x, starts[k].constant); known != diagram.end()) {
      known->starts.push_back(k);
      continue;
    }
    ParametricSystem there(system);
    there.constants[options.constant] = starts[k].constant;
    diagram.push_back({continue_equilibrium(there, starts[k].x, options), {k}});
  }
  for (std::size_t k = 0; k < diagram.size() && diagram.size() < most_branches; ++k) {
    const std::vector<BifurcationPoint> points = diagram[k].branch.bifurcations;
    for (const BifurcationPoint& point : points) {
      if (point.other.empty() || diagram.size() >= most_branches) continue;
      Branch branch = continue_equilibrium(system, point, options);
      // Its points next to the crossing tell whether it is known; the crossing itself lies on both.
      const bool is_new = std::ranges::any_of(branch.points, [&](const BranchPoint& other) {
        return &other != &branch.points.front() && other.x != point.at.x &&
               passing(other.x, other.constant) == diagram.end();
      });
      if (is_new) diagram.push_back({std::move(branch), {}, k});
    }
  }
  return diagram;
}

}  // namespace continuo::studies
