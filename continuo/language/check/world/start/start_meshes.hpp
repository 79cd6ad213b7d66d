// Meshes and chains with the parameters as the text has them, and the bodies that begin within or behind them.
#pragma once
#include <span>

#include <continuo/language/check/names/report.hpp>
#include <continuo/language/check/world/start/start_shapes.hpp>
#include <continuo/language/model.hpp>
#include <continuo/language/world.hpp>

namespace continuo::model::detail {

/// E225 for a surface that cannot be, E295 for a body that begins within one, or above its back.
void look_at_meshes(const Model& model, const WorldDescription& made, const StartShapes& starts,
                    std::span<const double> variables, Report& report);

}  // namespace continuo::model::detail
