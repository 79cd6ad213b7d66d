// continuo/live/session.hpp
// A model that moves while somebody looks at it: plays, pauses, steps, goes back; parameters, inputs, methods and the
// mouse change it at the instant that is shown. One thread, and a clock from outside.
//
//   Session session(now, audience, {.path = "models/pendulum.sim"});
//   if (!session.open_file()) ...;
//   session.play();
//   for (;;) session.turn();                       // 60 times a second
#pragma once
#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <continuo/language/load.hpp>
#include <continuo/live/audience.hpp>
#include <continuo/live/live_model.hpp>
#include <continuo/live/motion/clock.hpp>
#include <continuo/live/motion/history.hpp>
#include <continuo/live/motion/rows.hpp>
#include <continuo/live/motion/track.hpp>
#include <continuo/live/settings.hpp>

namespace continuo::live {

class Session {
 public:
  using Now = std::function<double()>;  // seconds, never backwards

  Session(Now now, Audience& audience, Place place);

  /// Reads the file of the place, or what is wrong with it: then there is nothing to show.
  model::Loaded open_file();
  bool is_open() const { return shown_ != nullptr; }
  /// Why there is nothing to show.
  const std::vector<model::Diagnostic>& problems() const { return problems_; }

  /// What is due by the clock; publishes what there is to see.
  void turn();
  /// Pictures a second, 1 to 120.
  void set_rate(double pictures) { rate_ = pictures; }

  // What hands do.
  void play();
  void pause();
  void step();
  void back();
  void reset();
  void until_event();
  void seek(double t);
  void set_speed(double speed);
  void set_parameter(const std::string& name, double value);
  void restore_parameters();
  void move_input(const std::string& name, double value);
  /// False where the model cannot be run so: `problems` says why.
  bool take_method(MethodChoice choice);
  void take_ghost(std::optional<MethodChoice> choice);
  void undo();
  void drag(std::size_t item, std::span<const double> to);
  void drag_body(std::size_t body, std::span<const double> to);
  /// What was in the hand goes on as fast as the hand went, or `still`.
  void release(bool still = false);
  void pick(std::size_t body);
  void open_gallery(const std::string& name);
  void run_text(const std::string& text);
  void save_text(const std::string& text);

  bool playing() const { return playing_; }
  bool has_ended() const { return !ended_.empty(); }
  double shown_time() const { return looking_ ? history_[*looking_].main.t : cursor_; }
  /// Where the run of the text ends; the view goes on.
  double planned_end() const { return main_->plan().to; }
  const LiveModel& shown() const { return *shown_; }
  const History& history() const { return history_; }
  const PacedClock& clock() const { return clock_; }
  /// Null without bodies.
  const worlds::WorldRun* world() const { return main_->world(); }
  /// For those who come later.
  std::string model_json() const;
  std::string state_json() const;

 private:
  enum class Halt { target, deadline, event, ended };

  // session_open.cpp
  bool begin(model::Model model, std::string path, std::string text);
  bool load_anew(const std::string& path, const std::string& text);
  bool begin_run();
  std::optional<model::Plan> plan_by(const MethodChoice& choice);
  std::unique_ptr<Track> track_by(const MethodChoice& choice);
  std::shared_ptr<const std::vector<double>> present_variables();

  // session_time.cpp
  void play_on(double wall);
  Halt go(double target, double deadline, bool to_event);
  bool ask_for_step(double wanted);
  void lead_ghost(double& stop, double deadline);
  bool pass(const Passed& passed);
  void end_run();
  model::Diagnostic why_failed(const Track& track) const;
  double sample_every(double target);
  double finest_rows(double target) const;
  void restart_clock() { clock_.start(now_(), cursor_); }

  // session_show.cpp
  void show_run();
  void emit(Instant main);

  // session_rows.cpp
  Row row_at(double t, const std::vector<double>& x, const Instant* ghost);
  void add_row(double t, const std::vector<double>& x, const Instant* ghost);
  void put(Row row);
  void put_unless_straight(const Row& next);
  void consider(double t);
  void append_values(double t, const std::vector<double>& x, double apart, std::vector<float>& row);
  void append_points(model::Evaluation& points, double t, const std::vector<double>& x, std::vector<float>& to);
  void use_variables(const std::shared_ptr<const std::vector<double>>& variables);
  double energy_of(double t, const std::vector<double>& x);
  void publish();
  std::shared_ptr<const Bodies> bodies_of(const Instant& instant) const;
  bool keeps_whole(double t) const;
  void rewind_to(double t);
  void say_model();
  void say_state();
  void say(const model::Diagnostic& problem, const model::Source* source = nullptr);
  void say_note(std::string text, std::string hint = {});

  // session_hands.cpp
  void look_at(std::size_t i);
  void leave_look();
  void touch(std::optional<Instant> changed = std::nullopt, const std::vector<std::size_t>& of_ghost_too = {});
  struct Undo {
    std::string what;
    double wall;
    Settings settings;
  };
  void remember_for_undo(const std::string& what, bool for_long = false);
  void keep_undo(Undo undo);
  void apply(const Settings& settings);
  void prepare_anew();
  std::string go_on(Track& track, const Instant& instant);
  bool change_method(MethodChoice choice);
  bool change_ghost(std::optional<MethodChoice> choice);

  // session_drag.cpp
  void hold_body(std::optional<HeldBody> held);
  struct InHand {
    double wall, t;
    std::vector<double> x;  // the states that the hand moves, or the place of the body
  };
  void watch_hand(double wall);
  std::vector<double> speed_of_hand() const;
  void stop_at_guards(const DragTarget& drag_target, const std::vector<double>& from, std::vector<double>& to);

  Now now_;
  Audience& audience_;
  Place place_;
  std::vector<model::Diagnostic> problems_;

  std::shared_ptr<const LiveModel> shown_;
  std::string path_, text_;
  Settings settings_;
  std::vector<Undo> undo_;

  PacedClock clock_;
  double rate_ = 60, span_ = 1;  // the length of the run in the text
  std::unique_ptr<Track> main_, ghost_;
  double cursor_ = 0;            // the time that has been shown
  std::size_t next_passed_ = 0;  // of main_->passed()
  bool main_over_ = false, playing_ = false, until_event_ = false;
  std::string ended_;
  double stride_ = 0;  // of samples, at unlimited speed
  History history_;
  Sample newest_;  // of what has been shown, in the history or not
  std::optional<std::size_t> looking_;

  std::shared_ptr<const std::vector<double>> variables_, evaluated_;  // as they are; those of the evaluations
  model::Evaluation quantities_, scene_, paths_;
  std::vector<model::Evaluation> drag_targets_;
  std::vector<double> values_;
  double first_energy_ = 0;
  std::vector<std::size_t> held_;
  std::size_t held_drag_target_ = 0;  // whose these are
  std::deque<InHand> in_hand_;

  std::optional<Row> last_row_;  // that was put
  std::vector<Row> between_;     // after it, that may be left out
  Bends bends_;
  double step_begin_ = 0;  // of main_

  std::uint32_t run_ = 0;
  std::shared_ptr<Slice> slice_;
  std::optional<HeldBody> held_body_;
  bool changed_ = false, state_changed_ = false;
  double state_said_ = -1e300;
};

}  // namespace continuo::live
