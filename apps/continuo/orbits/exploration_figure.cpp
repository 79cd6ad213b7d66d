// An exploration as a figure: the motion, the phase plane, and what the sliders do.
#include <algorithm>
#include <tuple>

#include <apps/continuo/orbits/exploration.hpp>
#include <apps/continuo/orbits/steady_branches.hpp>

#include <continuo/results/plots.hpp>

namespace continuo::app {
namespace {

std::string state_label(const model::Model& model, std::size_t i) {
  return results::label_of({model.states[i].column, model.states[i].unit});
}

results::Panel over_time(const model::Model& model, const model::Motion& motion) {
  results::Curve curve{.label = model.states[0].column, .x = {}, .y = {}};
  for (std::size_t row = 0; row < motion.rows(); ++row) {
    curve.x.push_back(motion.time(row));
    curve.y.push_back(motion.state(row)[0]);
  }
  return {.x_label = results::label_of({"t", model.time_unit}),
          .y_label = state_label(model, 0),
          .curves = {std::move(curve)}};
}

results::Panel plane(const model::Model& model, const model::Motion& motion, const Exploration& found) {
  using enum results::Curve::Style;
  results::Curve run{.label = "run", .x = {}, .y = {}};
  for (std::size_t row = 0; row < motion.rows(); ++row) {
    run.x.push_back(motion.state(row)[0]);
    run.y.push_back(motion.state(row)[1]);
  }
  results::Panel panel{
      .x_label = state_label(model, 0), .y_label = state_label(model, 1), .curves = {std::move(run)}, .tall = true};
  if (found.orbit) {
    results::Curve orbit{.label = "orbit", .x = {}, .y = {}};
    for (const double s : found.orbit->orbit.mesh) {
      const auto x = found.orbit->orbit(s);
      orbit.x.push_back(x[0]);
      orbit.y.push_back(x[1]);
    }
    panel.curves.push_back(std::move(orbit));
  }
  if (found.hybrid_orbit) {
    results::Curve orbit{.label = "orbit", .x = {}, .y = {}};
    for (const std::vector<double>& x : found.hybrid_orbit->x) {
      orbit.x.push_back(x[0]);
      orbit.y.push_back(x[1]);
    }
    panel.curves.push_back(std::move(orbit));
  }
  for (const auto& [name, stable, style] :
       {std::tuple{"equilibrium, stable", true, full_points}, {"equilibrium, not stable", false, empty_points}}) {
    results::Curve points{.label = name, .x = {}, .y = {}, .color = "#000000", .style = style};
    for (const ExploredEquilibrium& equilibrium : found.equilibria) {
      if ((equilibrium.at.stability == studies::Stability::asymptotically_stable) != stable) continue;
      points.x.push_back(equilibrium.at.x[0]);
      points.y.push_back(equilibrium.at.x[1]);
    }
    if (!points.x.empty()) panel.curves.push_back(std::move(points));
  }
  return panel;
}

results::Panel along(const model::Model& model, const Slider& slider) {
  results::Panel panel{.x_label = slider.name, .y_label = state_label(model, 0), .curves = {}};
  for (const studies::BranchOfDiagram& one : slider.branches) add_curves(one.branch, 0, panel);
  return panel;
}

}  // namespace

results::Figure exploration_figure(const Studied& studied, const Exploration& found) {
  const model::Model& model = studied.prepared.program->model;
  results::Figure figure{.title = model.name, .panels = {}};
  if (found.simulated.run) {
    figure.panels.push_back(over_time(model, found.simulated.run->motion));
    if (model.states.size() > 1) figure.panels.push_back(plane(model, found.simulated.run->motion, found));
  }
  for (const Slider& slider : found.sliders)
    if (results::Panel panel = along(model, slider); !panel.curves.empty()) figure.panels.push_back(std::move(panel));
  return figure;
}

}  // namespace continuo::app
