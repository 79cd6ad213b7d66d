// continuo/bodies/exact_motion.hpp
// Moves bodies from collision to collision. Of spheres under gravity alone, or without forces, every path between two
// collisions is a parabola; collision times come from closed forms or, where two bodies accelerate differently, from an
// isolated root of a polynomial (collision_time.hpp); energy and momentum are conserved to rounding. There is no step
// and no tolerance.
//
// Each body has its own time and one next event: a collision, or the crossing into another cell of the grid. An event
// moves only the bodies that take part in it. If the partner of a predicted collision has collided since the
// prediction, the collision is predicted again when its time comes. B. Lubachevsky, "How to simulate billiards and
// similar systems", J. Comp. Phys. 94 (1991) 255-283.
//
// Under other forces an error-controlled method (dop853) moves all bodies together between contacts. Contacts are
// located on its dense output to neighbouring floating-point numbers, and impulses are as exact as before; only the
// path is approximate, to `tolerance`. Bodies that forces press together are constrained by contact forces, see
// persistent_contacts.hpp. Where flights become too short, or friction jams bodies so that no consistent contact forces
// exist, time steps of first order continue the motion, see contact_steps.hpp.
//
// Several collisions at one instant are resolved one after the other, pairs of lower numbers first, until no two bodies
// approach each other: from Newton's cradle as many balls leave as came in.
//
// Where collisions lose energy, they can follow one another without end (inelastic collapse, see
// inelastic_collapse.hpp). Without gravity, all bodies in contact are then struck simultaneously. Under gravity, a ball
// that would rebound from a wall for less than the contact time rests on it. Two bodies that would rebound from each
// other for less than that have no parabolas: together with the bodies near them they form an island, which moves as
// under other forces until its bodies have not touched each other for some time. All other bodies stay on their
// parabolas, see islands.hpp.
//
// Bodies of other shapes turn as Euler's equations say, joints are constraints that are kept to rounding, and the gap
// of two shapes is followed until it closes: see exact_rigid/rigid_motion.hpp. What it does not know it refuses.
#pragma once
#include <cstddef>
#include <cstdint>
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

/// Moves a world exactly, from collision to collision. The cost is that of the events: a body that meets nothing costs
/// nothing.
template <class Real, int Dim>
class ExactMotion {
 public:
  /// Moves `world`. After any other change of the world, call `refresh`.
  explicit ExactMotion(World<Real, Dim>& world, const ExactOptions<Real>& options = {});
  /// The companions must live as long as the motion. After changing them, call `refresh`.
  ExactMotion(World<Real, Dim>& world, const ExactOptions<Real>& options, Companions<Real, Dim>& companions);
  /// The moved-from motion can only be destroyed or assigned.
  /// @{
  ExactMotion(ExactMotion&&) noexcept;
  ExactMotion& operator=(ExactMotion&&) noexcept;
  /// @}
  /// Leaves the world as it is.
  ~ExactMotion();

  /// Advances the world with all its bodies to time t. On failure the world is at the time of the last event.
  [[nodiscard]] Status advance_to(const Real& t);
  /// Advances by h.
  [[nodiscard]] Status step(const Real& h);
  /// Those of the next call of advance_to.
  [[nodiscard]] const ExactOptions<Real>& options() const { return options_; }
  /// Changes the options, and predicts all events again.
  void set_options(const ExactOptions<Real>& options);
  /// Predicts all events again from the present state of the world.
  void refresh();

  /// Counts of all events since the construction.
  [[nodiscard]] const ExactStatistics& statistics() const;
  /// The contact events of the last call of advance_to, and the number of those beyond `contact_events`, which are
  /// dropped.
  [[nodiscard]] std::span<const ContactEvent<Real, Dim>> contact_events() const;
  /// The number of contact events of the last call of advance_to that were not recorded.
  [[nodiscard]] std::size_t lost_contact_events() const;

  /// For snapshot.hpp: the state beside the world from which the motion continues to the same bits.
  void save(ByteWriter& writer) const;
  /// Takes over a state written by `save`; on wrong bytes the reader fails, and the motion stays as it was.
  void load(ByteReader& reader);

 private:
  enum class Kind : std::uint8_t { constrained, parabolic, rigid };  // snapshots have the number
  /// What the world needs: the engine for parabolas where the only force is gravity.
  [[nodiscard]] Kind kind() const;
  [[nodiscard]] std::unique_ptr<ExactEngine<Real, Dim>> engine(Kind kind) const;

  World<Real, Dim>* world_;
  Companions<Real, Dim>* companions_ = nullptr;
  Kind kind_ = Kind::parabolic;  // of the engine
  ExactOptions<Real> options_;
  std::unique_ptr<ExactEngine<Real, Dim>> engine_;
};

extern template class ExactMotion<float, 2>;
extern template class ExactMotion<float, 3>;
extern template class ExactMotion<double, 2>;
extern template class ExactMotion<double, 3>;

}  // namespace continuo
