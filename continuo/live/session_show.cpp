// continuo/live/session_show.cpp
// What the audience gets of a moment.
#include <cmath>
#include <limits>
#include <utility>

#include <continuo/live/messages.hpp>
#include <continuo/live/session.hpp>

namespace continuo::live {

/// Evaluations for a new program.
void Session::show_run() {
  const model::ModelProgram& program = *shown_->program;
  quantities_ = model::Evaluation(program.tape_of(shown_->quantities), *variables_);
  scene_ = model::Evaluation(program.tape_of(shown_->scene), *variables_);
  values_.assign(shown_->quantities.size(), 0.0);
  grips_.clear();
  for (const Grip& grip : shown_->grips) grips_.emplace_back(program.tape_of(grip.nodes), *variables_);
  evaluated_ = variables_;
}

void Session::use_variables(const std::shared_ptr<const std::vector<double>>& variables) {
  if (evaluated_ == variables) return;
  const model::Layout& layout = shown_->model().layout;
  for (std::uint32_t i = layout.parameters; i < layout.samples; ++i) {
    const double value = (*variables)[i];
    if ((*evaluated_)[i] == value) continue;
    quantities_.set(i, value);
    scene_.set(i, value);
    for (model::Evaluation& grip : grips_) grip.set(i, value);
  }
  evaluated_ = variables;
}

void Session::append_values(double t, const std::vector<double>& x, double apart, std::vector<float>& row) {
  for (const model::TableInput& input : shown_->program->step_inputs)
    quantities_.set(input.variable, input.table.value(t));
  if (!values_.empty()) quantities_(t, x, values_);
  for (const std::size_t i : shown_->plotted) row.push_back(static_cast<float>(x[i]));
  for (const double value : values_) row.push_back(static_cast<float>(value));
  if (shown_->drift) {
    const double energy = values_[*shown_->energy - shown_->plotted.size()];
    row.push_back(static_cast<float>((energy - first_energy_) / std::abs(first_energy_)));
  }
  row.push_back(static_cast<float>(apart));
}

void Session::append_scene(double t, const std::vector<double>& x, std::vector<float>& scene) {
  for (const model::TableInput& input : shown_->program->step_inputs) scene_.set(input.variable, input.table.value(t));
  for (const double value : scene_(t, x)) scene.push_back(static_cast<float>(value));
}

double Session::energy_of(double t, const std::vector<double>& x) {
  if (!shown_->energy) return 0;
  use_variables(variables_);
  quantities_(t, x, values_);
  return values_[*shown_->energy - shown_->plotted.size()];
}

void Session::add_row(double t, const std::vector<double>& x, const Instant* ghost) {
  use_variables(variables_);
  double apart = std::numeric_limits<double>::quiet_NaN();
  if (ghost) {
    double square = 0;
    for (const std::size_t i : shown_->apart) square += (x[i] - ghost->x[i]) * (x[i] - ghost->x[i]);
    apart = std::sqrt(square);
  }
  slice_->row_t.push_back(t);
  append_values(t, x, apart, slice_->rows);
  if (ghost) {
    append_values(t, ghost->x, apart, slice_->ghost_rows);
  } else {
    slice_->ghost_rows.resize(slice_->rows.size(), std::numeric_limits<float>::quiet_NaN());
  }
  changed_ = true;
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

std::shared_ptr<const Bodies> Session::bodies_of(const Sample& sample) const {
  const worlds::WorldRun* run = main_->world();
  if (!run) return nullptr;
  auto bodies = std::make_shared<Bodies>();
  const auto dimension = static_cast<std::size_t>(run->dimension());
  const std::size_t count = run->bodies().size(), states = model::WorldDescription::states_of_body(run->dimension());
  bodies->dimension = dimension;
  bodies->position.reserve(count * dimension);
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t k = 0; k < dimension; ++k)
      bodies->position.push_back(static_cast<float>(sample.main.x[i * states + 2 * k]));
  }
  constexpr std::size_t angle = 4;  // of x, x', y, y', angle, angle'
  for (std::size_t i = 0; i < count; ++i) {
    if (dimension == 2) {
      bodies->orientation.push_back(static_cast<float>(sample.main.x[i * states + angle]));
    } else if (!looking_) {  // how they stood is no state: of the past it is not
                             // known
      const auto [w, x, y, z] = run->orientation(i);
      for (const double part : {x, y, z, w}) bodies->orientation.push_back(static_cast<float>(part));
    }
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
  append_scene(sample.main.t, sample.main.x, slice_->scene);
  slice_->ghost = sample.ghost.has_value();
  slice_->bodies = bodies_of(sample);
  if (sample.ghost) append_scene(sample.main.t, sample.ghost->x, slice_->ghost_scene);
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
  }
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
