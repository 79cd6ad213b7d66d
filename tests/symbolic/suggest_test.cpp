#include <array>
#include <vector>

#include <gtest/gtest.h>

#include <continuo/language/text/words.hpp>
#include <continuo/symbolic/names/suggest.hpp>

namespace continuo::model {
namespace {

TEST(Suggestions, DistancesAreThoseOfDamerauAndLevenshtein) {
  EXPECT_EQ(edit_distance("kitten", "sitting"), 3U);  // the textbook pair: two replaced, one added
  EXPECT_EQ(edit_distance("wehn", "when"), 1U);       // neighbours swapped
  EXPECT_EQ(edit_distance("", "abc"), 3U);
  EXPECT_EQ(edit_distance("abc", ""), 3U);
  EXPECT_EQ(edit_distance("same", "same"), 0U);
}

TEST(Suggestions, TheNearestWordWithinAThirdIsProposed) {
  EXPECT_EQ(suggest("chek", statement_words()), "check");
  EXPECT_EQ(suggest("parm", statement_words()), "param");
  EXPECT_EQ(suggest("initialy", statement_words()), "initially");
  EXPECT_EQ(suggest("banana", statement_words()), std::nullopt);
}

TEST(Suggestions, AnotherCaseIsTheNearest) {
  const std::vector<std::string> names = {"kinetic", "k"};
  EXPECT_EQ(suggest("K", names), "k");
  EXPECT_EQ(suggest("Kinetic", names), "kinetic");
}

TEST(Suggestions, OneLetterIsNoMisspellingOfAnother) {
  const std::vector<std::string> names = {"x", "y"};
  EXPECT_EQ(suggest("z", names), std::nullopt);
}

TEST(Suggestions, AWordOfMegabytesIsNotCompared) {
  EXPECT_EQ(suggest(std::string(10'000'000, 'a'), statement_words()), std::nullopt);
}

TEST(Suggestions, HelpIsASentenceOrNothing) {
  EXPECT_EQ(did_you_mean("wehn", statement_words()), "did you mean `when`?");
  EXPECT_EQ(did_you_mean("banana", statement_words()), "");
}

}  // namespace
}  // namespace continuo::model
