// continuo/live/world_track.cpp
#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>

#include <continuo/live/world_track.hpp>

namespace continuo::live {

using worlds::Point;
using worlds::WorldRun;

namespace {

double dot(const Point& a, const Point& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
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
    const double room = dot(wall.normal, from) - radius - wall.offset, closing = -dot(wall.normal, way);
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

class WorldTrack final : public Track {
 public:
  WorldTrack(std::unique_ptr<WorldRun> run, const model::Plan& plan)
      : Track(plan), run_(std::move(run)), before_(run_->state()), before_t_(run_->time()), chunk_(length() / 1000) {}

  double t() const override { return run_->time(); }

  /// With steps: one. Without: as far as is wanted, or as a moment's work takes it.
  bool advance(double wanted) override {
    if (!error_.empty()) return false;
    passed_.clear();
    before_ = run_->state();
    before_t_ = run_->time();
    ++statistics_.steps;
    put_held();
    const auto begin = std::chrono::steady_clock::now();
    const double step = run_->step();
    const double to = step > 0 ? before_t_ + step / 2 : std::min(std::max(wanted, before_t_), before_t_ + chunk_);
    error_ = run_->advance_to(to);
    const std::chrono::duration<double> took = std::chrono::steady_clock::now() - begin;
    constexpr double moment = 4e-3;  // seconds
    chunk_ *= took.count() > moment ? 0.5 : 1.5;
    chunk_ = std::clamp(chunk_, 1e-9 * length(), length());
    put_held();
    note_contacts();
    if (error_.empty() && run_->time() > before_t_) return true;
    if (error_.empty()) error_ = "the time does not advance";
    outcome_.ending = Ending::not_finite;
    outcome_.t = run_->time();
    outcome_.hint = error_;
    return false;
  }

  void at(double t, X& x) override {
    x = run_->state();
    const double end = run_->time();
    if (t >= end || !(end > before_t_)) return;
    const double part = (t - before_t_) / (end - before_t_);
    for (std::size_t i = 0; i < x.size(); ++i) x[i] = before_[i] + part * (x[i] - before_[i]);
  }

  Instant instant_at(double t, bool whole) override {
    Instant instant;
    instant.t = t;
    at(t, instant.x);
    instant.mode = run_->mode();
    if (whole) instant.world = std::make_shared<const worlds::Snapshot>(run_->snapshot());
    return instant;
  }

  std::string go_on(const Instant& instant, std::span<const double> variables, std::span<const std::size_t>) override {
    error_.clear();
    outcome_ = {};
    passed_.clear();
    if (instant.world && instant.world->time != run_->time()) error_ = run_->restore(*instant.world);
    if (instant.moved) run_->set_state(instant.x);
    const std::vector<double> now(run_->variables().begin(), run_->variables().end());
    for (std::uint32_t i = layout_begin(); i < layout_end() && error_.empty(); ++i) {
      if (now[i] != variables[i]) error_ = run_->set(i, variables[i]);
    }
    before_ = run_->state();
    before_t_ = run_->time();
    return error_;
  }

  void set_layout(const model::Layout& layout) { layout_ = layout; }

  const Outcome<double>& outcome() const override { return outcome_; }
  const std::string& stop_text() const override { return error_; }
  Statistics statistics() const override { return statistics_; }
  const WorldRun* world() const override { return run_.get(); }

  void hold(std::optional<HeldBody> held) override {
    held_ = held;
    put_held();
    before_ = run_->state();
  }

 private:
  std::uint32_t layout_begin() const { return layout_.parameters; }
  std::uint32_t layout_end() const { return layout_.samples; }

  void put_held() {
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
  X before_;
  double before_t_, chunk_;
  model::Layout layout_;
  std::optional<HeldBody> held_;
  std::string error_;
  Outcome<double> outcome_;
  Statistics statistics_;
};

}  // namespace

MadeTrack make_world_track(const std::shared_ptr<const model::ModelProgram>& program, const model::Plan& plan) {
  worlds::WorldOptions options = worlds::options_of(plan);
  options.most_contacts = 200;
  worlds::StartedWorld started = worlds::start_world(program, options, plan.variables);
  if (!started.run) return {nullptr, started.error};
  auto track = std::make_unique<WorldTrack>(std::move(started.run), plan);
  track->set_layout(program->model.layout);
  return {std::move(track), {}};
}

}  // namespace continuo::live
