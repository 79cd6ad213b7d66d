// continuo/bodies/exact_options.hpp
// What the exact motion is told, what moves beside its bodies, and what it counts: for its engines as for who calls it.
#pragma once
#include <atomic>
#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include <continuo/bodies/support/vector.hpp>
#include <continuo/bodies/world.hpp>

namespace continuo {

/// Quantities beside the bodies with a rate of their own, such as the states of equations: they move together with the
/// bodies, as one system, by the same method. The law adds to forces and torques and sets the rates. Where nothing
/// twists, orientations, spins and torques are empty: spins are the world's between contacts.
template <class Real, int Dim>
struct Companions {
  using V = Vector<Real, Dim>;
  std::vector<Real> state;
  std::function<void(Real t, const BodyStates<Real, Dim>& at, std::span<const Real> state, std::span<V> force,
                     std::span<Spin<Real, Dim>> torque, std::span<Real> rate)>
      law;
  bool twists = false;  // the law has torques
  Real absolute_tolerance = Real(1e-13);
};

template <class Real>
struct ExactOptions {
  std::optional<Real> contact_time{};     // without one: a hundred-thousandth of the time in which a body falls its
                                          // radius, or flies it where there is no gravity
  std::size_t most_events = 100'000'000;  // in one call of advance_to, which then says so: some minutes
  Real tolerance = Real(1e-10);    // of a path under other forces than gravity: relative, and in units of a radius
  Real step = Real(0);             // greater than 0: such paths by the classical Runge-Kutta method in steps of this
  std::size_t contact_events = 0;  // so many of a call are kept, see contact_events.hpp
  const std::atomic<bool>* interrupt = nullptr;  // once it is true, advance_to ends early and says so

  [[nodiscard]] bool is_interrupted() const { return interrupt != nullptr && interrupt->load(); }
};

struct ExactStatistics {
  std::size_t collisions = 0;       // of two bodies
  std::size_t wall_collisions = 0;  //
  std::size_t crossings = 0;        // of cells
  std::size_t outdated = 0;         // predictions made again

  ExactStatistics& operator+=(const ExactStatistics& more) {
    collisions += more.collisions, wall_collisions += more.wall_collisions;
    crossings += more.crossings, outdated += more.outdated;
    return *this;
  }
  template <class Archive>
  void transfer(Archive& archive) {
    archive(collisions), archive(wall_collisions), archive(crossings), archive(outdated);
  }
};

}  // namespace continuo
