// The state machine of the exact motion under forces: its states, its events, and the table of its transitions.
// constrained_motion.hpp has a function for each state.
#pragma once
#include <algorithm>
#include <array>

namespace continuo {

enum class MotionState {
  impacts,             // of one instant: collisions, and which contacts persist after them
  free_flight,         // no contact persists: bodies follow the forces alone, by an error-controlled method
  persistent_contact,  // the same, with normal and friction forces that keep contacts closed
  contact_steps,       // steps of first order through all contacts together
  at_rest,             // nothing moves any more, for good
  ended                // the call
};

enum class MotionEvent {
  no_contact,       // after the impacts of an instant no contact persists
  contacts_press,   // some persist
  none_consistent,  // no contact forces were found with which none pulls and none sinks in
  contact_changes,  // two bodies begin to touch, a contact opens or begins to slip, or candidates are to be listed
  too_many_events,  // flights are shorter than steps, again and again: inelastic collapse
  stepped,          // a step was made, more are to follow
  steps_made,       // so many that flights are tried again
  nothing_moves,    // and nothing begins to move
  left_room,        // a body has left the range that the caller has set, or nothing moves within such a range
  time_reached,
  failed  // with a message
};

struct MotionTransition {
  MotionState from;
  MotionEvent event;
  MotionState to;
};

inline constexpr auto motion_transitions = [] {
  using enum MotionState;
  using enum MotionEvent;
  return std::to_array<MotionTransition>({
      {impacts, no_contact, free_flight},
      {impacts, contacts_press, persistent_contact},
      {impacts, none_consistent, contact_steps},
      {impacts, left_room, ended},
      {impacts, failed, ended},

      {free_flight, contact_changes, impacts},
      {free_flight, too_many_events, contact_steps},
      {free_flight, time_reached, ended},
      {free_flight, failed, ended},

      {persistent_contact, contact_changes, impacts},
      {persistent_contact, too_many_events, contact_steps},
      {persistent_contact, nothing_moves, at_rest},
      {persistent_contact, time_reached, ended},
      {persistent_contact, failed, ended},

      {contact_steps, stepped, contact_steps},
      {contact_steps, steps_made, impacts},
      {contact_steps, nothing_moves, at_rest},
      {contact_steps, left_room, ended},
      {contact_steps, time_reached, ended},
      {contact_steps, failed, ended},

      {at_rest, left_room, ended},
      {at_rest, time_reached, ended},
      {at_rest, failed, ended},
  });
}();

/// The state that follows an event. An event that is impossible in a state ends the call.
[[nodiscard]] constexpr MotionState next_state(MotionState state, MotionEvent event) {
  const auto is_meant = [&](const MotionTransition& one) { return one.from == state && one.event == event; };
  const auto found = std::ranges::find_if(motion_transitions, is_meant);
  return found != motion_transitions.end() ? found->to : MotionState::ended;
}

static_assert(std::ranges::all_of(motion_transitions, [](const MotionTransition& one) {
  return next_state(one.from, one.event) == one.to;  // no event leads from one state to two
}));

}  // namespace continuo
