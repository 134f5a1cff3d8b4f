#include <gtest/gtest.h>

#include <string>

#include "kith/files/document.hpp"

namespace kith {
namespace {

TomlAssignment assignment(const std::string& text) {
  TomlAssignmentParsing parsing = parse_assignment(text, "--set");
  for (const Diagnostic& d : parsing.diagnostics) ADD_FAILURE() << to_text(d);
  return parsing.assignment ? *std::move(parsing.assignment) : TomlAssignment{{"?"}, {}, {}, {}};
}

std::string refused_id(const std::string& text) {
  const TomlAssignmentParsing parsing = parse_assignment(text, "--set");
  if (parsing.assignment || parsing.diagnostics.size() != 1) return "accepted";
  EXPECT_NE(parsing.diagnostics[0].hint, "") << "a refused assignment must show the form";
  return parsing.diagnostics[0].id;
}

// The document `text` after the assignments, as TOML.
std::string merged(const std::string& text, const std::vector<std::string>& assignments) {
  TomlDocument document = *parse_toml(text, "a.toml").document;
  for (const std::string& a : assignments) EXPECT_TRUE(assign(document, assignment(a)).empty());
  return to_toml(document.root);
}

TEST(ParseAssignment, TakesDottedKeysAndTypedValues) {
  const TomlAssignment a = assignment("teacher.process_noise=0.5");
  EXPECT_EQ(a.keys, (std::vector<std::string>{"teacher", "process_noise"}));
  EXPECT_EQ(*a.value.real(), 0.5);
  EXPECT_EQ(a.place, (TomlPlace{0, 1, 9, 13}));
  EXPECT_EQ(assignment("a=\"x=y\"").keys.size(), 1u);
}

TEST(ParseAssignment, KeepsAnInlineTableAsTheValue) {
  const TomlAssignment a = assignment("learner.N.ability={ mean = 0.7 }");
  EXPECT_EQ(a.keys, (std::vector<std::string>{"learner", "N", "ability"}));
  EXPECT_EQ(to_toml(a.value), "{ mean = 0.7 }");
}

TEST(ParseAssignment, KeepsDotsInsideQuotedKeys) {
  EXPECT_EQ(assignment("design.vary.\"teacher.noise\"=[0.1, 0.5]").keys.back(), "teacher.noise");
}

TEST(ParseAssignment, RefusesWhatIsNoAssignment) {
  EXPECT_EQ(refused_id(""), "E0113");
  EXPECT_EQ(refused_id("seed"), "E0113");
  EXPECT_EQ(refused_id("[seed]"), "E0113");
  EXPECT_EQ(refused_id("a=1\nb=2"), "E0113");
  EXPECT_EQ(refused_id("'a=b'"), "E0113");
  EXPECT_EQ(refused_id("# a=1"), "E0113");
  EXPECT_EQ(refused_id("strategy=joint"), "E0101");
  EXPECT_EQ(refused_id("a="), "E0101");
}

TEST(ParseAssignment, SaysThatTextNeedsQuotes) {
  for (const std::string word : {"two", "four", "joint", "nothing", "individual"}) {
    const auto parsing = parse_assignment("replicates=" + word, "--set");
    ASSERT_EQ(parsing.diagnostics.size(), 1u) << word;
    EXPECT_NE(parsing.diagnostics[0].message.find("text needs \"quotes\""), std::string::npos)
        << parsing.diagnostics[0].message;
  }
}

TEST(Assign, SetsReplacesAndMakesTables) {
  EXPECT_EQ(merged("seed = 1\n[t]\nx = 1\ny = 2\n", {"seed=2", "t.x=[3]", "u.v.w=true"}),
            "seed = 2\n\n[t]\nx = [3]\ny = 2\n\n[u]\n\n[u.v]\nw = true\n");
  EXPECT_EQ(merged("t = { x = 1 }\n", {"t.z=2"}), "[t]\nx = 1\nz = 2\n");
}

TEST(Assign, RefusesAKeyThroughSomethingThatIsNoTable) {
  TomlDocument document = *parse_toml("seed = 1\n", "a.toml").document;
  const auto diagnostics = assign(document, assignment("seed.x.y=2"));
  ASSERT_EQ(diagnostics.size(), 1u);
  EXPECT_EQ(diagnostics[0].id, "E0114");
  EXPECT_EQ(diagnostics[0].file, "--set");
  EXPECT_EQ(to_toml(document.root), "seed = 1\n");
}

TEST(Assign, RemembersThatAValueCameFromTheCommandLine) {
  TomlDocument document = *parse_toml("seed = 1\nt = {}\n", "a.toml").document;
  ASSERT_TRUE(assign(document, assignment("t.list=[1, { k = 2 }]")).empty());
  const TomlValue& list = *document.root.find("t")->table()->find("list");
  const TomlValue& deep = *(*list.array())[1].table()->find("k");
  EXPECT_EQ(document.sources.at(deep.place().source).text, "t.list=[1, { k = 2 }]");
  EXPECT_EQ(deep.place().column, 18u);
  EXPECT_EQ(document.root.find("seed")->place().source, 0u);
}

}  // namespace
}  // namespace kith
