// continuo/worlds/world_along.cpp
// Advances a world and interpolates its states at the wanted instants.
#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

#include <fmt/format.h>

#include <continuo/worlds/prepared_world.hpp>
#include <continuo/worlds/world_along.hpp>
#include <continuo/worlds/world_events.hpp>

namespace continuo::worlds {

namespace {

using X = std::vector<double>;

/// The states at the two ends of a step, and their interpolation.
class Stretch {
 public:
  Stretch(const model::Model& model, std::span<const double> variables) : world_(*model.world) {
    const auto axes = static_cast<std::size_t>(world_.dimension);
    gravity_ = evaluate(model, std::span(world_.gravity).first(axes), variables);
  }

  void begin(double t, const X& x) { from_ = to_ = t, before_ = after_ = x; }
  /// `contacts` are those within the step.
  void end(double t, const X& x, std::span<const Contact> contacts) {
    to_ = t, after_ = x;
    met_.assign(world_.bodies.size(), 0);
    for (const Contact& contact : contacts) {
      met_[contact.a] = 1;
      if (contact.b != model::no_body) met_[contact.b] = 1;
    }
  }
  X at(double t) const {
    if (t >= to_) return after_;
    if (t <= from_) return before_;
    const double part = (t - from_) / (to_ - from_);
    X x(after_.size());
    for (std::size_t i = 0; i < x.size(); ++i) x[i] = before_[i] + part * (after_[i] - before_[i]);
    const std::size_t per_body = model::WorldDescription::states_of_body(world_.dimension);
    bool before_all = true;
    for (std::size_t body = 0; body < world_.bodies.size(); ++body) {
      if (met_[body] == 0) {
        follow_cubic(body * per_body, part, x);
      } else {
        before_all = follow_parabolas(body * per_body, part, x) && before_all;
      }
    }
    x[collisions()] =
        before_all && std::ranges::find(met_, 1) != met_.end() ? before_[collisions()] : after_[collisions()];
    return x;
  }

 private:
  std::size_t collisions() const { return world_.first_measure + model::world_measures(world_.dimension).size() - 1; }

  void follow_cubic(std::size_t first, double s, X& x) const {
    const double h = to_ - from_;
    for (std::size_t axis = 0; axis < gravity_.size(); ++axis) {
      const std::size_t place = first + 2 * axis, speed = place + 1;
      const double jump = after_[place] - before_[place];
      const double a = h * before_[speed] - jump, b = jump - h * after_[speed];
      x[place] = before_[place] + s * jump + s * (1 - s) * ((1 - s) * a + s * b);
    }
  }
  /// Follows the parabola before or after the impact; true before it. Both parabolas have the same acceleration, so
  /// that their difference d is linear in s, from d0 to d1: it is least at s = -d0.(d1 - d0)/|d1 - d0|^2.
  bool follow_parabolas(std::size_t first, double s, X& x) const {
    const double h = to_ - from_;
    double along = 0, square = 0;
    for (std::size_t axis = 0; axis < gravity_.size(); ++axis) {
      const std::size_t place = first + 2 * axis, speed = place + 1;
      const double bend = gravity_[axis] * h * h / 2;
      const double d0 = before_[place] - (after_[place] - h * after_[speed] + bend);
      const double d1 = before_[place] + h * before_[speed] + bend - after_[place];
      along -= d0 * (d1 - d0);
      square += (d1 - d0) * (d1 - d0);
    }
    const bool before = square > 0 && s < along / square;
    for (std::size_t axis = 0; axis < gravity_.size(); ++axis) {
      const std::size_t place = first + 2 * axis, speed = place + 1;
      const double time = before ? s * h : (s - 1) * h;
      const X& end = before ? before_ : after_;
      x[place] = end[place] + time * (end[speed] + time * gravity_[axis] / 2);
      x[speed] = end[speed] + time * gravity_[axis];
    }
    return before;
  }

  const model::WorldDescription& world_;
  X gravity_, before_, after_;
  std::vector<char> met_;
  double from_ = 0, to_ = 0;
};

class Follower {
 public:
  Follower(const std::shared_ptr<const model::ModelProgram>& program, const AlongRequest& request,
           PreparedWorld& prepared, WorldAlong& made)
      : request_(request),
        plan_(*prepared.plan),
        world_(*prepared.world),
        made_(made),
        events_(program, plan_.variables, plan_.from, (plan_.to - plan_.from) / looks),
        rows_(plan_),
        stretch_(program->model, plan_.variables) {}

  /// Moves the world and keeps the states at all wanted instants.
  Status follow() {
    const auto nobody = [](const WorldEventOccurrence&) {};
    if (Status status = events_.begin(world_, nobody); !status) return status;
    stretch_.begin(world_.time(), world_.state());
    while (true) {
      const double wanted = next_time();
      if (wanted <= world_.time() + slack_of(world_)) {
        made_.times.push_back(wanted);
        made_.states.push_back(stretch_.at(wanted));
        continue;
      }
      if (wanted == std::numeric_limits<double>::infinity() || events_.stopped()) break;
      if (request_.experiment.interrupt != nullptr && request_.experiment.interrupt->load()) {
        made_.outcome.ending = Ending::interrupted;
        break;
      }
      double to = std::min(wanted, events_.next(world_));
      if (world_.step() > 0) to = std::min(to, world_.time() + world_.step() / 2);  // one step, however t is rounded
      if (Status status = events_.advance(world_, to); !status) return status;
      stretch_.end(world_.time(), world_.state(), world_.contacts());
      keep_rows_of_stretch();
      if (Status status = events_.fire_due(world_, nobody); !status) return status;
      stretch_.begin(world_.time(), world_.state());
      if (request_.experiment.progress) request_.experiment.progress(world_.time());
    }
    return {};
  }

 private:
  double next_time() const {
    constexpr double none = std::numeric_limits<double>::infinity();
    const std::size_t row = made_.times.size();
    if (!request_.times.empty()) return row < request_.times.size() ? request_.times[row] : none;
    if (plan_.output != model::OutputPlan::Kind::steps) return rows_[row];
    constexpr double usual_rows = 200;
    const double t = plan_.from + (plan_.to - plan_.from) / usual_rows * static_cast<double>(row);
    return static_cast<double>(row) <= usual_rows ? std::min(t, plan_.to) : none;
  }
  /// Keeps the rows within the step. A row at its very end shows the state after the events there.
  void keep_rows_of_stretch() {
    for (double t = next_time(); t < world_.time(); t = next_time()) {
      made_.times.push_back(t);
      made_.states.push_back(stretch_.at(t));
    }
  }

  const AlongRequest& request_;
  const model::Plan& plan_;
  WorldRun& world_;
  WorldAlong& made_;
  WorldEvents events_;
  model::OutputTimes rows_;
  Stretch stretch_;
};

}  // namespace

WorldAlong world_along(const std::shared_ptr<const model::ModelProgram>& program, const AlongRequest& request) {
  WorldAlong made;
  PreparedWorld prepared = prepare_world(program, request.experiment, made.diagnostics, request.initial);
  if (!prepared.world) return made;
  made.variables = prepared.plan->variables;
  const Status status = Follower(program, request, prepared, made).follow();
  made.outcome.t = prepared.world->time();
  if (!status) {
    made.outcome.ending = status.ending;
    made.outcome.hint = status.message;
  }
  return made;
}

}  // namespace continuo::worlds
