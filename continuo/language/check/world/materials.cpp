// continuo/language/check/world/materials.cpp
// Restitution, friction and rolling resistance of a surface.
#include <continuo/language/check/world/attributes.hpp>
#include <continuo/language/check/world/materials.hpp>

namespace continuo::model::detail {

MaterialDescription material_of(const ast::WorldAttributes& attributes, Scope& scope, const WorldAtWork& work,
                                const WorldNumbers& numbers) {
  MaterialDescription material = work.material;
  const Measured pure = Measured::known(Unit());
  if (const auto* e = attribute(attributes, "restitution"))
    material.restitution = numbers.number(*e, scope, pure, "restitution", Sort::fraction);
  if (const auto* f = attribute(attributes, "friction"))
    material.friction = numbers.number(*f, scope, pure, "friction", Sort::not_negative);
  if (const auto* r = attribute(attributes, "rolling"))
    material.rolling = numbers.number(*r, scope, pure, "rolling resistance", Sort::not_negative);
  return material;
}

}  // namespace continuo::model::detail
