// Adds branches and bifurcations to a panel, each kind of bifurcation with its colour.
#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include <apps/continuo/studies/branch_curves.hpp>

namespace continuo::app {

namespace {

bool is_named(const results::Panel& panel, const std::string& label) {
  return std::ranges::any_of(panel.curves, [&](const results::Curve& curve) { return curve.label == label; });
}

const char* color_of(const std::string& kind) {
  if (kind.starts_with("Hopf") || kind == "torus") return "#cc79a7";
  if (kind == "period doubling") return "#e69f00";
  return kind == "fold" ? "#444444" : "#009e73";
}

}  // namespace

void add_branch(results::Panel& panel, std::span<const double> constants, std::span<const double> values,
                const std::vector<bool>& stable) {
  using enum results::Curve::Style;
  for (const bool wanted : {true, false}) {
    const std::string label = wanted ? "stable" : "not stable";
    results::Curve curve{.label = is_named(panel, label) ? "" : label,
                         .x = {},
                         .y = {},
                         .color = wanted ? "#0072b2" : "#d55e00",
                         .style = wanted ? line : dashed_line};
    bool before = false;  // the line to the next point belongs to the piece where it begins
    for (std::size_t k = 0; k < constants.size(); ++k) {
      const bool here = stable[k] == wanted;
      curve.x.push_back(constants[k]);
      curve.y.push_back(here || before ? values[k] : std::nan(""));
      before = here;
    }
    if (std::ranges::any_of(curve.y, [](double y) { return std::isfinite(y); }))
      panel.curves.push_back(std::move(curve));
  }
}

void add_bifurcation(results::Panel& panel, const std::string& kind, double constant, double value) {
  panel.curves.push_back({.label = is_named(panel, kind) ? "" : kind,
                          .x = {constant},
                          .y = {value},
                          .color = color_of(kind),
                          .style = results::Curve::Style::full_points});
}

}  // namespace continuo::app
