// continuo/bodies/fast_motion.hpp
// Many bodies in real time: fixed steps cut into substeps, contacts as soft constraints with friction, rolling
// resistance and warm starting, impacts located within the substep and reversed with the energy that restitution
// leaves.
//
//   FastMotion motion(world, {.step = 1.0 / 60});
//   motion.advance();                                   // one step
//
// Lasting contacts are approximate: they are soft, so that bodies in a pile overlap by some thousandths of a radius,
// and friction and rest are as good as the few iterations of a step. Free flight under gravity follows its parabola
// exactly, except with explicit Euler. An impact that is too fast for a soft contact (impacts.hpp) happens at its
// instant, whatever the speed: no body tunnels, and the balls of a cradle transmit their momentum.
#pragma once
#include <cstddef>
#include <memory>
#include <span>

#include <continuo/bodies/contact_events.hpp>
#include <continuo/bodies/support/bytes.hpp>
#include <continuo/bodies/time_stepping/integrator.hpp>
#include <continuo/bodies/world.hpp>
#include <continuo/status/status.hpp>

namespace continuo {

/// The options of the fast motion, in the units of the world.
template <class Real>
struct FastOptions {
  Real step = Real(1) / Real(60);  // the time of one step
  int substeps = 4;                // more make contacts stiffer, at proportional cost
  Real hertz = Real(120);          // of a contact; at most a third of the rate of substeps is used
  Real damping = Real(10);         // ratio: 1 is critical; overdamped contacts do not jump
  Real fastest_push = Real(4);     // greatest speed of separating an overlap, length per time
  std::size_t contact_events = 0;  // at most so many of a step are recorded
  ForceIntegrator integrator = ForceIntegrator::semi_implicit_euler;  // of forces, see integrator.hpp
  Real sleep_after = Real(0);     // bodies slower than sleep_speed for so long fall asleep; 0: never
  Real sleep_speed = Real(0.05);  // of centre and rim
  int threads = 1;                // at most; the results are the same to the last bit for any number
  int registers = 0;              // bytes of those that solve large islands in lanes: 16, 32 or 64; 0: the widest that
                                  // this machine has; the results are the same to the last bit for each width
  friend bool operator==(const FastOptions&, const FastOptions&) = default;
};

/// The steps, built pair lists and impacts so far; the contacts, colours (groups of contacts that share no body) and
/// sleeping bodies of the last step.
struct FastStatistics {
  std::size_t steps = 0;     // so far
  std::size_t lists = 0;     // of pairs, built so far
  std::size_t contacts = 0;  // in the last step
  std::size_t colours = 0;   // in the last step
  std::size_t impacts = 0;   // so far
  std::size_t asleep = 0;    // bodies, after the last step
  double hertz = 0;  // of the contacts in the last step: the one that was asked for, or the limit of the substeps
};

/// Moves a world in fixed steps.
template <class Real, int Dim>
class FastMotion {
 public:
  /// Moves `world`. Changes of the world between steps take effect in the next step; after adding or removing bodies
  /// call `refresh`, which wakes all bodies.
  explicit FastMotion(World<Real, Dim>& world, const FastOptions<Real>& options = {});
  /// The moved-from motion can only be destroyed or assigned.
  /// @{
  FastMotion(FastMotion&&) noexcept;
  FastMotion& operator=(FastMotion&&) noexcept;
  /// @}
  /// Leaves the world as it is.
  ~FastMotion();

  /// Advances by one step. Fails for options or bodies that make no sense. On failure the world is as it was before the
  /// step.
  [[nodiscard]] Status advance();
  /// Advances by one step of the size h, which is that of later steps, too. Another size than before begins anew.
  [[nodiscard]] Status step(const Real& h);
  /// Advances by whole steps until the time is not before t; a rounding beyond the end of a step is that end. Fails for
  /// a time that is not finite or before the present, and as `advance`: the world is then at the end of the last step.
  [[nodiscard]] Status advance_to(const Real& t);
  /// Those of the next step.
  [[nodiscard]] const FastOptions<Real>& options() const;
  /// Changes the options from the next step on. Another step, integrator, number of substeps or threads, width of
  /// registers, and other recording or sleep, begin anew, as `refresh` does.
  void set_options(const FastOptions<Real>& options);
  /// Starts anew from the present state of the world, with all bodies awake.
  void refresh();

  /// The deepest overlap of two bodies, or of one and a wall, now.
  [[nodiscard]] Real deepest_overlap() const;
  /// What the motion has done so far.
  [[nodiscard]] const FastStatistics& statistics() const;
  /// The contact events of the last step, and the number of those beyond `contact_events`, which are dropped. Impacts
  /// have their instants. A lasting contact begins and ends at the end of a step; its impulse is the sum over its steps
  /// of the impulse in the last substep times the number of substeps.
  [[nodiscard]] std::span<const ContactEvent<Real, Dim>> contact_events() const;
  /// The number of contact events of the last step that were not recorded.
  [[nodiscard]] std::size_t lost_contact_events() const;
  /// Bytes of memory beside the world: the bodies of the contact solver, pairs, contacts.
  [[nodiscard]] std::size_t memory() const;

  /// For snapshot.hpp: the state beside the world from which the motion continues to the same bits.
  void save(ByteWriter& writer) const;
  /// Takes over a state written by `save`; on wrong bytes the reader fails.
  void load(ByteReader& reader);

 private:
  class Stepper;
  struct Steppers;
  std::unique_ptr<Steppers> steppers_;
};

extern template class FastMotion<float, 2>;
extern template class FastMotion<float, 3>;
extern template class FastMotion<double, 2>;
extern template class FastMotion<double, 3>;

}  // namespace continuo
