// How the time that is shown advances, stops and goes back.
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <continuo/live/session/playback.hpp>
#include <continuo/simulation/simulate.hpp>

namespace continuo::live {

namespace {

constexpr double part_for_steps = 0.9;     // of the time between two pictures
constexpr double rows_of_a_run = 1000;     // at high speed: what a curve of the whole run should have at least
constexpr double most_rows_at_once = 32;   // and a picture at most
constexpr double rows_of_a_step = 8;       // which has a curve of its own, of high order
constexpr double longest_single_step = 1;  // second
constexpr std::size_t few_states = 32;

const std::vector<double>* state_of(const std::optional<Instant>& instant) {
  return instant ? &instant->x : nullptr;
}

}  // namespace

void Playback::begin(std::shared_ptr<const LiveModel> shown, std::unique_ptr<Track> main,
                     std::unique_ptr<Track> ghost) {
  shown_ = std::move(shown);
  main_ = std::move(main);
  ghost_ = std::move(ghost);
  const model::Plan& plan = main_->plan();
  variables_ = std::make_shared<const std::vector<double>>(plan.variables);
  span_ = plan.to > plan.from ? plan.to - plan.from : 1;
  cursor_ = plan.from;
  next_passed_ = 0;
  stride_ = 0;
  main_over_ = until_event_ = false;
  ended_.clear();
  looking_.reset();
  held_states_.clear();
  history_.clear();
  pending_.clear();
  rows_.show(shown_, variables_);
  const Instant start = main_->instant_at(cursor_);
  rows_.measure_drift_from(cursor_, start.x);
  emit(start);
  restart_clock();
  state_changed_ = true;
}

// ---- the way to an instant ------------------------------------------------------------------------------------------

void Playback::play_on(double wall) {
  if (!playing_) return;
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
double Playback::sample_every(double target) const {
  if (!std::isfinite(target)) return stride_ > 0 ? stride_ : span_ / rows_of_a_run;
  const double way = target - cursor_;
  return way / std::clamp(std::ceil(way / (span_ / rows_of_a_run)), 1.0, most_rows_at_once);
}

/// Time between rows, at least, that are looked at for a curve that bends between two pictures. The path of bodies is
/// known at the ends of their steps only.
double Playback::finest_rows(double target) const {
  if (!main_->equations() || !std::isfinite(target)) return std::numeric_limits<double>::infinity();
  return rows_.finest_spacing(target - cursor_);
}

bool Playback::ask_for_step(double wanted) {
  if (main_over_) return false;
  step_begin_ = main_->t();
  main_over_ = !main_->advance(wanted) && !main_->was_interrupted();
  next_passed_ = 0;
  return true;
}

/// The ghost comes along as far as `stop`, or as there is time for: then `stop` is there.
void Playback::lead_ghost(double& stop, double deadline) {
  while (ghost_ && ghost_->t() < stop) {
    if (!ghost_->advance(stop) && ghost_->t() < stop) {
      if (ghost_->was_interrupted()) {
        stop = ghost_->t();
        return;
      }
      if (!succeeded(ghost_->outcome().ending)) {
        model::Diagnostic why = why_failed(*ghost_);
        why.severity = model::Severity::warning;  // the motion itself goes on
        notices_.say(why);
      }
      notices_.note("the ghost has come to its end: " + std::string(to_string(ghost_->outcome().ending)));
      ghost_.reset();
      state_changed_ = true;
      return;
    }
    if (now_() > deadline && ghost_->t() < stop) {
      stop = ghost_->t();
      return;
    }
  }
}

Playback::Halt Playback::go(double target, double deadline, bool to_event) {
  // To read the clock takes as long as a step of a few equations, and nothing beside one of many.
  const unsigned look_at_clock_every = shown_->model().states.size() < few_states ? 8 : 1;
  const double every = sample_every(target);
  const double finest = finest_rows(target);
  double next_sample = cursor_ + every, shown = cursor_, looked = cursor_;
  Halt halt = Halt::target;
  for (unsigned count = 1; cursor_ < target; ++count) {
    if (interrupt_.is_requested() || (count % look_at_clock_every == 0 && now_() > deadline)) {
      halt = Halt::deadline;
      break;
    }
    if (!has_event_ahead() && main_->t() <= cursor_ && !ask_for_step(std::min(target, next_sample))) {
      halt = Halt::ended;
      break;
    }
    double stop = std::min({target, next_sample, main_->t()});
    const double look = looked + std::max(finest, (main_->t() - step_begin_) / rows_of_a_step);
    if (look < stop) stop = look;
    if (has_event_ahead()) stop = std::min(stop, main_->passed()[next_passed_].t);
    lead_ghost(stop, deadline);
    if (has_event_ahead() && stop == main_->passed()[next_passed_].t) {
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
bool Playback::pass(const Passed& passed) {
  for (const model::EventName& name : passed.names) pending_.add(LiveEvent{passed.t, name.event, name.mark});
  pending_.mark_changed();
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
    rows_.add(passed.t, passed.before, state_of(ghost));
  }
  emit(std::move(after));
  return true;
}

/// A row, and a moment to go back to.
void Playback::emit(Instant main) {
  std::optional<Instant> ghost;
  if (ghost_) ghost = ghost_->instant_at(main.t, main.world != nullptr);
  rows_.add(main.t, main.x, state_of(ghost));
  const bool kept = !main_->world() || main.world;
  newest_ = {std::move(main), std::move(ghost), variables_, rows_.first_energy()};
  if (kept) history_.add(newest_);
}

/// Perhaps a row.
void Playback::consider(double t) {
  if (!rows_.has_last()) return;
  std::optional<Instant> ghost;
  if (ghost_) ghost = ghost_->instant_at(t, false);
  rows_.consider(t, main_->instant_at(t, false).x, state_of(ghost));
}

/// Of many bodies a moment is megabytes: some in a second are enough to go back to.
bool Playback::keeps_whole(double t) const {
  constexpr std::size_t many = 10'000;  // states
  constexpr double seconds = 0.25;
  if (!main_->world() || history_.empty() || shown_->model().states.size() < many) return true;
  return t >= history_.last_time() + seconds * std::max(clock_.speed(), 1e-9);
}

void Playback::end_run() {
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
  notices_.say(problem);
}

model::Diagnostic Playback::why_failed(const Track& track) const {
  return track.world() ? model::error("", {}, track.stop_text()) : failure(shown_->model(), track.outcome());
}

// ---- play, pause, step ----------------------------------------------------------------------------------------------

void Playback::step() {
  if (looking_) {
    if (*looking_ + 1 < history_.size()) look_at(*looking_ + 1);
    return;
  }
  playing_ = until_event_ = false;
  state_changed_ = true;
  if (main_->t() <= cursor_ && !has_event_ahead()) {
    const double picture = clock_.speed() > 0 ? clock_.speed() / rate_ : span_ / rows_of_a_run;
    if (!ask_for_step(cursor_ + picture)) return;
  }
  const double target = main_->t();
  if (target > cursor_) go(target, now_() + longest_single_step, true);
  if (main_over_ && cursor_ >= main_->t() && !has_event_ahead() && ended_.empty()) end_run();
}

void Playback::play() {
  leave_look();
  if (!ended_.empty()) return notices_.note("this run has ended", "reset, go back, or change something");
  playing_ = true;
  until_event_ = false;
  state_changed_ = true;
  restart_clock();
}

void Playback::pause() {
  playing_ = until_event_ = false;
  state_changed_ = true;
}

void Playback::until_event() {
  if (shown_->model().event_order.empty() && !main_->world()) return notices_.note("this model has no events");
  play();
  until_event_ = playing_;
}

void Playback::set_speed(double speed) {
  clock_.set_speed(now_(), cursor_, std::clamp(speed, 0.0, 1e300));
  state_changed_ = true;
}

// ---- the past -------------------------------------------------------------------------------------------------------

void Playback::look_at(std::size_t i) {
  looking_ = i;
  if (*looking_ + 1 >= history_.size()) looking_.reset();
  pending_.mark_changed();
  state_changed_ = true;
}

void Playback::back() {
  pause();
  const std::size_t now = looking_.value_or(history_.size() - 1);
  if (now > 0) look_at(now - 1);
}

void Playback::seek(double t) {
  pause();
  look_at(history_.index_at(t));
}

void Playback::leave_look() {
  if (!looking_) return;
  const Sample sample = history_[*looking_];
  looking_.reset();
  main_over_ = false;
  ended_.clear();
  next_passed_ = 0;
  cursor_ = sample.main.t;
  bring(*main_, sample.main);
  if (ghost_) bring(*ghost_, sample.ghost.value_or(sample.main));
  rows_.set_first_energy(sample.first_energy);
  rewind_to(cursor_);
  emit(sample.main);
  restart_clock();
}

/// Rows from t on are void.
void Playback::rewind_to(double t) {
  history_.cut_from(t);
  rows_.rewind_to(t);
}

// ---- changes --------------------------------------------------------------------------------------------------------

void Playback::use(Variables variables) {
  variables_ = std::move(variables);
  rows_.use(variables_);
}

/// A track to an instant, with what stands in variables_ and held_states_; what follows a file in steps has the value
/// of that time. Fails where it cannot go on.
Status Playback::put(Track& track, const Instant& instant) const {
  std::vector<double> variables = *variables_;
  for (const model::TableInput& input : shown_->program->step_inputs)
    variables[input.variable] = input.table.value(instant.t);
  return track.go_on(instant, variables, held_states_);
}

void Playback::bring(Track& track, const Instant& instant) const {
  static_cast<void>(put(track, instant));
}

void Playback::go_on() {
  const Instant here = instant();
  if (ghost_) bring(*ghost_, ghost_->instant_at(cursor_));
  resume(here);
}

void Playback::go_on_from(const Instant& changed, std::span<const std::size_t> of_ghost_too) {
  if (ghost_) {
    Instant ghost = ghost_->instant_at(cursor_);
    ghost.mode = changed.mode;
    ghost.moved = true;
    for (const std::size_t i : of_ghost_too) ghost.x[i] = changed.x[i];
    bring(*ghost_, ghost);
  }
  resume(changed);
}

/// The motion from here, and what is shown with it.
void Playback::resume(const Instant& instant) {
  if (const Status status = put(*main_, instant); !status) notices_.say(model::error("", {}, status.message));
  next_passed_ = 0;
  main_over_ = false;
  ended_.clear();
  rows_.measure_drift_from(cursor_, instant.x);
  if (!playing_) rewind_to(cursor_);  // a slider moved during a pause leaves one row, not a hundred
  emit(instant);
  state_changed_ = true;
}

void Playback::change_main(std::unique_ptr<Track> main) {
  const Instant here = instant();
  bring(*main, here);
  main_ = std::move(main);
  go_on_from(here);
}

void Playback::change_ghost(std::unique_ptr<Track> ghost) {
  if (ghost) bring(*ghost, instant());
  ghost_ = std::move(ghost);
  show_again();
  state_changed_ = true;
}

void Playback::change_program(std::shared_ptr<const LiveModel> shown, Variables variables, std::unique_ptr<Track> main,
                              std::unique_ptr<Track> ghost) {
  const Instant here = instant();
  std::optional<Instant> of_ghost;
  if (ghost_) of_ghost = ghost_->instant_at(cursor_);
  shown_ = std::move(shown);
  variables_ = std::move(variables);
  main_ = std::move(main);
  ghost_ = std::move(ghost);
  bring(*main_, here);
  if (ghost_ && of_ghost) bring(*ghost_, *of_ghost);
  rows_.show(shown_, variables_);
}

void Playback::hold_body(std::optional<HeldBody> held) {
  main_->hold(held);
  if (ghost_) ghost_->hold(held);
  show_again();
}

void Playback::let_go(std::size_t body, const worlds::Point& velocity) {
  main_->let_go(body, velocity);
  if (ghost_) ghost_->let_go(body, velocity);
}

/// The present instant, in place of itself during a pause.
void Playback::show_again() {
  if (!playing_) rewind_to(cursor_);
  emit(instant());
}

}  // namespace continuo::live
