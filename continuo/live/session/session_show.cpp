// continuo/live/session/session_show.cpp
// What the audience gets of a moment.
#include <cmath>
#include <utility>

#include <continuo/live/session.hpp>
#include <continuo/live/session/messages.hpp>

namespace continuo::live {

/// Evaluations for a new program.
void Session::show_run() {
  const model::ModelProgram& program = *shown_->program;
  quantities_ = model::Evaluation(program.tape_of(shown_->quantities), *variables_);
  scene_ = model::Evaluation(program.tape_of(shown_->scene), *variables_);
  paths_ = model::Evaluation(program.tape_of(shown_->paths), *variables_);
  values_.assign(shown_->quantities.size(), 0.0);
  drag_targets_.clear();
  for (const DragTarget& drag_target : shown_->drag_targets)
    drag_targets_.emplace_back(program.tape_of(drag_target.nodes), *variables_);
  evaluated_ = variables_;
  bends_ = Bends(*shown_);
  last_row_.reset();
  between_.clear();
}

void Session::use_variables(const std::shared_ptr<const std::vector<double>>& variables) {
  if (evaluated_ == variables) return;
  const model::Layout& layout = shown_->model().layout;
  for (std::uint32_t i = layout.parameters; i < layout.samples; ++i) {
    const double value = (*variables)[i];
    if ((*evaluated_)[i] == value) continue;
    quantities_.set(i, value);
    scene_.set(i, value);
    paths_.set(i, value);
    for (model::Evaluation& drag_target : drag_targets_) drag_target.set(i, value);
  }
  evaluated_ = variables;
}

void Session::append_points(model::Evaluation& points, double t, const std::vector<double>& x, std::vector<float>& to) {
  for (const model::TableInput& input : shown_->program->step_inputs) points.set(input.variable, input.table.value(t));
  for (const double value : points(t, x)) to.push_back(static_cast<float>(value));
}

double Session::energy_of(double t, const std::vector<double>& x) {
  if (!shown_->energy) return 0;
  use_variables(variables_);
  quantities_(t, x, values_);
  return values_[*shown_->energy - shown_->plotted.size()];
}

/// Of many bodies a moment is megabytes: some in a second are enough to go back to.
bool Session::keeps_whole(double t) const {
  constexpr std::size_t many = 10'000;  // states
  constexpr double seconds = 0.25;
  if (!main_->world() || history_.empty() || shown_->model().states.size() < many) return true;
  return t >= history_.last_time() + seconds * std::max(clock_.speed(), 1e-9);
}

void Session::emit(Instant main) {
  std::optional<Instant> ghost;
  if (ghost_) ghost = ghost_->instant_at(main.t, main.world != nullptr);
  add_row(main.t, main.x, ghost ? &*ghost : nullptr);
  const bool kept = !main_->world() || main.world;
  newest_ = {std::move(main), std::move(ghost), variables_, first_energy_};
  if (kept) history_.add(newest_);
}

std::shared_ptr<const Bodies> Session::bodies_of(const Instant& instant) const {
  const worlds::WorldRun* run = main_->world();
  if (!run) return nullptr;
  auto bodies = std::make_shared<Bodies>();
  const auto dimension = static_cast<std::size_t>(run->dimension());
  const std::size_t count = run->bodies().size(), states = model::WorldDescription::states_of_body(run->dimension());
  bodies->dimension = dimension;
  bodies->position.reserve(count * dimension);
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t k = 0; k < dimension; ++k)
      bodies->position.push_back(static_cast<float>(instant.x[i * states + 2 * k]));
  }
  constexpr std::size_t angle = 4, quaternion = 6;  // of x, x', y, y', angle, angle'; x, x', ..., z', w, x, y, z, spin
  bodies->orientation.reserve(count * (dimension == 2 ? 1 : 4));
  for (std::size_t i = 0; i < count; ++i) {
    const double* state = instant.x.data() + i * states;
    if (dimension == 2) {
      bodies->orientation.push_back(static_cast<float>(state[angle]));
      continue;
    }
    // Between two steps the state is on the straight way, which is a little shorter.
    const double w = state[quaternion], x = state[quaternion + 1], y = state[quaternion + 2], z = state[quaternion + 3];
    const double length = std::sqrt(w * w + x * x + y * y + z * z);
    for (const double part : {x, y, z, w}) bodies->orientation.push_back(static_cast<float>(part / length));
  }
  return bodies;
}

