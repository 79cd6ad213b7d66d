// Tests of the comparison between pages and output.
#include <gtest/gtest.h>
#include <tests/docs/shown_text.hpp>

namespace continuo::docs {
namespace {

TEST(ShownText, LastDigitsDurationsAndHashesMayDiffer) {
  EXPECT_TRUE(shows("h = 5.1 m, 23 us by rk4", "h = 5.1000000000000005 m, 1.2 ms by rk4"));
  EXPECT_TRUE(shows("drift 2.9e-16", "drift -4.3e-16"));
  EXPECT_TRUE(shows("# manifest " + std::string(64, 'a'), "# manifest " + std::string(64, '0')));
  EXPECT_TRUE(shows("a   1", "a 1"));
}

TEST(ShownText, WordsAndNumbersMayNot) {
  EXPECT_FALSE(shows("h = 5.1 m", "h = 5.2 m"));
  EXPECT_FALSE(shows("h = 5.1 m", "h = 5.1 s"));
  EXPECT_FALSE(shows("one line", "one line\nand another"));
  EXPECT_FALSE(shows("checks 9 of 9 hold", "checks 8 of 9 hold"));
}

TEST(ShownText, DotsStandForWhatIsLeftOut) {
  EXPECT_TRUE(shows("first\n...\nlast", "first\n1\n2\nlast"));
  EXPECT_TRUE(shows("first\n...", "first"));
  EXPECT_TRUE(shows("in … s", "in 27 or so s"));
  EXPECT_FALSE(shows("first\n...\nlast", "first\n1"));
}

}  // namespace
}  // namespace continuo::docs
