// A step over lanes is the steps of its lanes, each with its own t and h.
#include <array>
#include <cstddef>
#include <string>
#include <tuple>

#include <gtest/gtest.h>

#include <continuo/methods/all.hpp>
#include <continuo/numerics/lanes.hpp>

namespace continuo::lanes_test {
namespace {

using Four = Lanes<double, 4>;
using Wide = std::array<Four, 2>;
using Narrow = std::array<double, 2>;

const auto problem =
    second_order([](auto t, const auto& q, const auto& v) { return std::array{q[0] * q[0] - t * v[0]}; });

const std::array<double, 4> times{0, 0.5, -1, 2}, steps{0.1, 0.02, 0.3, 0.07};
const std::array<Narrow, 4> starts{{{1, 0}, {0.5, -2}, {-1, 1}, {0, 3}}};

Wide together(const std::array<Narrow, 4>& states) {
  Wide result;
  for (std::size_t lane = 0; lane < 4; ++lane) {
    for (std::size_t i = 0; i < 2; ++i) result[i].set(lane, states[lane][i]);
  }
  return result;
}

template <class M>
class OverLanes : public ::testing::Test {};
struct NameOfMethod {
  template <class M>
  static std::string GetName(int) {
    return std::string(M::name);
  }
};
using Methods = ::testing::Types<ExplicitEuler, SemiImplicitEuler, SymplecticEulerPositionFirst, CentralDifference,
                                 VelocityVerlet, BogackiShampine3, DormandPrince5, Tsitouras5, Dop853, Verner7>;
TYPED_TEST_SUITE(OverLanes, Methods, NameOfMethod);

TYPED_TEST(OverLanes, AStepGivesTheBitsOfEachLaneAlone) {
  auto f = problem;
  Wide x = together(starts), x_new = x;
  auto work = TypeParam::workspace(x);
  Interpolant<Wide, TypeParam::dense_degree> p(x);
  const Four h(steps), t(times);
  TypeParam::step(f, t, x, h, true, work, x_new);
  const Four norm = TypeParam::error_norm(work, h, x, x_new, Tolerance<Four>{1e-6, 1e-6});
  TypeParam::interpolate(f, t, x, h, x_new, work, p);
  for (std::size_t lane = 0; lane < 4; ++lane) {
    const Narrow y = starts[lane];
    Narrow y_new{};
    auto narrow = TypeParam::workspace(y);
    Interpolant<Narrow, TypeParam::dense_degree> q(y);
    TypeParam::step(f, times[lane], y, steps[lane], true, narrow, y_new);
    EXPECT_DOUBLE_EQ(norm[lane], TypeParam::error_norm(narrow, steps[lane], y, y_new, Tolerance<double>{1e-6, 1e-6}));
    TypeParam::interpolate(f, times[lane], y, steps[lane], y_new, narrow, q);
    for (std::size_t i = 0; i < 2; ++i) {
      EXPECT_EQ(x_new[i][lane], y_new[i]) << lane << " " << i;
      EXPECT_EQ(p.component(0.4, i)[lane], q.component(0.4, i)) << lane << " " << i;
    }
  }
}

TYPED_TEST(OverLanes, OnlyAcceptedLanesGoOn) {
  // Lanes 1 and 3 repeat their first step with half of h, the others take a second one.
  auto f = problem;
  Wide x = together(starts), x_new = x;
  auto work = TypeParam::workspace(x);
  Four h(steps), t(times);
  TypeParam::step(f, t, x, h, true, work, x_new);
  Four sign(std::array{1.0, -1.0, 1.0, -1.0});
  const auto accepted = sign > 0;
  TypeParam::accept(work, accepted);
  for (std::size_t i = 0; i < 2; ++i) x[i] = select(accepted, x_new[i], x[i]);
  t = select(accepted, t + h, t);
  h = select(accepted, h, h / 2);
  TypeParam::step(f, t, x, h, false, work, x_new);
  for (std::size_t lane = 0; lane < 4; ++lane) {
    Narrow y = starts[lane], y_new{};
    auto narrow = TypeParam::workspace(y);
    TypeParam::step(f, times[lane], y, steps[lane], true, narrow, y_new);
    if (accepted[lane]) {
      TypeParam::accept(narrow);
      y = y_new;
    }
    TypeParam::step(f, t[lane], y, h[lane], false, narrow, y_new);
    for (std::size_t i = 0; i < 2; ++i) EXPECT_EQ(x_new[i][lane], y_new[i]) << lane << " " << i;
  }
}

}  // namespace
}  // namespace continuo::lanes_test
