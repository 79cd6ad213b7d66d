// continuo/live/session/session_hands.cpp
// What hands change, at the instant that is shown.
#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include <continuo/live/session.hpp>
#include <continuo/live/session/messages.hpp>
#include <continuo/simulation/simulate.hpp>

namespace continuo::live {

namespace {

constexpr double same_change = 1;  // seconds: a slider that is moved for longer is one change all the same
constexpr std::size_t most_undo = 200;

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
  go_on(*main_, sample.main);
  if (ghost_) go_on(*ghost_, sample.ghost.value_or(sample.main));
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

/// With what stands in variables_ and held_; what follows a file in steps has the value of that time.
std::string Session::go_on(Track& track, const Instant& instant) {
  std::vector<double> variables = *variables_;
  for (const model::TableInput& input : shown_->program->step_inputs)
    variables[input.variable] = input.table.value(instant.t);
  return track.go_on(instant, variables, held_);
}

/// The run goes on from the instant that is shown, or from `changed`.
void Session::touch(std::optional<Instant> changed, const std::vector<std::size_t>& of_ghost_too) {
  const Instant instant = changed ? *changed : main_->instant_at(cursor_);
  std::optional<Instant> ghost;
  if (ghost_) {
    ghost = ghost_->instant_at(cursor_);
    if (changed) {  // the hand holds both
      ghost->mode = changed->mode;
      ghost->moved = true;
      for (const std::size_t i : of_ghost_too) ghost->x[i] = changed->x[i];
    }
    go_on(*ghost_, *ghost);
  }
  if (const std::string problem = go_on(*main_, instant); !problem.empty()) say(model::error("", {}, problem));
  next_passed_ = 0;
  main_over_ = false;
  ended_.clear();
  first_energy_ = energy_of(cursor_, instant.x);
  if (!playing_) rewind_to(cursor_);  // a slider moved during a pause leaves one row, not a hundred
  emit(instant);
  state_changed_ = true;
}

void Session::remember_for_undo(const std::string& what, bool for_long) {
  const double wall = now_();
  if (!undo_.empty() && undo_.back().what == what && (for_long || wall - undo_.back().wall < same_change)) {
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
  for (const model::Input& input : model.inputs) variables[input.variable] = start[input.variable];
  for (const auto& [name, value] : settings_.inputs) {
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
  if (settings_.parameters.empty() && settings_.inputs.empty()) return;
  Settings settings = settings_;
  settings.parameters.clear();
  settings.inputs.clear();
  settings.taken.clear();
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
  settings_.inputs = settings.inputs;
  if (settings_.taken != settings.taken) {
    settings_.taken = settings.taken;
    prepare_anew();
  }
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
  remember_for_undo("input " + name, !input.key.empty());  // a key that is held and let go is one change
  settings_.inputs[name] = value;
  if (input.points) {  // from here on a hand's, no longer the file's
    settings_.taken.insert(name);
    prepare_anew();
  }
  variables_ = present_variables();
  touch();
}

/// The program anew, where other inputs follow their files; the run as it stands.
void Session::prepare_anew() {
  const Instant instant = main_->instant_at(cursor_);
  std::optional<Instant> ghost;
  if (ghost_) ghost = ghost_->instant_at(cursor_);
  model::Loaded loaded = model::load(model::Source(path_, text_));
  if (!loaded.model) return;
  shown_ = std::make_shared<const LiveModel>(prepare(std::move(*loaded.model), settings_.taken));
  variables_ = present_variables();
  main_ = track_by(settings_.method);
  go_on(*main_, instant);
  if (ghost) ghost_ = track_by(*settings_.ghost), go_on(*ghost_, *ghost);
  show_run();
  say_model();
}

// ---- methods --------------------------------------------------------------------------------------------------------

bool Session::take_method(MethodChoice choice) {
  leave_look();
  const Settings before = settings_;
  if (!change_method(std::move(choice))) return false;
  keep_undo({"method", now_(), before});
  return true;
}

bool Session::change_method(MethodChoice choice) {
  auto track = track_by(choice);
  if (!track) return false;
  const Instant instant = main_->instant_at(cursor_);
  go_on(*track, instant);
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
  if (track) go_on(*track, main_->instant_at(cursor_));
  ghost_ = std::move(track);
  settings_.ghost = std::move(choice);
  if (!playing_) rewind_to(cursor_);
  emit(main_->instant_at(cursor_));
  state_changed_ = true;
  return true;
}

}  // namespace continuo::live
