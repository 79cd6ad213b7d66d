// continuo/language/check/world/walls.hpp
// Walls and containers.
#pragma once
#include <continuo/language/check/world/world_numbers.hpp>

namespace continuo::model::detail {

class Walls {
 public:
  Walls(Expressions& expressions, WorldAtWork& work)
      : graph_(expressions.workspace.graph),
        text_(expressions.workspace.declared.world),
        work_(work),
        numbers_(expressions, work) {}

  void add(const ast::WorldWall& wall, Scope& scope, Span span);
  /// Two walls for each axis.
  void add(const ast::WorldContainer& container, Scope& scope, Span span);

 private:
  Graph& graph_;
  const WorldText& text_;
  WorldAtWork& work_;
  WorldNumbers numbers_;
};

}  // namespace continuo::model::detail
