// The runs that a thread advances at once, W or more, in groups of as many as a register has numbers. The groups take
// their steps in turn: while the size of a step waits for the error of the one before, or a stage for the one before,
// the processor computes the next group's. One group of several registers would fill them, and send what does not fit
// through memory.
#pragma once
#include <algorithm>
#include <array>
#include <cstddef>
#include <optional>
#include <utility>

#include <xsimd/xsimd.hpp>

#include <continuo/ensembles/lanes/lane_driver.hpp>

namespace continuo::detail {

template <class F, class Starts, class M, std::size_t W, class... E>
class LaneGroups {
  static constexpr std::size_t in_register = xsimd::batch<double>::size;
  // A system may be one of so many lanes, and no others.
  static constexpr bool is_of_any_width = !requires { F::lanes; };
  static constexpr std::size_t width = is_of_any_width && W % in_register == 0 ? in_register : W;

 public:
  using Driver = LaneDriver<F, Starts, M, width, E...>;
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
        if constexpr (Driver::can_step_freely) take_free_steps();
        if constexpr (Driver::takes_many_steps) {
          if (take_many_steps()) continue;
        }
        for (One& group : groups_)
          if (group.driver.is_active()) group.driver.take_step();
      }
    }
  }

 private:
  struct One {
    Driver driver;
  };
  // A step of few stages is short beside the time that its stages wait for each other.
  static constexpr std::size_t least = [] {
    if constexpr (Driver::takes_many_steps) {
      return F::motions_at_once;
    } else {
      return std::size_t(M::error_order == 0 && Driver::can_step_freely ? 4 : 1);
    }
  }();
  static constexpr std::size_t count = std::max(W / width, least);

  Queue& queue_;
  One groups_[count];

  template <std::size_t... i>
  LaneGroups(const F& f, const Starts& starts, const Settings& settings, Queue& queue, std::index_sequence<i...>)
      : queue_(queue), groups_{{((void)i, Driver(f, starts, settings, queue))}...} {}

  void take_free_steps()
    requires Driver::can_step_freely
  {
    std::size_t steps = groups_[0].driver.free_steps();
    for (const One& group : groups_) steps = std::min(steps, group.driver.free_steps());
    if (steps == 0) return;
    [&]<std::size_t... i>(std::index_sequence<i...> all) {
      std::array<typename Driver::FreeMotion, count> motions{groups_[i].driver.free_motion()...};
      Driver::take_free_steps(motions, steps, all);
      (groups_[i].driver.pass_free_steps(motions[i], steps), ...);
    }(std::make_index_sequence<count>());
  }
  // Lets the system take steps of all groups. False where it cannot.
  [[nodiscard]] bool take_many_steps()
    requires Driver::takes_many_steps
  {
    for (One& group : groups_)
      if (!group.driver.can_take_many_steps()) return false;
    auto rules = groups_[0].driver.step_size_rules();
    for (const One& group : groups_) rules.most = std::min(rules.most, group.driver.step_size_rules().most);
    return [&]<std::size_t... i>(std::index_sequence<i...>) {
      std::array<typename Driver::MotionOfSystem, count> motions{groups_[i].driver.begin_many_steps()...};
      F::template take_steps<M>(motions, rules);
      (groups_[i].driver.end_many_steps(motions[i]), ...);
      return true;
    }(std::make_index_sequence<count>());
  }
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
