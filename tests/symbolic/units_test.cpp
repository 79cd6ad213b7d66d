// Units: the meaning of their text, the names of results, and no silent mixing.
#include <numbers>
#include <string>

#include <gtest/gtest.h>

#include <continuo/symbolic/units/units.hpp>
#include <continuo/symbolic/units/units_database.hpp>

namespace continuo::model {
namespace {

Unit unit(const char* text) {
  const Result<Unit> parsed = parse_unit(text);
  EXPECT_TRUE(parsed) << text << ": " << describe(parsed.status());
  return parsed ? *parsed : Unit();
}

TEST(Units, NewtonIsKilogramMetrePerSecondSquared) {
  EXPECT_TRUE(unit("N") == unit("kg*m/s^2"));
  EXPECT_TRUE(unit("N") == unit("kg m s-2"));
  EXPECT_TRUE(unit("N") == unit("kg.m/s**2"));
  EXPECT_TRUE(unit("N/(m/s)") == unit("N*s/m"));
  EXPECT_FALSE(convertible(unit("N"), unit("N*s")));
}

TEST(Units, ResultsCarryTheNamesTheUserWrote) {
  EXPECT_EQ(to_text(unit("N/m") * unit("m")), "N");
  EXPECT_EQ(to_text(unit("N*s/m") * unit("m")), "N*s");
  EXPECT_EQ(to_text(unit("m") / unit("s") / unit("s")), "m/s^2");
  EXPECT_EQ(to_text(unit("kg") * unit("m/s^2")), "N");
  EXPECT_EQ(to_text(unit("km/h")), "km/h");
  EXPECT_EQ(to_text(unit("pm") / unit("fs")), "pm/fs");
  EXPECT_EQ(to_text(unit("1") / unit("s")), "1/s");
  EXPECT_EQ(to_text(unit("m") / unit("m")), "1");
  EXPECT_EQ(to_text(*power(unit("m"), 0.5)), "m^(1/2)");
  EXPECT_EQ(to_text(Unit() / (unit("kg") * unit("K"))), "1/(kg*K)");
}

TEST(Units, RootsOfUnitsAreUnits) {
  EXPECT_TRUE(*power(unit("m^2/s^2"), 1, 2) == unit("m/s"));
  EXPECT_TRUE(*power(*power(unit("m"), 1, 3), 3) == unit("m"));
  EXPECT_FALSE(power(unit("m"), 1, 7));
  EXPECT_FALSE(power(unit("m"), std::numbers::pi));
}

TEST(Units, ConversionFactorsAreExactToRounding) {
  EXPECT_NEAR(*conversion_factor(unit("km/h"), unit("m/s")), 1 / 3.6, 1e-16);
  EXPECT_EQ(*conversion_factor(unit("min"), unit("s")), 60);
  EXPECT_NEAR(*conversion_factor(unit("deg"), unit("rad")), std::numbers::pi / 180, 1e-17);
  EXPECT_EQ(*conversion_factor(unit("N"), unit("kg*m/s^2")), 1);
  EXPECT_FALSE(conversion_factor(unit("m"), unit("s")));
}

TEST(Units, AnglesArePureNumbers) {
  EXPECT_TRUE(unit("rad/s") == unit("1/s"));
  EXPECT_TRUE(unit("rad").dimensionless());
}

TEST(Units, CelsiusIsNeverTakenForKelvin) {
  EXPECT_FALSE(convertible(unit("degC"), unit("K")));
  EXPECT_TRUE(convertible(unit("degC/min"), unit("degC/s")));
  EXPECT_TRUE(unit("celsius") == unit("degC"));
  EXPECT_TRUE(unit("degree_fahrenheit") == unit("degF"));
  EXPECT_FALSE(convertible(unit("degF"), unit("degC")));
}

TEST(Units, TheDatabaseKnowsTheRest) {
  EXPECT_NEAR(*conversion_factor(unit("inch"), unit("m")), 0.0254, 1e-17);
  EXPECT_NEAR(*conversion_factor(unit("hectare"), unit("m^2")), 1e4, 1e-11);
  EXPECT_NEAR(*conversion_factor(unit("knot"), unit("m/s")), 1852.0 / 3600, 1e-16);
}

TEST(Units, UsualUnitsAreWorthWhatUdunitsSays) {
  for (const char* name :
       {"m",       "g",   "kg",   "s",   "A",  "K",    "mol", "cd",   "degC", "degF", "radian", "degree",
        "percent", "min", "hour", "day", "Hz", "N",    "Pa",  "bar",  "J",    "W",    "C",      "V",
        "ohm",     "S",   "F",    "H",   "Wb", "T",    "L",   "l",    "t",    "km",   "mm",     "um",
        "nm",      "pm",  "fs",   "ps",  "ns", "us",   "ms",  "MPa",  "kN",   "mol",  "mV",     "\u00b5m",
        "h",       "d",   "cm",   "GHz", "mg", "kohm", "nF",  "mbar", "kJ",   "dm"}) {
    const auto theirs = detail::database_unit(name);
    const auto ours = detail::usual_unit(name);
    ASSERT_TRUE(theirs) << describe(theirs.status());
    ASSERT_TRUE(ours) << name;
    EXPECT_TRUE(*ours == *theirs) << name << " " << ours->factor() << " " << theirs->factor();
  }
}

TEST(Units, MeasuredConstantsAreTodays) {
  // CODATA 2018; UDUNITS-2 has the values of 1986, which agree to 1e-5.
  for (const char* name : {"eV", "amu", "u"}) {
    EXPECT_NEAR(detail::usual_unit(name)->factor() / detail::database_unit(name)->factor(), 1, 1e-5) << name;
  }
  EXPECT_EQ(unit("eV").factor(), 1.602176634e-19);
}

TEST(Units, WrongOnesAreExplained) {
  EXPECT_EQ(parse_unit("meterz").status().message, "`meterz` is not a unit");
  EXPECT_EQ(parse_unit("sec")->factor(), 1);
  EXPECT_TRUE(parse_unit("Joule"));
  EXPECT_EQ(suggested_unit("Kg"), "kg");
  EXPECT_EQ(suggested_unit("kg"), "");
  EXPECT_EQ(suggested_unit(""), "1");
  EXPECT_FALSE(parse_unit(""));
  EXPECT_FALSE(parse_unit("m/"));
  EXPECT_FALSE(parse_unit("m/(s"));
  EXPECT_FALSE(parse_unit("m^x"));
  EXPECT_FALSE(parse_unit("m)"));
  EXPECT_FALSE(parse_unit("0"));
  EXPECT_FALSE(parse_unit(std::string(100000, '(')));
  EXPECT_FALSE(parse_unit("m^1e300"));
  EXPECT_FALSE(parse_unit("dB"));
}

}  // namespace
}  // namespace continuo::model
