// continuo/live/session/playback.hpp
// The motion that is shown and its ghost, played as fast as the clock on the wall: pause, single steps, and the moments
// that have been shown, to look at again and to go on from.
//
//   Playback playback(now, notices, pending, rows);
//   playback.begin(shown, std::move(track), nullptr);
//   playback.play();
//   for (;;) playback.play_on(now());             // 60 times a second
//
// A track makes one step after another. The instants of a step that are wanted, and its events, are shown in order,
// each with a row of the curves and a moment of the history. Changes take effect at the instant that is shown, t(): the
// tracks are put back to it.
#pragma once
#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <continuo/live/live_model.hpp>
#include <continuo/live/motion/clock.hpp>
#include <continuo/live/motion/history.hpp>
#include <continuo/live/motion/track.hpp>
#include <continuo/live/session/notices.hpp>
#include <continuo/live/session/pending_slice.hpp>
#include <continuo/live/session/rows.hpp>

namespace continuo::live {

class Playback {
 public:
  /// The arguments outlive the playback.
  Playback(const WallClock& now, Notices& notices, PendingSlice& pending, Rows& rows)
      : now_(now), notices_(notices), pending_(pending), rows_(rows) {}

  /// A run begins, with a ghost or without; it plays on if one did before.
  void begin(std::shared_ptr<const LiveModel> shown, std::unique_ptr<Track> main, std::unique_ptr<Track> ghost);

  // Time and pace.
  void set_rate(double pictures) { rate_ = pictures; }
  void set_speed(double speed);
  void play();
  void pause();
  void until_event();
  void step();
  /// What is due at this time on the wall, if it plays.
  void play_on(double wall);

  /// When it is requested, play_on and step return soon; until it is forgotten nothing advances. For the tracks that
  /// are made for this playback.
  StepInterrupt& interrupt() { return interrupt_; }

  // The past.
  void back();
  void seek(double t);
  /// The moment that is looked at becomes the present: what came later is forgotten.
  void leave_look();

  // Changes of what is shown; leave_look comes first.
  /// Sets parameters and inputs, which take effect with go_on.
  void use(Variables variables);
  /// Sets the states that stand still, which they do from go_on on.
  void hold_states(std::vector<std::size_t> held) { held_states_ = std::move(held); }
  /// The run goes on from the instant that is shown.
  void go_on();
  /// The run goes on from `changed`. The ghost gets the mode of `changed`, and its values of the states `of_ghost_too`.
  void go_on_from(const Instant& changed, std::span<const std::size_t> of_ghost_too = {});
  /// The motion goes on by another method.
  void change_main(std::unique_ptr<Track> main);
  /// Another ghost begins where the motion is; null takes the ghost away.
  void change_ghost(std::unique_ptr<Track> ghost);
  /// The motion goes on with its program made anew.
  void change_program(std::shared_ptr<const LiveModel> shown, Variables variables, std::unique_ptr<Track> main,
                      std::unique_ptr<Track> ghost);
  /// A body stays where the mouse is; empty: none is held.
  void hold_body(std::optional<HeldBody> held);
  /// A body that was held goes on with this velocity.
  void let_go(std::size_t body, const worlds::Point& velocity);

  /// Null before the first run.
  const std::shared_ptr<const LiveModel>& shown() const { return shown_; }
  const Variables& variables() const { return variables_; }
  std::span<const std::size_t> held_states() const { return held_states_; }
  const Track& main() const { return *main_; }
  /// Null without a ghost.
  const Track* ghost() const { return ghost_.get(); }
  /// The time that the motion has been shown to.
  double t() const { return cursor_; }
  /// The time of the moment that is looked at; t() where none is.
  double shown_time() const { return looking_ ? history_[*looking_].main.t : cursor_; }
  /// Everything that is needed to go on from t(); with `whole` false only to look at it.
  Instant instant(bool whole = true) const { return main_->instant_at(cursor_, whole); }
  bool playing() const { return playing_; }
  /// Why the run is over; empty while it is not.
  const std::string& ended() const { return ended_; }
  /// How long the text's run takes.
  double span() const { return span_; }
  const PacedClock& clock() const { return clock_; }
  const History& history() const { return history_; }
  bool looks_back() const { return looking_.has_value(); }
  /// The moment that is shown.
  const Sample& sample() const { return looking_ ? history_[*looking_] : newest_; }
  /// The moment that is looked at, or the last that can be; null before there is one.
  const Sample* kept_sample() const {
    if (looking_) return &history_[*looking_];
    return history_.empty() ? nullptr : &history_.back();
  }
  /// Whether the audience should be told anew whether it plays, how it ended and what moves.
  bool state_has_changed() const { return state_changed_; }
  void forget_state_change() { state_changed_ = false; }

 private:
  enum class Halt { target, deadline, event, ended };

  Halt go(double target, double deadline, bool to_event);
  double sample_every(double target) const;
  double finest_rows(double target) const;
  bool has_event_ahead() const { return next_passed_ < main_->passed().size(); }
  bool ask_for_step(double wanted);
  void lead_ghost(double& stop, double deadline);
  bool pass(const Passed& passed);
  void emit(Instant main);
  void consider(double t);
  bool keeps_whole(double t) const;
  void end_run();
  model::Diagnostic why_failed(const Track& track) const;
  void look_at(std::size_t i);
  void rewind_to(double t);
  void restart_clock() { clock_.start(now_(), cursor_); }
  Status put(Track& track, const Instant& instant) const;
  /// As `put`. A track that cannot go on fails again when it is asked to advance, and its failure is told then.
  void bring(Track& track, const Instant& instant) const;
  void resume(const Instant& instant);
  void show_again();

  const WallClock& now_;
  Notices& notices_;
  PendingSlice& pending_;
  Rows& rows_;

  std::shared_ptr<const LiveModel> shown_;
  Variables variables_;
  std::vector<std::size_t> held_states_;
  StepInterrupt interrupt_;
  std::unique_ptr<Track> main_, ghost_;

  PacedClock clock_;
  double rate_ = 60, span_ = 1;
  double cursor_ = 0;            // the time that has been shown
  double step_begin_ = 0;        // of main_
  std::size_t next_passed_ = 0;  // of main_->passed()
  bool main_over_ = false, playing_ = false, until_event_ = false;
  std::string ended_;
  double stride_ = 0;  // of samples, at unlimited speed

  History history_;
  Sample newest_;  // of what has been shown, in the history or not
  std::optional<std::size_t> looking_;
  bool state_changed_ = false;
};

}  // namespace continuo::live