void Session::publish() {
  if (!changed_ || history_.empty()) return;
  const Sample& sample = looking_ ? history_[*looking_] : newest_;
  use_variables(sample.variables);
  slice_->run = run_;
  slice_->looking_back = looking_.has_value();
  slice_->t = sample.main.t;
  slice_->reached = playing_ ? clock_.reached_speed() : 0;
  slice_->target = clock_.speed();
  append_points(scene_, sample.main.t, sample.main.x, slice_->scene);
  slice_->ghost = sample.ghost.has_value();
  slice_->bodies = bodies_of(sample.main);
  if (sample.ghost) {
    append_points(scene_, sample.main.t, sample.ghost->x, slice_->ghost_scene);
    slice_->ghost_bodies = bodies_of(*sample.ghost);
  }
  audience_.see(std::exchange(slice_, std::make_shared<Slice>()));
  changed_ = false;
}

/// Rows from t on are void.
void Session::rewind_to(double t) {
  history_.cut_from(t);
  slice_->rewound_to = std::min(t, slice_->rewound_to.value_or(t));
  const std::size_t columns = shown_->columns.size();
  while (!slice_->row_t.empty() && slice_->row_t.back() >= t) {
    slice_->row_t.pop_back();
    slice_->rows.resize(slice_->rows.size() - columns);
    slice_->ghost_rows.resize(slice_->ghost_rows.size() - columns);
    slice_->paths.resize(slice_->paths.size() - shown_->paths.size());
    slice_->ghost_paths.resize(slice_->ghost_paths.size() - shown_->paths.size());
  }
  last_row_.reset();
  between_.clear();
  std::erase_if(slice_->events, [t](const LiveEvent& event) { return event.t > t; });
  changed_ = true;
}

std::string Session::model_json() const {
  return live::model_json({.run = run_,
                           .shown = *shown_,
                           .variables = *variables_,
                           .path = path_,
                           .text = text_,
                           .saveable = path_ == place_.path,
                           .gallery = place_.gallery,
                           .plan = main_->plan(),
                           .world = main_->world(),
                           .undo = undo_.size()});
}

std::string Session::state_json() const {
  StateWords words{.shown = *shown_, .variables = *variables_, .plan = main_->plan()};
  words.playing = playing_;
  words.t = shown_time();
  words.target = clock_.speed();
  words.reached = playing_ ? clock_.reached_speed() : 0;
  words.slow = playing_ && clock_.slow();
  if (!history_.empty()) words.first = history_.first_time(), words.last = history_.last_time();
  if (ghost_) words.ghost = &ghost_->plan();
  words.undo = undo_.size();
  const Sample* sample = looking_ ? &history_[*looking_] : history_.empty() ? nullptr : &history_.back();
  if (!shown_->model().modes.empty()) words.mode = shown_->model().modes[sample ? sample->main.mode : 0].name;
  words.statistics = main_->statistics();
  words.ended = ended_;
  return live::state_json(words);
}

void Session::say_model() {
  audience_.hear(Topic::model, model_json());
}

void Session::say_state() {
  audience_.hear(Topic::state, state_json());
  state_said_ = now_();
  state_changed_ = false;
}

void Session::say(const model::Diagnostic& problem, const model::Source* source) {
  const model::Source own(path_, text_);
  audience_.hear(Topic::message, message_json(problem, source ? *source : own));
}

void Session::say_note(std::string text, std::string hint) {
  model::Diagnostic note = model::warning("", {}, std::move(text), {}, std::move(hint));
  note.severity = model::Severity::note;
  say(note);
}

}  // namespace continuo::live
