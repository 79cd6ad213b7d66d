// Rolling bodies, in the plane and in space, for typed tests.
#pragma once
#include <gtest/gtest.h>

namespace continuo::round {

struct Disc {
  static constexpr int dim = 2;
  static constexpr double inertia = 1.0 / 2;  // J / (m r^2)
};
struct Ball {
  static constexpr int dim = 3;
  static constexpr double inertia = 2.0 / 5;
};
using DiscAndBall = ::testing::Types<Disc, Ball>;

}  // namespace continuo::round
