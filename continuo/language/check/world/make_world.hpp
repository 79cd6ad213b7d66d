// continuo/language/check/world/make_world.hpp
// `world { ... }` made, but for its forces.
#pragma once
#include <continuo/language/check/expressions/expressions.hpp>
#include <continuo/language/check/world/world_at_work.hpp>

namespace continuo::model::detail {

/// Settings, bodies, walls, springs; the states of the world get initial values.
void make_world(Expressions& expressions, WorldAtWork& work, Model& model);

}  // namespace continuo::model::detail
