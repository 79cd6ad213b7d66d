// continuo/bodies/exact_options.hpp
// The options of the exact motion, the companions that it integrates with the bodies, and its statistics: for callers
// and for the engines.
#pragma once
#include <atomic>
#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include <continuo/bodies/world.hpp>
#include <continuo/numerics/vector.hpp>

namespace continuo {

/// States beside the bodies with rates of their own, such as the states of equations. They are integrated with the
/// bodies as one system, by the same method. The law adds to forces and torques and sets the rates. Where nothing
/// exerts a torque, the spans of orientations, spins and torques are empty: between contacts the spins are then those
/// of the world.
template <class Real, int Dim>
struct Companions {
  using V = Vector<Real, Dim>;
  std::vector<Real> state;  // at the present time of the world
  /// Adds to `force` and `torque`, and sets `rate` to the derivative of `state`.
  std::function<void(Real t, const BodyStates<Real, Dim>& at, std::span<const Real> state, std::span<V> force,
                     std::span<Spin<Real, Dim>> torque, std::span<Real> rate)>
      law;
  bool twists = false;                    // the law has torques
  Real absolute_tolerance = Real(1e-13);  // of the states, in their units
};

/// The speed of a motor at a time, and its derivative there.
template <class Real>
struct MotorSpeed {
  Real speed{};   // of the coordinate of the joint, in radians or length per time
  Real change{};  // its derivative by time
};
/// A motor whose speed changes with time: the law replaces the speed of the joint, and leaves there that of the end of
/// each call. It may jump: then a motor with an infinite `most` strikes its joint. Of balls without joints it does
/// nothing.
template <class Real>
struct MotorLaw {
  JointHandle joint{};                              // a hinge, slider or wheel with a motor
  std::function<MotorSpeed<Real>(Real t)> speed{};  // at time t
};

/// The options of the exact motion, in the units of the world.
template <class Real>
struct ExactOptions {
  std::optional<Real> contact_time{};     // without one: a hundred-thousandth of the time in which a body falls its
                                          // radius, or flies it where there is no gravity
  std::size_t most_events = 100'000'000;  // in one call of advance_to, which fails then: some minutes
  Real tolerance = Real(1e-10);    // of a path under other forces than gravity: relative, and in units of a radius
  Real step = Real(0);             // > 0: such paths by the classical Runge-Kutta method in steps of this size
  std::size_t contact_events = 0;  // at most so many of a call are recorded
  std::vector<MotorLaw<Real>> motors{};          // those whose speed changes with time
  const std::atomic<bool>* interrupt = nullptr;  // once it is true, advance_to ends as `interrupted`

  /// Whether the caller has asked for the end.
  [[nodiscard]] bool is_interrupted() const { return interrupt != nullptr && interrupt->load(); }
};

/// What a motion has done so far.
struct ExactStatistics {
  std::size_t collisions = 0;       // of two bodies
  std::size_t wall_collisions = 0;  // of a body with a wall
  std::size_t crossings = 0;        // of cells
  std::size_t outdated = 0;         // predictions made again

  /// Adds the counts of another motion.
  ExactStatistics& operator+=(const ExactStatistics& more) {
    collisions += more.collisions, wall_collisions += more.wall_collisions;
    crossings += more.crossings, outdated += more.outdated;
    return *this;
  }
  /// Reads or writes all counts.
  template <class Archive>
  void transfer(Archive& archive) {
    archive(collisions), archive(wall_collisions), archive(crossings), archive(outdated);
  }
};

}  // namespace continuo
