// Sections and Lyapunov exponents, for the terminal, as JSON, as a table, as a picture.
#include <algorithm>

#include <apps/continuo/options/models.hpp>
#include <apps/continuo/orbits/long_motion.hpp>
#include <apps/continuo/studies/orbit_text.hpp>
#include <apps/continuo/terminal/answer.hpp>
#include <apps/continuo/terminal/interrupt.hpp>
#include <apps/continuo/terminal/progress.hpp>
#include <apps/continuo/terminal/terminal.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <continuo/results/csv_writer.hpp>
#include <continuo/results/figure.hpp>
#include <continuo/results/output_file.hpp>
#include <continuo/results/summary.hpp>
#include <continuo/studies/lyapunov.hpp>
#include <continuo/studies/periodic_orbit.hpp>

namespace continuo::app {
namespace {

nlohmann::json state_names(const model::Model& model) {
  auto states = nlohmann::json::array();
  for (const model::State& state : model.states) states.push_back(state.column);
  return states;
}

std::string section_table(const model::Model& model, const studies::Section& section) {
  std::string csv = "t";
  for (const model::State& state : model.states) csv += "," + state.column;
  csv += "\n";
  for (const studies::SectionPoint& point : section.points) {
    results::append_number(csv, point.t);
    for (const double x : point.x) {
      csv += ',';
      results::append_number(csv, x);
    }
    csv += '\n';
  }
  return csv;
}

nlohmann::json section_json(const model::Model& model, const studies::Section& section, std::size_t component,
                            double level) {
  auto points = nlohmann::json::array();
  for (const studies::SectionPoint& point : section.points) points.push_back({{"t", point.t}, {"x", point.x}});
  return {{"states", state_names(model)},
          {"section", {{"state", model.states[component].column}, {"value", level}}},
          {"points", points}};
}

/// The points in the plane of the first two other states; where there is one, each against the one before, and where
/// there is none their distances in time.
results::Figure section_figure(const model::Model& model, const studies::Section& section, std::size_t component) {
  std::vector<std::size_t> others;
  for (std::size_t i = 0; i < model.states.size(); ++i)
    if (i != component) others.push_back(i);
  results::Curve dots{.label = "passes", .x = {}, .y = {}, .style = results::Curve::Style::dots};
  results::Panel panel{};
  panel.tall = true;
  const auto& points = section.points;
  if (others.size() >= 2) {
    for (const studies::SectionPoint& point : points)
      dots.x.push_back(point.x[others[0]]), dots.y.push_back(point.x[others[1]]);
    panel.x_label = model.states[others[0]].column;
    panel.y_label = model.states[others[1]].column;
  } else if (others.size() == 1) {
    for (std::size_t k = 1; k < points.size(); ++k)
      dots.x.push_back(points[k - 1].x[others[0]]), dots.y.push_back(points[k].x[others[0]]);
    panel.x_label = model.states[others[0]].column;
    panel.y_label = panel.x_label + " at the next pass";
  } else {
    for (std::size_t k = 1; k < points.size(); ++k)
      dots.x.push_back(points[k].t), dots.y.push_back(points[k].t - points[k - 1].t);
    panel.x_label = "t";
    panel.y_label = "since the last pass";
  }
  panel.curves = {std::move(dots)};
  return {.title = model.name, .panels = {std::move(panel)}};
}

}  // namespace

ExitCode show_exponents(const Studied& studied, const LongMotion& motion) {
  const model::Model& model = studied.prepared.program->model;
  Progress progress;
  const studies::LyapunovOptions averaging{.duration = motion.duration,
                                           .settle = motion.settle,
                                           .interrupt = &interrupt_flag(),
                                           .progress = progress.over(0, motion.settle + motion.duration)};
  const auto found = motion.whole
                         ? studies::lyapunov_exponents(studied.prepared.program, studied.prepared.experiment, averaging)
                         : studies::lyapunov_exponents(studied.system, studied.start, averaging);
  if (found.exponents.empty()) return failed_exit(found.outcome);
  if (motion.json) {
    const nlohmann::json json{{"states", state_names(model)},
                              {"exponents", found.exponents},
                              {"spread", found.spread},
                              {"averaged", found.averaged},
                              {"complete", static_cast<bool>(found.outcome)}};
    answer("continuo.exponents/1", json);
  } else {
    std::string text = fmt::format("Lyapunov exponents over {}\n", with_time_unit(found.averaged, model));
    for (std::size_t i = 0; i < found.exponents.size(); ++i)
      text += fmt::format("  {:>10} +- {:.1g}\n", results::short_number(found.exponents[i]), found.spread[i]);
    print(text);
  }
  return found.outcome ? done : failed_exit(found.outcome);
}

ExitCode show_section(const Studied& studied, const std::string& text, const LongMotion& motion) {
  const model::Model& model = studied.prepared.program->model;
  std::vector<double> levels(studied.start.size());
  if (!set_states(model, {text}, levels)) return usage;
  const std::size_t component = *state_named(model, text.substr(0, text.find('=')));
  const auto section = [&] {
    Progress progress;
    const studies::SectionOptions passing{.level = levels[component],
                                          .settle = motion.settle,
                                          .duration = motion.duration,
                                          .rtol = motion.tolerance,
                                          .interrupt = &interrupt_flag(),
                                          .progress = progress.over(0, motion.settle + motion.duration)};
    if (motion.whole)
      return studies::poincare_section(studied.prepared.program, studied.prepared.experiment, component, passing);
    return studies::poincare_section(studied.system, studied.start, component, passing);
  }();
  const bool to_terminal = motion.out.empty() || motion.out == "-";
  if (motion.json) answer("continuo.section/1", section_json(model, section, component, levels[component]));
  if (!to_terminal) {
    if (!written(results::write_file(motion.out, section_table(model, section)))) return usage;
  } else if (!motion.json && (motion.plot.empty() || motion.out == "-")) {
    print(section_table(model, section));
  }
  if (!motion.plot.empty() && !written(results::draw(section_figure(model, section, component), motion.plot)))
    return usage;
  mention(fmt::format("{} passes through {}", section.points.size(), text));
  return section.outcome ? done : failed_exit(section.outcome);
}

}  // namespace continuo::app
