// continuo orbit FILE --along NAME=LOW..HIGH --and NAME=LOW..HIGH: the folds, period doublings, tori and homoclinic
// ends of all branches of orbits, followed while both parameters move.
#pragma once
#include <string>
#include <vector>

#include <apps/continuo/orbits/steady_curves.hpp>
#include <apps/continuo/studies/branch_steps.hpp>
#include <apps/continuo/studies/studied_model.hpp>
#include <nlohmann/json.hpp>

#include <continuo/studies/orbit_curve.hpp>

namespace continuo::app {

std::vector<studies::OrbitCurveOfDiagram> curves_of(const Studied& studied,
                                                    const std::vector<studies::OrbitBranch>& branches,
                                                    const NamedPlane& plane, const BranchSteps& steps);

/// A few lines for each curve.
std::string text_of(const std::vector<studies::OrbitCurveOfDiagram>& curves, const NamedPlane& plane);
nlohmann::json json_of(const std::vector<studies::OrbitCurveOfDiagram>& curves, const NamedPlane& plane);
std::string csv_of(const std::vector<studies::OrbitCurveOfDiagram>& curves, const model::Model& model,
                   const NamedPlane& plane);
/// The curves in the plane of both parameters, as a file.
bool draw(const std::vector<studies::OrbitCurveOfDiagram>& curves, const model::Model& model, const NamedPlane& plane,
          const std::string& file);

}  // namespace continuo::app
