// The W runs that a thread advances at once, in groups of as many as a register has numbers. The groups take their
// steps in turn: while the size of a step waits for the error of the one before, the processor computes the next
// group's. One group of several registers would fill them, and send what does not fit through memory.
#pragma once
#include <cstddef>
#include <optional>
#include <utility>

#include <xsimd/xsimd.hpp>

#include <continuo/ensembles/lanes/lane_driver.hpp>

namespace continuo::detail {

template <class F, class Starts, class M, std::size_t W, class... E>
class LaneGroups {
  static constexpr std::size_t in_register = xsimd::batch<double>::size;
  // Steps of a fixed size wait for nothing, and a step of few stages finds room in the registers.
  // A system may be one of so many lanes, and no others.
  static constexpr bool is_of_any_width = !requires { F::lanes; };
  static constexpr std::size_t count =
      M::error_order > 0 && is_of_any_width&& W % in_register == 0 ? W / in_register : 1;

 public:
  using Driver = LaneDriver<F, Starts, M, W / count, E...>;
  using Settings = typename Driver::Settings;
  using Queue = typename Driver::Queue;

  /// For the runs of a queue that is not empty.
  LaneGroups(const F& f, const Starts& starts, const Settings& settings, Queue& queue)
      : LaneGroups(f, starts, settings, queue, std::make_index_sequence<count>()) {}

  /// Works until the queue is empty.
  void run() {
    while (true) {
      for (One& group : groups_) group.driver.refill();
      if (!any_is_active()) {
        const std::optional<std::size_t> pending = first_pending();
        if (!pending) return;
        queue_.wait_for_room(*pending);
        if (queue_.stopped()) return;
      }
      while (any_is_active() && !idle_can_begin()) {
        for (One& group : groups_)
          if (group.driver.is_active()) group.driver.take_step();
      }
    }
  }

 private:
  struct One {
    Driver driver;
  };
  Queue& queue_;
  One groups_[count];

  template <std::size_t... i>
  LaneGroups(const F& f, const Starts& starts, const Settings& settings, Queue& queue, std::index_sequence<i...>)
      : queue_(queue), groups_{{((void)i, Driver(f, starts, settings, queue))}...} {}

  [[nodiscard]] bool any_is_active() const {
    for (const One& group : groups_)
      if (group.driver.is_active()) return true;
    return false;
  }
  [[nodiscard]] bool idle_can_begin() const {
    for (const One& group : groups_)
      if (group.driver.idle_can_begin()) return true;
    return false;
  }
  [[nodiscard]] std::optional<std::size_t> first_pending() const {
    std::optional<std::size_t> first;
    for (const One& group : groups_) {
      const std::optional<std::size_t>& one = group.driver.pending();
      if (one && (!first || *one < *first)) first = one;
    }
    return first;
  }
};

}  // namespace continuo::detail
