// continuo/live/session/session_open.cpp
// Models come in, runs begin.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <set>
#include <string>
#include <utility>
#include <variant>

#include <fmt/format.h>

#include <continuo/language/load.hpp>
#include <continuo/language/syntax/format.hpp>
#include <continuo/language/syntax/parser.hpp>
#include <continuo/live/session.hpp>
#include <continuo/live/session/messages.hpp>
#include <continuo/live/session/write_file.hpp>
#include <continuo/runs/kind.hpp>
#include <continuo/runs/run.hpp>
#include <continuo/simulation/simulate.hpp>
#include <continuo/solve/catalogue.hpp>

namespace continuo::live {

namespace {

void collect_times(const std::vector<model::ast::Statement>& statements, std::set<std::string>& times) {
  for (const model::ast::Statement& statement : statements) {
    if (const auto* condition = std::get_if<model::ast::Condition>(&statement.node))
      times.insert(model::to_text(condition->time));
    if (const auto* family = std::get_if<model::ast::Family>(&statement.node)) collect_times(family->body, times);
  }
}

/// Whether conditions stand at several times, so that nothing moves before all is known. Only where they are written in
/// several ways has the text to be checked; what has errors is no such model, and can be mended here.
bool has_no_start(const model::Source& source) {
  std::set<std::string> times;
  collect_times(model::parse(source).model.statements, times);
  if (times.size() < 2) return false;
  const model::Loaded loaded = model::load(source);
  return loaded.model && !runs::kind_of(*loaded.model).has_start;
}

}  // namespace

std::vector<GalleryModel> gallery_in(const std::string& folder) {
  std::vector<GalleryModel> found;
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator(folder, error)) {
    if (entry.path().extension() != ".sim") continue;
    const auto source = model::read_source(entry.path());
    if (!source || has_no_start(*source)) continue;
    const std::string line = source->text().substr(0, source->text().find('\n'));
    const std::size_t begin = line.find_first_not_of("# \t");
    const bool heading = line.starts_with('#') && begin != std::string::npos;
    found.push_back({entry.path().stem().string(), heading ? line.substr(begin) : "", entry.path().string()});
  }
  std::ranges::sort(found, {}, &GalleryModel::name);
  return found;
}

Session::Session(Now now, Audience& audience, Place place)
    : now_(std::move(now)), audience_(audience), place_(std::move(place)), slice_(std::make_shared<Slice>()) {}

model::Loaded Session::open_file() {
  model::Loaded loaded = model::load(place_.path);
  problems_ = loaded.diagnostics;
  if (loaded.model) begin(*loaded.model, place_.path, loaded.source.text());
  return loaded;
}

namespace {

/// One second on the wall for one of the model, if that lets a run of the text be watched; else a round speed at which
/// it takes about twenty.
double first_speed(const model::Model& model, double span) {
  if (model.run.realtime || (span >= 1 && span <= 300)) return 1;
  const double wanted = span / 20, power = std::pow(10.0, std::floor(std::log10(wanted)));
  const double digit = wanted / power;
  return power * (digit < 1.5 ? 1 : digit < 3.5 ? 2 : digit < 7.5 ? 5 : 10);
}

model::Experiment experiment_of(const MethodChoice& choice, const model::Overrides& parameters) {
  model::Experiment experiment;
  experiment.method = choice.name;
  experiment.step = choice.step;
  experiment.rtol = choice.rtol;
  experiment.parameters = parameters;
  return experiment;
}

}  // namespace

bool Session::begin(model::Model model, std::string path, std::string text) {
  const bool other = path != path_ || !shown_;
  auto shown = std::make_shared<const LiveModel>(prepare(std::move(model), other ? Taken() : settings_.taken));
  const auto before = std::exchange(shown_, std::move(shown));
  const Settings settings = settings_;
  std::swap(path, path_);
  std::swap(text, text_);
  if (other) settings_ = {}, undo_.clear();
  std::erase_if(settings_.parameters,
                [this](const auto& given) { return find_parameter(shown_->model(), given.first) == model::npos; });
  if (!begin_run()) {
    shown_ = before;
    settings_ = settings;
    std::swap(path, path_);
    std::swap(text, text_);
    return false;
  }
  if (other) clock_.set_speed(now_(), cursor_, first_speed(shown_->model(), span_));
  return true;
}

