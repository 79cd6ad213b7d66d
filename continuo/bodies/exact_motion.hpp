// continuo/bodies/exact_motion.hpp
// Spheres under gravity alone, or no force at all, from collision to collision: every path between is a parabola, every
// collision time comes from a closed form, and energy and momentum hold to rounding. No step, no tolerance.
//
// Each body has a clock of its own and one next event, a collision or the crossing into another cell; an event moves
// the bodies that take part and nobody else. A predicted collision whose partner has collided since is predicted again
// when its time comes. B. Lubachevsky, "How to simulate billiards and similar systems", J. Comp. Phys. 94 (1991)
// 255-283.
//
// Under other forces an error-controlled method (dop853) moves all bodies together between contacts, which are located
// on its dense output to neighbouring times; impulses are as exact as before. What is approximate then is the path, by
// `tolerance`. What these forces press together is held, see persistent_contacts.hpp; where flights become too short,
// or no forces hold what friction jams, steps lead through, see contact_steps.hpp.
//
// Several collisions at one instant are resolved one after the other, pairs of lower numbers first, until nobody
// approaches: Newton's cradle sends out as many as came in.
//
// Where energy is lost, collisions can pile up without end (inelastic collapse): see inelastic_collapse.hpp. Without
// gravity, all that touch are struck together then. Under gravity a ball that would leave a wall for less than the
// contact time stays on it; one that would leave a body for less than that moves on no parabola: the two, and whoever
// comes near, go on as under other forces, until for some time they have not lain on each other. All others stay on
// their parabolas, see islands.cpp.
#pragma once
#include <cstddef>
#include <memory>
#include <span>

#include <continuo/bodies/contact_events.hpp>
#include <continuo/bodies/exact_options.hpp>
#include <continuo/bodies/support/bytes.hpp>
#include <continuo/bodies/world.hpp>
#include <continuo/status/status.hpp>

namespace continuo {

template <class Real, int Dim>
class ExactEngine;

template <class Real, int Dim>
class ExactMotion {
 public:
  /// The world is moved; it must not be changed but through this, or `refresh` must follow.
  explicit ExactMotion(World<Real, Dim>& world, const ExactOptions<Real>& options = {});
  /// The companions must live as long; what changes in them needs a `refresh`.
  ExactMotion(World<Real, Dim>& world, const ExactOptions<Real>& options, Companions<Real, Dim>& companions);
  ExactMotion(ExactMotion&&) noexcept;
  ExactMotion& operator=(ExactMotion&&) noexcept;
  ~ExactMotion();

  /// Brings the world to time t, all its bodies to the same instant. Where it fails the world is at the time of
  /// the last event.
  [[nodiscard]] Status advance_to(const Real& t);
  /// Predicts everything again from the world as it is.
  void refresh();

  [[nodiscard]] const ExactStatistics& statistics() const;
  /// What happened in the last call of advance_to, and how many more there were than `contact_events`.
  [[nodiscard]] std::span<const ContactEvent<Real, Dim>> contact_events() const;
  [[nodiscard]] std::size_t lost_contact_events() const;

  /// For snapshot.hpp: what is to be known beside the world to go on to the same bits.
  void save(ByteWriter& writer) const;
  void load(ByteReader& reader);

 private:
  [[nodiscard]] bool is_parabolic() const;
  [[nodiscard]] std::unique_ptr<ExactEngine<Real, Dim>> engine() const;

  World<Real, Dim>* world_;
  Companions<Real, Dim>* companions_ = nullptr;
  bool was_parabolic_ = true;  // the only force was gravity
  ExactOptions<Real> options_;
  std::unique_ptr<ExactEngine<Real, Dim>> engine_;
};

extern template class ExactMotion<float, 2>;
extern template class ExactMotion<float, 3>;
extern template class ExactMotion<double, 2>;
extern template class ExactMotion<double, 3>;

}  // namespace continuo
