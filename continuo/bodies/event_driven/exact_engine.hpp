// continuo/bodies/event_driven/exact_engine.hpp
// The engines of the exact motion: for balls on parabolas, on paths under any forces, and under gravity where some
// balls need the one and some the other; and for bodies of any shape with joints.
#pragma once
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <continuo/bodies/contact_events.hpp>
#include <continuo/bodies/exact_options.hpp>
#include <continuo/bodies/support/bytes.hpp>
#include <continuo/bodies/world.hpp>
#include <continuo/status/status.hpp>

namespace continuo {

[[nodiscard]] inline Status cannot_continue(std::string message) {
  return {.ending = Ending::cannot_continue, .message = std::move(message)};
}
[[nodiscard]] inline Status too_many_events() {
  return cannot_continue("more events than `most_events`: bodies may be caught between others");
}
/// Names some of the bodies that take part in a collision.
[[nodiscard]] inline std::string numbers_of(std::vector<std::uint32_t> bodies) {
  constexpr std::size_t most_named = 8;
  std::ranges::sort(bodies);
  std::string names = bodies.size() == 1 ? "body " : "bodies ";
  for (std::size_t k = 0; k < std::min(bodies.size(), most_named); ++k)
    names += (k > 0 ? ", " : "") + std::to_string(bodies[k]);
  if (bodies.size() > most_named) names += " and " + std::to_string(bodies.size() - most_named) + " more";
  return names;
}
/// `why` may say how to mend it.
template <class Real>
[[nodiscard]] Status impulses_not_found(const Real& t, std::vector<std::uint32_t> bodies, const std::string& why) {
  return cannot_continue("the impulses of the collision at t = " + std::to_string(t) + " of " +
                         numbers_of(std::move(bodies)) + " were not found: " + why);
}
[[nodiscard]] inline Status other_bodies() {
  return cannot_continue("bodies have come or gone: the motion needs a `refresh`");
}
[[nodiscard]] inline Status interrupted() {
  return {.ending = Ending::interrupted, .message = "interrupted"};
}

template <class Real, int Dim>
class ExactEngine {
 public:
  explicit ExactEngine(const ExactOptions<Real>& options) : contacts(options.contact_events) {}
  virtual ~ExactEngine() = default;
  [[nodiscard]] virtual Status advance_to(const Real& t) = 0;
  virtual void save(ByteWriter& writer) = 0;
  virtual void load(ByteReader& reader) = 0;

  ExactStatistics statistics{};
  ContactLog<Real, Dim> contacts;

 protected:
  ExactEngine(const ExactEngine&) = default;
  ExactEngine& operator=(const ExactEngine&) = default;
};

/// Bodies on parabolas, given by their numbers in the world. Some of them can be replaced by proxies: another engine
/// moves such a body within a sphere, which is at rest for all others.
template <class Real, int Dim>
class ParabolicEngine : public ExactEngine<Real, Dim> {
 public:
  using ExactEngine<Real, Dim>::ExactEngine;
  /// Advances to time t, or to the instant at which two bodies come to lie on each other, or a body reaches a proxy.
  /// Does not change the world.
  [[nodiscard]] virtual Status run_to(const Real& t) = 0;
  [[nodiscard]] virtual Real now() const = 0;
  /// Writes all bodies except proxies to the world at time t, before which no event may remain.
  virtual void synchronize(const Real& t) = 0;
  /// Writes one body to the world at the present time, and logs the end of its contacts with walls.
  virtual void bring_out(std::uint32_t number) = 0;
  virtual void replace_by_proxy(std::uint32_t number, const Vector<Real, Dim>& centre, const Real& radius) = 0;
  /// Puts a body on a parabola again, from its state in the world.
  virtual void take_back(std::uint32_t number) = 0;
  /// Finds the bodies that overlap a body, or its proxy, and can collide with it.
  virtual void find_overlapping(std::uint32_t number, std::vector<std::uint32_t>& found) = 0;

  std::optional<std::array<std::uint32_t, 2>> met;  // the two bodies at which run_to ended
};

/// Bodies that lie on each other, in a world of their own.
template <class Real, int Dim>
class ContactEngine : public ExactEngine<Real, Dim> {
 public:
  using ExactEngine<Real, Dim>::ExactEngine;
  /// A copy of the engine for the same world.
  [[nodiscard]] virtual std::unique_ptr<ContactEngine> clone() const = 0;
  /// From now on `advance_to` ends early where a body is `room` / 2 away from its present position, or where nothing
  /// moves any more (`is_steady`). With infinity it does not.
  virtual void keep_within(const Real& room) = 0;
  [[nodiscard]] virtual bool is_steady() const = 0;
  /// The numbers by which messages are to name the bodies.
  virtual void set_numbers(std::span<const std::uint32_t> numbers) = 0;
  /// Takes over the state of contacts from another engine, whose body i has the number to[i] here, or `nowhere`.
  static constexpr std::uint32_t nowhere = std::numeric_limits<std::uint32_t>::max();
  virtual void take_over(const ContactEngine& other, std::span<const std::uint32_t> to) = 0;
  /// Ends the lasting contacts of all bodies that leave.
  virtual void let_go(const std::vector<bool>& leaves) = 0;

  std::vector<Real> together;  // the last time at which each body lay on another
};

/// Fails where a position or velocity is no longer finite.
template <class Real, int Dim>
[[nodiscard]] Status check_motion(const World<Real, Dim>& world) {
  for (std::size_t i = 0; i < world.size(); ++i)
    if (!is_finite(world.position[i]) || !is_finite(world.velocity[i]))
      return cannot_continue("a body's motion is no longer finite: a speed or gravity is too large for the numbers");
  return {};
}

/// The engine for parabolas, from event to event: event_driven.hpp.
template <class Real, int Dim>
[[nodiscard]] std::unique_ptr<ParabolicEngine<Real, Dim>> event_driven(World<Real, Dim>& world,
                                                                       const ExactOptions<Real>& options);

/// The engine for any forces, from contact to contact by an error-controlled method: constrained_motion.hpp.
template <class Real, int Dim>
[[nodiscard]] std::unique_ptr<ContactEngine<Real, Dim>> constrained_motion(World<Real, Dim>& world,
                                                                           const ExactOptions<Real>& options,
                                                                           Companions<Real, Dim>* companions);

/// The event-driven engine, with the constrained one for bodies that lie on each other: islands.hpp.
template <class Real, int Dim>
[[nodiscard]] std::unique_ptr<ExactEngine<Real, Dim>> islands(World<Real, Dim>& world,
                                                              const ExactOptions<Real>& options);

/// The engine for bodies of any shape, and for joints: exact_rigid/rigid_motion.hpp.
template <class Real, int Dim>
[[nodiscard]] std::unique_ptr<ExactEngine<Real, Dim>> rigid_motion(World<Real, Dim>& world,
                                                                   const ExactOptions<Real>& options);

}  // namespace continuo
