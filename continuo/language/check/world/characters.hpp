// Characters, which walk: `character hero at (0, 0.9) radius 0.3 height 1.8 walk speed*(right - left) jump up*5`.
#pragma once
#include <continuo/language/check/expressions/expressions.hpp>
#include <continuo/language/check/world/body_shapes.hpp>
#include <continuo/language/check/world/world_numbers.hpp>

namespace continuo::model::detail {

class Characters {
 public:
  Characters(Expressions& expressions, WorldAtWork& work)
      : expressions_(expressions),
        graph_(expressions.workspace.graph),
        text_(expressions.workspace.declared.world),
        work_(work),
        numbers_(expressions, work),
        shapes_(expressions, work) {}

  /// Adds the character that this body is, and returns its capsule.
  [[nodiscard]] MadeShape make(std::size_t body, Scope& scope);
  /// After the equations: they may stand in what a character wishes.
  void make_wishes();

 private:
  [[nodiscard]] Measured speed_unit() const;

  Expressions& expressions_;
  Graph& graph_;
  const WorldText& text_;
  WorldAtWork& work_;
  WorldNumbers numbers_;
  BodyShapes shapes_;
};

}  // namespace continuo::model::detail
