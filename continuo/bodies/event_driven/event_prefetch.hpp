// continuo/bodies/event_driven/event_prefetch.hpp
// Prefetching for events. Many bodies do not fit into the cache of a core, and each event would wait for memory several
// times: for the body, then for its cells, then for the bodies in them. The queue knows the bodies of the next events,
// so that the data of these events is prefetched in that order, some events earlier, while others are processed. This
// affects run time only.
#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

#include <continuo/bodies/event_driven/event_queue.hpp>
#include <continuo/bodies/event_driven/flights.hpp>

namespace continuo {

template <class Real, int Dim>
class EventPrefetch {
 public:
  using Bodies = Flights<Real, Dim>;

  /// Prefetches the data in `flights` for the next events of `queue`.
  void look_ahead(const EventQueue<Real>& queue, const Bodies& flights) {
    const std::uint32_t present = queue.present_bucket();
    if (present < seen_) seen_ = 0;
    if (flights.memory() < in_cache) seen_ = present;
    for (; seen_ < present; ++seen_) {
      visit(queue, seen_ + 3 * apart, [&](std::uint32_t i) {
        queue.ask_for(i);
        ask_for_flight(flights, i);
      });
      visit(queue, seen_ + 2 * apart, [&](std::uint32_t i) {
        const Plan<Real, Dim>& plan = flights.plans[i];
        if (plan.partner < first_wall && plan.collision_time < plan.crossing_time) {
          ask_for_flight(flights, plan.partner);
          prefetch(&flights.collisions[plan.partner]);
        }
        if (!plan.is_large) flights.grid.ask_for_around(plan.cell);
      });
      visit(queue, seen_ + apart, [&](std::uint32_t i) {
        if (flights.plans[i].is_large) return;
        const std::size_t count = flights.grid.gather_around(flights.plans[i].cell, around_);
        for (std::size_t k = 0; k < count; ++k) prefetch(&flights.paths[around_[k]]);
      });
    }
  }

 private:
  static constexpr std::size_t in_cache = std::size_t{4} << 20;  // bytes: below, it costs more than it saves
  static constexpr std::uint32_t apart = 4;                      // buckets, of about one event each

  template <class Visit>
  void visit(const EventQueue<Real>& queue, std::uint32_t bucket, Visit&& visit) {
    const std::size_t count = queue.coming(bucket, coming_);
    for (std::size_t k = 0; k < count; ++k) visit(coming_[k]);
  }
  static void ask_for_flight(const Bodies& flights, std::uint32_t i) {
    prefetch(&flights.plans[i]);
    prefetch(&flights.plans[i].number);  // in its second line
    prefetch(&flights.paths[i]);
  }

  std::uint32_t seen_ = 0;  // so many buckets have been looked at
  std::vector<std::uint32_t> coming_, around_;
};

}  // namespace continuo
