// continuo orbit FILE --along NAME=LOW..HIGH --and NAME=LOW..HIGH --and NAME=LOW..HIGH: what is marked on curves of
// homoclinic orbits, followed while all three parameters move.
#pragma once
#include <array>
#include <string>
#include <vector>

#include <apps/continuo/orbits/steady_curves.hpp>
#include <apps/continuo/studies/branch_steps.hpp>
#include <apps/continuo/studies/studied_model.hpp>
#include <nlohmann/json.hpp>

#include <continuo/studies/degenerate_homoclinic.hpp>

namespace continuo::app {

/// Where three parameters go. `studied` has them as its constants, in this order.
using NamedSpace = std::array<NamedRange, 3>;
/// The range of a second --and. Says what is wrong.
std::optional<NamedRange> parse_third(const std::string& text, const NamedPlane& plane);
/// Whether the third parameter begins within its range; says so if not.
bool is_space(const Studied& studied, const NamedSpace& space);

std::vector<studies::DegenerateHomoclinicCurve> curves_of(const Studied& studied,
                                                          const std::vector<studies::OrbitCurveOfDiagram>& curves,
                                                          const NamedSpace& space, const BranchSteps& steps);

/// A few lines for each curve.
std::string text_of(const std::vector<studies::DegenerateHomoclinicCurve>& curves, const NamedSpace& space);
nlohmann::json json_of(const std::vector<studies::DegenerateHomoclinicCurve>& curves, const NamedSpace& space);
std::string csv_of(const std::vector<studies::DegenerateHomoclinicCurve>& curves, const model::Model& model,
                   const NamedSpace& space);
/// The second and the third parameter over the first, as a file.
bool draw(const std::vector<studies::DegenerateHomoclinicCurve>& curves, const model::Model& model,
          const NamedSpace& space, const std::string& file);

}  // namespace continuo::app
