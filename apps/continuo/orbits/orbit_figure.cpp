// A closed orbit in its plane and over time.
#include <apps/continuo/orbits/orbit_figure.hpp>

namespace continuo::app {

results::Figure orbit_figure(const model::Model& model, const std::vector<double>& times,
                             const std::vector<std::vector<double>>& states) {
  const std::string& first = model.states[0].column;
  results::Figure figure{.title = model.name, .panels = {}};
  results::Curve over_time{.label = first, .x = times, .y = {}};
  for (const auto& x : states) over_time.y.push_back(x[0]);
  if (model.states.size() > 1) {
    results::Curve plane{.label = "orbit", .x = over_time.y, .y = {}};
    for (const auto& x : states) plane.y.push_back(x[1]);
    figure.panels.push_back(
        {.x_label = first, .y_label = model.states[1].column, .curves = {std::move(plane)}, .tall = true});
  }
  figure.panels.push_back({.x_label = "t", .y_label = first, .curves = {std::move(over_time)}});
  return figure;
}

}  // namespace continuo::app
