// The exact motion under forces as a machine of states, and the one table of which event leads from which to which.
// What is done in each is in constrained_motion.cpp, a function per state.
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
  none_consistent,  // no set of them was found in which no contact pulls and none sinks in
  contact_changes,  // two come to touch, a contact lets go or begins to slip, or the candidates are to be listed anew
  too_many_events,  // flights are shorter than steps, again and again: inelastic collapse
  stepped,          // a step was made, more are to follow
  steps_made,       // so many that flights are tried again
  nothing_moves,    // nor begins to
  left_room,        // a body has gone as far as the caller allows, or nothing moves and the caller wants to know
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

/// Where an event leads; an event that a state cannot have ends the call.
[[nodiscard]] constexpr MotionState next_state(MotionState state, MotionEvent event) {
  const auto is_meant = [&](const MotionTransition& one) { return one.from == state && one.event == event; };
  const auto found = std::ranges::find_if(motion_transitions, is_meant);
  return found != motion_transitions.end() ? found->to : MotionState::ended;
}

static_assert(std::ranges::all_of(motion_transitions, [](const MotionTransition& one) {
  return next_state(one.from, one.event) == one.to;  // no event leads from one state to two
}));

}  // namespace continuo
