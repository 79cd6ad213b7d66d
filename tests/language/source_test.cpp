#include <fstream>

#include <gtest/gtest.h>

#include <continuo/language/text/source.hpp>

namespace continuo::model {
namespace {

TEST(SourceText, LinesAndColumnsCountFromOne) {
  const Source source("a.sim", "ab\n\ncd");
  EXPECT_EQ(source.place(0), (Place{1, 1}));
  EXPECT_EQ(source.place(2), (Place{1, 3}));  // the line end belongs to its line
  EXPECT_EQ(source.place(3), (Place{2, 1}));
  EXPECT_EQ(source.place(5), (Place{3, 2}));
  EXPECT_EQ(source.place(6), (Place{3, 3}));  // the end of the text
  EXPECT_EQ(source.line_count(), 3);
}

TEST(SourceText, ColumnsCountCharactersAndNotBytes) {
  const Source source("a.sim", "\xCF\x89\xE2\x82\x80' = 1");  // omega, subscript 0: five bytes, two characters
  EXPECT_EQ(source.place(5), (Place{1, 3}));
}

TEST(SourceText, AnOffsetBeyondTheEndIsTheEnd) {
  EXPECT_EQ(Source("a.sim", "ab\n").place(1000), (Place{2, 1}));
  EXPECT_EQ(Source("a.sim", "").place(7), (Place{1, 1}));
}

TEST(SourceText, ALineComesWithoutItsEndOfAnySystem) {
  const Source source("a.sim", "one\r\ntwo\nthree");
  EXPECT_EQ(source.line(1), "one");
  EXPECT_EQ(source.line(2), "two");
  EXPECT_EQ(source.line(3), "three");
  EXPECT_EQ(source.line(0), "");
  EXPECT_EQ(source.line(4), "");
}

TEST(SourceText, AFileIsReadWithItsBytesAsTheyAre) {
  const auto path = std::filesystem::path(testing::TempDir()) / "source_test.sim";
  const std::string bytes("x' = 1\r\n\xFF\0y", 11);
  std::ofstream(path, std::ios::binary) << bytes;
  const auto source = read_source(path);
  ASSERT_TRUE(source);
  EXPECT_EQ(source->text(), bytes);
  EXPECT_FALSE(read_source(path.parent_path()));
  EXPECT_FALSE(read_source(path.string() + ".none"));
}

}  // namespace
}  // namespace continuo::model
