#include <array>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <continuo/results/report.hpp>

namespace continuo::results {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

TEST(Report, TheFirstParagraphOfTheHeadingIsTheSubtitle) {
  const std::string page = report_page("Ball", "A ball\nfalls.\n\nTry: continuo run", {});
  EXPECT_THAT(page, HasSubstr("<p>A ball\nfalls.</p>"));
  EXPECT_THAT(page, Not(HasSubstr("Try")));
}

TEST(Report, WhatIsSpecialInHtmlIsNoneOfIt) {
  const std::array sections{ReportSection{.title = "a < b", .text = "x & \"y\""}};
  const std::string page = report_page("<b>", "", sections);
  EXPECT_THAT(page, HasSubstr("<h1>&lt;b&gt;</h1>"));
  EXPECT_THAT(page, HasSubstr("<h2>a &lt; b</h2>"));
  EXPECT_THAT(page, HasSubstr("<pre>x &amp; &quot;y&quot;</pre>"));
}

TEST(Report, EachPictureKeepsItsOwnNames) {  // both call a marker alike
  const std::string svg = "<?xml?>\n<svg><circle id='m'/><use xlink:href='#m'/></svg>";
  const std::array sections{ReportSection{.title = "one", .svg = svg}, ReportSection{.title = "two", .svg = svg}};
  const std::string page = report_page("Two", "", sections);
  EXPECT_THAT(page, HasSubstr("id='p0_m'"));
  EXPECT_THAT(page, HasSubstr("href='#p1_m'"));
  EXPECT_THAT(page, Not(HasSubstr("<?xml")));
}

}  // namespace
}  // namespace continuo::results
