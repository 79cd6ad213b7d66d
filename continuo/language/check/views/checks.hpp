// continuo/language/check/views/checks.hpp
// `check ...`: assertions of a model about its own run.
#pragma once
#include <string>
#include <vector>

#include <continuo/language/check/expressions/expressions.hpp>

namespace continuo::model::detail {

class Checks {
 public:
  /// `model`: its events by name, and whether it has energies.
  Checks(Expressions& expressions, const Model& model)
      : expressions_(expressions), report_(expressions.report), graph_(expressions.workspace.graph), model_(model) {}
  [[nodiscard]] std::vector<Check> make();
  /// What is measured, and in which unit.
  [[nodiscard]] Value measure(const ast::Measure& text, Span span, Scope& scope, Check& check);

 private:
  [[nodiscard]] bool are_at_start(const std::vector<Sample>& samples, const ast::Check& text) const;
  void add(const ast::Check& text, const Scope& outer, Span span);
  [[nodiscard]] Value value_at(const ast::ValueOf& text, Scope& scope, Span span, Check& check);
  [[nodiscard]] Moment moment(const ast::Moment& text, Scope& scope, Span span);
  void check_event_name(const std::string& begin, Span span);

  Expressions& expressions_;
  Report& report_;
  Graph& graph_;
  const Model& model_;
  std::vector<Check> made_;
};

}  // namespace continuo::model::detail
