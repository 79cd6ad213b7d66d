// continuo steady FILE --along NAME=LOW..HIGH --and NAME=LOW..HIGH: the folds and Hopf points of all branches, followed
// while both parameters move.
#pragma once
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <apps/continuo/orbits/steady_branches.hpp>
#include <apps/continuo/studies/studied_model.hpp>
#include <nlohmann/json.hpp>

#include <continuo/studies/bifurcation_curve.hpp>

namespace continuo::app {

/// Where both parameters go. `studied` has them as its two constants, in this order.
struct NamedPlane {
  NamedRange first, second;
};
/// Whether the second parameter begins within its range; says so if not. `what` is followed with that value first.
bool is_plane(const Studied& studied, const NamedPlane& plane, std::string_view what = "equilibria");
/// The range of --and, behind that of --along: of another parameter. Says what is wrong.
std::optional<NamedRange> parse_second(const std::string& text, const NamedRange& first);

std::vector<studies::CurveOfDiagram> curves_of(const Studied& studied, const SteadyDiagram& diagram,
                                               const NamedPlane& plane, const BranchSteps& steps);

/// A few lines for each curve.
std::string text_of(const std::vector<studies::CurveOfDiagram>& curves, const NamedPlane& plane);
nlohmann::json json_of(const std::vector<studies::CurveOfDiagram>& curves, const NamedPlane& plane);
std::string csv_of(const std::vector<studies::CurveOfDiagram>& curves, const model::Model& model,
                   const NamedPlane& plane);
/// The curves in the plane of both parameters, as a file.
bool draw(const std::vector<studies::CurveOfDiagram>& curves, const model::Model& model, const NamedPlane& plane,
          const std::string& file);

}  // namespace continuo::app
