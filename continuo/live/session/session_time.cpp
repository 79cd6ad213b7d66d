// continuo/live/session/session_time.cpp
// How the time that is shown advances.
#include <algorithm>
#include <cmath>
#include <limits>

#include <continuo/live/session.hpp>
#include <continuo/simulation/simulate.hpp>

namespace continuo::live {

namespace {

constexpr double part_for_steps = 0.9;     // of the time between two pictures
constexpr double rows_of_a_run = 1000;     // at high speed: what a curve of the whole run should have at least
constexpr double most_rows_at_once = 32;   // and a picture at most
constexpr double rows_of_a_step = 8;       // which has a curve of its own, of high order
constexpr double longest_single_step = 1;  // second

}  // namespace

void Session::turn() {
  const double wall = now_();
  if (playing_) play_on(wall);
  watch_hand(wall);
  publish();
  if ((state_changed_ || playing_) && wall - state_said_ >= 0.1) say_state();
}

void Session::play_on(double wall) {
  if (!until_event_) clock_.forgive(wall, cursor_);
  const double target = until_event_ ? std::numeric_limits<double>::infinity() : clock_.target(wall);
  const double before = cursor_;
  const Halt halt = go(target, wall + part_for_steps / rate_, until_event_);
  if (clock_.speed() <= 0 || until_event_) stride_ = std::max((cursor_ - before) / most_rows_at_once, 0.0);
  clock_.reached(wall, cursor_);
  if (halt == Halt::event || halt == Halt::ended) {
    playing_ = until_event_ = false;
    state_changed_ = true;
  }
}

/// Time between rows, where that is less than between pictures.
double Session::sample_every(double target) {
  if (!std::isfinite(target)) return stride_ > 0 ? stride_ : span_ / rows_of_a_run;
  const double way = target - cursor_;
  return way / std::clamp(std::ceil(way / (span_ / rows_of_a_run)), 1.0, most_rows_at_once);
}

/// Time between rows, at least, that are looked at for a curve that bends between two pictures. The path of bodies is
/// known at the ends of their steps only.
double Session::finest_rows(double target) const {
  constexpr double most_looks = 64;  // for a picture
  if (!main_->equations() || bends_.too_wide() || !std::isfinite(target))
    return std::numeric_limits<double>::infinity();
  return (target - cursor_) / most_looks;
}

bool Session::ask_for_step(double wanted) {
  if (main_over_) return false;
  step_begin_ = main_->t();
  main_over_ = !main_->advance(wanted);
  next_passed_ = 0;
  return true;
}

/// The ghost comes along as far as `stop`, or as there is time for: then `stop` is there.
void Session::lead_ghost(double& stop, double deadline) {
  while (ghost_ && ghost_->t() < stop) {
    if (!ghost_->advance(stop) && ghost_->t() < stop) {
      if (!succeeded(ghost_->outcome().ending)) {
        model::Diagnostic why = why_failed(*ghost_);
        why.severity = model::Severity::warning;  // the motion itself goes on
        say(why);
      }
      say_note("the ghost has come to its end: " + std::string(to_string(ghost_->outcome().ending)));
      ghost_.reset();
      settings_.ghost.reset();
      state_changed_ = true;
      return;
    }
    if (now_() > deadline && ghost_->t() < stop) {
      stop = ghost_->t();
      return;
    }
  }
}

Session::Halt Session::go(double target, double deadline, bool to_event) {
  constexpr unsigned look_at_clock_every = 8;
  const double every = sample_every(target);
  const double finest = finest_rows(target);
  double next_sample = cursor_ + every, shown = cursor_, looked = cursor_;
  Halt halt = Halt::target;
  for (unsigned count = 1; cursor_ < target; ++count) {
    if (count % look_at_clock_every == 0 && now_() > deadline) {
      halt = Halt::deadline;
      break;
    }
    const bool pending = next_passed_ < main_->passed().size();
    if (!pending && main_->t() <= cursor_ && !ask_for_step(std::min(target, next_sample))) {
      halt = Halt::ended;
      break;
    }
    double stop = std::min({target, next_sample, main_->t()});
    const double look = looked + std::max(finest, (main_->t() - step_begin_) / rows_of_a_step);
    if (look < stop) stop = look;
    if (next_passed_ < main_->passed().size()) stop = std::min(stop, main_->passed()[next_passed_].t);
    lead_ghost(stop, deadline);
    if (next_passed_ < main_->passed().size() && stop == main_->passed()[next_passed_].t) {
      const Passed& passed = main_->passed()[next_passed_++];
      cursor_ = stop;
      if (pass(passed)) shown = looked = stop;
      if (to_event && !passed.names.empty()) {
        if (cursor_ > shown) emit(main_->instant_at(cursor_));
        return Halt::event;
      }
      continue;
    }
    cursor_ = std::max(cursor_, stop);
    if (cursor_ >= next_sample && cursor_ > shown) {
      emit(main_->instant_at(cursor_, keeps_whole(cursor_)));
      shown = looked = cursor_;
      next_sample = cursor_ + every;
    } else if (cursor_ >= look) {
      consider(cursor_);
      looked = cursor_;
    }
  }
  if (cursor_ > shown) emit(main_->instant_at(cursor_, keeps_whole(cursor_)));
  if (halt == Halt::ended) end_run();
  return halt;
}

/// True where it left a row: contacts of bodies do not.
bool Session::pass(const Passed& passed) {
  constexpr std::size_t most_at_once = 200;
  for (const Passed::Name& name : passed.names) {
    if (slice_->events.size() < most_at_once) slice_->events.push_back({passed.t, name.event, name.mark});
  }
  changed_ = true;
  if (passed.after.empty()) return false;
  Instant after;
  if (main_->world()) {  // where events are the end of a step
    after = main_->instant_at(passed.t);
  } else {
    after.t = passed.t;
    after.x = passed.after;
    after.mode = passed.mode;
    after.stops = passed.stops;
  }
  if (passed.before != passed.after) {
    std::optional<Instant> ghost;
    if (ghost_) ghost = ghost_->instant_at(passed.t);
    add_row(passed.t, passed.before, ghost ? &*ghost : nullptr);
  }
  emit(std::move(after));
  return true;
}

void Session::end_run() {
  const Outcome<double>& outcome = main_->outcome();
  playing_ = until_event_ = false;
  state_changed_ = true;
  if (outcome.ending == Ending::stopped_by_event) {
    const std::string& text = main_->stop_text();
    ended_ = text.empty() ? outcome.event : text;
    return;
  }
  const model::Diagnostic problem = why_failed(*main_);
  ended_ = problem.message;
  say(problem);
}

model::Diagnostic Session::why_failed(const Track& track) const {
  return track.world() ? model::error("", {}, track.stop_text()) : failure(shown_->model(), track.outcome());
}

void Session::step() {
  if (looking_) {
    if (*looking_ + 1 < history_.size()) look_at(*looking_ + 1);
    return;
  }
  playing_ = until_event_ = false;
  state_changed_ = true;
  if (main_->t() <= cursor_ && next_passed_ >= main_->passed().size()) {
    const double picture = clock_.speed() > 0 ? clock_.speed() / rate_ : span_ / rows_of_a_run;
    if (!ask_for_step(cursor_ + picture)) return;
  }
  const double target = main_->t();
  if (target > cursor_) go(target, now_() + longest_single_step, true);
  if (main_over_ && cursor_ >= main_->t() && next_passed_ >= main_->passed().size() && ended_.empty()) end_run();
}

void Session::play() {
  if (looking_) leave_look();
  if (!ended_.empty()) return say_note("this run has ended", "reset, go back, or change something");
  playing_ = true;
  until_event_ = false;
  state_changed_ = true;
  restart_clock();
}

void Session::pause() {
  playing_ = until_event_ = false;
  state_changed_ = true;
}

void Session::until_event() {
  if (shown_->model().event_order.empty() && !main_->world()) return say_note("this model has no events");
  play();
  until_event_ = playing_;
}

void Session::set_speed(double speed) {
  clock_.set_speed(now_(), cursor_, std::clamp(speed, 0.0, 1e300));
  state_changed_ = true;
}

}  // namespace continuo::live
