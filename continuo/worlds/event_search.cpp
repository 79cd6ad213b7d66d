// The search for events between two samples of their conditions, in a world without steps.
#include <algorithm>
#include <cstdint>
#include <vector>

#include <continuo/worlds/world_events.hpp>

namespace continuo::worlds {

void WorldEvents::find_watched() {
  const model::Model& model = program_->model;
  std::vector<model::NodeId> guards;
  for (const model::When& when : model.events) guards.push_back(when.guard);
  const std::size_t per_body = model::WorldDescription::states_of_body(model.world->dimension);
  for (const std::uint32_t variable : variables_of(model.graph, guards)) {
    const std::size_t state = variable - model.layout.states;
    if (variable >= model.layout.states && state < model.world->body_states()) watched_.insert(state / per_body);
  }
}

/// Moves the world back to just before the first contact of a body that conditions depend on, or, if it was there, to
/// that contact: between contacts conditions are smooth. Where there are many contacts this is not worth its time.
Status WorldEvents::look_at_first_contact(WorldRun& world, const Snapshot& saved) {
  constexpr std::size_t many = 16;
  const double just = 1e-9 * look_;
  double first = world.time();
  std::size_t count = 0;
  for (const Contact& contact : world.contacts()) {
    if (!watched_.contains(contact.a) && !watched_.contains(contact.b)) continue;
    ++count;
    if (contact.time > saved.time) first = std::min(first, contact.time);
  }
  if (!(first < world.time()) || count > many) return {};
  Status status = world.restore(saved);
  return status ? world.advance_to(first - just > saved.time ? first - just : first) : status;
}

/// A condition that approached 0 at the last sample and recedes from it now has a minimum of its distance in between.
/// Its value there shows whether it has crossed 0; if so, the world is left there.
Status WorldEvents::look_where_guards_turn(WorldRun& world, const Snapshot& saved, const X& before) {
  const double from = saved.time, to = world.time();
  for (std::size_t i = 0; i < events_.size(); ++i) {
    if (!events_.is_guard(i) || !events_.active(system_, i) || !(before_[i] * values_[i] > 0)) continue;
    const double sign = before_[i] > 0 ? 1 : -1;
    const bool turns =
        sign * slope(i, from, before, to - from) < 0 && sign * slope(i, to, world.state(), to - from) > 0;
    if (!turns) continue;
    const Snapshot end = world.snapshot();
    Status status;
    const auto value_at = [&](double t) {
      if (status) status = world.restore(saved);
      if (status) status = world.advance_to(t);
      read_guards(world, values_);
      return sign * values_[i];
    };
    const auto is_through = [&] { return !status || any_passed() || !(sign * values_[i] > 0); };
    // The minimum by golden section search, to half of the digits: nearer to the minimum the value does not change.
    constexpr double part = 0.381966011250105;
    double low = from, high = to, a = low + part * (high - low), b = high - part * (high - low);
    double at_a = value_at(a), at_b = is_through() ? at_a : value_at(b);
    while (!is_through() && high - low > 1e-8 * (to - from)) {
      if (at_a < at_b) {
        high = b, b = a, at_b = at_a, a = low + part * (high - low), at_a = value_at(a);
      } else {
        low = a, a = b, at_a = at_b, b = high - part * (high - low), at_b = value_at(b);
      }
    }
    if (is_through()) return status;
    if (status = world.restore(end); !status) return status;
    read_guards(world, values_);
  }
  return {};
}

/// The change of a guard in a short time at the present velocities.
double WorldEvents::slope(std::size_t i, double t, const X& state, double length) {
  const model::WorldDescription& text = *program_->model.world;
  const double moment = 1e-7 * length;
  X later = state;
  const std::size_t per_body = model::WorldDescription::states_of_body(text.dimension);
  for (std::size_t first = 0; first < text.body_states(); first += per_body) {
    // x, x', y, y', and angle, angle' in the plane or z, z' in space
    for (std::size_t k = 0; k < 3; ++k) later[first + 2 * k] += moment * state[first + 2 * k + 1];
  }
  std::vector<double> now(events_.size()), then(events_.size());
  events_.guards(system_, t, state, now);
  events_.guards(system_, t + moment, later, then);
  return then[i] - now[i];
}

}  // namespace continuo::worlds
