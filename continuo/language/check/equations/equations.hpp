// continuo/language/check/equations/equations.hpp
// Equations solved for their highest derivatives: each alone where it holds one, else together where they hang
// together (accelerations coupled through a mass matrix). An equation without such a derivative determines an unknown.
#pragma once
#include <cstdint>
#include <optional>
#include <vector>

#include <continuo/language/check/equations/equation_counts.hpp>
#include <continuo/language/check/equations/equations_at_work.hpp>
#include <continuo/language/check/expressions/expressions.hpp>
#include <continuo/language/check/expressions/family_translator.hpp>

namespace continuo::model::detail {

struct SolvedEquations {
  std::vector<std::vector<NodeId>> derivatives;  // of each mode: of each state
  std::vector<NodeId> highest;                   // of the only mode: the highest derivative of each base
  std::vector<AlgebraicEquation> algebraic;
  std::vector<MassMatrix> masses;
};

class Equations {
 public:
  /// `model`: its parameters, states and their starts, at which pivots are looked at.
  Equations(Expressions& expressions, const Model& model)
      : expressions_(expressions),
        report_(expressions.report),
        declared_(expressions.workspace.declared),
        graph_(expressions.workspace.graph),
        model_(model),
        counts_(expressions.workspace) {}
  [[nodiscard]] SolvedEquations solve();

 private:
  [[nodiscard]] std::optional<std::size_t> base_of(const ast::Name& name, Scope& scope) const;
  [[nodiscard]] std::optional<Value> explicit_left(const EquationText& equation, Scope& scope,
                                                   std::vector<std::uint32_t>& held) const;
  [[nodiscard]] EquationAtWork read_equation(ModeAtWork& mode, const EquationText& equation);
  void solve_mode(std::size_t mode);
  void sort_out_algebraic(ModeAtWork& work);
  void count_algebraic(std::size_t count) const;
  void solve_one_by_one(ModeAtWork& work);
  void solve_for(ModeAtWork& work, const EquationAtWork& equation, std::uint32_t base);
  [[nodiscard]] Vanishes vanishing_beside(const LinearRows& rows);
  void solve_coupled(ModeAtWork& work);
  void solve_group(ModeAtWork& work, const std::vector<std::size_t>& members, std::vector<std::uint32_t> open);
  void solve_rows(ModeAtWork& work, const std::vector<std::size_t>& members, const std::vector<std::uint32_t>& open);
  [[nodiscard]] NodeId with_solved(const ModeAtWork& work, NodeId node) const;

  Expressions& expressions_;
  Report& report_;
  const Declarations& declared_;
  Graph& graph_;
  const Model& model_;
  EquationCounts counts_;
  FamilyTranslator right_sides_;
  std::vector<double> start_values_;           // of all variables, once the states have theirs; empty until asked for
  std::vector<std::uint32_t> on_left_, held_;  // by the equation that is read: not allocated for each
  SolvedEquations made_;
};

}  // namespace continuo::model::detail
