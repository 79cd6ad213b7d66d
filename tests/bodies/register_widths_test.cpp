// Whole motions with registers of every width that the machine has: the same bytes, with any number of threads.
#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <oneapi/tbb/global_control.h>

#include "random_rigid_worlds.hpp"
#include <continuo/bodies/fast_motion.hpp>
#include <continuo/bodies/snapshot.hpp>

namespace continuo::register_widths_test {

using namespace test;  // random_rigid_worlds.hpp

namespace {

/// The widths that this machine has, in bytes.
template <class Real, int Dim>
std::vector<int> widths() {
  std::vector<int> found;
  for (const int bytes : {16, 32, 64}) {
    World<Real, Dim> empty;
    FastMotion<Real, Dim> motion(empty, {.registers = bytes});
    const Status status = motion.advance();
    if (status) {
      found.push_back(bytes);
    } else {
      EXPECT_NE(status.message.find("registers of " + std::to_string(bytes)), std::string::npos) << status.message;
    }
  }
  return found;
}

template <class Real, int Dim>
Vector<Real, Dim> filled(Real value) {
  Vector<Real, Dim> v;
  v.components.fill(value);
  return v;
}
/// A heap of bodies of all shapes on any grounds, with joints, of which some hang in chains: islands that are solved in
/// lanes.
template <class Real, int Dim>
World<Real, Dim> crowd(unsigned seed) {
  RandomRigidWorld<Real, Dim> made(seed);
  const Real size = Dim == 2 ? Real(4) : Real(1.5);
  EXPECT_TRUE(made.world.add_container(filled<Real, Dim>(-size), filled<Real, Dim>(3 * size), {}));
  Material<Real> rough{.friction = Real(0.5)};
  if (made.numbers.one_in(3)) rough.restitution = Real(0.5);
  while (made.world.size() < 160) made.add_body(size, rough);
  for (int k = 0; k < 30; ++k) made.add_joint();
  BodyHandle last{};
  for (int k = 0; k < 60; ++k) {
    const auto place = made.numbers.template vector<Dim>(size);
    const auto added = made.world.add({.shape = Sphere<Real>{Real(0.1)}, .position = place, .group = 5});
    EXPECT_TRUE(added);
    EXPECT_TRUE(made.world.add_joint({.kind = JointKind::ball, .a = last, .b = *added, .anchor = place}));
    last = *added;
  }
  return std::move(made.world);
}
/// The bytes of a motion after 10 and 20 steps. Adds the number of steps in which contacts were solved in lanes.
template <class Real, int Dim>
std::vector<Bytes> bytes_of(World<Real, Dim> world, const FastOptions<Real>& options, std::size_t& in_lanes) {
  std::vector<Bytes> all;
  FastMotion<Real, Dim> motion(world, options);
  for (int k = 0; k < 20 && motion.advance(); ++k) {
    in_lanes += motion.statistics().colours > 0 ? 1 : 0;
    if (k % 10 == 9) all.push_back(snapshot(world, motion));
  }
  return all;
}
template <class Real, int Dim>
void expect_the_same_bytes(unsigned seeds) {
  const tbb::global_control allowed(tbb::global_control::max_allowed_parallelism, 8);
  const std::vector<int> all_widths = widths<Real, Dim>();
  ASSERT_EQ(all_widths.front(), 16);
  constexpr std::array threads{1, 2, 4, 7};
  std::size_t in_lanes = 0, runs = 0;
  for (unsigned seed = 0; seed < seeds; ++seed) {
    const World<Real, Dim> start = crowd<Real, Dim>(seed);
    FastOptions<Real> options{.substeps = 2 + static_cast<int>(seed % 4), .registers = 16};
    if (seed % 3 == 0) options.sleep_after = Real(0.1), options.sleep_speed = Real(0.5);
    const auto expected = bytes_of(start, options, in_lanes);
    for (const int bytes : all_widths) {
      options.registers = bytes, options.threads = threads[++runs % threads.size()];
      EXPECT_EQ(bytes_of(start, options, in_lanes), expected)
          << "seed " << seed << ", registers of " << bytes << " bytes, " << options.threads << " threads";
    }
  }
  EXPECT_GT(in_lanes, 10 * runs) << "most steps are to need the registers";
}
TEST(RegisterWidths, GiveTheSameBytesInThePlane) {
  expect_the_same_bytes<double, 2>(4);
  expect_the_same_bytes<float, 2>(4);
}
TEST(RegisterWidths, GiveTheSameBytesInSpace) {
  expect_the_same_bytes<double, 3>(2);
  expect_the_same_bytes<float, 3>(2);
}

}  // namespace
}  // namespace continuo::register_widths_test
