// What the tests of the exact motion share: to go on without a fault, and the energy of a world.
#pragma once
#include <gtest/gtest.h>

#include <continuo/bodies/exact_motion.hpp>

namespace continuo::test {

template <int Dim>
void advance(ExactMotion<double, Dim>& motion, double t) {
  const Status status = motion.advance_to(t);
  ASSERT_TRUE(status) << describe(status);
}
template <int Dim>
double energy(const World<double, Dim>& world) {
  return kinetic_energy(world) + potential_energy(world);
}

}  // namespace continuo::test
