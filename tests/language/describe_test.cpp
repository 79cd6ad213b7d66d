// The description of a model by `continuo info`.
#include <gmock/gmock.h>

#include "check_helpers.hpp"
#include <continuo/language/describe.hpp>

namespace continuo::model {
namespace {

using testing::HasSubstr;
using testing::Not;

TEST(Describe, TheReductionToFirstOrderIsVisible) {
  const std::string text = describe(good(R"(# A mass on a spring.
model Spring
param k = 4 [N/m] in 0..10  # stiffness
param m = 2 [kg]
m*x'' + k*x = 0 [N]
x(0) = 1 [m];  x'(0) = 0 [m/s]
energy kinetic = 1/2*m*x'^2
run 0..10 [s] output 0.1 method velocity_verlet step 0.01
)"));
  EXPECT_THAT(text, testing::StartsWith("Spring\nA mass on a spring.\n"));
  EXPECT_THAT(text, HasSubstr("  (x)'  = x'\n  (x')' = -k*x/m\n"));
  EXPECT_THAT(text, HasSubstr("  x  [m]   starts at 1\n  x' [m/s] starts at 0\n"));
  EXPECT_THAT(text, HasSubstr("k = 4 [N/m] in 0..10  # stiffness\n"));
  EXPECT_THAT(text, HasSubstr("t = 0..10 s, output every 0.1 s, method velocity_verlet, step 0.01 s\n"));
  EXPECT_THAT(text, HasSubstr("velocity_verlet and central_difference fit, too"));
}

TEST(Describe, EventsAreToldWithTheirActions) {
  const std::string text = describe(good(R"(param e = 0.9
mode flight { h'' = -10 }
mode rest { h'' = 0 }
h(0) = 1; h'(0) = 0
when h falls through 0 in flight { h := 0; if h' > -1 { h' := 0; go rest } else { h' := -e*h' } }
at 3 { mark "three" }
)"));
  EXPECT_THAT(text, HasSubstr("mode flight, where the run starts"));
  EXPECT_THAT(text, HasSubstr("when h falls through 0 in flight { h := 0; if "));
  EXPECT_THAT(text, HasSubstr("{ h' := 0; go rest } else { h' := -e*h' } }"));
  EXPECT_THAT(text, HasSubstr("{ mark \"three\" }"));
}

TEST(Describe, LimitsOfStepsAreToldWithTheRun) {
  EXPECT_THAT(describe(good("x' = 1\nx(0) = 0\nrun 0..1 tol 1e-8 max step 0.01 max steps 5000\n")),
              HasSubstr("tol 1e-08, max step 0.01, max steps 5000\n"));
}

TEST(Describe, WhatHappensAtALimitStandsAfterThen) {
  const std::string text = describe(good(R"(mode flight { h'' = -10 }
mode rest { h'' = 0 }
h(0) = 1; h'(0) = 0
when h falls through 0 in flight { h' := -h' } then { h' := 0; go rest }
)"));
  EXPECT_THAT(text, HasSubstr("{ h' := -h' } then { h' := 0; go rest }\n"));
}

TEST(Describe, LongFamiliesAreCounted) {
  const std::string text = describe(good("for i in 1..100 { u[i]' = 0\nu[i](0) = i }\n"), {.most_listed = 5});
  EXPECT_THAT(text, HasSubstr("States (100)"));
  EXPECT_THAT(text, HasSubstr("... and 95 more"));
  EXPECT_THAT(text, Not(HasSubstr("u[6]")));
}

TEST(Describe, TheOutputIsToldAlsoWhereTheModelDoesNotSayIt) {
  EXPECT_THAT(describe(good("x' = 1\nx(0) = 0\nrun 0..3\n")), HasSubstr("t = 0..3, output at every step\n"));
  EXPECT_THAT(describe(good("x' = 1\nx(0) = 0\nrun 0..3 output 0.5\n")), HasSubstr("t = 0..3, output every 0.5\n"));
}

}  // namespace
}  // namespace continuo::model
