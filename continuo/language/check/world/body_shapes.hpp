// The shapes of bodies: balls, capsules, boxes and hulls, with their volumes.
#pragma once
#include <array>
#include <optional>

#include <continuo/language/check/expressions/expressions.hpp>
#include <continuo/language/check/world/world_numbers.hpp>

namespace continuo::model::detail {

/// What the attributes of a body say of its shape.
struct MadeShape {
  ShapeDescription shape{};
  NodeId radius, volume;           // as in BodyDescription; not valid where something is wrong
  NodeId height;                   // along the last axis; not valid of a hull
  std::array<double, 3> centre{};  // of mass, in the frame of the shape
};

class BodyShapes {
 public:
  BodyShapes(Expressions& expressions, WorldAtWork& work)
      : expressions_(expressions),
        report_(expressions.report),
        graph_(expressions.workspace.graph),
        text_(expressions.workspace.declared.world),
        work_(work),
        numbers_(expressions, work) {}

  [[nodiscard]] MadeShape make(const ast::WorldAttributes& attributes, Scope& scope) const;
  /// A capsule of these numbers, which are valid.
  [[nodiscard]] MadeShape capsule(NodeId radius, NodeId length) const;

 private:
  [[nodiscard]] bool is_one_shape(const ast::WorldAttributes& attributes) const;
  [[nodiscard]] MadeShape make_ball(const ast::WorldAttributes& attributes, Scope& scope) const;
  [[nodiscard]] MadeShape make_capsule(const ast::WorldAttributes& attributes, const ast::Expression& length,
                                       Scope& scope) const;
  [[nodiscard]] MadeShape make_box(const ast::WorldAttributes& attributes, const ast::Expression& size,
                                   Scope& scope) const;
  [[nodiscard]] MadeShape make_hull(const ast::WorldAttributes& attributes, const ast::Expression& points,
                                    const Scope& outer) const;
  template <int Dim>
  [[nodiscard]] MadeShape measured_hull(const ast::Expression& points, ShapeDescription shape, double rounding) const;
  [[nodiscard]] NodeId radius_of(const ast::WorldAttributes& attributes, Scope& scope) const;
  [[nodiscard]] NodeId ball_volume(NodeId radius) const;

  Expressions& expressions_;
  Report& report_;
  Graph& graph_;
  const WorldText& text_;
  WorldAtWork& work_;
  WorldNumbers numbers_;
};

}  // namespace continuo::model::detail
