// Whether the options of the fast motion, and the bodies of a world, make sense.
#pragma once
#include <limits>

#include <continuo/bodies/fast_motion.hpp>

namespace continuo {

template <class Real, int Dim>
[[nodiscard]] Status check(const FastOptions<Real>& options, const World<Real, Dim>& world) {
  if (!(options.step > Real(0)) || !(options.step < std::numeric_limits<Real>::infinity()))
    return invalid_input("the step must be greater than 0, and finite");
  if (options.substeps < 1) return invalid_input("a step has at least one substep");
  if (!(options.hertz > Real(0)) || !(options.hertz < std::numeric_limits<Real>::infinity()))
    return invalid_input("hertz must be greater than 0, and finite");
  if (!(options.damping >= Real(0)) || !(options.fastest_push >= Real(0)))
    return invalid_input("damping and fastest_push must be 0 or more");
  if (!(options.sleep_after >= Real(0)) || !(options.sleep_speed >= Real(0)))
    return invalid_input("sleep_after and sleep_speed must be 0 or more");
  if (options.threads < 1) return invalid_input("there is at least one thread");
  return check_bodies(world);
}

}  // namespace continuo
