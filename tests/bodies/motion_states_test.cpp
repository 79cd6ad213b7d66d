// The state machine of the exact motion under forces: its table of transitions.
#include <algorithm>
#include <set>

#include <gtest/gtest.h>

#include <continuo/bodies/constrained/motion_states.hpp>

namespace continuo::motion_states_test {
namespace {

std::set<MotionState> reached_from(MotionState first) {
  std::set<MotionState> reached{first};
  for (std::size_t before = 0; before != reached.size();) {
    before = reached.size();
    for (const MotionTransition& one : motion_transitions)
      if (reached.contains(one.from)) reached.insert(one.to);
  }
  return reached;
}

TEST(MotionStates, AllAreReachedFromTheImpactsOfAnInstant) {
  using enum MotionState;
  EXPECT_EQ(reached_from(impacts), (std::set{impacts, free_flight, persistent_contact, contact_steps, at_rest, ended}));
}
TEST(MotionStates, EachCanEndTheCall) {
  for (const MotionTransition& one : motion_transitions) {
    EXPECT_TRUE(reached_from(one.from).contains(MotionState::ended));
    EXPECT_EQ(next_state(one.from, MotionEvent::failed), MotionState::ended);
  }
}
TEST(MotionStates, NothingWakesWhatIsAtRest) {
  using enum MotionState;
  EXPECT_EQ(reached_from(at_rest), (std::set{at_rest, ended}));
}
TEST(MotionStates, AnEventThatAStateCannotHaveEndsTheCall) {
  EXPECT_EQ(next_state(MotionState::at_rest, MotionEvent::no_contact), MotionState::ended);
}

}  // namespace
}  // namespace continuo::motion_states_test
