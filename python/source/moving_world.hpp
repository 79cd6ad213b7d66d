// A world of bodies with the motion that moves it, and memory that views of NumPy can hold on to.
#pragma once
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <continuo/bodies/exact_motion.hpp>
#include <continuo/bodies/fast_motion.hpp>
#include <continuo/bodies/world.hpp>

namespace continuo::python {

/// What the motion of a world is; the numbers are those of ExactOptions and FastOptions.
struct MotionSettings {
  bool exact = true;
  double step = 1.0 / 60;  // of the fast motion
  int substeps = 4, threads = 1;
  double sleep_after = 0;
  double tolerance = 1e-10;  // of the exact one
  std::optional<double> contact_time{};
  std::size_t contact_events = 100'000;
};

/// Views look into the arrays of the world as long as it has the same bodies. When bodies come or go, the arrays move
/// here, where a view still finds them: it shows what was there before.
template <int Dim>
struct FormerArrays {
  using W = World<double, Dim>;
  std::vector<typename W::V> position, velocity;
  std::vector<typename W::O> orientation;
  std::vector<typename W::S> spin;
  std::vector<double> radius, mass;
};

template <int Dim>
class MovingWorld {
 public:
  using W = World<double, Dim>;
  using Event = ContactEvent<double, Dim>;

  explicit MovingWorld(MotionSettings settings) : settings_(settings) {}
  MovingWorld(const MovingWorld&) = delete;
  MovingWorld& operator=(const MovingWorld&) = delete;

  [[nodiscard]] const W& world() const { return world_; }
  /// For changes that leave the bodies as they are: walls, forces, rules.
  [[nodiscard]] W& forces() {
    changed_ = true;
    return world_;
  }
  /// For changes of the bodies themselves: views of before no longer look into the world.
  [[nodiscard]] W& bodies();
  /// Lets `act` change velocities, spins and constant forces, which the fast motion follows without beginning anew.
  template <class Act>
  [[nodiscard]] Status push(Act&& act) {
    const bool was_as_left = is_as_left();
    Status status = act(world_);
    if (!was_as_left || settings_.exact) {
      changed_ = true;
    } else if (is_watched_) {
      remember();
    }
    return status;
  }
  /// A joint, whose limits, spring, motor, target and strength may be changed without a motion that begins anew, unless
  /// its bodies may be asleep; null where there is none.
  [[nodiscard]] Joint<double, Dim>* joint(JointHandle handle);
  /// What keeps the memory of a view, which may write into the world from now on.
  [[nodiscard]] std::shared_ptr<FormerArrays<Dim>> memory();

  [[nodiscard]] const MotionSettings& settings() const { return settings_; }
  /// Another motion, which begins anew.
  void set(const MotionSettings& settings);

  /// Moves to the time t: exactly, or by whole steps until it is not before t.
  [[nodiscard]] Status advance_to(double t);
  /// So many steps of the fast motion.
  [[nodiscard]] Status advance(std::size_t steps);
  /// The contact events of the last move, and how many there were beside.
  [[nodiscard]] const std::vector<Event>& events() const { return events_; }
  [[nodiscard]] std::size_t lost_events() const { return lost_; }

  /// The bodies that slept in the last step of the fast motion.
  [[nodiscard]] std::size_t asleep() const { return fast_ ? fast_->statistics().asleep : 0; }

  [[nodiscard]] std::vector<std::byte> save();
  [[nodiscard]] Status restore(std::span<const std::byte> bytes);

  /// Whether a move is under way, in another thread.
  std::atomic<bool> busy{false};
  /// Ends the move that is under way.
  std::atomic<bool> interrupt{false};

 private:
  /// The motion for the world as it is; whoever has written into views, or changed forces, is taken note of.
  [[nodiscard]] Status prepare();
  [[nodiscard]] bool is_as_left() const;
  void remember();
  /// After a move: what views may change from here on.
  void settle();
  void note(std::span<const Event> events, std::size_t lost);

  W world_;
  std::shared_ptr<FormerArrays<Dim>> memory_ = std::make_shared<FormerArrays<Dim>>();
  MotionSettings settings_;
  std::optional<ExactMotion<double, Dim>> exact_;
  std::optional<FastMotion<double, Dim>> fast_;
  bool changed_ = true;
  bool is_watched_ = false;       // views may have written into the world
  FormerArrays<Dim> remembered_;  // the world before they could, where it is watched
  std::vector<Event> events_;
  std::size_t lost_ = 0;
};

extern template class MovingWorld<2>;
extern template class MovingWorld<3>;

}  // namespace continuo::python
