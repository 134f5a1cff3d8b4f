#include "kith/files/reader.hpp"

#include <gtest/gtest.h>

namespace kith {
namespace {

// A document with the report and the reader of its top table.
struct Opened {
  explicit Opened(const std::string& text)
      : document{*parse_toml(text, "a.toml").document},
        report{document},
        reader{document.root, {0, 1, 1, 1}, "the file", report} {}

  // "ID LINE:COLUMN MESSAGE" of the only diagnostic.
  [[nodiscard]] std::string complaint() const {
    const auto diagnostics = report.diagnostics();
    if (diagnostics.size() != 1) return std::to_string(diagnostics.size()) + " diagnostics";
    const Diagnostic& d = diagnostics[0];
    return d.id + " " + std::to_string(d.line) + ":" + std::to_string(d.column) + " " + d.message;
  }

  TomlDocument document;
  TomlReport report;
  TomlReader reader;
};

TEST(TomlReader, ReadsTypedValues) {
  Opened o{"b = true\ni = 3\nr = 0.5\ns = \"x\"\nw = \"two\"\nl = [\"p\", \"q\"]\n[t]\nk = 1\n"};
  EXPECT_EQ(o.reader.boolean("b", Presence::kRequired), true);
  EXPECT_EQ(o.reader.integer("i", Presence::kRequired), 3);
  EXPECT_EQ(o.reader.real("r", Presence::kRequired), 0.5);
  EXPECT_EQ(o.reader.real("i", Presence::kRequired), 3.0);
  EXPECT_EQ(o.reader.string("s", Presence::kRequired), "x");
  EXPECT_EQ(o.reader.word("w", Presence::kRequired, {"one", "two"}), 1u);
  EXPECT_EQ(o.reader.strings("l", Presence::kRequired), (std::vector<std::string>{"p", "q"}));
  auto t = o.reader.table("t", Presence::kRequired);
  ASSERT_TRUE(t.has_value());
  EXPECT_EQ(t->name(), "[t]");
  EXPECT_EQ(t->integer("k", Presence::kOptional), 1);
  t->finish();
  o.reader.finish();
  EXPECT_FALSE(o.reader.real("missing", Presence::kOptional).has_value());
  EXPECT_EQ(o.report.diagnostics().size(), 0u);
}

TEST(TomlReader, ReportsAnUnknownKeyWithTheNearestKnownOne) {
  Opened o{"particels = 3\n"};
  o.reader.know("particles");
  o.reader.finish();
  EXPECT_EQ(o.complaint(), "E0107 1:1 unknown key 'particels' in the file");
  EXPECT_EQ(o.report.diagnostics()[0].hint, "did you mean 'particles'?");
}

TEST(TomlReader, ReportsAWrongTypeAtTheValue) {
  Opened o{"\nseed = \"1\"\n"};
  EXPECT_FALSE(o.reader.integer("seed", Presence::kRequired).has_value());
  EXPECT_EQ(o.complaint(), "E0108 2:8 'seed' must be an integer, not a string");
}

TEST(TomlReader, ReportsEveryWrongElement) {
  Opened o{"l = [\"a\", 1, 2]\n"};
  EXPECT_FALSE(o.reader.strings("l", Presence::kRequired).has_value());
  EXPECT_EQ(o.report.diagnostics().size(), 2u);
}

TEST(TomlReader, ReportsAMissingKeyWithItsTable) {
  Opened o{"[a.b]\n"};
  auto inner = o.reader.table("a", Presence::kRequired)->table("b", Presence::kRequired);
  ASSERT_TRUE(inner.has_value());
  EXPECT_FALSE(inner->real("x", Presence::kRequired).has_value());
  EXPECT_EQ(o.complaint(), "E0109 1:1 key 'x' is missing in [a.b]");
}

TEST(TomlReader, ReportsNumbersOutOfRange) {
  Opened low{"x = 0.0\n"};
  EXPECT_FALSE(low.reader.real("x", Presence::kRequired, {0.0, 1.0, true, false}).has_value());
  EXPECT_EQ(low.complaint(), "E0110 1:5 'x' must be greater than 0.0 and at most 1.0, not 0.0");
  Opened high{"n = 9\n"};
  EXPECT_FALSE(high.reader.integer("n", Presence::kRequired, {1, 8}).has_value());
  EXPECT_EQ(high.complaint(), "E0110 1:5 'n' must be at least 1 and at most 8, not 9");
  Opened edge{"x = 1.0\nn = 8\n"};
  EXPECT_EQ(edge.reader.real("x", Presence::kRequired, {0.0, 1.0, true, false}), 1.0);
  EXPECT_EQ(edge.reader.integer("n", Presence::kRequired, {1, 8}), 8);
}

TEST(TomlReader, NeverGivesANumberThatIsNotFinite) {
  for (const std::string text : {"nan", "-nan", "inf", "-inf"}) {
    Opened o{"x = " + text + "\n"};
    EXPECT_FALSE(o.reader.real("x", Presence::kRequired).has_value());
    EXPECT_EQ(o.complaint().substr(0, 9), "E0111 1:5") << text;
  }
}

TEST(TomlReader, SuggestsOneOfTheAllowedWords) {
  Opened o{"p = \"jiont\"\nq = \"x\"\n"};
  EXPECT_FALSE(o.reader.word("p", Presence::kRequired, {"common", "joint"}).has_value());
  EXPECT_FALSE(o.reader.word("q", Presence::kRequired, {"common", "joint"}).has_value());
  const auto diagnostics = o.report.diagnostics();
  ASSERT_EQ(diagnostics.size(), 2u);
  EXPECT_EQ(diagnostics[0].id, "E0112");
  EXPECT_EQ(diagnostics[0].hint, "did you mean 'joint'?");
  EXPECT_EQ(diagnostics[1].hint, "known: common, joint");
}

TEST(TomlReport, ListsInFileOrderAndStopsAtTwentyErrors) {
  std::string text;
  for (int i = 0; i < 30; ++i) text.append("k").append(std::to_string(i)).append(" = 1\n");
  Opened o{text};
  o.report.warning("W0201", {0, 31, 1, 1}, "late");
  o.report.infeasible("E0207", {0, 5, 1, 1}, "no way");
  o.reader.finish();
  const auto diagnostics = o.report.diagnostics();
  ASSERT_EQ(diagnostics.size(), TomlReport::kMaxErrors + 1);
  EXPECT_EQ(o.report.num_errors(), 31u);
  for (std::size_t i = 1; i < diagnostics.size(); ++i) EXPECT_LE(diagnostics[i - 1].line, diagnostics[i].line);
  EXPECT_EQ(diagnostics.back().severity, Severity::kWarning);
  EXPECT_TRUE(diagnostics[4].infeasible || diagnostics[5].infeasible);
}

// Looking for the line of each, this would take minutes.
TEST(TomlReport, OnlyCountsWhatIsBeyondTwentyErrors) {
  const Opened o{std::string(kMaxTomlBytes - 2, '\n')};
  TomlReport report{o.document};
  for (int i = 0; i < 200'000; ++i) report.error("E0107", {0, kMaxTomlBytes - 2, 1, 1}, "unknown");
  EXPECT_EQ(report.num_errors(), 200'000u);
  EXPECT_EQ(report.diagnostics().size(), TomlReport::kMaxErrors);
}

TEST(TomlReport, NamesTheSourceOfAnAssignedValue) {
  TomlDocument document = *parse_toml("seed = 1\n", "a.toml").document;
  ASSERT_TRUE(assign(document, *parse_assignment("seed=\"x\"", "--set").assignment).empty());
  TomlReport report{document};
  TomlReader reader{document.root, {0, 1, 1, 1}, "the file", report};
  EXPECT_FALSE(reader.integer("seed", Presence::kRequired).has_value());
  ASSERT_EQ(report.diagnostics().size(), 1u);
  EXPECT_EQ(report.diagnostics()[0].file, "--set");
  EXPECT_EQ(report.diagnostics()[0].source_line, "seed=\"x\"");
  EXPECT_EQ(report.diagnostics()[0].column, 6u);
}

// A required key that is misspelt is one mistake.
TEST(TomlReader, DoesNotMissAKeyThatIsMisspelt) {
  const auto parsing = parse_toml("[a]\nrewards = 1\n[b]\nrewards = 1\nprior = 2\n", "x.toml");
  TomlReport report{*parsing.document};
  for (const char* key : {"a", "b"}) {
    const auto* table = parsing.document->root.find(key);
    TomlReader reader{*table->table(), table->place(), "[t]", report};
    EXPECT_EQ(reader.value("reward", Presence::kRequired), nullptr);
    EXPECT_EQ(reader.value("name", Presence::kRequired), nullptr);
    if (*key == 'a') reader.finish();
  }
  std::string ids;
  for (const auto& one : report.diagnostics()) ids += one.id + " ";
  EXPECT_EQ(ids, "E0109 E0107 E0109 E0109 ");
  EXPECT_EQ(report.num_errors(), 4u);
}

}  // namespace
}  // namespace kith
