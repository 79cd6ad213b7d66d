// continuo/language/check/world/springs.hpp
// Springs between bodies by name, and between the neighbours of a pattern.
#pragma once
#include <vector>

#include <continuo/language/check/expressions/expressions.hpp>
#include <continuo/language/check/world/world_numbers.hpp>

namespace continuo::model::detail {

class Springs {
 public:
  /// `states`: where the bodies begin, for springs as long as they are at the start.
  Springs(Expressions& expressions, WorldAtWork& work, const std::vector<State>& states)
      : expressions_(expressions),
        report_(expressions.report),
        graph_(expressions.workspace.graph),
        text_(expressions.workspace.declared.world),
        work_(work),
        states_(states),
        numbers_(expressions, work) {}

  void add(const ast::WorldSpring& text, Scope& scope, Span span);
  /// Between neighbours along each axis of a grid, or one and the next of a stack.
  void add(const ast::WorldSprings& text, Scope& scope, Span span);

 private:
  void add_spring(SpringDescription spring, const ast::WorldAttributes& attributes, Scope& scope);
  [[nodiscard]] NodeId length_at_start(const SpringDescription& spring) const;

  Expressions& expressions_;
  Report& report_;
  Graph& graph_;
  const WorldText& text_;
  WorldAtWork& work_;
  const std::vector<State>& states_;
  WorldNumbers numbers_;
};

}  // namespace continuo::model::detail
