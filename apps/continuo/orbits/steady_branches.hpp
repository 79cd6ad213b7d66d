// continuo steady FILE --along NAME=LOW..HIGH: how equilibria move with a parameter, which branches cross, and
// where stability changes.
#pragma once
#include <string>
#include <vector>

#include <apps/continuo/studies/branch_steps.hpp>
#include <apps/continuo/studies/studied_model.hpp>
#include <nlohmann/json.hpp>

#include <continuo/results/figure.hpp>
#include <continuo/studies/continuation.hpp>
#include <continuo/studies/equilibrium.hpp>

namespace continuo::app {

/// The branches through places that are known where the parameter is now, through others that are found elsewhere in
/// its range, and those that cross them. `studied` has the parameter as its one constant.
struct SteadyDiagram {
  std::vector<studies::BranchStart> starts;  // first those that are known
  std::vector<studies::BranchOfDiagram> branches;
};
SteadyDiagram diagram_of(const Studied& studied, const std::vector<studies::Equilibrium>& known,
                         const NamedRange& range, const studies::EquilibriumBox& box, const BranchSteps& steps = {});

/// A few lines for each branch.
std::string text_of(const SteadyDiagram& diagram, const model::Model& model, const NamedRange& range,
                    std::size_t known);
nlohmann::json json_of(const SteadyDiagram& diagram, const model::Model& model, const NamedRange& range);
std::string csv_of(const SteadyDiagram& diagram, const model::Model& model, const NamedRange& range);
/// One state over the parameter, with the points at which something changes.
void add_curves(const studies::Branch& branch, std::size_t component, results::Panel& panel);
/// That of all branches, as a file.
bool draw(const SteadyDiagram& diagram, const model::Model& model, const NamedRange& range, std::size_t component,
          const std::string& file);

/// [[real, imaginary], ...]
nlohmann::json json_of(const std::vector<std::complex<double>>& values);

}  // namespace continuo::app
