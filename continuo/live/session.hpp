// continuo/live/session.hpp
// A model that moves while somebody looks at it: plays, pauses, steps, goes back; parameters, inputs, methods and the
// mouse change it at the instant that is shown. One thread, and a clock from outside.
//
//   Session session(now, audience, {.path = "models/pendulum.sim"});
//   if (!session.open_file()) ...;
//   session.play();
//   for (;;) session.turn();                       // 60 times a second
#pragma once
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <continuo/language/load.hpp>
#include <continuo/live/audience.hpp>
#include <continuo/live/live_model.hpp>
#include <continuo/live/motion/clock.hpp>
#include <continuo/live/session/interaction.hpp>
#include <continuo/live/session/mouse_drag.hpp>
#include <continuo/live/session/notices.hpp>
#include <continuo/live/session/pending_slice.hpp>
#include <continuo/live/session/playback.hpp>
#include <continuo/live/session/rows.hpp>
#include <continuo/live/session/scene.hpp>
#include <continuo/live/settings.hpp>

namespace continuo::live {

/// A running model with its history, changed by commands. One thread at a time.
class Session {
 public:
  using Now = WallClock;

  /// Nothing is opened yet. `now` gives wall time in seconds; the audience must outlive the session.
  Session(Now now, Audience& audience, Place place);
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;

  /// Reads the file of the place, or what is wrong with it: then there is nothing to show. Where the place names none,
  /// the first model of its gallery is opened.
  model::Loaded open_file();
  /// Shows a text that is wrong, with its mistakes and with nothing that moves, until `run_text` brings a better one.
  void open_mistaken(const model::Loaded& loaded);
  /// Whether a model is shown.
  [[nodiscard]] bool is_open() const { return playback_.shown() != nullptr; }
  /// Why there is nothing to show.
  [[nodiscard]] const std::vector<model::Diagnostic>& problems() const { return notices_.problems(); }

  /// What is due by the clock; publishes what there is to see.
  void turn();
  /// From any thread: gives up the step that is being computed, so that `turn` and `step` return soon and a command can
  /// be obeyed. The motion stands where that step began, and does not advance before `forget_interrupt`.
  void interrupt() { playback_.interrupt().request(); }
  /// What was given up may be begun again.
  void forget_interrupt() { playback_.interrupt().forget(); }
  /// Pictures a second, 1 to 120.
  void set_rate(double pictures) { playback_.set_rate(pictures); }

  // What hands do.
  /// The commands of the same names in docs/protocol.md: play, pause, one step, one step back, begin again, play to the
  /// next event.
  /// @{
  void play() { playback_.play(); }
  void pause() { playback_.pause(); }
  void step();
  void back() { playback_.back(); }
  void reset();
  void until_event() { playback_.until_event(); }
  /// @}
  /// Shows an instant of the history; `play` continues from it and discards the later part.
  void seek(double t) { playback_.seek(t); }
  /// Sets the speed as a multiple of real time; 0: as fast as possible.
  void set_speed(double speed) { playback_.set_speed(speed); }
  /// Changes a parameter at the instant that is shown. An unknown name is reported to the audience.
  void set_parameter(const std::string& name, double value);
  /// Gives all parameters and inputs the values of the text.
  void restore_parameters();
  /// Moves an input, which no longer follows its file.
  void move_input(const std::string& name, double value) { interaction_.move_input(name, value); }
  /// False where the model cannot be run so: `problems` says why.
  bool take_method(MethodChoice choice) { return interaction_.take_method(std::move(choice)); }
  /// Runs another method beside the first; nothing ends that.
  void take_ghost(std::optional<MethodChoice> choice) { interaction_.take_ghost(std::move(choice)); }
  /// Takes back the last change of settings, up to 200 of them.
  void undo();
  /// Moves a shape of the drawing towards a point, until `release`.
  void drag(std::size_t item, std::span<const double> to) { drag_.move(item, to); }
  /// Moves a body towards a point, until `release`.
  void drag_body(std::size_t body, std::span<const double> to) { drag_.move_body(body, to); }
  /// What was in the hand goes on as fast as the hand went, or `still`.
  void release(bool still = false) { drag_.release(still); }
  /// Tells the audience the values of a body.
  void pick(std::size_t body);
  /// Opens a model of the gallery by its name.
  void open_gallery(const std::string& name);
  /// Reads a text as the model, as if it stood in the file that is open, and begins it. Where it is wrong, the present
  /// model stays.
  void run_text(const std::string& text);
  /// Writes the text to the file of the place. Any other file is refused.
  void save_text(const std::string& text);

  /// Whether the motion advances.
  [[nodiscard]] bool playing() const { return playback_.playing(); }
  /// Whether the run has come to its end.
  [[nodiscard]] bool has_ended() const { return !playback_.ended().empty(); }
  /// The time that is shown, in the model's unit of time.
  [[nodiscard]] double shown_time() const { return playback_.shown_time(); }
  /// Where the run of the text ends; the view goes on.
  [[nodiscard]] double planned_end() const { return playback_.main().plan().to; }
  /// The model that is shown; `is_open` must be true.
  [[nodiscard]] const LiveModel& shown() const { return *playback_.shown(); }
  /// The instants to which the session can go back.
  [[nodiscard]] const History& history() const { return playback_.history(); }
  /// The clock that maps wall time to time of the model.
  [[nodiscard]] const PacedClock& clock() const { return playback_.clock(); }
  /// Null without bodies.
  [[nodiscard]] const worlds::WorldRun* world() const { return playback_.main().world(); }
  /// For those who come later.
  [[nodiscard]] std::string model_json() const;
  /// The message `state` of docs/protocol.md, for clients that join later.
  [[nodiscard]] std::string state_json() const;

 private:
  bool begin(model::Model model, ModelText text, std::vector<model::Diagnostic> mistakes = {});
  bool load_anew(const std::string& text);
  void load_anew_after(Change change);
  bool begin_run(std::shared_ptr<const LiveModel> shown);
  void publish();
  void say_model();
  void say_state();

  Now now_;
  Audience& audience_;
  Place place_;
  ModelText text_;                           // that is open
  std::vector<model::Diagnostic> mistakes_;  // of that text

  // Each uses those before it.
  Notices notices_;
  PendingSlice pending_;
  Rows rows_;
  Playback playback_;
  MouseDrag drag_;
  Interaction interaction_;
  Scene scene_;

  std::uint32_t run_ = 0;
  double state_said_ = -1e300;         // when
  std::optional<double> played_at_{};  // the wall time of the last turn, if it played
  bool takes_long_ = false;            // a turn that plays, which is one of a heavy step
};

}  // namespace continuo::live
