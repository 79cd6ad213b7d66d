// continuo/bodies/event_driven/exact_engine.hpp
// What the exact motion hands its work to: engines for parabolas, for whatever paths other forces make, and for worlds
// under gravity, of which some parts need the one and some the other.
#pragma once
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

/// Bodies on parabolas, by number, of which some can be set aside: then somebody else moves them, within a sphere that
/// stands still for all others.
template <class Real, int Dim>
class ParabolicEngine : public ExactEngine<Real, Dim> {
 public:
  using ExactEngine<Real, Dim>::ExactEngine;
  /// No further than to where two come to lie on each other, or one meets such a sphere. Leaves the world as it is.
  [[nodiscard]] virtual Status run_to(const Real& t) = 0;
  [[nodiscard]] virtual Real now() const = 0;
  /// All but what is set aside, in the world at time t, where nothing happens before.
  virtual void synchronize(const Real& t) = 0;
  /// One body in the world as it is now, and that it lies on no wall any more.
  virtual void bring_out(std::uint32_t number) = 0;
  virtual void replace_by_proxy(std::uint32_t number, const Vector<Real, Dim>& centre, const Real& radius) = 0;
  /// On its parabola again, from where it is in the world.
  virtual void take_back(std::uint32_t number) = 0;
  /// Those that overlap with a body, or the sphere in its place, and do not pass through it.
  virtual void find_overlapping(std::uint32_t number, std::vector<std::uint32_t>& found) = 0;

  std::optional<std::array<std::uint32_t, 2>> met;  // at the end of run_to
};

/// Bodies that lie on each other, in a world of their own.
template <class Real, int Dim>
class ContactEngine : public ExactEngine<Real, Dim> {
 public:
  using ExactEngine<Real, Dim>::ExactEngine;
  /// As they are; the world stays the same one.
  [[nodiscard]] virtual std::unique_ptr<ContactEngine> clone() const = 0;
  /// From here on `advance_to` ends early where a body has gone half as far from its present place, or where nothing
  /// moves any more: `is_steady`. Infinity: no more.
  virtual void keep_within(const Real& room) = 0;
  [[nodiscard]] virtual bool is_steady() const = 0;
  /// What is known of contacts of other bodies: those that are here are at the places `to`; nowhere: not here.
  static constexpr std::uint32_t nowhere = std::numeric_limits<std::uint32_t>::max();
  virtual void take_over(const ContactEngine& other, std::span<const std::uint32_t> to) = 0;
  /// Contacts that last end, of all bodies that leave.
  virtual void let_go(const std::vector<bool>& leaves) = 0;

  std::vector<Real> together;  // when each body lay on another last
};

/// Whether parabolas are still within the numbers.
template <class Real, int Dim>
[[nodiscard]] Status check_motion(const World<Real, Dim>& world) {
  for (std::size_t i = 0; i < world.size(); ++i)
    if (!is_finite(world.position[i]) || !is_finite(world.velocity[i]))
      return cannot_continue("a body's motion is no longer finite: a speed or gravity is too large for the numbers");
  return {};
}

/// From event to event on parabolas: event_driven.cpp.
template <class Real, int Dim>
[[nodiscard]] std::unique_ptr<ParabolicEngine<Real, Dim>> event_driven(World<Real, Dim>& world,
                                                                       const ExactOptions<Real>& options);

/// From contact to contact on whatever paths forces make, by an error-controlled method: constrained_motion.cpp.
template <class Real, int Dim>
[[nodiscard]] std::unique_ptr<ContactEngine<Real, Dim>> constrained_motion(World<Real, Dim>& world,
                                                                           const ExactOptions<Real>& options,
                                                                           Companions<Real, Dim>* companions);

/// The one, and of those that lie on each other the other: islands.cpp.
template <class Real, int Dim>
[[nodiscard]] std::unique_ptr<ExactEngine<Real, Dim>> islands(World<Real, Dim>& world,
                                                              const ExactOptions<Real>& options);

}  // namespace continuo
