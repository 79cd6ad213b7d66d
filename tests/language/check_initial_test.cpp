// Initial values and boundary values.
#include "check_helpers.hpp"

namespace continuo::model {
namespace {

TEST(CheckInitial, AMissingValueSaysWhatIsNeeded) {
  const Said message = said("h'' = -9.8\nh(0) = 10\nrun 0..1\n", "E240");
  EXPECT_EQ(place(message), "1:1");
  EXPECT_EQ(message.message, "`h'(0)` is missing");
  EXPECT_EQ(message.label, "`h''` needs `h(0)` and `h'(0)`");
  EXPECT_EQ(message.help, "add h'(0) = ...");
}

TEST(CheckInitial, AFamilyWithoutValuesIsOneMessage) {
  EXPECT_EQ(count_said("for i in 1..50 { u[i]' = -u[i] }\nrun 0..1\n"), 1U);
  EXPECT_EQ(said("for i in 1..3 { u[i]' = -u[i] }\nu[1](0) = 1\nrun 0..1\n", "E240").message, "`u[2](0)` is missing");
}

TEST(CheckInitial, AValueGivenTwiceIsRefused) {
  EXPECT_EQ(place(said("x' = 1\nx(0) = 1\nx(0) = 2\nrun 0..1\n", "E241")), "3:1");
}

TEST(CheckInitial, TheHighestDerivativeHasNone) {
  const Said message = said("x' = 1\nx(0) = 1; x'(0) = 2\nrun 0..1\n", "E242");
  EXPECT_EQ(place(message), "2:11");
  EXPECT_EQ(message.label, "it follows from its equation");
}

TEST(CheckInitial, ValuesMayDependOnParametersAndNameStatesWithTheirTime) {
  const Model model = good("param a = 2, b = a^2\nx' = 1\nx(0) = b + 1\nrun 0..1\n");
  EXPECT_EQ(start_values(model)[1], 5);
  EXPECT_EQ(start_values(model, {{"a", 3.0}})[1], 10);
  EXPECT_EQ(start_values(model, {{"b", 7.0}})[1], 8);
  const Said message = said("x' = 1\ny' = 1\nx(0) = 1; y(0) = x + 1\nrun 0..1\n", "E222");
  EXPECT_EQ(place(message), "3:18");
  EXPECT_EQ(message.help, "write x(0)");
}

TEST(CheckInitial, TheRunMayStartElsewhere) {
  const Model model = good("x' = 1\nx(2) = 5\nrun 2..3\n");
  EXPECT_FALSE(model.needs_boundary_solver());
  EXPECT_EQ(start_values(model)[0], 2);
  EXPECT_EQ(start_values(model)[1], 5);
}

TEST(CheckInitial, ConditionsAtSeveralTimesMakeABoundaryValueProblem) {
  const Model model = good("x'' = -x\nx(1) = 3; x(7) = 4\nguess x = 3 + t/6\nrun 1..7\n");
  EXPECT_TRUE(model.needs_boundary_solver());
  ASSERT_EQ(model.boundary.size(), 2U);
  EXPECT_EQ(model.boundary[1].time.value, 7);
  EXPECT_EQ(model.guesses.size(), 1U);
  EXPECT_EQ(place(said("x'' = -x\nx(1) = 3; x(7) = 4; x(5) = 2\nrun 1..7\n", "E244")), "2:21");
}

TEST(CheckInitial, AParamHasNoInitialValue) {
  const Said message = said("param k = 3\nx' = k\nx(0) = 1; k(0) = 2\nrun 0..1\n", "E213");
  EXPECT_EQ(place(message), "3:11");
}

}  // namespace
}  // namespace continuo::model
