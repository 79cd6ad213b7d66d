// continuo/bodies/fast_motion.hpp
// Many bodies in real time: fixed steps cut into substeps, contacts as soft constraints with friction, rolling
// resistance and warm starting, impacts located within the substep and reversed with the energy that restitution
// leaves.
//
//   FastMotion motion(world, {.step = 1.0 / 60});
//   motion.advance();                                   // one step
//
// What is approximate: contacts that last are soft, a pile yields by some thousandths of a radius; friction and resting
// are as good as the few iterations of a step. What is not: free flight follows its parabola, and an impact faster than
// gravity acts in a substep happens at its instant, whatever the speed: nothing tunnels, a cradle's balls pass on
// theirs.
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

template <class Real>
struct FastOptions {
  Real step = Real(1) / Real(60);
  int substeps = 4;                // more are stiffer and cost as much more
  Real hertz = Real(120);          // of a contact; a third of the rate of substeps at most
  Real damping = Real(10);         // ratio: 1 is critical; overdamped contacts do not jump
  Real fastest_push = Real(4);     // with which overlapping bodies part, length per time
  std::size_t contact_events = 0;  // so many of a step are kept, see contact_events.hpp
  ForceIntegrator integrator = ForceIntegrator::semi_implicit_euler;  // of forces, see integrator.hpp
  Real sleep_after = Real(0);     // so long slower than the next, bodies fall asleep, see sleep.hpp; 0: never
  Real sleep_speed = Real(0.05);  // of centre and rim
  int threads = 1;                // at most; the results are the same to the last bit for any number
};

struct FastStatistics {
  std::size_t steps = 0, lists = 0, contacts = 0, colours = 0, impacts = 0, asleep = 0;
};

template <class Real, int Dim>
class FastMotion {
 public:
  /// The world is moved; what is changed in it between steps is seen, but bodies that come or go need a `refresh`,
  /// which wakes all.
  explicit FastMotion(World<Real, Dim>& world, const FastOptions<Real>& options = {});
  FastMotion(FastMotion&&) noexcept;
  FastMotion& operator=(FastMotion&&) noexcept;
  ~FastMotion();

  /// One step. Where it fails the world is as it was before the step.
  [[nodiscard]] Status advance();
  void refresh();

  /// The deepest overlap of two bodies, or of one and a wall, now.
  [[nodiscard]] Real deepest_overlap() const;
  [[nodiscard]] const FastStatistics& statistics() const;
  /// What happened in the last step: impacts at their instants; what lasts begins and ends with a step, and its impulse
  /// is that of the last substep times their number, summed over the steps. And how many more there were than asked
  /// for.
  [[nodiscard]] std::span<const ContactEvent<Real, Dim>> contact_events() const;
  [[nodiscard]] std::size_t lost_contact_events() const;
  /// Bytes held beside the world: bodies as contacts need them, pairs, contacts.
  [[nodiscard]] std::size_t memory() const;

  /// For snapshot.hpp: what is to be known beside the world to go on to the same bits.
  void save(ByteWriter& writer) const;
  void load(ByteReader& reader);

 private:
  class Stepper;
  std::unique_ptr<Stepper> stepper_;
};

extern template class FastMotion<float, 2>;
extern template class FastMotion<float, 3>;
extern template class FastMotion<double, 2>;
extern template class FastMotion<double, 3>;

}  // namespace continuo
