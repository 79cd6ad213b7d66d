// Initial values computed from other initial values, against a direct evaluation.
#include <cmath>
#include <numeric>
#include <random>

#include <fmt/format.h>

#include "check_helpers.hpp"

namespace continuo::model {
namespace {

double start_of(const Model& model, std::string_view column, const Overrides& overrides = {},
                std::optional<double> from = std::nullopt) {
  const std::size_t state = find_state(model, column);
  EXPECT_NE(state, npos) << column;
  return start_values(model, overrides, from).at(model.states.at(state).variable);
}

TEST(CheckStarts, AStartMayNameOthersInAnyOrder) {
  const Model model = good(R"(param beta = 2, first = 0.01
S' = -beta*S*I; I' = beta*S*I - I; R' = I
S(0) = 1 - I(0) - R(0); I(0) = first; R(0) = 2*I(0)
run 0..100
)");
  EXPECT_FALSE(model.needs_boundary_solver());
  EXPECT_EQ(model.layout.size, model.layout.samples);
  EXPECT_DOUBLE_EQ(start_of(model, "S"), 0.97);
  EXPECT_DOUBLE_EQ(start_of(model, "S", {{"first", 0.1}}), 0.7);
}

TEST(CheckStarts, ALetOfStatesIsItsValueAtTheStart) {
  const Model model = good(R"(let am = 0.1*(V + 40)/(1 - exp(-(V + 40)/10)), bm = 4*exp(-(V + 65)/18)
V' = -V; m' = am*(1 - m) - bm*m
m(0) = am/(am + bm)
V(0) = -65
run 0..1
)");
  const double am = 0.1 * -25 / (1 - std::exp(2.5));
  EXPECT_NEAR(start_of(model, "m"), am / (am + 4), 1e-15);
  EXPECT_FALSE(
      good("x' = -x; y' = -y\nlet twice = 2*x\nx(0) = 3; y(0) = twice(0)\nrun 0..1\n").needs_boundary_solver());
}

TEST(CheckStarts, DerivativesHaveThemToo) {
  const Model model = good("x'' = -x\ny' = 1\nx(0) = 3; x'(0) = 2*y(0) + x(0); y(0) = 7\nrun 0..1\n");
  EXPECT_EQ(start_of(model, "x'"), 17);
  EXPECT_EQ(start_of(good("x' = 1; y'' = 1\ny(0) = 1; y'(0) = 4; x(0) = y'(0)^2\nrun 0..1\n"), "x"), 16);
}

TEST(CheckStarts, TheRunMayStartElsewhere) {
  const Model model = good("x' = 1; y' = 1\nlet late = 10*t\nx(2) = y(2) + 1; y(2) = late + t\nrun 2..5\n");
  EXPECT_FALSE(model.needs_boundary_solver());
  EXPECT_EQ(start_of(model, "x"), 23);
  EXPECT_EQ(start_of(model, "x", {}, 3), 34);
  const Model moved = good("param T = 2\nx' = 1; y' = 1\nx(T) = y(T) + t; y(T) = 1\nrun T..5\n");
  EXPECT_EQ(start_of(moved, "x"), 3);
  EXPECT_EQ(start_of(moved, "x", {{"T", 4}}), 5);
}

TEST(CheckStarts, InputsAreWhatTheyAreAtTheStart) {
  EXPECT_EQ(start_of(good("input F = 3\nx' = F\nx(0) = 2*F\nrun 0..1\n"), "x"), 6);
  Model model = good("input F = 3\nx' = F\nx(1) = 2*F\nrun 1..2\n");
  model.inputs[0].points = Table({0, 2}, {10, 20}, Table::Between::linear);
  EXPECT_EQ(start_of(model, "x"), 30);
  EXPECT_EQ(start_of(model, "x", {}, 2), 40);
}

TEST(CheckStarts, UnitsAreConverted) {
  const Model model = good("x' = 0 [m/s]; y' = 0 [km/s]\nx(0) = y(0) + 1 [m]; y(0) = 2 [km]\nrun 0..1 [s]\n");
  EXPECT_EQ(start_of(model, "y"), 2);
  const State& x = model.states[find_state(model, "x")];
  EXPECT_EQ(start_of(model, "x"), x.unit == "m" ? 2001 : 2.001);
  said("x' = 0 [m/s]; y' = 0 [kg/s]\nx(0) = 1 [m]; y(0) = x(0) + 1 [kg]\nrun 0..1 [s]\n", "E201");
}

TEST(CheckStarts, ALongFamilyIsNoDeepOne) {
  const Model model = good(R"(param N = 20000, q = 1
for i in 1..N { u[i]' = 0 }
for i in 2..N { u[i](0) = q*u[i-1](0) + 1 }
u[1](0) = 1
run 0..1
)");
  EXPECT_EQ(start_of(model, "u[20000]"), 20000);
  EXPECT_EQ(start_of(model, "u[20000]", {{"q", 0}}), 1);
}

TEST(CheckStarts, ACircleIsNamed) {
  const Said message =
      said("x' = 1; y' = 1; z' = 1\nlet twice = 2*z\nx(0) = y(0) + 1; y(0) = twice; z(0) = x(0)\nrun 0..1\n", "E246");
  EXPECT_EQ(place(message), "3:1");
  EXPECT_EQ(message.message, "`x(0)` is given by itself");
  EXPECT_EQ(message.label, "x(0) -> y(0) -> z(0) -> x(0)");
  EXPECT_EQ(said("x' = 1\nx(0) = 1 - x(0)/2\nrun 0..1\n", "E246").label, "x(0) -> x(0)");
  EXPECT_EQ(count_said("x' = 1; y' = 1; z' = 1\nx(0) = y(0); y(0) = x(0); z(0) = y(0)\nrun 0..1\n"), 1U);
}

TEST(CheckStarts, WhatIsNotKnownAtTheStartIsNamed) {
  const Said unknown =
      said("unknown v = 1\nlet w = 2*v\nx' = -v; 0 = v - x\ny' = 1\nx(0) = 1; y(0) = w\nrun 0..1\n", "E222");
  EXPECT_EQ(place(unknown), "5:11");
  EXPECT_EQ(unknown.message, "this start cannot depend on `v`");
  const Said rate = said("x'' = -x\nlet a = 2*x''\ny' = 1\nx(0) = 1; x'(0) = 0; y(0) = a\nrun 0..1\n", "E222");
  EXPECT_EQ(place(rate), "4:22");
  EXPECT_EQ(rate.message, "this start cannot depend on `x''`");
  EXPECT_EQ(said("x' = 1; y' = 1\ny(0) = 2*x(0)\nrun 0..1\n", "E240").message, "`x(0)` is missing");
}

TEST(CheckStarts, AnotherTimeMakesABoundaryCondition) {
  const Model model = good("x'' = -x; y' = x\nx(0) = 1 - x(1); x'(0) = 2*y(0); y(0) = 3\nrun 0..1\n");
  EXPECT_TRUE(model.needs_boundary_solver());
  EXPECT_EQ(model.boundary.size(), 3U);
  const std::string head = "x'' = -x; y' = x\nlet s = x + y\nx(1) = 1; x(0) = 0; ";
  EXPECT_TRUE(good(head + "y(0) = s(0)\nrun 0..1\n").needs_boundary_solver());
  EXPECT_EQ(said(head + "y(0) = s\nrun 0..1\n", "E222").help, "name what changes with a time, as in x(0)");
}

// Sums and products of earlier starts, parameters and t, written in random order; evaluated here as they are made.
TEST(CheckStarts, RandomOnesAgreeWithADirectEvaluation) {
  std::mt19937 random(19);
  const auto pick = [&](std::size_t below) { return std::uniform_int_distribution<std::size_t>(0, below - 1)(random); };
  for (int trial = 0; trial < 200; ++trial) {
    const std::size_t n = 1 + pick(12);
    const double k = 0.25 * static_cast<double>(1 + pick(8)), begin = static_cast<double>(pick(4));
    std::vector<std::string> lines{fmt::format("param k = {}", k)};
    std::vector<double> start;
    for (std::size_t i = 0; i < n; ++i) {
      std::string text = fmt::format("{}", 1 + pick(9));
      double value = std::stod(text);
      for (std::size_t terms = pick(4); terms-- > 0;) {
        const std::size_t kind = i == 0 ? 3 + pick(2) : pick(5), of = i == 0 ? 0 : pick(i);
        const double factor = 0.5 * static_cast<double>(1 + pick(4));
        const std::string name = kind == 0   ? fmt::format("x{}({})", of, begin)
                                 : kind == 1 ? fmt::format("a{}", of)
                                 : kind == 2 ? fmt::format("a{}({})", of, begin)
                                 : kind == 3 ? "k"
                                             : "t";
        const double known = kind == 0 ? start[of] : kind < 3 ? start[of] - k : kind == 3 ? k : begin;
        text += fmt::format(" + {}*{}", factor, name);
        value += factor * known;
      }
      start.push_back(value);
      lines.push_back(fmt::format("x{}' = 1", i));
      lines.push_back(fmt::format("let a{0} = x{0} - k", i));
      lines.push_back(fmt::format("x{}({}) = {}", i, begin, text));
    }
    lines.push_back(fmt::format("run {}..{}", begin, begin + 1));
    std::ranges::shuffle(lines, random);
    std::string text;
    for (const std::string& line : lines) text += line + "\n";
    const Model model = good(text);
    ASSERT_FALSE(model.needs_boundary_solver()) << text;
    // Every number is a small multiple of a power of two: sums and products of few terms are exact or nearly so.
    for (std::size_t i = 0; i < n; ++i)
      EXPECT_NEAR(start_of(model, fmt::format("x{}", i)), start[i], 1e-14 * std::abs(start[i])) << text;
  }
}

}  // namespace
}  // namespace continuo::model
