// Joins the parts of a session: models come in, runs begin, and the audience is told of both.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include <continuo/language/load_confined.hpp>
#include <continuo/live/session.hpp>
#include <continuo/live/session/messages.hpp>
#include <continuo/live/session/planned_track.hpp>
#include <continuo/results/output_file.hpp>

namespace continuo::live {

namespace {

/// One second on the wall for one of the model, if that lets a run of the text be watched; else a round speed at which
/// it takes about twenty.
double first_speed(const model::Model& model, double span) {
  if (model.run.realtime || (span >= 1 && span <= 300)) return 1;
  const double wanted = span / 20, power = std::pow(10.0, std::floor(std::log10(wanted)));
  const double digit = wanted / power;
  return power * (digit < 1.5 ? 1 : digit < 3.5 ? 2 : digit < 7.5 ? 5 : 10);
}

/// What others are told of a path: not where this computer keeps its files.
std::string name_of(const std::string& path) {
  return std::filesystem::path(path).filename().string();
}

constexpr double long_turn = 0.05;  // seconds: three pictures

/// Stands for a model whose text is wrong.
constexpr std::string_view nothing_that_moves = "model Nothing\nrest' = 0\nrest(0) = 0\nrun 0..1\n";

}  // namespace

Session::Session(Now now, Audience& audience, Place place)
    : now_(std::move(now)),
      audience_(audience),
      place_(std::move(place)),
      notices_(audience, text_),
      rows_(pending_),
      playback_(now_, notices_, pending_, rows_),
      drag_(now_, playback_, notices_),
      interaction_(now_, text_, playback_, notices_, place_.keys, [this] {
        drag_.show();
        scene_.show(*playback_.shown(), playback_.variables());
        say_model();
      }) {}

// ---- models ---------------------------------------------------------------------------------------------------------

model::Loaded Session::open_file() {
  const std::string path = place_.path.empty() && !place_.gallery.empty() ? place_.gallery.front().path : place_.path;
  model::Loaded loaded = model::load(path);
  notices_.set_problems(loaded.diagnostics);
  if (loaded.model) begin(*loaded.model, {path, loaded.source.text(), true});
  return loaded;
}

void Session::open_mistaken(const model::Loaded& loaded) {
  model::Loaded still = model::load(model::Source("", std::string(nothing_that_moves)));
  still.model->name = std::filesystem::path(place_.path).stem().string();
  begin(std::move(*still.model), {place_.path, loaded.source.text()}, loaded.diagnostics);
}

/// False where it cannot be run: then everything is as it was.
bool Session::begin(model::Model model, ModelText text, std::vector<model::Diagnostic> mistakes) {
  const bool other = text.path != text_.path || !is_open() || !mistakes_.empty();
  auto shown = std::make_shared<const LiveModel>(
      prepare(std::move(model), place_.keys, other ? Taken() : interaction_.settings().taken));
  const Settings settings = interaction_.settings();
  ModelText before = std::exchange(text_, std::move(text));
  mistakes.swap(mistakes_);
  if (other) interaction_.forget_all();
  interaction_.forget_unknown_parameters(shown->model());
  if (!begin_run(std::move(shown))) {
    interaction_.set_settings(settings);
    text_ = std::move(before);
    mistakes_ = std::move(mistakes);
    return false;
  }
  if (other) playback_.set_speed(first_speed(playback_.shown()->model(), playback_.span()));
  return true;
}

bool Session::begin_run(std::shared_ptr<const LiveModel> shown) {
  const Settings& settings = interaction_.settings();
  auto main = planned_track(*shown, settings, settings.method, playback_.interrupt(), notices_);
  if (!main) return false;
  auto ghost =
      settings.ghost ? planned_track(*shown, settings, *settings.ghost, playback_.interrupt(), notices_) : nullptr;
  if (!ghost) interaction_.forget_ghost();
  playback_.begin(std::move(shown), std::move(main), std::move(ghost));
  drag_.begin();
  scene_.show(*playback_.shown(), playback_.variables());
  ++run_;
  say_model();
  return true;
}

void Session::reset() {
  begin_run(playback_.shown());
}

/// Parameters that decide how many equations there are go into the check itself.
bool Session::load_anew(const std::string& text) {
  const ModelText written{text_.path, text, text_.trusted && text == text_.text};
  model::Loaded loaded = load(written);
  model::Overrides structural;
  for (const auto& [name, value] : interaction_.settings().parameters) {
    const std::size_t i = loaded.model ? find_parameter(*loaded.model, name) : model::npos;
    if (i != model::npos && loaded.model->parameters[i].structural) structural[name] = value;
  }
  if (!structural.empty()) loaded = load(written, structural);
  for (const model::Diagnostic& problem : loaded.diagnostics) notices_.say(problem, &loaded.source);
  return loaded.model && begin(*loaded.model, written);
}

void Session::load_anew_after(Change change) {
  if (change == Change::needs_check) load_anew(text_.text);
}

void Session::run_text(const std::string& text) {
  if (!is_open()) text_.path = place_.path;
  load_anew(text);
}

void Session::open_gallery(const std::string& name) {
  const auto found = std::ranges::find(place_.gallery, name, &GalleryModel::name);
  if (found == place_.gallery.end()) return notices_.note(fmt::format("there is no model `{}` in the gallery", name));
  model::Loaded loaded = model::load_confined(found->path);
  for (const model::Diagnostic& problem : loaded.diagnostics) notices_.say(problem, &loaded.source);
  if (!loaded.model) return;
  begin(std::move(*loaded.model), {.path = found->path, .text = loaded.source.text()});
}

void Session::save_text(const std::string& text) {
  if (!place_.writable) return notices_.note("this view writes no files");
  if (text_.path != place_.path) return notices_.note(fmt::format("only {} is ever written", name_of(place_.path)));
  if (const Status status = results::write_file(text_.path, text); !status) {
    std::string message = status.message;
    if (const std::size_t at = message.find(text_.path); at != std::string::npos)
      message.replace(at, text_.path.size(), name_of(text_.path));
    return notices_.say(model::error("", {}, std::move(message)));
  }
  text_.text = text;
  audience_.hear(Topic::message, saved_json(name_of(text_.path)));
}

// ---- hands ----------------------------------------------------------------------------------------------------------

void Session::step() {
  const bool had_ghost = playback_.ghost() != nullptr;
  playback_.step();
  if (had_ghost && !playback_.ghost()) interaction_.forget_ghost();
}

void Session::set_parameter(const std::string& name, double value) {
  load_anew_after(interaction_.set_parameter(name, value));
}

void Session::restore_parameters() {
  load_anew_after(interaction_.restore_parameters());
}

void Session::undo() {
  load_anew_after(interaction_.undo());
}

void Session::pick(std::size_t body) {
  const worlds::WorldRun* bodies = world();
  if (!bodies || body >= bodies->bodies().size()) return notices_.note("there is no such body");
  audience_.hear(Topic::message, picked_json(*bodies, body));
}

// ---- what is shown --------------------------------------------------------------------------------------------------

void Session::turn() {
  const double wall = now_();
  if (played_at_) takes_long_ = wall - *played_at_ > long_turn;
  played_at_ = playing() ? std::optional(wall) : std::nullopt;
  const auto is_due = [&] { return wall - state_said_ >= 0.1; };
  if (playback_.state_has_changed() && (takes_long_ || is_due())) {  // who changed it does not wait for the next step
    publish();
    say_state();
  }
  const bool had_ghost = playback_.ghost() != nullptr;
  playback_.play_on(wall);
  if (had_ghost && !playback_.ghost()) interaction_.forget_ghost();
  drag_.watch(wall);
  publish();
  if ((playback_.state_has_changed() || playing()) && is_due()) say_state();
}

void Session::publish() {
  if (!pending_.has_changed() || history().empty()) return;
  const Sample& sample = playback_.sample();
  Slice& slice = pending_.slice();
  slice.run = run_;
  slice.looking_back = playback_.looks_back();
  slice.t = sample.main.t;
  slice.reached = playing() ? clock().reached_speed() : 0;
  slice.target = clock().speed();
  scene_.draw(sample, world(), slice);
  audience_.see(pending_.take());
}

std::string Session::model_json() const {
  return live::model_json({.run = run_,
                           .shown = shown(),
                           .variables = *playback_.variables(),
                           .path = name_of(text_.path),
                           .text = text_.text,
                           .saveable = place_.writable && text_.path == place_.path,
                           .welcome = place_.path.empty(),
                           .mistakes = mistakes_,
                           .gallery = place_.gallery,
                           .plan = playback_.main().plan(),
                           .world = world(),
                           .undo = interaction_.undo_count()});
}

std::string Session::state_json() const {
  StateWords words{.shown = shown(), .variables = *playback_.variables(), .plan = playback_.main().plan()};
  words.playing = playing();
  words.t = shown_time();
  words.target = clock().speed();
  words.reached = playing() ? clock().reached_speed() : 0;
  words.slow = playing() && clock().slow();
  if (!history().empty()) words.first = history().first_time(), words.last = history().last_time();
  if (playback_.ghost()) words.ghost = &playback_.ghost()->plan();
  words.undo = interaction_.undo_count();
  const auto& modes = shown().model().modes;
  const Sample* sample = playback_.kept_sample();
  if (!modes.empty()) words.mode = modes[sample ? sample->main.mode : 0].name;
  words.statistics = playback_.main().statistics();
  words.ended = playback_.ended();
  return live::state_json(words);
}

/// A state belongs to the model that was said last, so a new one follows.
void Session::say_model() {
  audience_.hear(Topic::model, model_json());
  say_state();
}

void Session::say_state() {
  audience_.hear(Topic::state, state_json());
  state_said_ = now_();
  playback_.forget_state_change();
}

}  // namespace continuo::live
