// The coefficients of continuo/numerics/coefficient.hpp, by its documentation.
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>

#include <boost/multiprecision/cpp_bin_float.hpp>
#include <gtest/gtest.h>

#include <continuo/numerics/coefficient.hpp>

namespace continuo::coefficient_test {
namespace {

using Wide = boost::multiprecision::cpp_bin_float_100;
using Quad = boost::multiprecision::cpp_bin_float_quad;  // 113 bits

// The compiler's own literals are the nearest doubles: the same text must give the same bits.
static_assert((0.1_c).as<double>() == 0.1);
static_assert((0.980025540904509685729810286287024595494213797956302_c).as<double>() ==
              0.980025540904509685729810286287024595494213797956302);
static_assert((0.000816434459656746903223636063354686240186254_c).as<double>() ==
              0.000816434459656746903223636063354686240186254);
static_assert((7340.848417712071304684606060804637321789_c).as<double>() == 7340.848417712071304684606060804637321789);
static_assert((1_c / 3).as<double>() == 1.0 / 3.0);
static_assert((-(9017_c / 3168)).as<double>() == -9017.0 / 3168.0);
static_assert((1_c / 3).as<float>() == 1.0F / 3.0F);

// Integers are kept exactly, at the ends of their types too.
static_assert(Coefficient(std::numeric_limits<std::int64_t>::min()).as<long double>() == -9223372036854775808.0L);
static_assert(Coefficient(std::numeric_limits<std::int64_t>::max()).as<long double>() == 9223372036854775807.0L);
static_assert(Coefficient(std::numeric_limits<std::uint64_t>::max()).as<long double>() == 18446744073709551615.0L);
static_assert(Coefficient(-5).as<long double>() == -5.0L);

TEST(Coefficient, ALongDoubleIsTheNearestOne) {
  constexpr long double parsed = 0.980025540904509685729810286287024595494213797956302L;
  EXPECT_EQ((0.980025540904509685729810286287024595494213797956302_c).as<long double>(), parsed);
  EXPECT_EQ((2_c / 7).as<long double>(), 2.0L / 7.0L);
}

TEST(Coefficient, ADecimalKeepsFortyFiveDigitsBehindThePoint) {
  const Wide expected("12.920969317847109291706118681783359395417807520");
  const Wide kept = (12.920969317847109291706118681783359395417807520_c).as<Wide>();
  EXPECT_LT(abs(kept / expected - 1), Wide("1e-46"));
  const Wide small("0.000392079324131595136938351731087080339335600");
  EXPECT_LT(abs((0.0003920793241315951369383517310870803393356_c).as<Wide>() - small), Wide("1e-45"));
}

TEST(Coefficient, ARatioOfLongIntegersHasAtLeast113Bits) {
  // Verner's a_63 of the 7(6) pair as published.
  constexpr Coefficient ratio =
      27569888999279458303270493567994248533230000_c / 2551701010245296220859455115479340650299761_c;
  const Wide expected =
      Wide("27569888999279458303270493567994248533230000") / Wide("2551701010245296220859455115479340650299761");
  EXPECT_LT(abs(ratio.as<Wide>() / expected - 1), Wide("1e-46"));
  EXPECT_LE(abs(ratio.as<Quad>() / Quad(expected) - 1), 2 * std::numeric_limits<Quad>::epsilon());
}

TEST(Coefficient, ArithmeticLosesNothingThatADoubleQuartetWouldShow) {
  const std::array<Coefficient, 4> values{1_c / 3, -2.718281828459045235360287471352662497757247093_c, 1_c / 1024,
                                          123456789_c / 7};
  for (const Coefficient& a : values) {
    for (const Coefficient& b : values) {
      const Wide x = a.as<Wide>(), y = b.as<Wide>();
      const Wide size = abs(x) + abs(y);
      EXPECT_LE(abs((a + b).as<Wide>() - (x + y)), Wide("1e-46") * size);
      EXPECT_LE(abs((a - b).as<Wide>() - (x - y)), Wide("1e-46") * size);
      EXPECT_LE(abs((a * b).as<Wide>() - (x * y)), Wide("1e-46") * abs(x * y));
      EXPECT_LE(abs((a / b).as<Wide>() - (x / y)), Wide("1e-46") * abs(x / y));
    }
  }
}

TEST(Coefficient, CompileTimeAndRunTimeAgree) {
  constexpr Coefficient before = (355_c / 113) * (0.1415926535897932384626433832795028841971_c / 7);
  const auto later = [](Coefficient a, Coefficient b) { return a * b; };
  volatile int seven = 7;
  EXPECT_EQ(later(355_c / 113, 0.1415926535897932384626433832795028841971_c / int(seven)), before);
}

}  // namespace
}  // namespace continuo::coefficient_test
