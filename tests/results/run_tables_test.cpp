#include <clocale>
#include <cmath>
#include <cstdlib>
#include <limits>

#include <gtest/gtest.h>

#include "example.hpp"
#include <continuo/results/csv_writer.hpp>
#include <continuo/results/run_tables.hpp>

namespace continuo::results {
namespace {

TEST(Csv, NumbersAreTheShortestThatReadBackTheSame) {
  EXPECT_EQ(number(0.1), "0.1");
  EXPECT_EQ(number(100000), "100000");
  EXPECT_EQ(number(1.0 / 3), "0.3333333333333333");
  EXPECT_EQ(number(-0.0), "0");
  EXPECT_EQ(number(std::nan("")), "nan");
  EXPECT_EQ(number(-std::numeric_limits<double>::infinity()), "-inf");
  for (double value = 1e-300; value < 1e300; value *= -1.0e7 / 3) {
    EXPECT_EQ(std::strtod(number(value).c_str(), nullptr), value);
    if (std::abs(value) > 1e290) break;
  }
}

TEST(Csv, APointStaysAPointInEveryLocale) {
  for (const char* locale : {"de_DE.UTF-8", "fr_FR.UTF-8", "C.UTF-8"}) {
    std::setlocale(LC_ALL, locale);  // one that is not installed changes nothing
    EXPECT_EQ(number(1234.5), "1234.5") << locale;
  }
  std::setlocale(LC_ALL, "C");
}

TEST(Csv, FieldsWithCommasAndQuotesAreQuoted) {  // RFC 4180, 2.6 and 2.7
  std::string text;
  append_field(text, "u[1,2]");
  append_field(text, "h'");
  append_field(text, "say \"x\"");
  EXPECT_EQ(text, "\"u[1,2]\"h'\"say \"\"x\"\"\"");
}

TEST(Tables, TheMotionHasTheHashTheModelsNamesAndBothSidesOfAnEvent) {
  const Folder folder;
  ASSERT_TRUE(write_motion(falling_ball().run, folder / "ball.csv", "abc"));
  EXPECT_EQ(content(folder / "ball.csv"),
            "# manifest abc\n"
            "t,h,h'\n"
            "0,1,0\n"
            "0.5,0.75,-1\n"
            "1,0,-2\n"
            "1,0,1\n");
}

TEST(Tables, TheEventListHasTheStatesBeforeAndAfter) {
  const Folder folder;
  ASSERT_TRUE(write_events(falling_ball().run, folder / "events.csv", "abc"));
  EXPECT_EQ(content(folder / "events.csv"),
            "# manifest abc\n"
            "event,t,before h,before h',after h,after h'\n"
            "h falls through 0,1,0,-2,0,1\n");
}

// A contact has an impulse and no states: a gas of a thousand balls had six thousand columns of nan a row.
TEST(Tables, ContactsHaveAnImpulseAndColumnsOfStatesOnlyBesideOtherEvents) {
  const Folder folder;
  model::Run run = falling_ball().run;
  const model::RecordedEvent fall = run.events.at(0);
  run.events = {{.name = "a meets b", .mark = "", .t = 0.25, .before = {}, .after = {}, .impulse = 3}};
  ASSERT_TRUE(write_events(run, folder / "contacts.csv", "abc"));
  EXPECT_EQ(content(folder / "contacts.csv"), "# manifest abc\nevent,t,impulse\na meets b,0.25,3\n");
  run.events.push_back(fall);
  ASSERT_TRUE(write_events(run, folder / "both.csv", "abc"));
  EXPECT_EQ(content(folder / "both.csv"),
            "# manifest abc\n"
            "event,t,impulse,before h,before h',after h,after h'\n"
            "a meets b,0.25,3,nan,nan,nan,nan\n"
            "h falls through 0,1,nan,0,-2,0,1\n");
}

TEST(Tables, AFolderThatIsNotThereIsOneMessage) {
  const Status status = write_motion(falling_ball().run, "/no such folder/ball.csv", "abc");
  ASSERT_FALSE(status);
  EXPECT_EQ(status.ending, Ending::unwritable);
  EXPECT_EQ(status.message, "cannot write /no such folder/ball.csv: No such file or directory");
}

TEST(Tables, AFullDiskIsTold) {
  if (!std::filesystem::exists("/dev/full")) GTEST_SKIP();
  const Status status = write_motion(falling_ball().run, "/dev/full", "abc");
  ASSERT_FALSE(status);
  EXPECT_EQ(status.ending, Ending::unwritable);
  EXPECT_EQ(status.message, "cannot write /dev/full: No space left on device");
}

}  // namespace
}  // namespace continuo::results
