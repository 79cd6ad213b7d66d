// continuo/bodies/contact_events.hpp
// Contact events: the two bodies, the point, the time and the impulse. A motion records them while it advances; the
// caller reads them afterwards.
//
//   ExactMotion motion(world, {.contact_events = 1000});
//   motion.advance_to(1);
//   for (const ContactEvent<double, 3>& event : motion.contact_events()) ...
#pragma once
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <limits>
#include <span>
#include <vector>

#include <continuo/bodies/body.hpp>

namespace continuo {

/// What happens to a contact.
enum class ContactChange : std::uint8_t {
  impact,  // begins and ends in an instant
  begin,   // of a contact that lasts
  end
};

/// One event of a contact. The impulse has the unit mass times velocity.
template <class Real, int Dim>
struct ContactEvent {
  static constexpr std::uint32_t no_wall = std::numeric_limits<std::uint32_t>::max();  // `wall` of two bodies
  static constexpr std::uint32_t no_mesh = no_wall;                                    // `mesh`, if it is none

  ContactChange change = ContactChange::impact;  // what happens
  BodyHandle a{};                                // a body
  BodyHandle b{};                                // the other one; unused in a contact with a wall or a mesh
  std::uint32_t wall = no_wall;                  // its number in world.walls()
  std::uint32_t mesh = no_mesh;                  // its number in world.meshes()
  Vector<Real, Dim> point{};                     // of the contact
  Vector<Real, Dim> normal{};                    // from a to b, or into the wall or mesh; of length 1
  Real impulse{};                                // along the normal: of the impact; at `end`, of the whole contact
  Real time{};                                   // of the world

  /// Whether b is a wall.
  [[nodiscard]] bool with_wall() const { return wall != no_wall; }
  /// Whether b is a static mesh.
  [[nodiscard]] bool with_mesh() const { return mesh != no_mesh; }
};

/// The contact events of one call: the first `most` of them, and the number of the others.
template <class Real, int Dim>
class ContactLog {
 public:
  /// An empty log for `most` events; with 0, nothing is recorded.
  explicit ContactLog(std::size_t most = 0) : most_(most) {}

  /// Whether events are recorded.
  [[nodiscard]] bool is_kept() const { return most_ > 0; }
  /// Drops all events, and sets the number of lost ones to 0.
  void clear() {
    events_.clear();
    lost_ = 0;
  }
  /// Records an event, or counts it as lost where the log is full.
  void add(const ContactEvent<Real, Dim>& event) {
    if (events_.size() < most_) {
      events_.push_back(event);
    } else if (most_ > 0) {
      ++lost_;
    }
  }
  /// Merges the events of another log in the order of time. `rename` gives the handle here for a handle there.
  template <class Rename>
  void take_over(ContactLog& other, Rename&& rename) {
    if (other.events_.empty()) return;
    for (ContactEvent<Real, Dim>& event : other.events_) {
      event.a = rename(event.a);
      if (!event.with_wall() && !event.with_mesh()) event.b = rename(event.b);
    }
    using Event = ContactEvent<Real, Dim>;
    const auto first = std::ranges::upper_bound(events_, other.events_.front().time, {}, &Event::time);
    const std::vector<Event> later(first, events_.end());
    events_.erase(first, events_.end());
    std::ranges::merge(later, other.events_, std::back_inserter(events_), {}, &Event::time, &Event::time);
    lost_ += other.lost_;
    if (events_.size() > most_) lost_ += events_.size() - most_, events_.resize(most_);
    other.clear();
  }
  /// The recorded events, in the order of time.
  [[nodiscard]] std::span<const ContactEvent<Real, Dim>> events() const { return events_; }
  /// The number of events that were not recorded because the log was full.
  [[nodiscard]] std::size_t lost() const { return lost_; }

 private:
  std::size_t most_, lost_ = 0;
  std::vector<ContactEvent<Real, Dim>> events_;
};

}  // namespace continuo
