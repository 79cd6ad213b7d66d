// `for`, `sum` and indices, against systems written out by hand.
#include <map>
#include <random>
#include <utility>

#include <fmt/format.h>

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

TEST(CheckFamilies, SeveralIndicesAreFamiliesInsideEachOther) {
  const std::string body = "{ u[i,j]' = i*u[i,j] + 10*j\nu[i,j](0) = i + 100*j }\n", run = "run 0..1\n";
  const std::string ends = "output s = sum(i in 1..3, j in 1..i where j != 2: u[i,j])\n" + run;
  const std::string inside = "output s = sum(i in 1..3: sum(j in 1..i where j != 2: u[i,j]))\n" + run;
  const Model one = good("for i in 1..3, j in 1..i " + body + ends);
  const Model other = good("for i in 1..3 { for j in 1..i " + body + "}\n" + inside);
  ASSERT_EQ(one.states.size(), 6U);
  for (std::size_t i = 0; i < one.states.size(); ++i) {
    EXPECT_EQ(one.states[i].column, other.states[i].column);
    EXPECT_EQ(rate(one, one.states[i].column), rate(other, one.states[i].column));
  }
  EXPECT_EQ(one.states[4].column, "u[3,2]");
  EXPECT_EQ(value_of(one, "s"), 101 + 102 + 103 + 303);
  EXPECT_EQ(value_of(one, "s"), value_of(other, "s"));
}

TEST(CheckFamilies, SeveralIndicesStandWhereverAFamilyDoes) {
  const Model model = good(R"(for i in 1..2, j in 1..3 { x[i,j]' = 0; x[i,j](0) = 0 }
initially { for i in 1..2, j in 1..3 { x[i,j] := 10*i + j } }
draw { for i in 1..2, j in 1..3 { ball (i, x[i,j]) radius 0.1 } }
run 0..1
)");
  EXPECT_EQ(model.schedule.at(0).actions.size(), 6U);
  EXPECT_EQ(model.drawing.size(), 6U);
}

/// A stencil with boundaries by conditions, of a random shape, and the same system with every equation written by hand.
TEST(CheckFamilies, RandomGridsAreTheSystemWrittenOut) {
  std::mt19937 random(7);
  for (int trial = 0; trial < 20; ++trial) {
    const auto n = std::uniform_int_distribution(1, 5)(random), m = std::uniform_int_distribution(1, 5)(random);
    const auto low = std::uniform_int_distribution(-3, 3)(random);
    std::string grid = fmt::format("param L = {}, N = {}, M = {}\n", low, low + n - 1, m), written;
    grid += "for i in L..N, j in 1..M {\n  u[i,j](0) = 3*i + 5*j + i*j\n  u[i,j]' = ";
    grid +=
        "(if i > L then u[i-1,j] else 7) + (if i < N then 2*u[i+1,j] else 11) + (if j == 1 then 13 else 3*u[i,j-1])"
        " + (if not j < M then i else 5*u[i,j+1]) - 4*u[i,j]\n}\nrun 0..1\n";
    const auto name = [&](int i, int j) { return fmt::format("u{}x{}", i - low, j); };
    for (int i = low; i < low + n; ++i) {
      for (int j = 1; j <= m; ++j) {
        written +=
            fmt::format("{0}(0) = {1}\n{0}' = {2} + {3} + {4} + {5} - 4*{0}\n", name(i, j), 3 * i + 5 * j + i * j,
                        i > low ? name(i - 1, j) : "7", i < low + n - 1 ? "2*" + name(i + 1, j) : "11",
                        j == 1 ? "13" : "3*" + name(i, j - 1), j < m ? "5*" + name(i, j + 1) : fmt::format("({})", i));
      }
    }
    const Model family = good(grid), plain = good(written + "run 0..1\n");
    ASSERT_EQ(family.states.size(), plain.states.size());
    for (std::size_t k = 0; k < family.states.size(); ++k)
      EXPECT_EQ(rate(family, family.states[k].column), rate(plain, plain.states[k].column)) << grid;
  }
}

TEST(CheckFamilies, OnlyWhatTheIndicesRuleOutMayLieOutside) {
  const std::string family = "param N = 3, k = 1\nfor i in 1..N { u[i](0) = 0; u[i]' = ";
  static_cast<void>(good(family + "if i < N then u[i+1] else 0 }\nrun 0..1\n"));
  EXPECT_EQ(said(family + "if k < 2 then u[i+1] else 0 }\nrun 0..1\n", "E220").message, "`u[4]` is out of range");
  EXPECT_EQ(said(family + "if i < N then u[i+2] else 0 }\nrun 0..1\n", "E220").message, "`u[4]` is out of range");
  EXPECT_EQ(said(family + "if i < N then u[i+1,1] else 0 }\nrun 0..1\n", "E219").message, "`u` needs one index");
  EXPECT_EQ(said(family + "if i < 9 then 0 else w[i] }\nrun 0..1\n", "E210").message, "there is no `w[1]`");
}

/// Members in any order, with gaps, far from each other, and under one name with other numbers of indices.
TEST(CheckFamilies, MembersAreFoundInWhateverOrderTheyCome) {
  std::mt19937 random(11);
  for (const int spread : {3, 40, 100'000'000}) {
    std::uniform_int_distribution index(-spread, spread);
    std::map<std::pair<int, int>, int> values;
    std::string text;
    for (int k = 0; k < 60; ++k) {
      const std::pair at(index(random), index(random));
      if (!values.try_emplace(at, k).second) continue;
      text += fmt::format("param p[{},{}] = {}\n", at.first, at.second, k);
    }
    text += "x' = 1\nx(0) = 0\n";
    for (const auto& [at, k] : values) text += fmt::format("output o{} = p[{},{}]\n", k, at.first, at.second);
    const Model model = good(text + "run 0..1\n");
    for (const auto& [at, k] : values) EXPECT_EQ(value_of(model, fmt::format("o{}", k)), k);
  }
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
  EXPECT_EQ(place(said("x' = sum(i in 1..9: sum(j in 1..1000000000: i*j))\nx(0) = 0\nrun 0..1\n", "E221")), "1:30");
  EXPECT_EQ(place(said("x' = 1\nx(0) = 0\nfor i in 1..1000, j in 1..1000000 {}\nrun 0..1\n", "E221")), "3:24");
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
