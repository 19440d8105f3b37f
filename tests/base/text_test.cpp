// Lines and words of files.
#include "base/text.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace plisse {
namespace {

using testing::ElementsAre;
using testing::Pair;

TEST(Text, LinesAreCountedFromOne) {
  std::vector<std::pair<std::size_t, std::string>> lines;
  for_each_line("a\n\nb c\r\nd",
                [&](std::string_view line, std::size_t number) { lines.emplace_back(number, line); });
  EXPECT_THAT(lines, ElementsAre(Pair(1, "a"), Pair(2, ""), Pair(3, "b c\r"), Pair(4, "d")));
}

TEST(Text, WordsStandBetweenBlanks) {
  EXPECT_THAT(words_of(" a\tbc  d\r"), ElementsAre("a", "bc", "d"));
  EXPECT_THAT(words_of(" \t"), ElementsAre());
  EXPECT_EQ(trimmed(" two words \r"), "two words");
  EXPECT_EQ(trimmed(" \t"), "");
  std::string_view rest = " first second ";
  EXPECT_EQ(next_word(rest), "first");
  EXPECT_EQ(rest, " second ");
  EXPECT_EQ(next_word(rest), "second");
  EXPECT_EQ(next_word(rest), "");
}

}  // namespace
}  // namespace plisse
