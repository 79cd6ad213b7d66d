// continuo/live/session_hands.cpp
// What hands change, at the instant that is shown.
#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include <continuo/live/messages.hpp>
#include <continuo/live/session.hpp>
#include <continuo/model/simulate.hpp>

namespace continuo::live {

namespace {

constexpr double same_change = 1;  // seconds: a slider that is moved for longer is one change all the same
constexpr std::size_t most_undo = 200;

/// From above zero to zero counts: a run that began at zero would have to leave it first, and nothing would turn it
/// back.
bool is_crossed(double before, double after) {
  return before > 0 ? after <= 0 : before == 0 && after < 0;
}

}  // namespace

// ---- the past -------------------------------------------------------------------------------------------------------

void Session::look_at(std::size_t i) {
  looking_ = i;
  if (*looking_ + 1 >= history_.size()) looking_.reset();
  changed_ = state_changed_ = true;
}

void Session::back() {
  pause();
  const std::size_t now = looking_.value_or(history_.size() - 1);
  if (now > 0) look_at(now - 1);
}

void Session::seek(double t) {
  pause();
  look_at(history_.index_at(t));
}

/// The moment that is looked at becomes the present: what came later is forgotten.
void Session::leave_look() {
  if (!looking_) return;
  const Sample sample = history_[*looking_];
  looking_.reset();
  main_over_ = false;
  ended_.clear();
  next_passed_ = 0;
  cursor_ = sample.main.t;
  main_->go_on(sample.main, *variables_, held_);
  if (ghost_) ghost_->go_on(sample.ghost.value_or(sample.main), *variables_, held_);
  first_energy_ = sample.first_energy;
  rewind_to(cursor_);
  emit(sample.main);
  restart_clock();
}

void Session::reset() {
  const bool was_playing = playing_;
  if (begin_run()) playing_ = was_playing;
  say_state();
}

// ---- changes --------------------------------------------------------------------------------------------------------

/// The run goes on with what stands in variables_ and held_ from the instant that is shown, or from `changed`.
void Session::touch(std::optional<Instant> changed) {
  const Instant instant = changed ? *changed : main_->instant_at(cursor_);
  std::optional<Instant> ghost;
  if (ghost_) {
    ghost = ghost_->instant_at(cursor_);
    if (changed) {  // the hand holds both
      ghost->mode = changed->mode;
      ghost->moved = true;
      for (const std::size_t i : held_) ghost->x[i] = changed->x[i];
    }
    ghost_->go_on(*ghost, *variables_, held_);
  }
  if (const std::string problem = main_->go_on(instant, *variables_, held_); !problem.empty())
    say(model::error("", {}, problem));
  next_passed_ = 0;
  main_over_ = false;
  ended_.clear();
  first_energy_ = energy_of(cursor_, instant.x);
  if (!playing_) rewind_to(cursor_);  // a slider moved during a pause leaves one row, not a hundred
  emit(instant);
  state_changed_ = true;
}

void Session::remember_for_undo(const std::string& what) {
  const double wall = now_();
  if (!undo_.empty() && undo_.back().what == what && wall - undo_.back().wall < same_change) {
    undo_.back().wall = wall;
    return;
  }
  keep_undo({what, wall, settings_});
}

void Session::keep_undo(Undo undo) {
  undo_.push_back(std::move(undo));
  if (undo_.size() > most_undo) undo_.erase(undo_.begin());
}

std::shared_ptr<const std::vector<double>> Session::present_variables() {
  const model::Model& model = shown_->model();
  const std::vector<double> start = start_values(model, settings_.parameters);
  std::vector<double> variables = *variables_;
  for (const model::Parameter& parameter : model.parameters) variables[parameter.variable] = start[parameter.variable];
  for (const auto& [name, value] : inputs_) {
    const std::size_t i = find_input(model, name);
    if (i != model::npos) variables[model.inputs[i].variable] = value;
  }
  return std::make_shared<const std::vector<double>>(std::move(variables));
}

void Session::set_parameter(const std::string& name, double value) {
  const std::size_t i = find_parameter(shown_->model(), name);
  if (i == model::npos) return say(no_parameter(shown_->model(), name, {}));
  if (!std::isfinite(value)) return say_note(fmt::format("`{}` must be a finite number", name));
  remember_for_undo("parameter " + name);
  settings_.parameters[name] = value;
  if (shown_->model().parameters[i].structural) {
    load_anew(path_, text_);
    return;
  }
  leave_look();
  variables_ = present_variables();
  touch();
}

void Session::restore_parameters() {
  if (settings_.parameters.empty()) return;
  Settings settings = settings_;
  settings.parameters.clear();
  remember_for_undo("restore");
  apply(settings);
}

void Session::undo() {
  if (undo_.empty()) return;
  const Settings settings = std::move(undo_.back().settings);
  undo_.pop_back();
  apply(settings);
}

/// All at once, whatever differs.
void Session::apply(const Settings& settings) {
  const auto same = [](const MethodChoice& a, const MethodChoice& b) {
    return a.name == b.name && a.step == b.step && a.rtol == b.rtol;
  };
  const model::Overrides before = std::exchange(settings_.parameters, settings.parameters);
  for (const model::Parameter& parameter : shown_->model().parameters) {
    const auto value = [&](const model::Overrides& all) {
      const auto found = all.find(parameter.name);
      return found == all.end() ? std::optional<double>() : std::optional(found->second);
    };
    if (parameter.structural && value(before) != value(settings_.parameters)) {
      settings_ = settings;
      load_anew(path_, text_);
      return;
    }
  }
  leave_look();
  variables_ = present_variables();
  touch();
  if (!same(settings_.method, settings.method)) change_method(settings.method);
  const bool ghost = settings.ghost.has_value();
  if (ghost != settings_.ghost.has_value() || (ghost && !same(*settings_.ghost, *settings.ghost)))
    change_ghost(settings.ghost);
}

void Session::move_input(const std::string& name, double value) {
  const std::size_t i = find_input(shown_->model(), name);
  if (i == model::npos) return say_note(fmt::format("there is no input `{}`", name));
  if (!std::isfinite(value)) return say_note(fmt::format("`{}` must be a finite number", name));
  const model::Input& input = shown_->model().inputs[i];
  if (input.range) value = std::clamp(value, input.range->low, input.range->high);
  leave_look();
  inputs_[name] = value;
  if (input.points) {  // from here on a hand's, no longer the file's
    taken_.insert(name);
    take_input_from_file();
  }
  variables_ = present_variables();
  touch();
}

/// The program anew without the file, the run as it stands.
void Session::take_input_from_file() {
  const Instant instant = main_->instant_at(cursor_);
  std::optional<Instant> ghost;
  if (ghost_) ghost = ghost_->instant_at(cursor_);
  model::Loaded loaded = model::load(model::Source(path_, text_));
  if (!loaded.model) return;
  shown_ = std::make_shared<const LiveModel>(prepare(std::move(*loaded.model), taken_));
  variables_ = present_variables();
  main_ = track_by(settings_.method);
  main_->go_on(instant, *variables_, held_);
  if (ghost) ghost_ = track_by(*settings_.ghost), ghost_->go_on(*ghost, *variables_, held_);
  show_run();
  say_model();
}

// ---- methods --------------------------------------------------------------------------------------------------------

void Session::take_method(MethodChoice choice) {
  leave_look();
  const Settings before = settings_;
  if (!change_method(std::move(choice))) return;
  keep_undo({"method", now_(), before});
}

bool Session::change_method(MethodChoice choice) {
  auto track = track_by(choice);
  if (!track) return false;
  const Instant instant = main_->instant_at(cursor_);
  track->go_on(instant, *variables_, held_);
  main_ = std::move(track);
  settings_.method = std::move(choice);
  touch(instant);
  return true;
}

void Session::take_ghost(std::optional<MethodChoice> choice) {
  leave_look();
  const Settings before = settings_;
  if (!change_ghost(std::move(choice))) return;
  keep_undo({"ghost", now_(), before});
}

bool Session::change_ghost(std::optional<MethodChoice> choice) {
  auto track = choice ? track_by(*choice) : nullptr;
  if (choice && !track) return false;
  if (track) track->go_on(main_->instant_at(cursor_), *variables_, held_);
  ghost_ = std::move(track);
  settings_.ghost = std::move(choice);
  if (!playing_) rewind_to(cursor_);
  emit(main_->instant_at(cursor_));
  state_changed_ = true;
  return true;
}

// ---- the mouse ------------------------------------------------------------------------------------------------------

void Session::drag(std::size_t item, std::span<const double> to) {
  if (item >= shown_->drawing.size() || !shown_->drawing[item].grip) return say_note("this cannot be dragged");
  const std::size_t number = *shown_->drawing[item].grip;
  const Grip& grip = shown_->grips[number];
  if (to.size() != grip.dimension || !std::ranges::all_of(to, [](double v) { return std::isfinite(v); }))
    return say_note(fmt::format("a drag needs {} coordinates", grip.dimension));
  leave_look();
  held_ = grip.held();
  use_variables(variables_);
  Instant instant = main_->instant_at(cursor_);
  std::vector<double> x = pull(grip, grips_[number], cursor_, instant.x, to);
  stop_at_guards(grip, instant.x, x);
  const bool moved = std::ranges::any_of(grip.positions, [&](std::size_t i) { return x[i] != instant.x[i]; });
  if (moved) instant.mode = shown_->model().start_mode;
  instant.moved = true;
  instant.x = std::move(x);
  touch(std::move(instant));
}

void Session::hold_body(std::optional<HeldBody> held) {
  held_body_ = held;
  main_->hold(held);
  if (ghost_) ghost_->hold(held);
  if (!playing_) rewind_to(cursor_);
  emit(main_->instant_at(cursor_));
}

void Session::drag_body(std::size_t body, std::span<const double> to) {
  const worlds::WorldRun* world = main_->world();
  if (!world || body >= world->bodies().size()) return say_note("there is no such body");
  const bool finite = std::ranges::all_of(to, [](double v) { return std::isfinite(v); });
  if (to.size() != static_cast<std::size_t>(world->dimension()) || !finite)
    return say_note(fmt::format("a drag needs {} coordinates", world->dimension()));
  leave_look();
  HeldBody held{body, {}};
  std::ranges::copy(to, held.to.begin());
  hold_body(held);
}

void Session::pick(std::size_t body) {
  const worlds::WorldRun* world = main_->world();
  if (!world || body >= world->bodies().size()) return say_note("there is no such body");
  audience_.hear(Topic::message, picked_json(*world, body));
}

void Session::release() {
  if (held_body_) hold_body(std::nullopt);
  if (held_.empty()) return;
  held_.clear();
  touch();
}

/// A hand does not push through what an event would have turned back: where a guard whose event changes something would
/// have fired, the way ends just before.
void Session::stop_at_guards(const Grip& grip, const std::vector<double>& from, std::vector<double>& to) {
  constexpr int halvings = 50;
  if (!main_->equations()) return;
  model::ModelSystem system = main_->equations()->system();
  system.go(shown_->model().start_mode);
  model::ModelEvents guards = main_->equations()->events();
  std::vector<double> before(guards.size()), after(guards.size());
  guards.guards(system, cursor_, from, before);
  const auto fires = [&](const std::vector<double>& x) {
    guards.guards(system, cursor_, x, after);
    for (std::size_t i = 0; i < guards.size(); ++i) {
      if (!guards.is_guard(i) || guards.only_notes(i) || !guards.active(system, i)) continue;
      const Direction direction = guards.direction(i);
      if (direction != Direction::rises && is_crossed(before[i], after[i])) return true;
      if (direction != Direction::falls && is_crossed(-before[i], -after[i])) return true;
    }
    return false;
  };
  if (!fires(to)) return;
  std::vector<double> tried = to;
  double good = 0, bad = 1;
  const auto at = [&](double part) {
    for (const std::size_t i : grip.positions) tried[i] = from[i] + part * (to[i] - from[i]);
    return tried;
  };
  for (int k = 0; k < halvings; ++k) {
    const double middle = (good + bad) / 2;
    (fires(at(middle)) ? bad : good) = middle;
  }
  to = at(good);
}

}  // namespace continuo::live
