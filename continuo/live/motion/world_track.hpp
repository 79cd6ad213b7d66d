// continuo/live/motion/world_track.hpp
// Bodies as a Track. Contacts are its events; the `when` of a text are not looked for.
#pragma once
#include <memory>

#include <continuo/live/motion/track.hpp>

namespace continuo::live {

Result<std::unique_ptr<Track>> make_world_track(const std::shared_ptr<const model::ModelProgram>& program,
                                                const model::Plan& plan);

/// How much of the way of a body is free: 1, or less where it would come to overlap another or a wall.
double free_part(const worlds::WorldRun& run, std::size_t body, const worlds::Point& to);

}  // namespace continuo::live
