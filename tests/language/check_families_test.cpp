// `for`, `sum` and indices, against systems written out by hand.
#include "check_helpers.hpp"

namespace continuo::model {
namespace {

constexpr const char* coupled = R"(param N = 4, D = 2
for i in 2..N-1 { u[i]' = D*(u[i-1] - 2*u[i] + u[i+1]) }
u[1]' = D*(u[2] - 2*u[1])
u[N]' = D*(u[N-1] - 2*u[N])
for i in 1..N { u[i](0) = i^2 }
output total = sum(i in 1..N: u[i]), odd = sum(i in 1..N where mod(i, 2) == 1: u[i])
output none = sum(i in 5..N: u[i])
run 0..1
)";

constexpr const char* by_hand = R"(param D = 2
a' = D*(b - 2*a)
b' = D*(a - 2*b + c)
c' = D*(b - 2*c + d)
d' = D*(c - 2*d)
a(0) = 1; b(0) = 4; c(0) = 9; d(0) = 16
run 0..1
)";

TEST(CheckFamilies, AFamilyIsTheSystemWrittenOut) {
  const Model family = good(coupled), plain = good(by_hand);
  ASSERT_EQ(family.states.size(), 4U);
  const char* names[] = {"a", "b", "c", "d"};
  for (int i = 0; i < 4; ++i) {
    EXPECT_EQ(rate(family, "u[" + std::to_string(i + 1) + "]"), rate(plain, names[i]));
  }
}

TEST(CheckFamilies, SumsRunOverTheirRange) {
  const Model model = good(coupled);
  EXPECT_EQ(value_of(model, "total"), 30);
  EXPECT_EQ(value_of(model, "odd"), 10);
  EXPECT_EQ(value_of(model, "none"), 0);
}

TEST(CheckFamilies, BodiesPullEachOther) {
  const Model model = good(R"(param N = 3, m[1..N] = (1, 2, 3)
for i in 1..N {
  x[i]'' = sum(j in 1..N where j != i: m[j]*(x[j] - x[i]))
  x[i](0) = 10*i;  x[i]'(0) = 0
}
run 0..1
)");
  EXPECT_EQ(rate(model, "x[1]'"), 2 * 10 + 3 * 20);
  EXPECT_EQ(rate(model, "x[3]'"), -1 * 20 - 2 * 10);
  EXPECT_EQ(model.states[2].column, "x[2]");
}

TEST(CheckFamilies, AnIndexOutOfRangeNamesTheIndexAndTheSize) {
  const Said message = said("for i in 1..3 { u[i]' = u[i+1]\nu[i](0) = 0 }\nrun 0..1\n", "E220");
  EXPECT_EQ(place(message), "1:25");
  EXPECT_EQ(message.message, "`u[4]` is out of range");
  EXPECT_EQ(message.label, "`u` goes from `u[1]` to `u[3]`");
}

TEST(CheckFamilies, IndicesAreWholeAndWhereTheyBelong) {
  const std::string family = "for i in 1..3 { u[i]' = 0\nu[i](0) = 0 }\nx' = 1\nx(0) = 0\nrun 0..1\n";
  EXPECT_EQ(place(said(family + "output a = u[1.5]\n", "E219")), "6:14");
  EXPECT_EQ(place(said(family + "output a = u\n", "E219")), "6:12");
  EXPECT_EQ(place(said(family + "output a = x[1]\n", "E219")), "6:12");
  EXPECT_EQ(place(said(family + "output a = u[x]\n", "E222")), "6:14");
  EXPECT_EQ(place(said("param m[1..3] = (1, 2)\nx' = 1\nx(0) = 0\nrun 0..1\n", "E220")), "1:17");
}

TEST(CheckFamilies, TheSizeIsChangedByAnOverrideAtLoading) {
  const Model model = good(coupled, {.overrides = {{"N", 7.0}}});
  EXPECT_EQ(model.states.size(), 7U);
  EXPECT_TRUE(model.parameters[find_parameter(model, "N")].structural);
  EXPECT_FALSE(model.parameters[find_parameter(model, "D")].structural);
  EXPECT_EQ(said(coupled, "E210", {.overrides = {{"M", 7.0}}}).message, "there is no parameter `M` to set");
}

TEST(CheckFamilies, HugeFamiliesAreRefusedInTime) {
  EXPECT_EQ(place(said("for i in 1..1000000000 { u[i]' = 0 }\nrun 0..1\n", "E221")), "1:10");
  EXPECT_EQ(place(said("x' = sum(i in 1..1000: sum(j in 1..1000000: i*j))\nx(0) = 0\nrun 0..1\n", "E221")), "1:33");
}

TEST(CheckFamilies, EventsAndActionsAreWrittenOut) {
  const Model model = good(R"(for i in 1..2 {
  x[i]'' = -1
  x[i](0) = i; x[i]'(0) = 0
  when x[i] falls through 0 { x[i]' := -x[i]' }
}
initially { for i in 1..2 { x[i] := 3*i } }
run 0..1
)");
  ASSERT_EQ(model.events.size(), 2U);
  EXPECT_EQ(model.events[1].name, "x[2] falls through 0");
  EXPECT_EQ(model.schedule.at(0).actions.size(), 2U);
}

}  // namespace
}  // namespace continuo::model
