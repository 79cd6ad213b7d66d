// continuo/language/check/world/materials.hpp
// The materials of surfaces: restitution, friction and rolling resistance.
#pragma once
#include <continuo/language/check/world/world_numbers.hpp>

namespace continuo::model::detail {

/// That of the world, but for what the attributes say.
[[nodiscard]] MaterialDescription material_of(const ast::WorldAttributes& attributes, Scope& scope,
                                              const WorldAtWork& work, const WorldNumbers& numbers);

}  // namespace continuo::model::detail