std::optional<model::Plan> Session::plan_by(const MethodChoice& choice) {
  std::vector<model::Diagnostic> problems;
  model::Experiment experiment = experiment_of(choice, settings_.parameters);
  const MethodInfo* info = choice.name ? find_method(*choice.name) : nullptr;
  // Who names an adaptive method means it to choose its steps, though the text gives one for another method.
  if (info && info->error_order > 0 && !choice.step && !choice.rtol)
    experiment.rtol = shown_->model().run.rtol.value_or(1e-6);
  auto plan = runs::plan_from_start(*shown_->program, experiment, problems);
  for (const model::Diagnostic& problem : problems) say(problem);
  if (!plan) {
    problems_ = std::move(problems);
    return std::nullopt;
  }
  for (const auto& [name, value] : settings_.inputs) {
    const std::size_t i = find_input(shown_->model(), name);
    if (i != model::npos) plan->variables[shown_->model().inputs[i].variable] = value;
  }
  return plan;
}

std::unique_ptr<Track> Session::track_by(const MethodChoice& choice) {
  const auto plan = plan_by(choice);
  if (!plan) return nullptr;
  MadeTrack made = make_track(shown_->program, *plan);
  if (!made.track) {
    problems_ = {model::error("", {}, made.error)};
    say(problems_.front());
  }
  return std::move(made.track);
}

bool Session::begin_run() {
  auto main = track_by(settings_.method);
  if (!main) return false;
  main_ = std::move(main);
  ghost_ = settings_.ghost ? track_by(*settings_.ghost) : nullptr;
  if (!ghost_) settings_.ghost.reset();
  const model::Plan& plan = main_->plan();
  variables_ = std::make_shared<const std::vector<double>>(plan.variables);
  span_ = plan.to > plan.from ? plan.to - plan.from : 1;
  cursor_ = plan.from;
  next_passed_ = 0;
  stride_ = 0;
  main_over_ = until_event_ = false;
  ended_.clear();
  looking_.reset();
  held_.clear();
  in_hand_.clear();
  history_.clear();
  slice_ = std::make_shared<Slice>();
  ++run_;
  show_run();
  held_body_.reset();
  const Instant start = main_->instant_at(cursor_);
  first_energy_ = energy_of(cursor_, start.x);
  say_model();
  emit(start);
  restart_clock();
  state_changed_ = true;
  return true;
}

/// Parameters that decide how many equations there are go into the check itself.
bool Session::load_anew(const std::string& path, const std::string& text) {
  model::Loaded loaded = model::load(model::Source(path, text));
  model::Overrides structural;
  for (const auto& [name, value] : settings_.parameters) {
    const std::size_t i = loaded.model ? find_parameter(*loaded.model, name) : model::npos;
    if (i != model::npos && loaded.model->parameters[i].structural) structural[name] = value;
  }
  if (!structural.empty()) loaded = model::load(model::Source(path, text), {.overrides = structural});
  for (const model::Diagnostic& problem : loaded.diagnostics) say(problem, &loaded.source);
  return loaded.model && begin(*loaded.model, path, text);
}

void Session::run_text(const std::string& text) {
  load_anew(path_, text);
}

void Session::open_gallery(const std::string& name) {
  const auto found = std::ranges::find(place_.gallery, name, &GalleryModel::name);
  if (found == place_.gallery.end()) return say_note(fmt::format("there is no model `{}` in the gallery", name));
  model::Loaded loaded = model::load(found->path);
  for (const model::Diagnostic& problem : loaded.diagnostics) say(problem, &loaded.source);
  if (!loaded.model) return;
  begin(std::move(*loaded.model), found->path, loaded.source.text());
}

void Session::save_text(const std::string& text) {
  if (path_ != place_.path) return say_note(fmt::format("only {} is ever written", place_.path));
  if (const Status status = write_atomically(path_, text); !status) {
    return say(model::error("", {}, status.message));
  }
  text_ = text;
  audience_.hear(Topic::message, saved_json(path_));
}

}  // namespace continuo::live
