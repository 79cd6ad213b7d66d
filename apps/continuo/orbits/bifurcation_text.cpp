// Tells the bifurcation points of a diagram apart.
#include <algorithm>
#include <cmath>
#include <optional>

#include <apps/continuo/orbits/bifurcation_text.hpp>
#include <fmt/format.h>

#include <continuo/results/summary.hpp>

namespace continuo::app {
namespace {

constexpr double same_point = 1e-6;  // in parts of the largest value of the diagram

/// The largest |x| of each state, and behind them that of the parameter.
std::vector<double> sizes_of(const std::vector<studies::BranchOfDiagram>& diagram, std::size_t states) {
  std::vector<double> sizes(states + 1, 0.0);
  for (const studies::BranchOfDiagram& one : diagram) {
    for (const studies::BranchPoint& point : one.branch.points) {
      for (std::size_t i = 0; i < states; ++i) sizes[i] = std::max(sizes[i], std::abs(point.x[i]));
      sizes[states] = std::max(sizes[states], std::abs(point.constant));
    }
  }
  return sizes;
}

bool is_alike(const studies::BifurcationPoint& a, const studies::BifurcationPoint& b,
              const std::vector<double>& sizes) {
  return a.kind == b.kind && std::abs(a.at.constant - b.at.constant) <= same_point * sizes.back();
}

/// The first state in which the two points differ.
std::optional<std::size_t> difference(const studies::BifurcationPoint& a, const studies::BifurcationPoint& b,
                                      const std::vector<double>& sizes) {
  for (std::size_t i = 0; i < a.at.x.size(); ++i)
    if (std::abs(a.at.x[i] - b.at.x[i]) > same_point * sizes[i]) return i;
  return std::nullopt;
}

}  // namespace

bool is_listed_before(const std::vector<studies::BranchOfDiagram>& diagram, std::size_t branch,
                      const studies::BifurcationPoint& point) {
  const std::vector<double> sizes = sizes_of(diagram, point.at.x.size());
  for (std::size_t k = 0; k < branch; ++k)
    for (const studies::BifurcationPoint& other : diagram[k].branch.bifurcations)
      if (is_alike(point, other, sizes) && !difference(point, other, sizes)) return true;
  return false;
}

std::string state_text(const std::vector<studies::BranchOfDiagram>& diagram, const studies::BifurcationPoint& point,
                       const model::Model& model) {
  const std::vector<double> sizes = sizes_of(diagram, point.at.x.size());
  std::optional<std::size_t> state;
  for (const studies::BranchOfDiagram& one : diagram)
    for (const studies::BifurcationPoint& other : one.branch.bifurcations)
      if (const auto i = difference(point, other, sizes); i && is_alike(point, other, sizes))
        state = state ? std::min(*state, *i) : *i;
  if (!state) return "";
  const double x = point.at.x[*state];
  return fmt::format(", {} = {}", model.states[*state].column,
                     results::short_number(std::abs(x) <= same_point * sizes[*state] ? 0 : x));
}

}  // namespace continuo::app
