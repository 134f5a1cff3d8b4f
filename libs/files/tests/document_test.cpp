#include "kith/files/document.hpp"

#include <gtest/gtest.h>

namespace kith {
namespace {

TomlDocument parsed(const std::string& text) {
  TomlParsing parsing = parse_toml(text, "a.toml");
  for (const Diagnostic& d : parsing.diagnostics) ADD_FAILURE() << to_text(d);
  return parsing.document ? *std::move(parsing.document) : TomlDocument{{{"", ""}}, {}};
}

std::string refusal(const std::string& text) {
  const TomlParsing parsing = parse_toml(text, "a.toml");
  if (parsing.document || parsing.diagnostics.size() != 1) return "accepted";
  const Diagnostic& d = parsing.diagnostics[0];
  return d.id + " " + std::to_string(d.line) + ":" + std::to_string(d.column);
}

const TomlPlace& place(const TomlDocument& document, const std::string& key) {
  return document.root.find_entry(key)->place;
}

TEST(ParseToml, KeepsTheOrderOfTheFile) {
  const TomlDocument document = parsed("z = 1\na = 2\n[m]\nq = 1\nb = { y = 1, x = 2 }\n[c]\n");
  std::string order;
  for (const TomlEntry& entry : document.root.entries()) order += entry.key;
  for (const TomlEntry& entry : document.root.find("m")->table()->entries()) order += entry.key;
  for (const TomlEntry& entry : document.root.find("m")->table()->find("b")->table()->entries()) order += entry.key;
  EXPECT_EQ(order, "zamcqbyx");
}

TEST(ParseToml, KnowsWhereKeysAndValuesStand) {
  const TomlDocument document = parsed("# c\nab = \"xyz\"  # d\n\"#\" = [1,\n  22]\n");
  EXPECT_EQ(place(document, "ab"), (TomlPlace{0, 2, 1, 2}));
  EXPECT_EQ(document.root.find("ab")->place(), (TomlPlace{0, 2, 6, 5}));
  EXPECT_EQ(place(document, "#"), (TomlPlace{0, 3, 1, 3}));
  EXPECT_EQ((*document.root.find("#")->array())[1].place(), (TomlPlace{0, 4, 3, 2}));
}

TEST(ParseToml, CountsColumnsInCharacters) {
  const TomlDocument document = parsed("a = { b = \"h\xC3\xA9\", c = 1 }\n");
  EXPECT_EQ(document.root.find("a")->table()->find("c")->place(), (TomlPlace{0, 1, 21, 1}));
}

TEST(ParseToml, PlacesAnEarlyEndRightBehindTheLastLine) {
  for (const std::string text : {"s = \"\"\"h\xC3\xA9", "s = \"\"\"h\xC3\xA9\n"}) {
    const auto diagnostics = parse_toml(text, "a.toml").diagnostics;
    ASSERT_EQ(diagnostics.size(), 1u);
    EXPECT_EQ(diagnostics[0].line, 1u);
    EXPECT_EQ(diagnostics[0].column, 10u);
  }
}

TEST(ParseToml, ReadsEveryKindOfValue) {
  const TomlDocument document = parsed("a=true\nb=-7\nc=3.5\nd='x'\ne=1979-05-27\nf=[]\ng={}\nh=07:32:00\n");
  EXPECT_EQ(*document.root.find("a")->boolean(), true);
  EXPECT_EQ(*document.root.find("b")->integer(), -7);
  EXPECT_EQ(*document.root.find("c")->real(), 3.5);
  EXPECT_EQ(*document.root.find("d")->string(), "x");
  EXPECT_EQ(document.root.find("e")->kind_name(), "a date");
  EXPECT_TRUE(document.root.find("f")->array()->empty());
  EXPECT_TRUE(document.root.find("g")->table()->empty());
  EXPECT_EQ(document.root.find("h")->kind_name(), "a date");
  EXPECT_EQ(document.root.find("i"), nullptr);
}

TEST(ParseToml, RefusesSyntaxErrorsAtTheirPlace) {
  EXPECT_EQ(refusal("a = 1\nb = \n"), "E0101 2:5");
  EXPECT_EQ(refusal("a = joint\n"), "E0101 1:5");
  EXPECT_EQ(refusal("a = \"x\n"), "E0101 1:7");
  EXPECT_EQ(refusal("a = \"\xFF\"\n").substr(0, 5), "E0101");
}

TEST(ParseToml, NamesTheRangeOfANumberThatIsTooLarge) {
  EXPECT_EQ(refusal("a = 1\nb = 99999999999999999999 # much\n"), "E0110 2:5");
  EXPECT_EQ(refusal("a = [1, -99999999999999999999]\n"), "E0110 1:9");
  const auto assigned = parse_assignment("a=99999999999999999999", "--set");
  ASSERT_EQ(assigned.diagnostics.size(), 1u);
  EXPECT_NE(assigned.diagnostics[0].message.find("9223372036854775807"), std::string::npos);
  EXPECT_EQ(assigned.diagnostics[0].hint.find("KEY=VALUE"), std::string::npos);
}

TEST(ParseToml, PointsAtTheSecondOfTwoEqualKeys) {
  EXPECT_EQ(refusal("a = 1\nbc = 2\nbc = 3\n"), "E0102 3:1");
  EXPECT_EQ(refusal("t = { b = 1, b = 2 }\n"), "E0102 1:14");
  EXPECT_EQ(refusal("[t]\n[t]\n"), "E0102 2:2");
}

TEST(ParseToml, RefusesWhatTheLimitsForbid) {
  EXPECT_EQ(refusal("a = \"" + std::string(kMaxTomlBytes, 'x') + "\"\n"), "E0103 0:0");
  EXPECT_EQ(refusal("a = " + std::string(17, '[') + std::string(17, ']')), "E0104 1:21");
  EXPECT_EQ(refusal("a = " + std::string(1000, '[')), "E0104 1:21");
  std::string dotted = "a";
  for (int i = 0; i < 1000; ++i) dotted += ".a";
  EXPECT_EQ(refusal(dotted + " = 1").substr(0, 5), "E0104");
  EXPECT_EQ(refusal("[a.a.a.a.a.a.a.a.a.a]\na.a.a.a.a.a.a.a = 1\n").substr(0, 5), "E0104");
  EXPECT_EQ(refusal("a\xC3\xA9 = 1\n"), "E0105 1:2");
  EXPECT_EQ(refusal("\xEF\xBB\xBF"
                    "a = 1\n"),
            "E0105 1:1");
}

TEST(ParseToml, TakesSixteenLevels) {
  EXPECT_EQ(parsed("a = " + std::string(15, '[') + std::string(15, ']')).root.entries().size(), 1u);
}

TEST(ParseToml, TakesAnythingInStringsAndComments) {
  const TomlDocument document =
      parsed("# \xC3\xA9 [[[[[[[[[[[[[[[[[[[[[[[[\na = '\xC3\xA9\"'\nb = \"\"\"\n\xC3\xA9 \\\" ''' \"\"\"\"\n");
  EXPECT_EQ(*document.root.find("a")->string(), "\xC3\xA9\"");
  EXPECT_EQ(*document.root.find("b")->string(), "\xC3\xA9 \" ''' \"");
}

// Texts on which toml++ by itself stops the process or runs into undefined behaviour.
TEST(ParseToml, SurvivesHostileTexts) {
  for (const std::string text : {"[[[",     "[",
                                 "[[",      "a=[",
                                 "a={",     "\"",
                                 "'''",     "a.",
                                 ".",       "=",
                                 "[a",      "[[a]",
                                 "a=\x01",  "\xF0",
                                 "a=1e400", "a=99999999999999999999",
                                 "a=0x",    "a=2000-13-41",
                                 "a=\"\\",  "\\"}) {
    EXPECT_FALSE(parse_toml(text, "a.toml").document.has_value()) << text;
  }
}

TEST(TomlSource, GivesLinesWithoutTheirEnds) {
  const TomlSource source{"a", "one\r\ntwo\n\nfour"};
  EXPECT_EQ(source.line(0), "");
  EXPECT_EQ(source.line(1), "one");
  EXPECT_EQ(source.line(2), "two");
  EXPECT_EQ(source.line(3), "");
  EXPECT_EQ(source.line(4), "four");
  EXPECT_EQ(source.line(5), "");
}

TEST(TomlDocument, PointsIntoStringsThatAreWrittenAsTheyAre) {
  const TomlDocument document = parsed("a = \"abc\"\nb = \"a\\\"c\"\n");
  EXPECT_EQ(document.inside(*document.root.find("a"), 1, 2), (TomlPlace{0, 1, 7, 2}));
  EXPECT_EQ(document.inside(*document.root.find("b"), 1, 2), document.root.find("b")->place());
}

TEST(TomlTable, ReplacesAValueInItsPosition) {
  TomlDocument document = parsed("a = 1\nb = 2\n");
  document.root.set({"a", {}, TomlValue{std::string{"x"}}});
  document.root.set({"c", {}, TomlValue{true}});
  EXPECT_EQ(to_toml(document.root), "a = \"x\"\nb = 2\nc = true\n");
}

}  // namespace
}  // namespace kith
