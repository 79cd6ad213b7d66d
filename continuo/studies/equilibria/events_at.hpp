// Which events of a model a point of its states has to do with: an equilibrium at which one fires, or that a motion
// cannot come to without meeting one, is no equilibrium of the model as it is.
#pragma once
#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include <continuo/simulation/program/model_program.hpp>

namespace continuo::studies {

struct EventAt {
  enum class Where {
    on_surface,  // neighbours on one side meet it
    beyond,      // on the side to which the event is passed; of a condition, it holds
  };
  std::string event;  // by its name: "T rises through high"
  Where where;
  bool is_condition;
};

/// Of the events that are watched in the mode and change something. Those that watch both directions are only met on
/// their surface.
[[nodiscard]] std::vector<EventAt> events_at(const model::ModelProgram& program, std::size_t mode,
                                             std::span<const double> x, const model::Overrides& parameters = {});

}  // namespace continuo::studies
