// How the points of a diagram of equilibria are named: by the parameter, and by a state where that is not enough.
#pragma once
#include <string>
#include <vector>

#include <continuo/language/model.hpp>
#include <continuo/studies/continuation.hpp>

namespace continuo::app {

/// Whether a branch before this one lists the same point, because the two cross there.
bool is_listed_before(const std::vector<studies::BranchOfDiagram>& diagram, std::size_t branch,
                      const studies::BifurcationPoint& point);
/// Symmetric equations have two points of one kind at one value of the parameter: ", x = 7.95602" with the first state
/// in which they differ. Empty where the value of the parameter is enough.
std::string state_text(const std::vector<studies::BranchOfDiagram>& diagram, const studies::BifurcationPoint& point,
                       const model::Model& model);

}  // namespace continuo::app
