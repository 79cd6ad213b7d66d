// continuo/language/check/equations/algebraic.cpp
// Unknowns and the equations `0 = ...` that determine them: they join the states, behind them, and their equations must
// be able to determine them (index 1).
#include <algorithm>
#include <string>
#include <vector>

#include <fmt/format.h>

#include <continuo/language/check/names/checker.hpp>
#include <continuo/symbolic/graph/assignment.hpp>

namespace continuo::model::detail {

void Checker::append_unknowns() {
  if (errors_ > 0 || unknowns_.empty()) return;
  const bool constant = model_.algebraic.empty();  // of a boundary-value problem: x' = 0
  for (const Unknown& unknown : model_.unknowns) {
    model_.states.push_back({.base = unknown.name,
                             .primes = 0,
                             .column = unknown.name,
                             .variable = unknown.variable,
                             .unit = unknown.unit,
                             .initial = unknown.guess,
                             .span = unknown.span,
                             .algebraic = !constant});
  }
  model_.all_paired = false;
  if (constant) {
    for (Mode& mode : model_.modes)
      mode.derivatives.insert(mode.derivatives.end(), unknowns_.size(), model_.graph.constant(0));
    return;
  }
  for (const AlgebraicEquation& equation : model_.algebraic)
    model_.modes[equation.mode].derivatives.push_back(equation.residual);
  for (std::size_t mode = 0; mode < model_.modes.size(); ++mode) check_index(mode);
}

void Checker::check_index(std::size_t mode) {
  std::vector<const AlgebraicEquation*> equations;
  std::vector<std::vector<std::size_t>> contained;
  for (const AlgebraicEquation& equation : model_.algebraic) {
    if (equation.mode != mode) continue;
    equations.push_back(&equation);
    std::vector<std::size_t>& unknowns = contained.emplace_back();
    for (const std::uint32_t variable : variables_of(model_.graph, equation.residual)) {
      if (variable >= model_.layout.unknowns && variable < model_.layout.parameters)
        unknowns.push_back(variable - model_.layout.unknowns);
    }
  }
  const std::size_t left_over = Assignment(unknowns_.size(), contained).first_left_over();
  if (left_over == Assignment::npos) return;
  std::string label = "this equation contains no unknown";
  if (!contained[left_over].empty()) {
    std::vector<std::string> names;
    names.reserve(contained[left_over].size());
    for (const std::size_t unknown : contained[left_over]) names.push_back(model_.unknowns[unknown].name);
    label =
        fmt::format("{} {} already determined by the other equations", listed(names), names.size() == 1 ? "is" : "are");
  }
  fail("E236", equations[left_over]->span,
       "the algebraic equations do not determine their unknowns: the index is above 1", std::move(label),
       "replace this equation by its derivative with respect to time, until an unknown appears in it");
}

}  // namespace continuo::model::detail
