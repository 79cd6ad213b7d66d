// How bodies and meshes stand: `angle 30 [deg]`, in space `axis (0, 0, 1) angle 30 [deg]` or `angle (0, 0, pi/6)`.
#pragma once
#include <array>

#include <continuo/language/check/expressions/expressions.hpp>
#include <continuo/language/check/world/world_numbers.hpp>

namespace continuo::model::detail {

/// How a body stands and turns at the start: an angle and one spin in the plane, in space a quaternion and three.
struct Turn {
  std::array<NodeId, 4> orientation;
  NodePoint spin;
};

/// A point turned by an angle of the plane, or by a unit quaternion.
[[nodiscard]] NodePoint turned(Graph& graph, const NodePoint& point, const std::array<NodeId, 4>& orientation,
                               int dimension);

class Turns {
 public:
  Turns(Expressions& expressions, WorldAtWork& work)
      : expressions_(expressions),
        report_(expressions.report),
        graph_(expressions.workspace.graph),
        text_(expressions.workspace.declared.world),
        work_(work),
        numbers_(expressions, work) {}

  /// By the attributes `angle`, `axis` and `spin`.
  [[nodiscard]] Turn turn_of(const ast::WorldAttributes& attributes, Scope& scope) const;

 private:
  [[nodiscard]] NodePoint rotation_vector(const ast::WorldAttributes& attributes, Scope& scope) const;

  Expressions& expressions_;
  Report& report_;
  Graph& graph_;
  const WorldText& text_;
  WorldAtWork& work_;
  WorldNumbers numbers_;
};

}  // namespace continuo::model::detail
