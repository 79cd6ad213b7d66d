// continuo/language/check/equations/algebraic.cpp
// Appends unknowns to the states; E236 where the index is above 1.
#include <algorithm>
#include <string>
#include <vector>

#include <fmt/format.h>

#include <continuo/language/check/equations/algebraic.hpp>
#include <continuo/symbolic/graph/assignment.hpp>

namespace continuo::model::detail {

namespace {

void check_index(const Model& model, std::size_t mode, Report& report) {
  std::vector<const AlgebraicEquation*> equations;
  std::vector<std::vector<std::size_t>> contained;
  for (const AlgebraicEquation& equation : model.algebraic) {
    if (equation.mode != mode) continue;
    equations.push_back(&equation);
    std::vector<std::size_t>& unknowns = contained.emplace_back();
    for (const std::uint32_t variable : variables_of(model.graph, equation.residual)) {
      if (variable >= model.layout.unknowns && variable < model.layout.parameters)
        unknowns.push_back(variable - model.layout.unknowns);
    }
  }
  const std::size_t left_over = Assignment(model.unknowns.size(), contained).first_left_over();
  if (left_over == Assignment::npos) return;
  std::string label = "this equation contains no unknown";
  if (!contained[left_over].empty()) {
    std::vector<std::string> names;
    names.reserve(contained[left_over].size());
    for (const std::size_t unknown : contained[left_over]) names.push_back(model.unknowns[unknown].name);
    label =
        fmt::format("{} {} already determined by the other equations", listed(names), names.size() == 1 ? "is" : "are");
  }
  report.fail("E236", equations[left_over]->span,
              "the algebraic equations do not determine their unknowns: the index is above 1", std::move(label),
              "replace this equation by its derivative with respect to time, until an unknown appears in it");
}

}  // namespace

void append_unknowns(Model& model, Report& report) {
  if (model.unknowns.empty()) return;
  const bool constant = model.algebraic.empty();  // of a boundary-value problem: x' = 0
  for (const Unknown& unknown : model.unknowns) {
    model.states.push_back({.base = unknown.name,
                            .primes = 0,
                            .column = unknown.name,
                            .variable = unknown.variable,
                            .unit = unknown.unit,
                            .initial = unknown.guess,
                            .span = unknown.span,
                            .algebraic = !constant});
  }
  model.all_paired = false;
  if (constant) {
    for (Mode& mode : model.modes)
      mode.derivatives.insert(mode.derivatives.end(), model.unknowns.size(), model.graph.constant(0));
    return;
  }
  for (const AlgebraicEquation& equation : model.algebraic)
    model.modes[equation.mode].derivatives.push_back(equation.residual);
  for (std::size_t mode = 0; mode < model.modes.size(); ++mode) check_index(model, mode, report);
}

}  // namespace continuo::model::detail
