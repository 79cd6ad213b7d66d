// Events over steps that grow by nine powers of ten: Robertson's reaction, as in the example cvRoberts_dns of SUNDIALS.
#include <cmath>

#include <bench/problems/robertson.hpp>
#include <bench/stiff/measure.hpp>
#include <gtest/gtest.h>

#include <continuo/methods/collocation/radau.hpp>
#include <continuo/methods/dirk/kencarp4.hpp>
#include <continuo/methods/dirk/kvaerno5.hpp>
#include <continuo/methods/extrapolation/seulex.hpp>
#include <continuo/methods/multistep/bdf.hpp>
#include <continuo/methods/rosenbrock/rodas4.hpp>
#include <continuo/methods/rosenbrock/rodas5p.hpp>
#include <continuo/solve/solve.hpp>

namespace continuo::stiff_events_test {
namespace {

template <class M>
class StiffEvents : public ::testing::Test {};
using Methods = ::testing::Types<Rodas4, Rodas5P, Radau5, Radau, Bdf, Kvaerno5, KenCarp4, Seulex>;
TYPED_TEST_SUITE(StiffEvents, Methods);

// Until the first event C grows like t, near the second A falls like 1/t: a relative error of theirs is one of t, to a
// factor near 1. Methods keep within 30 tolerances (stiff_tolerance_test.cpp), here 3e-9; eight digits are 5e-9.
TYPED_TEST(StiffEvents, AreFoundToEightDigits) {
  using Problem = bench::Robertson<>;
  using X = Problem::State;
  constexpr double rtol = 1e-10, digits = 5e-9;
  Options<X> options{.rtol = rtol, .atol = rtol * bench::absolute_part<Problem>, .save = Save<X>::only_end()};
  options.events = {rises<X>("C", [](double, const X& x) { return x[2] - 0.01; }),
                    falls<X>("A", [](double, const X& x) { return x[0] - 1e-4; })};
  const auto solution = solve(Problem{}, Problem::start(), {0.0, 4e7}, TypeParam{}, options);
  ASSERT_TRUE(solution.outcome) << describe(solution.outcome);
  ASSERT_EQ(solution.events.size(), 2u);
  EXPECT_LE(std::abs(solution.events[0].t / Problem::third_above_0_01 - 1), digits);
  EXPECT_LE(std::abs(solution.events[1].t / Problem::first_below_0_0001 - 1), digits);
}

}  // namespace
}  // namespace continuo::stiff_events_test
