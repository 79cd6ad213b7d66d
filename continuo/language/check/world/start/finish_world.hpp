// continuo/language/check/world/start/finish_world.hpp
// The world of the model; and what of it is in order and yet seldom meant: groups without bodies, bodies that begin
// within each other.
#pragma once
#include <memory>

#include <continuo/language/check/names/declarations.hpp>
#include <continuo/language/check/names/report.hpp>
#include <continuo/language/check/world/world_at_work.hpp>

namespace continuo::model::detail {

/// Null where the model has no world. Warns of what it finds, of overlaps in a model without errors only.
[[nodiscard]] std::shared_ptr<const WorldDescription> finish_world(const WorldText& text, WorldAtWork world,
                                                                   const Model& model, Report& report);

}  // namespace continuo::model::detail
