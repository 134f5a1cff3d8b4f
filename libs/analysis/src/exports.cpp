#include "kith/analysis/exports.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "kith/table/csv_writer.hpp"
#include "model.hpp"

namespace kith {
namespace {

// The column of a table with this name.
std::optional<std::size_t> column_of(const ResultTable& table, const std::string& name) {
  for (std::size_t c = 0; c < table.columns.size(); ++c) {
    if (table.columns[c].name == name) return c;
  }
  return std::nullopt;
}

const double* number_at(const std::vector<TableCell>& row, std::optional<std::size_t> column) {
  return column ? std::get_if<double>(&row[*column]) : nullptr;
}

std::string text_at(const std::vector<TableCell>& row, std::size_t column) {
  const auto* const text = std::get_if<std::string>(&row[column]);
  if (text != nullptr) return *text;
  const auto* const count = std::get_if<std::int64_t>(&row[column]);
  return count != nullptr ? std::to_string(*count) : std::string{};
}

// Shares and p-values without the zero before the point.
std::string share_text(double value) {
  auto text = fmt::format("{:.3f}", value);
  if (text.rfind("0.", 0) == 0) text.erase(0, 1);
  return text;
}

std::string apa_p(double p) { return p < 0.0005 ? "p < .001" : "p = " + share_text(p); }

// The residual degrees of freedom of a table of F tests: of its own column, or of its row of residuals.
std::string residual_df(const ResultTable& table, const std::vector<TableCell>& row) {
  if (const auto own = column_of(table, "residual df")) return text_at(row, *own);
  const auto df = column_of(table, "df");
  for (const auto& other : table.rows) {
    if (text_at(other, 0) == "residuals") return text_at(other, *df);
  }
  return "";
}

// "the effect of g", "the interaction of a and b"; a row that is named otherwise is itself.
std::string term_words(const ResultTable& table, const std::string& name) {
  if (table.columns.front().name != "term") return name;
  std::vector<std::string> factors(1);
  for (const char c : name) {
    if (c == ':') {
      factors.emplace_back();
    } else {
      factors.back() += c;
    }
  }
  return (factors.size() > 1 ? "the interaction of " : "the effect of ") + with_and(factors);
}

// The first p-value of these columns that a row has, and how it is named.
std::string p_phrase(const ResultTable& table, const std::vector<TableCell>& row) {
  for (const auto& [name, prefix] : {std::pair{"corrected p-value", "corrected "},
                                     std::pair{"adjusted p-value", "adjusted "}, std::pair{"p-value", ""}}) {
    const auto* const p = number_at(row, column_of(table, name));
    if (p != nullptr) return prefix + apa_p(*p);
  }
  return "";
}

std::string sentence_start(std::string text) {
  // Names of columns and levels stay as they are.
  if (text.rfind("the ", 0) == 0) text[0] = 'T';
  return text;
}

// Of a likelihood-ratio test.
std::string chi_squared_sentence(const ResultTable& table, const std::vector<TableCell>& row, double alpha) {
  const auto* const statistic = number_at(row, column_of(table, "chi-squared"));
  const auto* const p = number_at(row, column_of(table, "p-value"));
  const auto df = column_of(table, "df");
  if (statistic == nullptr || p == nullptr || !df) return "";
  return fmt::format("{} {} significant, chi-squared({}) = {:.2f}, {}.",
                     sentence_start(term_words(table, text_at(row, 0))), *p < alpha ? "was" : "was not",
                     text_at(row, *df), *statistic, apa_p(*p));
}

std::string test_sentence(const ResultTable& table, const std::vector<TableCell>& row, double alpha) {
  if (column_of(table, "chi-squared")) return chi_squared_sentence(table, row, alpha);
  const auto f = column_of(table, "F"), p = column_of(table, "p-value"), df = column_of(table, "df");
  if (!f || !p || !df || number_at(row, f) == nullptr || number_at(row, p) == nullptr) return "";
  const auto below = residual_df(table, row);
  const auto* const corrected = number_at(row, column_of(table, "corrected p-value"));
  const bool found = (corrected != nullptr ? *corrected : *number_at(row, p)) < alpha;
  auto text = fmt::format("{} {} significant, F({}{}) = {:.2f}, {}", sentence_start(term_words(table, text_at(row, 0))),
                          found ? "was" : "was not", text_at(row, *df), below.empty() ? "" : ", " + below,
                          *number_at(row, f), p_phrase(table, row));
  const auto eta = column_of(table, "partial eta squared");
  const auto low = column_of(table, "lower limit"), high = column_of(table, "upper limit");
  if (number_at(row, eta) != nullptr) {
    text += ", partial eta squared = " + share_text(*number_at(row, eta));
    if (number_at(row, low) != nullptr && number_at(row, high) != nullptr)
      text += fmt::format(", {:.3g} % CI [{}, {}]", 100.0 * (1.0 - 2.0 * alpha), share_text(*number_at(row, low)),
                          share_text(*number_at(row, high)));
  }
  return text + ".";
}

std::string estimate_text(double value) { return formatted(value, ResultKind::kNumber); }

// A difference with its interval and test: of planned contrasts, and of t tests.
std::string difference_sentence(const ResultTable& table, const std::vector<TableCell>& row, double alpha) {
  const auto* const difference = number_at(row, column_of(table, "difference"));
  const auto* const low = number_at(row, column_of(table, "lower limit"));
  const auto* const high = number_at(row, column_of(table, "upper limit"));
  if (difference == nullptr || low == nullptr || high == nullptr) return "";
  auto text = fmt::format("{}: mean difference = {}, {:.3g} % CI [{}, {}]", text_at(row, 0), estimate_text(*difference),
                          100.0 * (1.0 - alpha), estimate_text(*low), estimate_text(*high));
  if (const auto* const t = number_at(row, column_of(table, "t")); t != nullptr) {
    const auto* const df = number_at(row, column_of(table, "df"));
    const auto n = column_of(table, "n");
    const auto* const pairs = n ? std::get_if<std::int64_t>(&row[*n]) : nullptr;
    const auto degrees = df != nullptr      ? fmt::format("({:.1f})", *df)
                         : pairs != nullptr ? fmt::format("({})", *pairs - 1)
                                            : std::string{};
    text += fmt::format(", t{} = {:.2f}", degrees, *t);
  }
  return text + ", " + p_phrase(table, row) + ".";
}

std::string latex_escaped(const std::string& text) {
  std::string result;
  for (const char c : text) {
    switch (c) {
      case '\\':
        result += "\\textbackslash{}";
        break;
      case '~':
        result += "\\textasciitilde{}";
        break;
      case '^':
        result += "\\textasciicircum{}";
        break;
      case '<':
      case '>':
        result += std::string{"$"} + c + "$";
        break;
      case '&':
      case '%':
      case '$':
      case '#':
      case '_':
      case '{':
      case '}':
        result += '\\';
        [[fallthrough]];
      default:
        result += c;
    }
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
  for (const auto& table : finding.tables) {
    const bool is_planned =
        table.caption.rfind("Planned contrasts", 0) == 0 && table.columns.front().name == "contrast";
    if (tests.empty()) {
      for (const auto& row : table.rows) append(tests, test_sentence(table, row, alpha));
    }
    if (!is_planned && !column_of(table, "t")) continue;
    for (const auto& row : table.rows) append(differences, difference_sentence(table, row, alpha));
  }
  append(tests, differences);
  if (tests.empty() || finding.methods.empty()) return tests;
  return fmt::format("{} ({}). {}", finding.model, finding.methods.front().text, tests);
}

std::string latex_text(const Analysis& analysis, double alpha) {
  std::string text = "% Findings of kith; needs the package booktabs.\n";
  for (const auto& note : analysis.notes) text += "% " + note + "\n";
  for (const auto& finding : analysis.findings) {
    text += fmt::format("\n\\section*{{{}}}\n{}\n", latex_escaped(finding.title), latex_escaped(finding.sentence));
    if (const auto results = results_paragraph(finding, alpha); !results.empty())
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
