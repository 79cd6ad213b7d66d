// continuo/live/session/mouse_drag.hpp
// Things of the drawing and bodies that the mouse holds, moves and lets go: they fly on as fast as the hand moved.
//
//   MouseDrag drag(now, playback, notices);
//   drag.show();                                   // of each run
//   drag.move(item, to);  drag.watch(now());  ...  drag.release();
#pragma once
#include <cstddef>
#include <deque>
#include <optional>
#include <span>
#include <vector>

#include <continuo/live/motion/clock.hpp>
#include <continuo/live/motion/drag_target.hpp>
#include <continuo/live/session/live_evaluation.hpp>
#include <continuo/live/session/notices.hpp>
#include <continuo/live/session/playback.hpp>

namespace continuo::live {

class MouseDrag {
 public:
  /// The arguments outlive it.
  MouseDrag(const WallClock& now, Playback& playback, Notices& notices)
      : now_(now), playback_(playback), notices_(notices) {}

  /// A run has begun: nothing is held.
  void begin();
  /// The program of the run has been made anew.
  void show();

  /// A point of the drawing towards `to`: the states that it depends on are moved, and stand still until it is let go.
  void move(std::size_t item, std::span<const double> to);
  /// A body, as near to `to` as others leave it room.
  void move_body(std::size_t body, std::span<const double> to);
  /// Releases the held object, which continues with the velocity of the mouse, or at rest if `still`.
  void release(bool still);
  /// Records the position of the held object, at each turn.
  void watch(double wall);

 private:
  struct InHand {
    double wall, t;
    std::vector<double> x;  // the states that the hand moves, or the place of the body
  };

  const DragTarget& held_target() const { return playback_.shown()->drag_targets[target_]; }
  std::vector<double> speed_of_hand() const;
  void stop_at_guards(const DragTarget& target, const std::vector<double>& from, std::vector<double>& to) const;
  void hold_body(std::optional<HeldBody> held);

  const WallClock& now_;
  Playback& playback_;
  Notices& notices_;
  std::vector<LiveEvaluation> targets_;  // by LiveModel::drag_targets
  std::size_t target_ = 0;               // that of the states that are held, playback_.held_states()
  std::optional<HeldBody> body_;         // that is held
  std::deque<InHand> in_hand_;           // of the last moments
};

}  // namespace continuo::live
