#include "kith/files/csv_reader.hpp"
#include "kith/files/csv_writer.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <random>

#include "kith/core/error.hpp"
#include "kith/files/atomic_file.hpp"

namespace kith {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

const std::vector<Column> kColumns{
    {.name = "name", .type = ColumnType::kText, .description = "", .unit = ""},
    {.name = "count", .type = ColumnType::kInteger, .description = "", .unit = ""},
    {.name = "area_sr", .type = ColumnType::kReal, .description = "", .unit = "sr"},
    {.name = "done", .type = ColumnType::kBoolean, .description = "", .unit = "", .required = true}};

std::string written(const std::vector<Column>& columns, const std::function<void(CsvWriter&)>& rows) {
  std::string out;
  CsvWriter writer{columns, [&](std::string_view piece) { out += piece; }};
  rows(writer);
  writer.flush();
  return out;
}

struct Result {
  std::vector<std::vector<TableCell>> rows;
  std::vector<std::size_t> lines;
  std::vector<Diagnostic> diagnostics;
};

Result parsed_csv(std::string_view text, const std::vector<Column>& columns = kColumns) {
  Result result;
  result.diagnostics = read_csv(text, "t.csv", columns, [&](const CsvRow& row) {
    result.rows.emplace_back(row.cells.begin(), row.cells.end());
    result.lines.push_back(row.line);
  });
  return result;
}

// id, line, column, length of each.
std::vector<std::tuple<std::string, std::size_t, std::size_t, std::size_t>> places(const Result& result) {
  std::vector<std::tuple<std::string, std::size_t, std::size_t, std::size_t>> list;
  for (const Diagnostic& d : result.diagnostics) list.emplace_back(d.id, d.line, d.column, d.length);
  return list;
}

TEST(CsvWriter, WritesAHeaderAndRows) {
  const std::string out = written(kColumns, [](CsvWriter& writer) {
    writer.text("joint").integer(-3).real(0.1).boolean(true);
    writer.end_row();
    writer.text_or_missing({}).integer(std::optional<std::int64_t>{}).real(std::optional<double>{}).boolean(false);
    writer.end_row();
    EXPECT_EQ(writer.num_rows(), 2u);
  });
  EXPECT_EQ(out, "name,count,area_sr,done\njoint,-3,0.1,true\n,,,false\n");
}

TEST(CsvWriter, QuotesWhatWouldNotBeOneCell) {
  const std::vector<Column> columns{{.name = "a,b"}, {.name = "c"}};
  const std::string out = written(columns, [](CsvWriter& writer) {
    writer.text("say \"hi\"").text("two\nlines");
    writer.end_row();
    writer.text("").text(" padded");
    writer.end_row();
    writer.text("1,0,-4").text("caf\xC3\xA9");
    writer.end_row();
  });
  EXPECT_EQ(out, "\"a,b\",c\n\"say \"\"hi\"\"\",\"two\nlines\"\n\"\",\" padded\"\n\"1,0,-4\",caf\xC3\xA9\n");
}

TEST(CsvWriter, WritesTheShortestNumbersThatReadBack) {
  const std::vector<Column> columns{{.name = "x", .type = ColumnType::kReal}};
  const std::string out = written(columns, [](CsvWriter& writer) {
    for (const double x : {0.1, 1.0, -0.0, 1e300, 5e-324, 1.0 / 3.0, std::numeric_limits<double>::infinity()}) {
      writer.real(x).end_row();
    }
  });
  EXPECT_EQ(out, "x\n0.1\n1\n-0\n1e+300\n5e-324\n0.3333333333333333\ninf\n");
}

TEST(CsvWriter, RefusesCellsThatDoNotFitTheColumns) {
  CsvWriter writer{kColumns, [](std::string_view) {}};
  EXPECT_THROW(writer.integer(1), std::invalid_argument);
  EXPECT_THROW(writer.end_row(), std::invalid_argument);
  EXPECT_THROW(writer.text(std::string_view{"a\0b", 3}), std::invalid_argument);
  EXPECT_THROW(writer.text("a").integer(std::uint64_t{1} << 63), std::invalid_argument);
  writer.integer(7u);
  EXPECT_THROW(writer.flush(), std::invalid_argument);
  EXPECT_THROW(writer.real(std::nan("")), std::invalid_argument);
  writer.missing();
  EXPECT_THROW(writer.missing(), std::invalid_argument);  // required
  writer.boolean(true);
  EXPECT_THROW(writer.boolean(true), std::invalid_argument);
  EXPECT_THROW(writer.missing(), std::invalid_argument);
  writer.end_row();
  CsvWriter single{{{.name = "only"}}, [](std::string_view) {}};
  EXPECT_THROW(single.missing(), std::invalid_argument);
}

TEST(CsvWriter, RefusesTablesWithoutProperNames) {
  const CsvWriter::Sink sink = [](std::string_view) {};
  EXPECT_THROW((CsvWriter{{}, sink}), std::invalid_argument);
  EXPECT_THROW((CsvWriter{{{.name = ""}}, sink}), std::invalid_argument);
  EXPECT_THROW((CsvWriter{{{.name = "a"}, {.name = "a"}}, sink}), std::invalid_argument);
  EXPECT_THROW((void)parsed_csv("a\n", {}), std::invalid_argument);
}

TEST(CsvWriter, HandsOverPiecesThatEndWhereRowsDo) {
  std::vector<std::size_t> pieces;
  CsvWriter writer{{{.name = "x", .type = ColumnType::kInteger}}, [&](std::string_view piece) {
                     ASSERT_TRUE(piece.ends_with('\n'));
                     pieces.push_back(piece.size());
                   }};
  for (std::int64_t i = 0; i < 50'000; ++i) writer.integer(i).end_row();
  writer.flush();
  writer.flush();
  ASSERT_EQ(pieces.size(), 5u);  // 288 892 bytes
  for (std::size_t i = 0; i + 1 < pieces.size(); ++i) EXPECT_NEAR(static_cast<double>(pieces[i]), 65540.0, 10.0);
}

// Random cells with everything that needs quoting come back as they were, to the bit.
TEST(Csv, ReadsBackWhatItWrote) {
  std::mt19937_64 bits{1};
  const std::vector<std::string> pieces{"a", "\"", ",", "\n", "\r\n", " ", "\t", "\xE2\x82\xAC", "0", "'", ";"};
  std::vector<std::vector<TableCell>> rows;
  std::string out;
  CsvWriter writer{kColumns, [&](std::string_view piece) { out += piece; }};
  for (int r = 0; r < 3000; ++r) {
    std::vector<TableCell> row(4);
    std::string text;
    for (std::uint64_t k = bits() % 6; k > 0; --k) text += pieces[bits() % pieces.size()];
    double real = 0.0;
    do {
      const std::uint64_t pattern = bits();
      std::memcpy(&real, &pattern, sizeof real);
    } while (std::isnan(real));
    if (bits() % 5 != 0) row[0] = text;
    if (bits() % 5 != 0) row[1] = static_cast<std::int64_t>(bits()) >> (bits() % 64);
    if (bits() % 5 != 0) row[2] = real;
    row[3] = bits() % 2 == 0;
    row[0].index() == 0 ? writer.missing() : writer.text(std::get<std::string>(row[0]));
    row[1].index() == 0 ? writer.missing() : writer.integer(std::get<std::int64_t>(row[1]));
    row[2].index() == 0 ? writer.missing() : writer.real(std::get<double>(row[2]));
    writer.boolean(std::get<bool>(row[3])).end_row();
    rows.push_back(row);
  }
  writer.flush();
  const Result result = parsed_csv(out);
  EXPECT_TRUE(result.diagnostics.empty());
  EXPECT_EQ(result.rows, rows);
}

TEST(ReadCsv, AcceptsAnyOrderByteOrderMarksCarriageReturnsAndBlankLines) {
  const Result result = parsed_csv(
      "\xEF\xBB\xBF"
      "done,area_sr,name,count\r\n\r\ntrue,0.5,\"\",7\r\n\nfalse,,,");
  EXPECT_TRUE(result.diagnostics.empty());
  ASSERT_EQ(result.rows.size(), 2u);
  EXPECT_EQ(result.rows[0], (std::vector<TableCell>{std::string{}, std::int64_t{7}, 0.5, true}));
  EXPECT_EQ(result.rows[1], (std::vector<TableCell>{TableCell{}, TableCell{}, TableCell{}, false}));
  EXPECT_THAT(result.lines, ElementsAre(3u, 5u));
}

TEST(ReadCsv, KeepsBlanksAndCountsLinesInsideQuotes) {
  const Result result = parsed_csv("name,count,area_sr,done\n\"a\nb\",1,,true\n x ,2,,true\n");
  EXPECT_TRUE(result.diagnostics.empty());
  EXPECT_EQ(result.rows[0][0], TableCell{std::string{"a\nb"}});
  EXPECT_EQ(result.rows[1][0], TableCell{std::string{" x "}});
  EXPECT_THAT(result.lines, ElementsAre(2u, 4u));
}

TEST(ReadCsv, ReportsEveryProblemOfTheRowsWithItsPlace) {
  const Result result = parsed_csv(
      "name,count,area_sr,done\n"
      "caf\xC3\xA9,x1,\"1,5\",maybe\n"  // three cells of the wrong type; characters are counted, not bytes
      "a,1,0.5,true\n"
      "b,1,0.5\n"                      // a cell too few
      "c,1,0.5,true,,\n"               // two too many
      "d,99999999999999999999,nan,\n"  // out of range, no number, required
      "\"e\nf\",1.0,,true\n"           // a place on the second line of a record
      "\xFF,1,0.5,true\n");
  using Place = std::tuple<std::string, std::size_t, std::size_t, std::size_t>;
  EXPECT_THAT(places(result), ElementsAre(Place{"E0506", 2, 6, 2}, Place{"E0506", 2, 9, 5}, Place{"E0506", 2, 15, 5},
                                          Place{"E0505", 4, 5, 3}, Place{"E0505", 5, 14, 1}, Place{"E0510", 6, 3, 20},
                                          Place{"E0506", 6, 24, 3}, Place{"E0507", 6, 28, 1}, Place{"E0506", 8, 4, 3},
                                          Place{"E0509", 9, 1, 1}));
  EXPECT_THAT(result.lines, ElementsAre(3u));
  EXPECT_EQ(result.diagnostics[0].source_line, "caf\xC3\xA9,x1,\"1,5\",maybe");
  EXPECT_EQ(result.diagnostics[0].message, "\"x1\" in column \"count\" is not of type integer");
  EXPECT_THAT(result.diagnostics[1].hint, HasSubstr("decimal point"));
  for (const Diagnostic& d : result.diagnostics) {
    EXPECT_EQ(d.file, "t.csv");
    EXPECT_EQ(d.severity, Severity::kError);
    EXPECT_FALSE(d.hint.empty());
  }
}

TEST(ReadCsv, ReportsEveryProblemOfTheHeader) {
  const Result result = parsed_csv("name,cuont,name,done\nrow,1,2,true\n");
  using Place = std::tuple<std::string, std::size_t, std::size_t, std::size_t>;
  EXPECT_THAT(places(result), ElementsAre(Place{"E0503", 1, 6, 5}, Place{"E0504", 1, 12, 4}, Place{"E0502", 1, 1, 4},
                                          Place{"E0502", 1, 1, 4}));
  EXPECT_EQ(result.diagnostics[0].hint, "did you mean count?");
  EXPECT_TRUE(result.rows.empty());
}

TEST(ReadCsv, ReportsBrokenQuotesAndReadsOn) {
  const Result result =
      parsed_csv("name,count,area_sr,done\na\"b,1,,true\n\"a\"b,1,,true\nc,1,,true\n\"open,1,,true\nd,1\n");
  EXPECT_THAT(result.lines, ElementsAre(4u));
  ASSERT_EQ(result.diagnostics.size(), 3u);
  for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(result.diagnostics[i].id, "E0508");
  EXPECT_EQ(result.diagnostics[0].line, 2u);
  EXPECT_EQ(result.diagnostics[1].line, 3u);
  EXPECT_EQ(result.diagnostics[2].line, 5u);
}

TEST(ReadCsv, ReportsATableWithoutAHeader) {
  for (const std::string_view text : {"", "\n\n", "\xEF\xBB\xBF"}) {
    const Result result = parsed_csv(text);
    ASSERT_EQ(result.diagnostics.size(), 1u);
    EXPECT_EQ(result.diagnostics[0].id, "E0501");
    EXPECT_EQ(result.diagnostics[0].line, 0u);
  }
}

TEST(ReadCsv, StopsAfterAThousandProblems) {
  std::string text = "name,count,area_sr,done\n";
  for (int i = 0; i < 5000; ++i) text += "a,b,c,true\n";
  const Result result = parsed_csv(text);
  EXPECT_EQ(result.diagnostics.size(), 1001u);
  EXPECT_EQ(result.diagnostics.back().id, "E0511");
}

// Quadratic in the number of columns, this would take minutes; with the line in every diagnostic, gigabytes.
TEST(ReadCsv, ReadsATableAsWideAsItLikes) {
  constexpr std::size_t kWide = 100'000;
  std::string header = "c0";
  std::string row = "x";
  for (std::size_t i = 1; i < kWide; ++i) header += ",c" + std::to_string(i);
  for (std::size_t i = 1; i < kWide; ++i) row += ",x";
  const std::string text = header + "\n" + row + "\n";
  auto columns = read_csv_header(text, "wide.csv");
  ASSERT_EQ(columns.size(), kWide);
  std::size_t rows = 0;
  EXPECT_TRUE(read_csv(text, "wide.csv", columns, [&](const CsvRow&) { ++rows; }).empty());
  EXPECT_EQ(rows, 1u);
  for (auto& column : columns) column.type = ColumnType::kInteger;
  const auto faults = read_csv(text, "wide.csv", columns, [](const CsvRow&) {});
  ASSERT_EQ(faults.size(), 50u);
  EXPECT_EQ(faults.back().column, 99u);
  EXPECT_TRUE(faults.back().source_line.empty());
  EXPECT_EQ(parsed_csv(text).diagnostics.size(), 50u);
}

TEST(ReadCsv, SurvivesRandomBytes) {
  std::mt19937 bits{2};
  const std::string alphabet = "a1,.\"\n\r\t\xC3\xA9\xFF-e";
  std::size_t problems = 0;
  for (int round = 0; round < 3000; ++round) {
    std::string text = round % 2 == 0 ? "" : "name,count,area_sr,done\n";
    for (auto k = bits() % 60; k > 0; --k) text += alphabet[bits() % alphabet.size()];
    if (round % 7 == 0) text += '\0';
    const Result result = parsed_csv(text);
    problems += result.diagnostics.size();
    for (const Diagnostic& d : result.diagnostics) EXPECT_GE(d.length, 1u);
  }
  EXPECT_GT(problems, 3000u);
}

TEST(ReadCsvFile, ReadsAFileOrThrowsWithAllDiagnostics) {
  const auto path = std::filesystem::path{::testing::TempDir()} / "kith_read_csv_file.csv";
  write_file_atomically(path, "name,count,area_sr,done\na,1,2,true\n");
  const CsvTable table = read_csv_file(path, kColumns);
  EXPECT_EQ(table.rows.size(), 1u);
  EXPECT_THAT(table.lines, ElementsAre(2u));
  write_file_atomically(path, "name,count,area_sr,done\na,x,y,true\n");
  try {
    (void)read_csv_file(path, kColumns);
    FAIL() << "no error";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::kInvalidInput);
    EXPECT_EQ(error.diagnostics().size(), 2u);
    EXPECT_EQ(error.diagnostics()[0].file, path.string());
  }
  std::filesystem::remove(path);
  EXPECT_THROW((void)read_csv_file(path, kColumns), Error);
}

TEST(CsvReader, IgnoresColumnsThatWereNotAskedForIfToldTo) {
  std::vector<TableCell> cells;
  const auto keep = [&](const CsvRow& row) { cells.assign(row.cells.begin(), row.cells.end()); };
  const std::vector<Column> wanted{{.name = "count", .type = ColumnType::kInteger}};
  EXPECT_TRUE(read_csv("a,count,b\nx,3,y\n", "t.csv", wanted, keep, OtherColumns::kIgnore).empty());
  EXPECT_EQ(cells, (std::vector<TableCell>{std::int64_t{3}}));

  const auto faults = read_csv("a,cuont\nx,3\n", "t.csv", wanted, keep, OtherColumns::kIgnore);
  ASSERT_EQ(faults.size(), 1u);
  EXPECT_EQ(faults[0].id, "E0502");
  EXPECT_EQ(faults[0].hint, "did you mean cuont?");
}

TEST(CsvReader, TellsTheColumnsOfAnUnknownTable) {
  const auto columns = read_csv_header("\xEF\xBB\xBFteam,\"a,b\"\r\n1,2\r\n", "t.csv");
  ASSERT_EQ(columns.size(), 2u);
  EXPECT_EQ(columns[0].name, "team");
  EXPECT_EQ(columns[1].name, "a,b");
}

TEST(CsvReader, TakesWhatRAndPandasAndSpreadsheetsWrite) {
  const std::vector<Column> wanted{{.name = "who"}, {.name = "share", .type = ColumnType::kReal}};
  for (const std::string_view text :
       {"who,share\nA,0.5\nB,1.25\n", "\"\",\"who\",\"share\"\n\"1\",\"A\",0.5\n\"2\",\"B\",1.25\n",
        ",who,share\n0,A,0.5\n1,B,1.25\n", "who\tshare\nA\t0.5\nB\t1,25\n", "sep=;\r\nwho;share\r\nA;0,5\r\nB;1,25\r\n",
        "sep=,\nwho,share\nA,0.5\nB,1.25\n", "\xEF\xBB\xBFsep=\t\nwho\tshare\nA\t0.5\nB\t1.25\n"}) {
    std::vector<TableCell> cells;
    const auto keep = [&](const CsvRow& row) { cells.insert(cells.end(), row.cells.begin(), row.cells.end()); };
    EXPECT_TRUE(read_csv(text, "t.csv", wanted, keep).empty()) << text;
    EXPECT_EQ(cells, (std::vector<TableCell>{"A", 0.5, "B", 1.25})) << text;
    EXPECT_EQ(read_csv_header(text, "t.csv").size(), 2u) << text;
  }
}

TEST(CsvReader, RefusesRowNamesThatAreNone) {
  const std::vector<Column> wanted{{.name = "who"}};
  const auto faults = read_csv(",who\n1,A\n2,B\n1,C\n", "t.csv", wanted, [](const CsvRow&) {});
  ASSERT_EQ(faults.size(), 1u);
  EXPECT_EQ(faults[0].id, "E0512");
  EXPECT_EQ(faults[0].line, 4u);
}

TEST(CsvReader, RefusesAHeaderWithoutNames) {
  const auto id_of = [](std::string_view text) -> std::string {
    try {
      (void)read_csv_header(text, "t.csv");
    } catch (const Error& error) {
      return error.diagnostics().at(0).id;
    }
    return "none";
  };
  EXPECT_EQ(id_of(""), "E0501");
  EXPECT_EQ(id_of("a,,b\n"), "E0512");
  EXPECT_EQ(id_of("a,a\n"), "E0504");
  EXPECT_EQ(id_of("a\"b\n"), "E0508");
  EXPECT_EQ(id_of("\xFF\n"), "E0509");
}

TEST(CsvReader, SaysWhereACellIsWritten) {
  const std::string_view text = "\xEF\xBB\xBFx,name,count\n,\"a,\nb\",7\r\n1,,8";
  std::vector<std::string_view> cells;
  const std::vector<Column> wanted{{.name = "count", .type = ColumnType::kInteger}, {.name = "name"}};
  const auto keep = [&](const CsvRow& row) {
    cells.push_back(row.written(0));
    cells.push_back(row.written(1));
    EXPECT_THROW((void)row.written(2), std::out_of_range);
  };
  EXPECT_TRUE(read_csv(text, "t.csv", wanted, keep, OtherColumns::kIgnore).empty());
  EXPECT_THAT(cells, ElementsAre("7", "\"a,", "8", ""));  // of a cell on several lines the first one
  for (const auto cell : cells) {
    EXPECT_GE(cell.data(), text.data());
    EXPECT_LE(cell.data() + cell.size(), text.data() + text.size());
  }
}

TEST(ReadCsv, TakesSemicolonsAndDecimalCommasOfSpreadsheets) {
  const auto result =
      parsed_csv("\nname;count;\"area_sr\";done\n\"a;b\";42;0,5;true\n1,5;;-1,25e-3;false\n;7;2.5;true\n");
  EXPECT_TRUE(result.diagnostics.empty());
  ASSERT_EQ(result.rows.size(), 3u);
  EXPECT_EQ(result.rows[0], (std::vector<TableCell>{std::string{"a;b"}, std::int64_t{42}, 0.5, true}));
  EXPECT_EQ(result.rows[1], (std::vector<TableCell>{std::string{"1,5"}, {}, -1.25e-3, false}));
  EXPECT_EQ(result.rows[2], (std::vector<TableCell>{{}, std::int64_t{7}, 2.5, true}));
}

TEST(ReadCsv, ReportsPlacesOfTablesWithSemicolons) {
  const auto result = parsed_csv("name;count;area_sr;done\na;1,5;1,234,5;true\na;1;2\n");
  EXPECT_EQ(places(result), (std::vector<std::tuple<std::string, std::size_t, std::size_t, std::size_t>>{
                                {"E0506", 2, 3, 3}, {"E0506", 2, 7, 7}, {"E0505", 3, 5, 1}}));
  EXPECT_THAT(result.diagnostics.back().hint, HasSubstr("semicolons"));
}

TEST(ReadCsv, TakesASemicolonForTextWhereCommasSeparate) {
  const auto result = parsed_csv("name,count,area_sr,done\na;b,1,2,true\n");
  EXPECT_TRUE(result.diagnostics.empty());
  EXPECT_EQ(result.rows.at(0).at(0), TableCell{std::string{"a;b"}});
}

TEST(ReadCsv, TakesTruthAsRAndPythonWriteIt) {
  const auto result = parsed_csv("name,count,area_sr,done\n,,,TRUE\n,,,FALSE\n,,,True\n,,,False\n,,,yes\n");
  ASSERT_EQ(result.rows.size(), 4u);
  for (std::size_t i = 0; i < 4; ++i) EXPECT_EQ(result.rows[i][3], TableCell{i % 2 == 0}) << i;
  ASSERT_EQ(result.diagnostics.size(), 1u);
  EXPECT_EQ(result.diagnostics[0].id, "E0506");
}

}  // namespace
}  // namespace kith
