// continuo/language/check/world/walls.cpp
// A wall is a half-space; its normal has a length.
#include <fmt/format.h>

#include <continuo/language/check/world/attributes.hpp>
#include <continuo/language/check/world/materials.hpp>
#include <continuo/language/check/world/walls.hpp>

namespace continuo::model::detail {

void Walls::add(const ast::WorldWall& wall, Scope& scope, Span span) {
  WallDescription made{.name = {},
                       .normal = {},
                       .offset = {},
                       .material = material_of(wall.attributes, scope, work_, numbers_),
                       .thin = attribute(wall.attributes, "thin") != nullptr,
                       .span = span};
  made.name = wall.name ? wall.name->text : fmt::format("wall {}", work_.made.walls.size() + 1);
  made.normal = numbers_.point(wall.normal, scope, Measured::unknown(), "the normal of a wall");
  made.offset = numbers_.number(wall.offset, scope, work_.length, "the place of a wall", Sort::any);
  NodeId square = graph_.constant(0);
  for (std::size_t axis = 0; axis < text_.axes() && made.normal[axis].valid(); ++axis)
    square = graph_.add(square, graph_.multiply(made.normal[axis], made.normal[axis]));
  if (made.normal[0].valid()) numbers_.expect(square, Sort::positive, wall.normal.span, "the length of a normal");
  work_.made.walls.push_back(std::move(made));
}

void Walls::add(const ast::WorldContainer& container, Scope& scope, Span span) {
  const NodePoint lower = numbers_.point(container.lower, scope, work_.length, "the corner of a container");
  const NodePoint upper = numbers_.point(container.upper, scope, work_.length, "the corner of a container");
  if (!lower[0].valid() || !upper[0].valid()) return;
  Graph& g = graph_;
  const MaterialDescription material = material_of(container.attributes, scope, work_, numbers_);
  const std::string name = container.name ? container.name->text : fmt::format("wall {}", work_.made.walls.size() + 1);
  for (std::size_t axis = 0; axis < text_.axes(); ++axis) {
    numbers_.expect(g.subtract(upper[axis], lower[axis]), Sort::positive,
                    cover(container.lower.span, container.upper.span), "the size of a container");
    for (const double side : {1.0, -1.0}) {
      WallDescription wall{.name = name, .normal = {}, .offset = {}, .material = material, .span = span};
      for (std::size_t k = 0; k < text_.axes(); ++k) wall.normal[k] = g.constant(k == axis ? side : 0);
      wall.offset = side > 0 ? lower[axis] : g.negate(upper[axis]);
      work_.made.walls.push_back(std::move(wall));
    }
  }
}

}  // namespace continuo::model::detail
