// Settings as somebody changes them, at the instant that is shown.
#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include <continuo/language/load.hpp>
#include <continuo/live/session/interaction.hpp>
#include <continuo/live/session/planned_track.hpp>
#include <continuo/simulation/simulate.hpp>

namespace continuo::live {

namespace {

constexpr double same_change = 1;  // seconds: a slider that is moved for longer is one change all the same
constexpr std::size_t most_undo = 200;

}  // namespace

void Interaction::forget_unknown_parameters(const model::Model& model) {
  std::erase_if(settings_.parameters,
                [&](const auto& given) { return find_parameter(model, given.first) == model::npos; });
}

// ---- undo -----------------------------------------------------------------------------------------------------------

void Interaction::remember_for_undo(const std::string& what, bool for_long) {
  const double wall = now_();
  if (!undo_.empty() && undo_.back().what == what && (for_long || wall - undo_.back().wall < same_change)) {
    undo_.back().wall = wall;
    return;
  }
  keep_undo({what, wall, settings_});
}

void Interaction::keep_undo(Undo undo) {
  undo_.push_back(std::move(undo));
  if (undo_.size() > most_undo) undo_.erase(undo_.begin());
}

Change Interaction::undo() {
  if (undo_.empty()) return Change::made;
  const Settings settings = std::move(undo_.back().settings);
  undo_.pop_back();
  return apply(settings);
}

/// All at once, whatever differs.
Change Interaction::apply(const Settings& settings) {
  const auto same = [](const MethodChoice& a, const MethodChoice& b) {
    return a.name == b.name && a.step == b.step && a.rtol == b.rtol;
  };
  if (differ_in_structure(settings_.parameters, settings.parameters)) {
    settings_ = settings;
    return Change::needs_check;
  }
  playback_.leave_look();
  settings_.parameters = settings.parameters;
  settings_.inputs = settings.inputs;
  if (settings_.taken != settings.taken) {
    settings_.taken = settings.taken;
    prepare_anew();
  }
  use_settings();
  if (!same(settings_.method, settings.method)) change_method(settings.method);
  const bool ghost = settings.ghost.has_value();
  if (ghost != settings_.ghost.has_value() || (ghost && !same(*settings_.ghost, *settings.ghost)))
    change_ghost(settings.ghost);
  return Change::made;
}

bool Interaction::differ_in_structure(const model::Overrides& a, const model::Overrides& b) const {
  return std::ranges::any_of(model().parameters, [&](const model::Parameter& parameter) {
    const auto value = [&](const model::Overrides& all) {
      const auto found = all.find(parameter.name);
      return found == all.end() ? std::optional<double>() : std::optional(found->second);
    };
    return parameter.structural && value(a) != value(b);
  });
}

// ---- parameters and inputs ------------------------------------------------------------------------------------------

Variables Interaction::present_variables(const model::Model& model) const {
  const std::vector<double> start = start_values(model, settings_.parameters);
  std::vector<double> variables = *playback_.variables();
  for (const model::Parameter& parameter : model.parameters) variables[parameter.variable] = start[parameter.variable];
  for (const model::Input& input : model.inputs) variables[input.variable] = start[input.variable];
  for (const auto& [name, value] : settings_.inputs) {
    const std::size_t i = find_input(model, name);
    if (i != model::npos) variables[model.inputs[i].variable] = value;
  }
  return std::make_shared<const std::vector<double>>(std::move(variables));
}

void Interaction::use_settings() {
  playback_.use(present_variables(model()));
  playback_.go_on();
}

Change Interaction::set_parameter(const std::string& name, double value) {
  const std::size_t i = find_parameter(model(), name);
  if (i == model::npos) {
    notices_.say(no_parameter(model(), name, {}));
    return Change::made;
  }
  if (!std::isfinite(value)) {
    notices_.note(fmt::format("`{}` must be a finite number", name));
    return Change::made;
  }
  remember_for_undo("parameter " + name);
  settings_.parameters[name] = value;
  if (model().parameters[i].structural) return Change::needs_check;
  playback_.leave_look();
  use_settings();
  return Change::made;
}

Change Interaction::restore_parameters() {
  if (settings_.parameters.empty() && settings_.inputs.empty()) return Change::made;
  Settings settings = settings_;
  settings.parameters.clear();
  settings.inputs.clear();
  settings.taken.clear();
  remember_for_undo("restore");
  return apply(settings);
}

void Interaction::move_input(const std::string& name, double value) {
  const std::size_t i = find_input(model(), name);
  if (i == model::npos) return notices_.note(fmt::format("there is no input `{}`", name));
  if (!std::isfinite(value)) return notices_.note(fmt::format("`{}` must be a finite number", name));
  const model::Input& input = model().inputs[i];
  if (input.range) value = std::clamp(value, input.range->low, input.range->high);
  playback_.leave_look();
  remember_for_undo("input " + name, !input.key.empty());  // a key that is held and let go is one change
  settings_.inputs[name] = value;
  if (input.points) {  // from here on a hand's, no longer the file's
    settings_.taken.insert(name);
    prepare_anew();
  }
  use_settings();
}

/// The program anew, where other inputs follow their files; the run as it stands.
void Interaction::prepare_anew() {
  model::Loaded loaded = load(text_);
  if (!loaded.model) return;
  auto shown = std::make_shared<const LiveModel>(prepare(std::move(*loaded.model), keys_, settings_.taken));
  auto main = planned_track(*shown, settings_, settings_.method, playback_.interrupt(), notices_);
  if (!main) return;
  auto ghost =
      playback_.ghost() ? planned_track(*shown, settings_, *settings_.ghost, playback_.interrupt(), notices_) : nullptr;
  Variables variables = present_variables(shown->model());
  playback_.change_program(std::move(shown), std::move(variables), std::move(main), std::move(ghost));
  on_new_program_();
}

// ---- methods --------------------------------------------------------------------------------------------------------

std::unique_ptr<Track> Interaction::track_by(const MethodChoice& choice) const {
  return planned_track(*playback_.shown(), settings_, choice, playback_.interrupt(), notices_);
}

bool Interaction::take_method(MethodChoice choice) {
  playback_.leave_look();
  const Settings before = settings_;
  if (!change_method(std::move(choice))) return false;
  keep_undo({"method", now_(), before});
  return true;
}

bool Interaction::change_method(MethodChoice choice) {
  auto track = track_by(choice);
  if (!track) return false;
  settings_.method = std::move(choice);
  playback_.change_main(std::move(track));
  return true;
}

void Interaction::take_ghost(std::optional<MethodChoice> choice) {
  playback_.leave_look();
  const Settings before = settings_;
  if (!change_ghost(std::move(choice))) return;
  keep_undo({"ghost", now_(), before});
}

bool Interaction::change_ghost(std::optional<MethodChoice> choice) {
  auto track = choice ? track_by(*choice) : nullptr;
  if (choice && !track) return false;
  settings_.ghost = std::move(choice);
  playback_.change_ghost(std::move(track));
  return true;
}

}  // namespace continuo::live
