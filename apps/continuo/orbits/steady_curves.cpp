// Curves of folds and Hopf points in two parameters: followed, printed and drawn.
#include <algorithm>
#include <cmath>

#include <apps/continuo/orbits/steady_curves.hpp>
#include <apps/continuo/studies/branch_curves.hpp>
#include <apps/continuo/terminal/interrupt.hpp>
#include <apps/continuo/terminal/progress.hpp>
#include <apps/continuo/terminal/terminal.hpp>
#include <fmt/format.h>

#include <continuo/results/csv_writer.hpp>
#include <continuo/results/figure.hpp>
#include <continuo/results/output_file.hpp>
#include <continuo/results/summary.hpp>

namespace continuo::app {
namespace {

using studies::BifurcationCurve;
using studies::CurvePoint;
using studies::DegeneratePoint;
using Curves = std::vector<studies::CurveOfDiagram>;

constexpr std::size_t most_plane_curves = 20;

/// What the place is exact to leaves of a zero.
double rounded(double value, const NamedRange& range) {
  return std::abs(value) < 1e-9 * (range.high - range.low) ? 0 : value;
}
std::string place_text(const CurvePoint& point, const NamedPlane& plane) {
  return fmt::format("{} = {:.9g}, {} = {:.9g}", plane.first.name, rounded(point.constants[0], plane.first),
                     plane.second.name, rounded(point.constants[1], plane.second));
}

std::string mark_text(const DegeneratePoint& mark, const NamedPlane& plane) {
  std::string line = fmt::format("   {}: {}", place_text(mark.at, plane), to_string(mark.kind));
  if (mark.at.frequency > 0 && mark.kind != studies::Degeneracy::bogdanov_takens) {
    line += fmt::format(", frequency {}", results::short_number(mark.at.frequency));
    if (mark.other_frequency > 0) line += fmt::format(" and {}", results::short_number(mark.other_frequency));
  } else if (mark.other_frequency > 0) {
    line += fmt::format(", frequency {}", results::short_number(mark.other_frequency));
  }
  for (const studies::NormalFormNumber& number : mark.numbers)
    line += fmt::format(", {} = {}", number.name, results::short_number(number.value));
  return line + "\n";
}

nlohmann::json json_of(const CurvePoint& point, const BifurcationCurve& curve) {
  nlohmann::json entry{{"at", {point.constants[0], point.constants[1]}},
                       {"x", point.x},
                       {"eigenvalues", app::json_of(point.eigenvalues)}};
  const bool hopf = curve.kind == studies::Bifurcation::hopf;
  if (hopf) entry["frequency"] = point.frequency;
  if (point.coefficient) entry[hopf ? "first_lyapunov_coefficient" : "coefficient"] = *point.coefficient;
  return entry;
}

/// The points of a curve and between them those that are more.
std::vector<std::pair<const CurvePoint*, const DegeneratePoint*>> points_of(const BifurcationCurve& curve) {
  std::vector<std::pair<const CurvePoint*, const DegeneratePoint*>> points;
  auto mark = curve.marks.begin();
  for (std::size_t i = 0; i <= curve.points.size(); ++i) {
    for (; mark != curve.marks.end() && mark->next == i; ++mark) points.emplace_back(&mark->at, &*mark);
    if (i < curve.points.size()) points.emplace_back(&curve.points[i], nullptr);
  }
  return points;
}

/// A line; dashed where the orbits born at Hopf points repel.
void add_curve(const BifurcationCurve& curve, results::Panel& panel) {
  using enum results::Curve::Style;
  const bool hopf = curve.kind == studies::Bifurcation::hopf;
  for (const bool subcritical : {false, true}) {
    if (subcritical && !hopf) continue;
    std::string label = "fold";
    if (hopf) label = subcritical ? "Hopf points, subcritical" : "Hopf points";
    if (std::ranges::any_of(panel.curves, [&](const results::Curve& other) { return other.label == label; }))
      label = "";
    results::Curve line_of{.label = label,
                           .x = {},
                           .y = {},
                           .color = hopf ? "#cc79a7" : "#444444",
                           .style = subcritical ? dashed_line : line};
    bool before = false, any = false;
    for (const auto& [point, mark] : points_of(curve)) {
      const bool here = hopf && point->coefficient.value_or(-1) > 0;
      line_of.x.push_back(point->constants[0]);
      line_of.y.push_back(here == subcritical || before ? point->constants[1] : std::nan(""));
      before = here == subcritical;
      any = any || before;
    }
    if (any) panel.curves.push_back(std::move(line_of));
  }
}

}  // namespace

std::optional<NamedRange> parse_second(const std::string& text, const NamedRange& first) {
  auto second = parse_range(text);
  if (second && second->name == first.name) {
    say(fmt::format("--along and --and both name `{}`; two different parameters are needed", first.name));
    return std::nullopt;
  }
  return second;
}

bool is_plane(const Studied& studied, const NamedPlane& plane, std::string_view what) {
  const auto& [low, high] = std::pair(plane.second.low, plane.second.high);
  const double now = studied.system.constants[1];
  if (now >= low && now <= high) return true;
  say(
      fmt::format("{0} is {1:.10g}, outside of {2:.10g}..{3:.10g}, and {4} are followed with that value first: "
                  "--set {0}=VALUE gives it another",
                  plane.second.name, now, low, high, what));
  return false;
}

Curves curves_of(const Studied& studied, const SteadyDiagram& diagram, const NamedPlane& plane,
                 const BranchSteps& steps) {
  std::vector<studies::CurveStart> starts;
  const double now = studied.system.constants[1];
  for (const studies::BranchOfDiagram& of : diagram.branches)
    for (const studies::BifurcationPoint& point : of.branch.bifurcations)
      if (point.kind == studies::Bifurcation::fold || point.kind == studies::Bifurcation::hopf)
        starts.push_back({point.kind, {point.at.constant, now}, point.at.x, point.frequency});
  Progress progress;
  studies::CurveOptions options{.low = {plane.first.low, plane.second.low},
                                .high = {plane.first.high, plane.second.high},
                                .interrupt = &interrupt_flag(),
                                .progress = progress.parts()};
  steps.set(options);
  return studies::bifurcation_curves(studied.system, starts, options, most_plane_curves);
}

std::string text_of(const Curves& curves, const NamedPlane& plane) {
  if (curves.empty())
    return fmt::format("\nno fold and no Hopf point was found along {}, so none is followed in {}\n", plane.first.name,
                       plane.second.name);
  std::string text;
  for (std::size_t k = 0; k < curves.size(); ++k) {
    const auto& [curve, starts, from] = curves[k];
    text += fmt::format("\ncurve {} of {}s{}: ", k + 1, to_string(curve.kind),
                        from ? fmt::format(", touching curve {}", *from + 1) : "");
    if (curve.points.empty()) {
      text += curve.status.message + "\n";
      continue;
    }
    text += fmt::format("{} points\n", curve.points.size());
    const bool closed = curve.ends[0].ending == studies::CurveEnding::closed;
    text += closed ? fmt::format("   closed, through {}\n", place_text(curve.points.front(), plane))
                   : fmt::format("   from {}: {}\n", place_text(curve.points.front(), plane), curve.ends[0].reason);
    for (const DegeneratePoint& mark : curve.marks) text += mark_text(mark, plane);
    if (!closed) text += fmt::format("   to {}: {}\n", place_text(curve.points.back(), plane), curve.ends[1].reason);
  }
  if (curves.size() >= most_plane_curves)
    text += fmt::format("only the first {} curves were followed\n", most_plane_curves);
  return text;
}

nlohmann::json json_of(const Curves& curves, const NamedPlane& plane) {
  auto list = nlohmann::json::array();
  for (const auto& [curve, starts, from] : curves) {
    nlohmann::json entry{{"kind", to_string(curve.kind)},
                         {"points", nlohmann::json::array()},
                         {"degenerate", nlohmann::json::array()},
                         {"ends", nlohmann::json::array()}};
    if (!curve.status) entry["message"] = curve.status.message;
    if (from) entry["from"] = *from + 1;
    for (const CurvePoint& point : curve.points) entry["points"].push_back(json_of(point, curve));
    for (const DegeneratePoint& mark : curve.marks) {
      nlohmann::json at = json_of(mark.at, curve);
      at["kind"] = to_string(mark.kind);
      if (mark.other_frequency > 0) at["other_frequency"] = mark.other_frequency;
      at["normal_form"] = nlohmann::json::object();
      for (const studies::NormalFormNumber& number : mark.numbers)
        at["normal_form"][std::string(number.name)] = number.value;
      entry["degenerate"].push_back(std::move(at));
    }
    if (!curve.points.empty())
      for (std::size_t side = 0; side < 2; ++side) {
        const CurvePoint& last = side == 0 ? curve.points.front() : curve.points.back();
        entry["ends"].push_back({{"at", {last.constants[0], last.constants[1]}}, {"reason", curve.ends[side].reason}});
      }
    list.push_back(std::move(entry));
  }
  return {{"parameters", {plane.first.name, plane.second.name}}, {"curves", list}};
}

std::string csv_of(const Curves& curves, const model::Model& model, const NamedPlane& plane) {
  std::string csv = "curve,kind,";
  results::append_field(csv, plane.first.name);
  csv += ',';
  results::append_field(csv, plane.second.name);
  csv += ",frequency,coefficient";
  for (const model::State& state : model.states) {
    csv += ',';
    results::append_field(csv, state.column);
  }
  std::size_t most = 0;
  for (const auto& of : curves)
    for (const CurvePoint& point : of.curve.points) most = std::max(most, point.eigenvalues.size());
  for (std::size_t k = 1; k <= most; ++k) csv += fmt::format(",eigenvalue {0} re,eigenvalue {0} im", k);
  csv += "\n";
  const auto field = [&](double value) {
    csv += ',';
    results::append_number(csv, value);
  };
  for (std::size_t k = 0; k < curves.size(); ++k) {
    const BifurcationCurve& curve = curves[k].curve;
    for (const auto& [point, mark] : points_of(curve)) {
      csv += fmt::format("{},{}", k + 1, mark ? to_string(mark->kind) : to_string(curve.kind));
      for (const double value : point->constants) field(value);
      field(point->frequency);
      if (point->coefficient) {
        field(*point->coefficient);
      } else {
        csv += ',';
      }
      for (const double x : point->x) field(x);
      for (const auto& value : point->eigenvalues) field(value.real()), field(value.imag());
      for (std::size_t j = point->eigenvalues.size(); j < most; ++j) csv += ",,";
      csv += '\n';
    }
  }
  return csv;
}

bool draw(const Curves& curves, const model::Model& model, const NamedPlane& plane, const std::string& file) {
  results::Panel panel{.x_label = plane.first.name, .y_label = plane.second.name, .curves = {}};
  for (const auto& of : curves) add_curve(of.curve, panel);
  for (const auto& of : curves)
    for (const DegeneratePoint& mark : of.curve.marks)
      add_bifurcation(panel, std::string(to_string(mark.kind)), mark.at.constants[0], mark.at.constants[1]);
  return written(results::draw({.title = model.name, .panels = {std::move(panel)}}, file));
}

}  // namespace continuo::app
