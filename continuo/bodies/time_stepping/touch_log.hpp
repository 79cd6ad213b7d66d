// continuo/bodies/time_stepping/touch_log.hpp
// Lasting contacts from step to step: which have begun, which have ended, and the impulse of each since it began.
#pragma once
#include <algorithm>
#include <array>
#include <cstdint>
#include <utility>
#include <vector>

#include <continuo/bodies/contact_events.hpp>
#include <continuo/bodies/contact_solver/solver_body.hpp>
#include <continuo/bodies/time_stepping/contact_list.hpp>
#include <continuo/bodies/world.hpp>

namespace continuo {

template <class Real, int Dim>
class TouchLog {
 public:
  /// To be called in each step for each contact, in any order, with the impulse of the step. Contacts of the same two,
  /// as of several parts of a compound, count as one.
  void touch(const ContactEvent<Real, Dim>& contact) { now_.push_back({key(contact), contact}); }

  /// The step ends at `time`.
  void end_step(const Real& time, ContactLog<Real, Dim>& log) {
    std::ranges::sort(now_, {}, [](const Touch& touch) { return std::pair(touch.first, -touch.second.impulse); });
    join_equal();
    auto old = before_.begin();
    const auto end_old = [&] {
      old->second.change = ContactChange::end;
      old->second.time = time;
      log.add(old->second);
      ++old;
    };
    for (Touch& touch : now_) {
      while (old != before_.end() && old->first < touch.first) end_old();
      const bool lasts = old != before_.end() && old->first == touch.first;
      if (lasts) {
        touch.second.impulse += old->second.impulse;
        ++old;
      } else {
        ContactEvent<Real, Dim> event = touch.second;
        event.change = ContactChange::begin;
        event.time = time;
        event.impulse = Real(0);
        log.add(event);
      }
    }
    while (old != before_.end()) end_old();
    std::swap(before_, now_);
    now_.clear();
  }

  template <class Archive>
  void transfer(Archive& archive) {
    auto count = static_cast<std::uint64_t>(before_.size());
    archive(count);
    if constexpr (Archive::reads) {
      if (count > archive.left()) return archive.fail("a list longer than the bytes that are left");
      before_.resize(static_cast<std::size_t>(count));
    }
    for (auto& [of, event] : before_) {
      archive(of), archive(event.a.slot), archive(event.a.generation), archive(event.b.slot);
      archive(event.b.generation), archive(event.wall), archive(event.mesh), archive(event.point);
      archive(event.normal), archive(event.impulse);
    }
  }

 private:
  using Key = std::array<std::uint32_t, 6>;
  using Touch = std::pair<Key, ContactEvent<Real, Dim>>;
  [[nodiscard]] static Key key(const ContactEvent<Real, Dim>& contact) {
    return {contact.a.slot, contact.a.generation, contact.wall, contact.mesh, contact.b.slot, contact.b.generation};
  }
  /// Leaves one contact of those of the same two: the first, which has the greatest impulse, with the sum of all.
  void join_equal() {
    std::size_t kept = 0;
    for (std::size_t k = 0; k < now_.size(); ++k) {
      if (kept > 0 && now_[kept - 1].first == now_[k].first) {
        now_[kept - 1].second.impulse += now_[k].second.impulse;
      } else {
        now_[kept++] = now_[k];
      }
    }
    now_.resize(kept);
  }

  std::vector<Touch> before_, now_;
};

/// Notes, at the end of a step, the contacts with a normal impulse in the last of so many substeps. order[k] is the
/// number in the world of the body at place k.
template <class Real, int Dim>
void note_touching(const World<Real, Dim>& world, const SolverBodies<Real, Dim>& bodies,
                   const std::vector<std::uint32_t>& order, const ContactList<Real, Dim>& contacts, int substeps,
                   TouchLog<Real, Dim>& touches) {
  const auto handle = [&](std::uint32_t k) { return world.handle(order[k]); };
  contacts.for_each_touching([&](std::uint32_t k, std::uint32_t other, bool is_wall, const Real& impulse) {
    ContactEvent<Real, Dim> event{.a = handle(k)};
    event.impulse = impulse * static_cast<Real>(substeps);
    if (is_wall) {
      event.wall = other;
      event.normal = -facing(world.walls()[other], bodies.x(k)).normal;
    } else {
      event.b = handle(other);
      if (event.b.slot < event.a.slot) std::swap(event.a, event.b);
      const Vector<Real, Dim> apart = world.position_of(event.b) - world.position_of(event.a);
      if (const Real distance = length(apart); distance > Real(0)) event.normal = apart * (1 / distance);
    }
    event.point = world.position_of(event.a) + event.normal * world.radius[world.index(event.a)];
    touches.touch(event);
  });
}

}  // namespace continuo
