// continuo/simulation/program/event_names.hpp
// The events of one instant as a reader knows them: by their names in the text, with the marks that they have reached.
#pragma once
#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include <continuo/simulation/program/model_events.hpp>

namespace continuo::model {

struct EventName {
  std::string event;
  std::string mark;  // the text of a `mark` among its actions; empty for none
};

/// Follows one source of events, and is asked at every instant at which some of them fire.
class EventNames {
 public:
  /// Of the text's events among those that fired, and, `with_slides`, where the motion begins to slide along a surface
  /// or leaves it. Steps of inputs and other jumps of the equations have no name. They stay until the next call.
  [[nodiscard]] const std::vector<EventName>& of(const ModelEvents& events, std::span<const std::size_t> fired,
                                                 bool with_slides = false);
  /// How many marks the source had at the last instant.
  [[nodiscard]] std::size_t marks_seen() const { return marks_seen_; }
  /// The source has been read from a checkpoint, where so many marks had been seen.
  void see(std::size_t marks) { marks_seen_ = marks; }
  /// The source has been made anew.
  void restart() { marks_seen_ = 0; }

 private:
  std::size_t marks_seen_ = 0;
  std::vector<EventName> names_;  // kept from instant to instant for its memory
};

}  // namespace continuo::model
