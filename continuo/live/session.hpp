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

class Session {
 public:
  using Now = WallClock;

  Session(Now now, Audience& audience, Place place);
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;

  /// Reads the file of the place, or what is wrong with it: then there is nothing to show.
  model::Loaded open_file();
  [[nodiscard]] bool is_open() const { return playback_.shown() != nullptr; }
  /// Why there is nothing to show.
  [[nodiscard]] const std::vector<model::Diagnostic>& problems() const { return notices_.problems(); }

  /// What is due by the clock; publishes what there is to see.
  void turn();
  /// Pictures a second, 1 to 120.
  void set_rate(double pictures) { playback_.set_rate(pictures); }

  // What hands do.
  void play() { playback_.play(); }
  void pause() { playback_.pause(); }
  void step();
  void back() { playback_.back(); }
  void reset();
  void until_event() { playback_.until_event(); }
  void seek(double t) { playback_.seek(t); }
  void set_speed(double speed) { playback_.set_speed(speed); }
  void set_parameter(const std::string& name, double value);
  void restore_parameters();
  void move_input(const std::string& name, double value) { interaction_.move_input(name, value); }
  /// False where the model cannot be run so: `problems` says why.
  bool take_method(MethodChoice choice) { return interaction_.take_method(std::move(choice)); }
  void take_ghost(std::optional<MethodChoice> choice) { interaction_.take_ghost(std::move(choice)); }
  void undo();
  void drag(std::size_t item, std::span<const double> to) { drag_.move(item, to); }
  void drag_body(std::size_t body, std::span<const double> to) { drag_.move_body(body, to); }
  /// What was in the hand goes on as fast as the hand went, or `still`.
  void release(bool still = false) { drag_.release(still); }
  void pick(std::size_t body);
  void open_gallery(const std::string& name);
  void run_text(const std::string& text);
  void save_text(const std::string& text);

  [[nodiscard]] bool playing() const { return playback_.playing(); }
  [[nodiscard]] bool has_ended() const { return !playback_.ended().empty(); }
  [[nodiscard]] double shown_time() const { return playback_.shown_time(); }
  /// Where the run of the text ends; the view goes on.
  [[nodiscard]] double planned_end() const { return playback_.main().plan().to; }
  [[nodiscard]] const LiveModel& shown() const { return *playback_.shown(); }
  [[nodiscard]] const History& history() const { return playback_.history(); }
  [[nodiscard]] const PacedClock& clock() const { return playback_.clock(); }
  /// Null without bodies.
  [[nodiscard]] const worlds::WorldRun* world() const { return playback_.main().world(); }
  /// For those who come later.
  [[nodiscard]] std::string model_json() const;
  [[nodiscard]] std::string state_json() const;

 private:
  bool begin(model::Model model, ModelText text);
  bool load_anew(const std::string& text);
  void load_anew_after(Change change);
  bool begin_run(std::shared_ptr<const LiveModel> shown);
  void publish();
  void say_model();
  void say_state();

  Now now_;
  Audience& audience_;
  Place place_;
  ModelText text_;  // that is open

  // Each uses those before it.
  Notices notices_;
  PendingSlice pending_;
  Rows rows_;
  Playback playback_;
  MouseDrag drag_;
  Interaction interaction_;
  Scene scene_;

  std::uint32_t run_ = 0;
  double state_said_ = -1e300;  // when
};

}  // namespace continuo::live
