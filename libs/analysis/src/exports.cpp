#include "kith/analysis/exports.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <sstream>

#include "kith/files/csv_writer.hpp"
#include "shown.hpp"

namespace kith {
namespace {

// Shares and p-values without the zero before the point.
std::string share_text(double value) {
  auto text = fmt::format("{:.3f}", value);
  if (text.rfind("0.", 0) == 0) text.erase(0, 1);
  return text;
}

std::string apa_p(double p) { return p < 0.0005 ? "p < .001" : "p = " + share_text(p); }

// "the effect of g", "the interaction of a and b".
std::string term_words(const std::string& name) {
  std::vector<std::string> factors;
  std::istringstream parts{name};
  for (std::string factor; std::getline(parts, factor, ':');) factors.push_back(factor);
  return (factors.size() > 1 ? "the interaction of " : "the effect of ") + listed(factors);
}

std::string sentence_start(std::string text) {
  // Names of columns and levels stay as they are.
  if (text.rfind("the ", 0) == 0) text[0] = 'T';
  return text;
}

std::string test_sentence(const TestFamily& family, const TermResult& test, double alpha) {
  if (!test.statistic || !test.p) return "";
  const bool is_f = family.statistic == TestFamily::Statistic::kF;
  auto text = fmt::format("{} {} significant, {}({}) = {:.2f}, {}",
                          sentence_start(family.are_terms ? term_words(test.subject) : test.subject),
                          test.corrected_p.value_or(*test.p) < alpha ? "was" : "was not", is_f ? "F" : "chi-squared",
                          degrees_text(test, family.residuals), *test.statistic,
                          test.corrected_p ? "corrected " + apa_p(*test.corrected_p) : apa_p(*test.p));
  if (test.effect) {
    text += ", partial eta squared = " + share_text(*test.effect);
    if (test.low && test.high)
      text += fmt::format(", {:.3g} % CI [{}, {}]", 100.0 * (1.0 - 2.0 * alpha), share_text(*test.low),
                          share_text(*test.high));
  }
  return text + ".";
}

std::string estimate_text(double value) { return formatted(value, ResultKind::kNumber); }

// Whether a family is reported comparison by comparison, and with its statistics.
bool is_stated(const ComparisonFamily& family) {
  const bool is_asked = family.kind == ComparisonFamily::Kind::kPrimary ||
                        family.kind == ComparisonFamily::Kind::kPlanned ||
                        family.kind == ComparisonFamily::Kind::kAlone;
  return is_asked && family.by.empty();
}

// A difference with its interval and test.
std::string difference_sentence(const ComparisonFamily& family, const ComparisonResult& one, double alpha) {
  if (!one.estimate || !one.low || !one.high || !one.p) return "";
  auto text = fmt::format("{}: mean difference = {}, {:.3g} % CI [{}, {}]", one.name, estimate_text(*one.estimate),
                          100.0 * (1.0 - alpha), estimate_text(*one.low), estimate_text(*one.high));
  if (one.t && family.kind != ComparisonFamily::Kind::kPlanned) {
    const auto degrees = one.n > 0 ? fmt::format("({})", one.n - 1)
                         : one.df  ? fmt::format("({:.1f})", *one.df)
                                   : std::string{};
    text += fmt::format(", t{} = {:.2f}", degrees, *one.t);
  }
  if (one.corrected_p) return text + ", corrected " + apa_p(*one.corrected_p) + ".";
  return text + (family.is_adjusted ? ", adjusted " : ", ") + apa_p(*one.p) + ".";
}

std::string latex_escaped(const std::string& text) {
  static const std::map<char, std::string> kWords{{'\\', "\\textbackslash{}"},
                                                  {'~', "\\textasciitilde{}"},
                                                  {'^', "\\textasciicircum{}"},
                                                  {'<', "$<$"},
                                                  {'>', "$>$"}};
  std::string result;
  for (const char c : text) {
    const auto word = kWords.find(c);
    if (std::string_view{"&%$#_{}"}.find(c) != std::string_view::npos) result += '\\';
    result += word == kWords.end() ? std::string{c} : word->second;
  }
  return result;
}

std::string latex_table(const ResultTable& table) {
  std::string columns, text, heads;
  for (const auto& column : table.columns) {
    columns += column.kind == ResultKind::kText ? 'l' : 'r';
    heads += (heads.empty() ? "" : " & ") + latex_escaped(column.name);
  }
  text = fmt::format(
      "\\begin{{table}}[htb]\n\\centering\n\\caption{{{}}}\n\\begin{{tabular}}{{{}}}\n\\toprule\n{} \\\\\n\\midrule\n",
      latex_escaped(table.caption), columns, heads);
  for (const auto& row : formatted_rows(table)) {
    std::string cells;
    for (std::size_t c = 0; c < row.size(); ++c) cells += (c == 0 ? "" : " & ") + latex_escaped(row[c]);
    text += cells + " \\\\\n";
  }
  return text + "\\bottomrule\n\\end{tabular}\n\\end{table}\n";
}

ColumnType type_of(const ResultTable& table, std::size_t c) {
  if (table.columns[c].kind == ResultKind::kText) return ColumnType::kText;
  const auto fits = [&](const std::vector<TableCell>& row) {
    return !std::holds_alternative<double>(row[c]) && !std::holds_alternative<bool>(row[c]);
  };
  // Counts of tables that also have text in their column, such as "not reached".
  const auto is_text = [&](const std::vector<TableCell>& row) {
    const auto* const text = std::get_if<std::string>(&row[c]);
    return text != nullptr && !text->empty();
  };
  if (std::any_of(table.rows.begin(), table.rows.end(), is_text)) return ColumnType::kText;
  return std::all_of(table.rows.begin(), table.rows.end(), fits) ? ColumnType::kInteger : ColumnType::kReal;
}

void write_cell(const TableCell& cell, ColumnType type, CsvWriter& writer) {
  const auto* const text = std::get_if<std::string>(&cell);
  const auto* const count = std::get_if<std::int64_t>(&cell);
  const auto* const number = std::get_if<double>(&cell);
  if (type == ColumnType::kText && text != nullptr) {
    writer.text(*text);
  } else if (type == ColumnType::kText && (count != nullptr || number != nullptr)) {
    writer.text(count != nullptr ? std::to_string(*count) : fmt::format("{}", *number));
  } else if (type == ColumnType::kInteger && count != nullptr) {
    writer.integer(*count);
  } else if (type == ColumnType::kReal && (count != nullptr || number != nullptr)) {
    writer.real(count != nullptr ? static_cast<double>(*count) : *number);
  } else {
    writer.missing();
  }
}

std::string csv_text(const ResultTable& table) {
  const auto fields = field_names(table);
  std::vector<Column> columns;
  for (std::size_t c = 0; c < fields.size(); ++c) columns.push_back({.name = fields[c], .type = type_of(table, c)});
  std::string text;
  CsvWriter writer{columns, [&](std::string_view part) { text += part; }};
  for (const auto& row : table.rows) {
    for (std::size_t c = 0; c < row.size(); ++c) write_cell(row[c], columns[c].type, writer);
    writer.end_row();
  }
  writer.flush();
  return text;
}

std::string file_stem(const std::string& id) {
  std::string stem;
  for (const char c : id) {
    const bool plain =
        (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-' || c == '_';
    stem += plain ? c : '_';
  }
  return stem.empty() ? "finding" : stem;
}

}  // namespace

std::string results_paragraph(const Finding& finding, double alpha) {
  std::string tests, differences;
  const auto append = [](std::string& text, const std::string& sentence) {
    if (!sentence.empty()) text += (text.empty() ? "" : " ") + sentence;
  };
  for (const auto& family : finding.tests) {
    if (!tests.empty()) break;
    for (const auto& test : family.tests) append(tests, test_sentence(family, test, alpha));
  }
  for (const auto& family : finding.comparisons) {
    if (!is_stated(family)) continue;
    for (const auto& comparison : family.comparisons)
      append(differences, difference_sentence(family, comparison, alpha));
  }
  append(tests, differences);
  if (tests.empty() || finding.methods.empty()) return tests;
  return fmt::format("{} ({}). {}", finding.model, finding.methods.front().text, tests);
}

std::string latex_text(const Analysis& analysis, double alpha) {
  std::string text = "% Findings of kith; needs the package booktabs.\n";
  for (const auto& note : analysis.notes) text += "% " + note + "\n";
  for (const auto& finding : analysis.findings) {
    text += fmt::format("\n\\section*{{{}}}\n{}\n", latex_escaped(finding.title()), latex_escaped(finding.sentence));
    if (const auto results = finding.results.empty() ? results_paragraph(finding, alpha) : finding.results;
        !results.empty())
      text += "\n" + latex_escaped(results) + "\n";
    for (const auto& warning : finding.warnings) text += "\n\\noindent Note: " + latex_escaped(warning) + ".\n";
    for (const auto& table : finding.tables) text += "\n" + latex_table(table);
  }
  return text;
}

std::vector<NamedText> csv_tables(const Analysis& analysis) {
  std::vector<NamedText> files;
  std::string list;
  CsvWriter writer{{{.name = "file"}, {.name = "finding"}, {.name = "caption"}},
                   [&](std::string_view part) { list += part; }};
  for (const auto& finding : analysis.findings) {
    for (std::size_t t = 0; t < finding.tables.size(); ++t) {
      files.push_back({fmt::format("{}-{}.csv", file_stem(finding.id), t + 1), csv_text(finding.tables[t])});
      writer.text(files.back().name).text(finding.id).text(finding.tables[t].caption);
      writer.end_row();
    }
  }
  writer.flush();
  files.push_back({"tables.csv", std::move(list)});
  return files;
}

}  // namespace kith
