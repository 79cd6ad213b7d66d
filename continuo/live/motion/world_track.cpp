// continuo/live/motion/world_track.cpp
// Moves a world of bodies as a Track.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>

#include <continuo/live/motion/world_track.hpp>
#include <continuo/worlds/world_events.hpp>

namespace continuo::live {

using worlds::dot;
using worlds::Point;
using worlds::WorldRun;

namespace {

Point minus(const Point& a, const Point& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}

}  // namespace

double free_part(const WorldRun& run, std::size_t body, const Point& to) {
  constexpr double gap = 1e-6;  // of the distance: what touches would hold the hand for ever
  const Point from = run.position(body), way = minus(to, from);
  const double radius = run.bodies()[body].radius;
  double part = 1;
  for (const worlds::WallShape& wall : run.walls()) {
    const double height = dot(wall.normal, from) - wall.offset, side = wall.thin && height < 0 ? -1 : 1;
    const double room = side * height - radius, closing = -side * dot(wall.normal, way);
    if (closing > 0) part = std::min(part, std::max(0.0, (room - gap * radius) / closing));
  }
  for (std::size_t i = 0; i < run.bodies().size(); ++i) {
    if (i == body) continue;
    // |d + s*way| = sum of the radii, for the smaller s.
    const Point d = minus(from, run.position(i));
    const double reach = (radius + run.bodies()[i].radius) * (1 + gap);
    const double a = dot(way, way), b = dot(d, way), c = dot(d, d) - reach * reach, root = b * b - a * c;
    if (!(b < 0) || !(root > 0)) continue;
    part = std::min(part, std::max(0.0, (-b - std::sqrt(root)) / a));
  }
  return part;
}

namespace {

using worlds::looks;  // in a run of the text's length

class WorldTrack final : public Track {
 public:
  WorldTrack(const std::shared_ptr<const model::ModelProgram>& program, std::unique_ptr<WorldRun> run,
             const model::Plan& plan)
      : Track(plan),
        run_(std::move(run)),
        events_(program, plan.variables, plan.from, length() / looks),
        layout_(program->model.layout),
        chunk_(length() / looks) {
    status_ = events_.begin(*run_, sink());
    remember();
    end_where_stopped();
  }

  double t() const override { return run_->time(); }

  /// With steps: one. Without: as far as is wanted, or as a moment's work takes it.
  bool advance(double wanted) override {
    if (!status_ || events_.stopped()) return false;
    remember();
    passed_.clear();
    ++statistics_.steps;
    put_held();
    const auto begin = std::chrono::steady_clock::now();
    const double step = run_->step();
    const double to = step > 0 ? before_t_ + step / 2 : std::min(std::max(wanted, before_t_), before_t_ + chunk_);
    status_ = events_.advance(*run_, std::min(to, events_.next(*run_)));
    const std::chrono::duration<double> took = std::chrono::steady_clock::now() - begin;
    constexpr double moment = 4e-3;  // seconds
    chunk_ *= took.count() > moment ? 0.5 : 1.5;
    chunk_ = std::clamp(chunk_, 1e-9 * length(), length());
    put_held();
    note_contacts();
    if (status_) status_ = events_.fire_due(*run_, sink());
    end_where_stopped();
    if (status_ && run_->time() > before_t_) return !events_.stopped();
    if (events_.stopped()) return false;
    if (status_) status_ = {.ending = Ending::cannot_continue, .message = "the time does not advance"};
    outcome_.ending = Ending::not_finite;
    outcome_.t = run_->time();
    outcome_.hint = status_.message;
    return false;
  }

  void at(double t, X& x) override {
    x = run_->state();
    const double end = run_->time();
    if (t >= end || !(end > before_t_)) return;
    const double part = (t - before_t_) / (end - before_t_);
    if (const X* until = first_before()) x = *until;  // events at the end have changed it since
    for (std::size_t i = 0; i < x.size(); ++i) x[i] = before_[i] + part * (x[i] - before_[i]);
  }

  Instant instant_at(double t, bool whole) override {
    Instant instant;
    instant.t = t;
    at(t, instant.x);
    instant.mode = t < run_->time() ? mode_ : run_->mode();
    const auto stops = events_.stops();
    instant.stops.assign(stops.begin(), stops.end());
    if (whole) instant.world = std::make_shared<const worlds::Snapshot>(run_->snapshot());
    return instant;
  }

