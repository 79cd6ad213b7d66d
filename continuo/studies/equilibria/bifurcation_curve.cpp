// continuo/studies/equilibria/bifurcation_curve.cpp
// Starts curves of folds and Hopf points, and names their special points.
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include <fmt/format.h>

#include <continuo/studies/bifurcation_curve.hpp>
#include <continuo/studies/equilibria/curve_follower.hpp>

namespace continuo::studies {

std::string_view to_string(Degeneracy kind) {
  constexpr std::array<std::string_view, 5> names{"cusp", "Bogdanov-Takens point", "generalised Hopf point",
                                                  "zero-Hopf point", "double Hopf point"};
  return names[static_cast<std::size_t>(kind)];
}

BifurcationCurve follow_bifurcation(const ParametricSystem& system, const CurveStart& start,
                                    const CurveOptions& options) {
  detail::CurveFollower follower(system, start, options);
  return follower.from(start);
}

std::vector<CurveOfDiagram> bifurcation_curves(const ParametricSystem& system, const std::vector<CurveStart>& starts,
                                               const CurveOptions& options, std::size_t most_curves) {
  std::vector<CurveOfDiagram> diagram;
  const auto is_interrupted = [&] { return options.interrupt && options.interrupt->load(); };
  const auto through = [&](Bifurcation kind, const CurvePoint& place, double frequency) {
    detail::CurveFollower follower(system, {kind, place.constants, place.x, frequency}, options);
    return std::ranges::find_if(diagram, [&](const CurveOfDiagram& known) {
      return known.curve.kind == kind && follower.passes(known.curve, place, frequency);
    });
  };
  for (std::size_t k = 0; k < starts.size() && diagram.size() < most_curves && !is_interrupted(); ++k) {
    CurvePoint place;
    place.constants = starts[k].constants;
    place.x = starts[k].x;
    if (const auto known = through(starts[k].kind, place, starts[k].frequency); known != diagram.end()) {
      known->starts.push_back(k);
      continue;
    }
    diagram.push_back({follow_bifurcation(system, starts[k], options), {k}});
  }
  for (std::size_t k = 0; k < diagram.size(); ++k) {
    const std::vector<DegeneratePoint> marks = diagram[k].curve.marks;
    for (const DegeneratePoint& mark : marks) {
      using enum Degeneracy;
      if (mark.kind == cusp || mark.kind == generalized_hopf) continue;
      if (diagram.size() >= most_curves || is_interrupted()) return diagram;
      const bool to_hopf = diagram[k].curve.kind == Bifurcation::fold || mark.kind == double_hopf;
      const Bifurcation kind = to_hopf ? Bifurcation::hopf : Bifurcation::fold;
      if (through(kind, mark.at, mark.other_frequency) != diagram.end()) continue;
      detail::CurveFollower follower(system, {kind, mark.at.constants, mark.at.x, mark.other_frequency}, options);
      BifurcationCurve curve = follower.from(mark, kind);
      if (curve.points.size() > 1) diagram.push_back({std::move(curve), {}, k});
    }
  }
  return diagram;
}

}  // namespace continuo::studies
