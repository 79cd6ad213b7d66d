// A singular mass matrix is reported as such.
#include <tests/language/check_helpers.hpp>

#include <continuo/simulation/experiment.hpp>
#include <continuo/simulation/program/singular_mass.hpp>

namespace continuo::model {
namespace {

std::optional<Diagnostic> said_of(const std::string& text, const Overrides& overrides = {}) {
  const Model model = good(text);
  return singular_mass(model, start_values(model, overrides));
}

TEST(SingularMass, OfNumbersItIsSaidByTheCheck) {
  const Said message =
      said("x'' + y'' = 1\nx'' + y'' + x = 2\nx(0) = 0; x'(0) = 0; y(0) = 0; y'(0) = 0\nrun 0..1\n", "E237");
  EXPECT_EQ(place(message), "1:1");
  EXPECT_EQ(message.message, "`x''` and `y''` are not determined");
  EXPECT_EQ(message.label, "the matrix before them is singular");
  said("0.1*x' + 0.3*y' = 1\n0.3*x' + 0.9*y' = 2\nx(0) = 0; y(0) = 0\nrun 0..1\n", "E237");
  said("x'*y' = 1\nx' + y' = 2\nx(0) = 0; y(0) = 0\nrun 0..1\n", "E232");
}

TEST(SingularMass, OfParametersItHangsOnTheirValues) {
  const std::string text = R"(param m = 0.1, n = 0.3
m*x'' + n*y'' = 1
n*x'' + 0.9*y'' + x = 2
x(0) = 0; x'(0) = 0; y(0) = 0; y'(0) = 0
run 0..1
)";
  const auto message = said_of(text);
  ASSERT_TRUE(message);
  EXPECT_EQ(message->code, "E335");
  EXPECT_EQ(message->message, "`x''` and `y''` are not determined at the start");
  EXPECT_FALSE(said_of(text, {{"m", 0.2}}));
  EXPECT_FALSE(said_of(text, {{"m", 0.1 * (1 + 1e-12)}}));
  std::vector<Diagnostic> problems;
  EXPECT_FALSE(plan(good(text), {}, problems));
  ASSERT_EQ(problems.size(), 1U);
  EXPECT_EQ(problems.front().code, "E335");
}

TEST(SingularMass, AMassOfZeroIsOne) {
  const std::string text = "param m = 0\nm*x'' = 1\nx(0) = 0; x'(0) = 0\nrun 0..1\n";
  EXPECT_EQ(said_of(text)->message, "`x''` is not determined at the start");
  EXPECT_FALSE(said_of(text, {{"m", 1e-300}}));
  EXPECT_TRUE(said_of("x*x' = 1\nx(0) = 0\nrun 0..1\n"));
  EXPECT_FALSE(said_of("x*x' = 1\nx(0) = 1\nrun 0..1\n"));
  EXPECT_FALSE(said_of("x*x' = 1\nx(0) = 0\ninitially { x := 1 }\nrun 0..1\n"));
  EXPECT_FALSE(said_of("x*x' = 1\nx(2) = 0\nat 2 { x := 1 }\nrun 2..3\n"));
  EXPECT_FALSE(said_of("mode a { x*x' = 1 }\nmode b { (x - 1)*x' = 1 }\nx(0) = 1\nwhen x > 2 { go b }\nrun 0..1\n"));
}

TEST(SingularMass, UnitsOfEquationsSayNothing) {
  const std::string text = R"(param m = 1e-12, big = 1e12
m*x'' + 2*m*y'' = 1
big*x'' - big*y'' = 2
x(0) = 0; x'(0) = 0; y(0) = 0; y'(0) = 0
run 0..1
)";
  EXPECT_FALSE(said_of(text));
}

// The first pivot is 0 at the start, the matrix (0, 1; 1, 1) is regular: x' = 1, y' = 2.
TEST(SingularMass, ARegularOneIsSolvedWhateverStandsFirst) {
  const Model model = good("param a = 1\n(a - 1)*x' + y' = 2\nx' + a*y' = 3\nx(0) = 0; y(0) = 0\nrun 0..1\n");
  EXPECT_FALSE(singular_mass(model, start_values(model)));
  EXPECT_EQ(rate(model, "x"), 1);
  EXPECT_EQ(rate(model, "y"), 2);
  // The second pivot, 0.9 - 0.3/0.1*0.3, is rounding alone; x' = 4, y' = -1, z' = 2 by substitution.
  for (const auto* head : {"param a = 0.1, b = 0.3, c = 0.9\n", "let a = 0.1, b = 0.3, c = 0.9\n"}) {
    const Model three = good(std::string(head) +
                             "a*x' + b*y' = 0.1\nb*x' + c*y' + z' = 2.3\nx' + y' + z' = 5\n"
                             "x(0) = 0; y(0) = 0; z(0) = 0\nrun 0..1\n");
    EXPECT_NEAR(rate(three, "x"), 4, 1e-13);
    EXPECT_NEAR(rate(three, "y"), -1, 1e-13);
    EXPECT_NEAR(rate(three, "z"), 2, 1e-13);
  }
}

}  // namespace
}  // namespace continuo::model