  Status go_on(const Instant& instant, std::span<const double> variables, std::span<const std::size_t>) override {
    status_ = {};
    outcome_ = {};
    passed_.clear();
    if (!is_of_this_motion(instant)) {
      place(instant);
    } else {
      if (instant.world->time != run_->time()) status_ = run_->restore(*instant.world);
      if (instant.moved) run_->set_state(instant.x);
    }
    const std::vector<double> now(run_->variables().begin(), run_->variables().end());
    for (std::uint32_t i = layout_.parameters; i < layout_.samples && status_; ++i) {
      if (now[i] != variables[i]) status_ = run_->set(i, variables[i]);
    }
    events_.go_on(*run_, run_->variables(), instant.stops);
    remember();
    return status_;
  }

  const Outcome<double>& outcome() const override { return outcome_; }
  const std::string& stop_text() const override { return status_ ? events_.stop_text() : status_.message; }
  Statistics statistics() const override { return statistics_; }
  const WorldRun* world() const override { return run_.get(); }

  void hold(std::optional<HeldBody> held) override {
    held_ = held;
    put_held();
    before_ = run_->state();
  }
  void let_go(std::size_t body, const Point& velocity) override {
    held_.reset();
    if (run_->is_rigid()) {
      run_->pull(std::nullopt);  // it has the velocity that the hand gave it
    } else {
      run_->set_body(body, run_->position(body), velocity);
    }
    before_ = run_->state();
  }

 private:
  worlds::WorldEvents::Sink sink() {
    return [this](const worlds::WorldEventOccurrence& now) {
      Passed passed{now.t, now.names, now.before, run_->state(), run_->mode(), {}};
      const auto stops = events_.stops();
      passed.stops.assign(stops.begin(), stops.end());
      statistics_.events += passed.names.size();
      passed_.push_back(std::move(passed));
    };
  }

  /// Of events at the end of the step, the state that the first of them found.
  const X* first_before() const {
    const auto found = std::ranges::find_if(passed_, [](const Passed& passed) { return !passed.before.empty(); });
    return found == passed_.end() ? nullptr : &found->before;
  }

  void end_where_stopped() {
    if (!events_.stopped()) return;
    outcome_.ending = Ending::stopped_by_event;
    outcome_.event = events_.stopped_by();
    outcome_.t = run_->time();
  }

  void remember() {
    before_ = run_->state();
    before_t_ = run_->time();
    mode_ = run_->mode();
  }

  bool is_of_this_motion(const Instant& instant) const {
    return instant.world && instant.world->method == plan_.method && instant.world->step == plan_.step;
  }
  void place(const Instant& instant) {
    if (instant.mode != run_->mode()) run_->go(instant.mode);
    run_->place(instant.t, instant.x);
  }

  void put_held() {
    if (run_->is_rigid()) {
      run_->pull(held_ ? std::optional(std::pair(held_->body, held_->to)) : std::nullopt);
      return;
    }
    if (!held_) return;
    const Point from = run_->position(held_->body);
    const double part = free_part(*run_, held_->body, held_->to);
    Point there = from;
    for (std::size_t k = 0; k < there.size(); ++k) there[k] += part * (held_->to[k] - from[k]);
    run_->set_body(held_->body, there, {});
  }

  void note_contacts() {
    for (const worlds::Contact& contact : run_->contacts()) {
      statistics_.events += 1;
      const double t = std::clamp(contact.time, before_t_, run_->time());
      passed_.push_back({t, {{run_->name_of(contact), {}}}, {}, {}, run_->mode(), {}});
    }
    std::ranges::sort(passed_, {}, &Passed::t);
  }

  std::unique_ptr<WorldRun> run_;
  worlds::WorldEvents events_;
  model::Layout layout_;
  // At the beginning of the last step:
  X before_;
  double before_t_ = 0;
  std::size_t mode_ = 0;
  double chunk_;
  std::optional<HeldBody> held_;
  Status status_;
  Outcome<double> outcome_;
  Statistics statistics_;
};

}  // namespace

Result<std::unique_ptr<Track>> make_world_track(const std::shared_ptr<const model::ModelProgram>& program,
                                                const model::Plan& plan) {
  worlds::WorldOptions options = worlds::options_of(plan);
  options.most_contacts = 200;
  std::vector<double> variables = plan.variables;
  for (const model::TableInput& input : program->step_inputs) variables[input.variable] = input.table.value(plan.from);
  auto started = worlds::start_world(program, options, variables);
  if (!started) return started.status();
  return std::unique_ptr<Track>(std::make_unique<WorldTrack>(program, *std::move(started), plan));
}

}  // namespace continuo::live
