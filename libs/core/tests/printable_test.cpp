#include "kith/core/printable.hpp"

#include <gtest/gtest.h>

#include "kith/core/diagnostic.hpp"

namespace kith {
namespace {

using namespace std::string_literals;

TEST(Printable, EscapesWhatCommandsATerminal) {
  EXPECT_EQ(printable("a\033]0;title\007b"), "a\\x1b]0;title\\x07b");
  EXPECT_EQ(printable("over\rwritten\b\177"s + '\0'), "over\\x0dwritten\\x08\\x7f\\x00");
  EXPECT_EQ(printable("\xc2\x9b[2J"), "\\x9b[2J");  // U+009B: the same as ESC [
}

TEST(Printable, KeepsText) {
  EXPECT_EQ(printable("two\n\tlines"), "two\n\tlines");
  EXPECT_EQ(printable("two\n\tlines", Keep::kLine), "two\\x0a\tlines");
  EXPECT_EQ(printable("\xc3\xa9t\xc3\xa9 \xe2\x86\x92 \xff \xc2"), "\xc3\xa9t\xc3\xa9 \xe2\x86\x92 \xff \xc2");
  EXPECT_EQ(printable("\xc2\xa0"), "\xc2\xa0");  // the first character behind the controls
  EXPECT_EQ(printable(""), "");
}

TEST(Printable, KeepsColoursWhereAskedToAndNothingElse) {
  EXPECT_EQ(printable("\033[1;31mred\033[0m"), "\\x1b[1;31mred\\x1b[0m");
  EXPECT_EQ(printable("\033[1;31mred\033[m", Keep::kTextColors), "\033[1;31mred\033[m");
  EXPECT_EQ(printable("\033[2J\033[1", Keep::kTextColors), "\\x1b[2J\\x1b[1");
}

TEST(Printable, ChangesNothingTheSecondTime) {
  const auto once = printable("\033[2J \xc2\x85 \\x1b");
  EXPECT_EQ(printable(once), once);
}

TEST(DiagnosticText, ShowsControlCharactersInsteadOfSendingThem) {
  Diagnostic diagnostic;
  diagnostic.file = "a\nb\033[2J.toml";
  diagnostic.line = 1;
  diagnostic.column = 3;
  diagnostic.message = "'\033c' is unknown";
  diagnostic.hint = "\a";
  diagnostic.source_line = "\tx\033c = 1\r";
  EXPECT_EQ(to_text(diagnostic),
            "a\\x0ab\\x1b[2J.toml:1:3: error: '\\x1bc' is unknown\n"
            "    1 | \tx\\x1bc = 1\n"
            "      | \t ^\n"
            "   = help: \\x07\n");
}

}  // namespace
}  // namespace kith
