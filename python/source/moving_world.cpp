// Moves a world whose arrays others may look into and write to.
#include "moving_world.hpp"

#include <cmath>

#include <fmt/format.h>

#include <continuo/bodies/snapshot.hpp>

namespace continuo::python {

namespace {

/// Numbers that were written into views may be anything.
template <int Dim>
Status check_numbers(const World<double, Dim>& world) {
  for (std::size_t i = 0; i < world.size(); ++i) {
    const bool good = is_finite(world.position[i]) && is_finite(world.velocity[i]) && is_finite(world.spin[i]) &&
                      is_finite(world.orientation[i]);
    if (!good)
      return invalid_input(fmt::format("the position, velocity, spin or orientation of body {} is not finite", i));
  }
  return {};
}

/// Keeps the old array where a view may be looking into it; the world goes on with a copy.
template <class T>
void part(std::vector<T>& array, std::vector<T>& former) {
  std::vector<T> copy;
  copy.reserve(array.capacity());
  copy = array;
  former = std::exchange(array, std::move(copy));
}

}  // namespace

template <int Dim>
World<double, Dim>& MovingWorld<Dim>::bodies() {
  changed_ = true;
  if (memory_.use_count() > 1) {
    part(world_.position, memory_->position), part(world_.velocity, memory_->velocity);
    part(world_.orientation, memory_->orientation), part(world_.spin, memory_->spin);
    part(world_.radius, memory_->radius), part(world_.mass, memory_->mass);
    memory_ = std::make_shared<FormerArrays<Dim>>();
  }
  return world_;
}

template <int Dim>
Joint<double, Dim>* MovingWorld<Dim>::joint(JointHandle handle) {
  if (settings_.sleep_after > 0) changed_ = true;
  return world_.find(handle);
}

template <int Dim>
std::shared_ptr<FormerArrays<Dim>> MovingWorld<Dim>::memory() {
  if (!is_watched_) remember();
  is_watched_ = true;
  return memory_;
}

template <int Dim>
void MovingWorld<Dim>::remember() {
  remembered_.position = world_.position, remembered_.velocity = world_.velocity;
  remembered_.orientation = world_.orientation, remembered_.spin = world_.spin;
}

template <int Dim>
bool MovingWorld<Dim>::is_as_left() const {
  return !changed_ &&
         (!is_watched_ || (remembered_.position == world_.position && remembered_.velocity == world_.velocity &&
                           remembered_.orientation == world_.orientation && remembered_.spin == world_.spin));
}

template <int Dim>
void MovingWorld<Dim>::set(const MotionSettings& settings) {
  settings_ = settings;
  exact_.reset(), fast_.reset();
}

template <int Dim>
Status MovingWorld<Dim>::prepare() {
  events_.clear();
  lost_ = 0;
  interrupt = false;
  const bool is_same = is_as_left();
  if (!is_same) {
    if (Status status = check_numbers(world_); !status) return status;
  }
  if (settings_.exact && !exact_) {
    exact_.emplace(world_, ExactOptions<double>{.contact_time = settings_.contact_time,
                                                .tolerance = settings_.tolerance,
                                                .contact_events = settings_.contact_events,
                                                .interrupt = &interrupt});
  } else if (!settings_.exact && !fast_) {
    fast_.emplace(world_, FastOptions<double>{.step = settings_.step,
                                              .substeps = settings_.substeps,
                                              .contact_events = settings_.contact_events,
                                              .sleep_after = settings_.sleep_after,
                                              .threads = settings_.threads});
  } else if (settings_.exact && !is_same) {
    exact_->refresh();
  } else if (!is_same) {
    fast_->refresh();
  }
  changed_ = false;
  return {};
}

template <int Dim>
void MovingWorld<Dim>::settle() {
  is_watched_ = memory_.use_count() > 1;
  if (is_watched_) remember();
}

template <int Dim>
void MovingWorld<Dim>::note(std::span<const Event> events, std::size_t lost) {
  const std::size_t room = settings_.contact_events - std::min(settings_.contact_events, events_.size());
  const std::size_t taken = std::min(room, events.size());
  events_.insert(events_.end(), events.begin(), events.begin() + static_cast<std::ptrdiff_t>(taken));
  lost_ += lost + events.size() - taken;
}

template <int Dim>
Status MovingWorld<Dim>::advance(std::size_t steps) {
  Status status = prepare();
  for (std::size_t k = 0; k < steps && status; ++k) {
    if (interrupt) {
      status = {Ending::interrupted, "the steps were interrupted", {}};
      break;
    }
    status = fast_->advance();
    note(fast_->contact_events(), fast_->lost_contact_events());
  }
  settle();
  return status;
}

template <int Dim>
Status MovingWorld<Dim>::advance_to(double t) {
  if (!settings_.exact) {
    // A time that is a rounding beyond the end of a step is that end.
    const double steps = std::ceil((t - world_.time) / settings_.step - 1e-9);
    return advance(steps > 0 ? static_cast<std::size_t>(steps) : 0);
  }
  if (Status status = prepare(); !status) return status;
  Status status = exact_->advance_to(t);
  note(exact_->contact_events(), exact_->lost_contact_events());
  settle();
  return status;
}

template <int Dim>
std::vector<std::byte> MovingWorld<Dim>::save() {
  const bool is_same = is_as_left();
  if (is_same && settings_.exact && exact_) return snapshot(world_, *exact_);
  if (is_same && !settings_.exact && fast_) return snapshot(world_, *fast_);
  return snapshot(world_);
}

template <int Dim>
Status MovingWorld<Dim>::restore(std::span<const std::byte> bytes) {
  W& world = bodies();
  if (Status status = prepare(); !status) return status;
  // With the motion where the snapshot has one, so that it goes on to the same bits; else the bodies alone.
  Status status = settings_.exact ? continuo::restore(bytes, world, *exact_) : continuo::restore(bytes, world, *fast_);
  if (status) {
    changed_ = false;
    settle();
    return status;
  }
  status = continuo::restore(bytes, world);
  changed_ = true;
  return status;
}

template class MovingWorld<2>;
template class MovingWorld<3>;

}  // namespace continuo::python
