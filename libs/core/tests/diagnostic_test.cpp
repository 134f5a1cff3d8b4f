#include "kith/core/diagnostic.hpp"

#include <gtest/gtest.h>
#include <random>

namespace kith {
namespace {

Diagnostic unknown_feature() {
  return {.id = "E0312",
          .message = "weight names an unknown feature 'rubbel'",
          .file = "domains/item_delivery.toml",
          .line = 34,
          .column = 13,
          .length = 6,
          .hint = "did you mean 'rubble' (declared at line 22)?",
          .source_line = "weights = { rubbel = -3.0, recharge = 3.5, step = -1.0 }"};
}

TEST(Diagnostic, IsWrittenWithPlaceExcerptAndHelp) {
  EXPECT_EQ(to_text(unknown_feature()),
            "domains/item_delivery.toml:34:13: error[E0312]: weight names an unknown feature 'rubbel'\n"
            "   34 | weights = { rubbel = -3.0, recharge = 3.5, step = -1.0 }\n"
            "      |             ^~~~~~\n"
            "   = help: did you mean 'rubble' (declared at line 22)?\n");
}

TEST(Diagnostic, LeavesOutWhatIsNotKnown) {
  Diagnostic d{.severity = Severity::kWarning, .id = "W0001", .message = "it is empty", .file = "a.toml"};
  EXPECT_EQ(to_text(d), "a.toml: warning[W0001]: it is empty\n");
  d.line = 3;
  EXPECT_EQ(to_text(d), "a.toml:3: warning[W0001]: it is empty\n");
  d.column = 7;
  EXPECT_EQ(to_text(d), "a.toml:3:7: warning[W0001]: it is empty\n");
}

TEST(Diagnostic, PutsTheCaretUnderItsCharacterBehindTabs) {
  Diagnostic d = unknown_feature();
  d.source_line = "\t\tx = 1";
  d.column = 3;
  d.length = 1;
  d.hint.clear();
  const std::string text = to_text(d);
  EXPECT_NE(text.find("\n      | \t\t^\n"), std::string::npos) << text;
}

TEST(HasErrors, IgnoresWarnings) {
  Diagnostic warning;
  warning.severity = Severity::kWarning;
  EXPECT_FALSE(has_errors({}));
  EXPECT_FALSE(has_errors({warning}));
  EXPECT_TRUE(has_errors({warning, unknown_feature()}));
}

TEST(NearestWord, FindsSpellingMistakes) {
  const std::vector<std::string> known{"rubble", "recharge", "step", "stop"};
  EXPECT_EQ(nearest_word("rubbel", known), "rubble");  // neighbours swapped: one edit
  EXPECT_EQ(nearest_word("recharg", known), "recharge");
  EXPECT_EQ(nearest_word("recharge", known), "recharge");
  EXPECT_EQ(nearest_word("stap", known), "step");  // a tie goes to the earlier word
  EXPECT_EQ(nearest_word("passenger", known), "");
  EXPECT_EQ(nearest_word(std::string(1 << 20, 'r'), known), "");
  EXPECT_EQ(nearest_word("ab", {"cd"}), "");  // nothing in common
  EXPECT_EQ(nearest_word("", {}), "");
}

TEST(NearestWord, ForgivesAThirdOfALongWord) {
  EXPECT_EQ(nearest_word("abcdefghi", {"xyzdefghi"}), "xyzdefghi");  // 3 of 9
  EXPECT_EQ(nearest_word("abcdefghi", {"wxyzefghi"}), "");           // 4 of 9
}

// Oracle: every word within one edit of `word`, by doing the edits.
TEST(NearestWord, FindsEveryWordThatOneEditMakes) {
  std::mt19937 engine{5};
  const auto letter = [&] { return static_cast<char>('a' + engine() % 26); };
  for (int i = 0; i < 500; ++i) {
    std::string word;
    for (int k = 0; k < 6; ++k) word += letter();
    std::string edited = word;
    const std::size_t at = engine() % 5;
    switch (engine() % 4) {
      case 0:
        edited.erase(at, 1);
        break;
      case 1:
        edited.insert(at, 1, letter());
        break;
      case 2:
        edited[at] = letter();
        break;
      default:
        std::swap(edited[at], edited[at + 1]);
    }
    ASSERT_EQ(nearest_word(edited, {"zzzzzzzzzzzz", word}), word) << edited;
  }
}

}  // namespace
}  // namespace kith
