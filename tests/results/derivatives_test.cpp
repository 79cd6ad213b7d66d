#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <continuo/results/derivatives.hpp>

namespace continuo::results {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

model::DerivativeReport report_of(std::size_t wrong) {
  model::DerivativeReport report;
  report.states = 3;
  report.entries = 7;
  report.band = {2, 1};
  report.points = 5;
  report.to = 2;
  for (std::size_t i = 0; i < wrong; ++i)
    report.wrong.push_back({"d(x')/d(y)", "flight", 0.5, -3, 3.0000004, 3, 3, 0.25});
  return report;
}

TEST(Derivatives, WrongOnesAreNamedWithBothValues) {
  const std::string text = derivatives_text(report_of(1));
  EXPECT_THAT(text, HasSubstr("  wrong   d(x')/d(y) at t = 0.5 in mode flight: -3, by differences 3\n"));
  EXPECT_THAT(text, Not(HasSubstr("right")));
  const auto json = nlohmann::json::parse(derivatives_json(report_of(1)));
  EXPECT_FALSE(json["agrees"].get<bool>());
  EXPECT_EQ(json["wrong"][0]["exact"], -3);
  EXPECT_EQ(json["wrong"][0]["mode"], "flight");
  EXPECT_TRUE(json["furthest"].is_null());
}

TEST(Derivatives, ManyWrongOnesStayAScreenful) {
  EXPECT_THAT(derivatives_text(report_of(100)), HasSubstr("          and 92 more\n"));
  EXPECT_THAT(derivatives_text(report_of(0)), HasSubstr("  right   by differences at 5 times, 0 to 2\n"));
}

}  // namespace
}  // namespace continuo::results
