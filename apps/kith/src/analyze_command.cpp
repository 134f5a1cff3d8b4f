#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <iostream>
#include <nlohmann/json.hpp>
#include <set>
#include <span>

#include "analysis_in_r.hpp"
#include "command.hpp"
#include "embedded.hpp"
#include "kith/analysis/analysis.hpp"
#include "kith/analysis/exports.hpp"
#include "kith/analysis/table_model.hpp"
#include "kith/core/text.hpp"
#include "kith/explain/json.hpp"
#include "kith/explain/wrapped.hpp"
#include "kith/files/atomic_file.hpp"
#include "kith/files/codebook.hpp"
#include "kith/files/file_set.hpp"
#include "kith/files/published_run.hpp"
#include "kith/files/table_text.hpp"
#include "work_notice.hpp"

namespace kith::cli {
namespace {

struct AnalyzeOptions {
  std::string input;                     ///< Run folder, CSV file, or "-" for standard input.
  std::string model;                     ///< A formula; empty: the analyses of a study.
  std::string table = "teams";           ///< Of a run folder, for the model.
  std::string observed;                  ///< Column that tells counts that were not cut off; empty: none was.
  std::vector<std::string> where;        ///< Rows to keep, "COLUMN=VALUE" or "COLUMN!=VALUE".
  std::vector<std::string> identifiers;  ///< Columns that name who or what a row is about, besides the obvious ones.
  bool independent = false;              ///< Rows are independent although identifiers repeat.
  bool counts = false;                   ///< The response is a count.
  bool ordinal = false;                  ///< The response is a rating, of which only the order counts.
  std::string latex;                     ///< File for all findings as LaTeX; empty: none.
  std::string csv;                       ///< Folder for every table as CSV; empty: none.
  std::string r;                         ///< Folder for data, plan and script of the analysis in R; empty: none.
  std::vector<std::string> contrasts;    ///< "NAME [FACTOR]: TERMS", see parse_contrast().
  std::vector<std::string> by;           ///< Factors at each level of which others are compared.
  std::string smallest_effect;           ///< "0.5" or "d=0.3"; empty: no tests of equivalence.
  std::string codebook;                  ///< File that describes the columns; empty: codebook.json beside the table.
  double alpha = 0.05;
  std::string correction = "bonferroni";
  bool brief = false;  ///< A few lines in words.
  bool all = false;    ///< Every finding of a run with all of its tables.
};

AnalysisOptions analysis_options(const AnalyzeOptions& options) {
  AnalysisOptions result;
  result.alpha = options.alpha;
  for (const auto& known : kWordsFor<Correction>) {
    if (known.word == options.correction) result.correction = known.value;
  }
  for (const auto& text : options.contrasts) result.contrasts.push_back(parse_contrast(text));
  result.by = options.by;
  return result;
}

void write_texts(const std::filesystem::path& folder, const std::vector<NamedText>& files) {
  FileSet set{folder};
  for (const auto& file : files) set.write(file.name, file.text);
  set.commit();
}

// Takes over what a codebook says of a table: what it lists under the table's name, or the only table that it lists.
// Whether there is one.
bool describe(Dataset& data, const std::string& codebook, const std::string& file, const std::string& table) {
  const auto tables = read_codebook(codebook, file);
  bool any = false;
  for (const auto& one : tables) {
    if (one.file != table && tables.size() > 1) continue;
    data.describe(one);
    any = true;
  }
  return any;
}

// The table that the model is about: a file, standard input, or one of a run folder.
Dataset dataset_of(const AnalyzeOptions& options) {
  namespace fs = std::filesystem;
  if (options.input == "-") {
    const std::string name = "<stdin>";
    return Dataset::parse(read_table_text(std::cin, name), name);
  }
  std::error_code failure;
  if (!fs::is_directory(options.input, failure)) {
    if (options.table != AnalyzeOptions{}.table) refuse("--table names a table of a run folder; leave it out");
    auto data = Dataset::read(options.input);
    const auto beside = fs::path{options.input}.parent_path() / "codebook.json";
    if (options.codebook.empty() && fs::is_regular_file(beside, failure))
      describe(data, read_file(beside), beside.string(), fs::path{options.input}.filename().string());
    return data;
  }
  const auto run = PublishedRun::open(options.input);
  const auto table = "tables/" + options.table + ".csv";
  auto data = Dataset::parse(run.read(table), (run.folder() / table).string());
  const std::string codebook = "tables/codebook.json";
  if (options.codebook.empty() && run.has(codebook))
    describe(data, run.read(codebook), (run.folder() / codebook).string(), options.table + ".csv");
  return data;
}

// The same with what a codebook that was named says of its columns.
Dataset described_dataset_of(const AnalyzeOptions& options) {
  auto data = dataset_of(options);
  if (options.codebook.empty()) return data;
  std::error_code failure;
  const std::filesystem::path input{options.input};
  const auto table = std::filesystem::is_directory(input, failure) ? options.table + ".csv" : input.filename().string();
  if (!describe(data, read_file(options.codebook), options.codebook, table))
    refuse("--codebook " + options.codebook + " describes several tables, but none named " + table);
  return data;
}

Analysis analysis_of(const AnalyzeOptions& options) {
  namespace fs = std::filesystem;
  std::error_code failure;
  const bool is_run = options.input != "-" && !fs::is_regular_file(options.input, failure);
  if (options.model.empty()) {
    if (!is_run) refuse("to analyse a table, give a model, such as --model 'knowledge ~ strategy'");
    if (!options.where.empty()) refuse("--where can only be used with --model");
    return analyze_run(options.input, analysis_options(options));
  }
  std::vector<RowFilter> filters;
  for (const auto& text : options.where) filters.push_back(parse_row_filter(text));
  ModelQuestion question{.formula = options.model,
                         .observed = {},
                         .response_kind = options.counts    ? ColumnKind::kCount
                                          : options.ordinal ? ColumnKind::kOrdinal
                                                            : ColumnKind::kUnspecified,
                         .identifiers = options.identifiers,
                         .independent = options.independent};
  if (!options.observed.empty()) question.observed = options.observed;
  if (!options.smallest_effect.empty()) question.smallest_effect = parse_smallest_effect(options.smallest_effect);
  const auto data = described_dataset_of(options).where(filters);
  if (!options.r.empty()) {
    write_texts(options.r, {{"data.csv", table_csv(data)},
                            {"plan.json", table_plan(data, question, analysis_options(options))},
                            {"analysis.R", std::string{detail::kAnalysisScript}}});
  }
  auto analysis = analyze_in_r_or_alone(data, question, analysis_options(options));
  if (!analysis) {
    throw Error{
        ErrorKind::kInfeasible,
        "this model needs R" + (options.r.empty() ? std::string{} : ", for which " + options.r + " has all files"),
        Advice{std::string{"install it: "} + kInstallR}};
  }
  return *std::move(analysis);
}

// The words of a head on lines no wider than `width`, where they fit.
std::vector<std::string> head_lines(const std::string& head, std::size_t width) {
  std::vector<std::string> lines;
  const auto text = wrapped(head, width);
  for (std::size_t begin = 0; begin <= text.size();) {
    const auto end = std::min(text.find('\n', begin), text.size());
    lines.push_back(text.substr(begin, end - begin));
    begin = end + 1;
  }
  return lines;
}

// A table whose heads are on as many lines as keep its columns narrow.
std::string text_of(const ResultTable& table, const Console& console) {
  const auto rows = formatted_rows(table);
  std::string alignment;
  std::vector<std::vector<std::string>> heads;
  std::size_t height = 1;
  for (std::size_t c = 0; c < table.columns.size(); ++c) {
    const auto& column = table.columns[c];
    alignment += column.kind == ResultKind::kText ? 'l' : 'r';
    constexpr std::size_t kNarrow = 10;
    std::size_t width = kNarrow;
    for (const auto& row : rows) width = std::max(width, row[c].size());
    heads.push_back(head_lines(column.name, width));
    height = std::max(height, heads.back().size());
  }
  TextTable text{alignment};
  for (std::size_t line = 0; line < height; ++line) {
    std::vector<std::string> cells;
    for (const auto& head : heads) {
      const auto blank = height - head.size();  // heads stand on the rows
      cells.push_back(line < blank ? "" : head[line - blank]);
    }
    text.add(std::move(cells));
  }
  for (const auto& row : rows) text.add(row);
  return "\n" + console.dim(table.caption) + "\n" + text.text(console, height == 1);
}

std::string note_text(const std::string& note) { return wrapped("Note: " + note + ".", kTextWidth, "      ") + "\n"; }

std::string text_of(const Finding& finding, const Console& console) {
  std::string text = console.bold(finding.title()) + "\n";
  if (finding.model != finding.title()) text += console.dim(finding.model) + "\n";
  text += wrapped(finding.sentence, kTextWidth) + "\n";
  for (const auto& warning : finding.warnings) text += note_text(warning);
  if (!finding.results.empty()) text += "\n" + wrapped("For a paper: " + finding.results, kTextWidth) + "\n";
  for (const auto& table : finding.tables) text += text_of(table, console);
  return text;
}

// What was planned, or else what the design asks: effects on each outcome. Everything else says the same in other ways,
// or of parts.
bool is_on_the_page(const Finding& finding) {
  static constexpr std::array<std::string_view, 5> kOthers{"-within-composition", "-beliefs", "-variation", "-paired",
                                                           "-baseline"};
  return finding.id != "demonstrations" && std::none_of(kOthers.begin(), kOthers.end(), [&](std::string_view ending) {
           return finding.id.ends_with(ending);
         });
}

// What is only in the long form, by name where there is room for it.
std::string left_text(std::span<const Finding* const> left, std::size_t num_notes, const Analysis& analysis,
                      bool brief) {
  if (brief && left.empty()) return "";
  std::string what;
  const auto add = [&](const std::string& one) { what += (what.empty() ? ", and " : ", ") + one; };
  if (brief) add(counted(left.size(), "more finding"));
  if (num_notes > 0) add(counted(num_notes, "note"));
  for (const auto* finding : brief ? left.first(0) : left) add(finding->id);
  return (brief ? "" : "\n") +
         wrapped("`kith analyze " + analysis.subject + " --all` shows every table" + what + ".", kTextWidth) + "\n";
}

// The findings of a run on a page: what was found, then as many first tables and notes as there is room for; all tables
// where comparisons were asked for. The brief form is shorter still, and in words.
std::string page_text(const Analysis& analysis, const AnalyzeOptions& options, const Console& console,
                      std::string text) {
  const auto num_lines = [](const std::string& lines) { return std::count(lines.begin(), lines.end(), '\n'); };
  const bool compares = !options.contrasts.empty() || !options.by.empty();
  std::vector<const Finding*> all;
  for (const auto& finding : analysis.findings) all.push_back(&finding);
  const auto others =
      std::stable_partition(all.begin(), all.end(), [](const auto* one) { return is_on_the_page(*one); });
  const auto most =
      static_cast<std::size_t>((options.brief || others == all.begin() ? all.end() : others) - all.begin());
  auto room = (options.brief ? 25 : 45) - num_lines(text) - num_lines(left_text(all, 10, analysis, options.brief));
  const auto fits = [&](const std::string& part) {
    if (num_lines(part) > room && (options.brief || !compares)) return false;
    room -= num_lines(part);
    return true;
  };

  std::vector<std::string> parts;
  while (parts.size() < most) {
    const auto& finding = *all[parts.size()];
    auto part = options.brief
                    ? wrapped("* " + finding.sentence, kTextWidth, "  ") + "\n"
                    : "\n" + console.bold(finding.title()) + "\n" + wrapped(finding.sentence, kTextWidth) + "\n";
    if (!fits(part) && !parts.empty()) break;
    parts.push_back(std::move(part));
  }

  for (std::size_t i = 0; i < parts.size() && !options.brief; ++i) {
    for (const auto& table : all[i]->tables) {
      const auto rows = text_of(table, console);
      if ((compares || &table == &all[i]->tables.front()) && fits(rows)) parts[i] += rows;
    }
  }
  std::set<std::string> notes;
  std::size_t num_left = 0;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    text += parts[i];
    for (const auto& warning : options.brief ? std::vector<std::string>{} : all[i]->warnings) {
      const auto note = "\n" + note_text(warning);
      if (!notes.insert(warning).second) continue;
      if (fits(note))
        text += note;
      else
        ++num_left;
    }
  }
  return text + left_text(std::span{all}.subspan(parts.size()), num_left, analysis, options.brief);
}

Json analysis_json(const Analysis& analysis, const AnalyzeOptions& options) {
  return {{"schema", "kith.analyze/5"},
          {"subject", analysis.subject},
          {"alpha", options.alpha},
          {"correction", options.correction},
          {"notes", analysis.notes},
          {"findings", Json::parse(findings_json(analysis))},
          {"not_analysed", analysis.not_analysed}};
}

void declare(OptionList& list, AnalyzeOptions& options) {
  list.text("input", options.input, "DIR|CSV", "Run folder, CSV file, or '-' for standard input").required();
  const auto model =
      list.text("--model", options.model, "FORMULA",
                "A model for R: response, factors and covariates, such as 'knowledge ~ strategy*age + (1|team)'");
  list.word("--table", options.table, "NAME",
            {"teams", "learners", "periods", "responses", "demonstrations", "progress"},
            "Table of the run folder to which the model applies")
      .needs(model);
  list.texts("--where", options.where, "CONDITION", "Rows to keep, COLUMN=VALUE or COLUMN!=VALUE (may be repeated)");
  auto observed = list.text("--observed", options.observed, "COLUMN", "Column that is false where a count is censored");
  observed.needs(model);
  list.texts("--identifier", options.identifiers, "COLUMN",
             "Column that names who or what a row is about; rows with the same value belong together (may be repeated)")
      .needs(model);
  list.flag("--independent", options.independent, "Analyse rows as independent although identifiers repeat")
      .needs(model);
  auto counts = list.flag("--count", options.counts, "The response is a count of events");
  counts.needs(model);
  auto ordinal = list.flag("--ordinal", options.ordinal, "The response is a rating, of which only the order counts");
  ordinal.needs(model).excludes(counts).excludes(observed);
  list.text("--codebook", options.codebook, "FILE",
            "Description of the columns (default: codebook.json beside the table)")
      .needs(model);
  list.texts("--contrast", options.contrasts, "CONTRAST",
             "Planned comparison of means, such as 'team beliefs: joint + common - individual-low - individual-high' "
             "(may be repeated)");
  list.texts("--by", options.by, "FACTOR",
             "Compare the levels of other factors at each level of this one (may be repeated)");
  list.text("--smallest-effect", options.smallest_effect, "X",
            "Smallest difference that matters, in units of the response or as d=0.3: tests whether differences are "
            "smaller")
      .needs(model)
      .excludes(ordinal);
  list.text("--latex", options.latex, "FILE", "Write all findings and tables to this file as LaTeX");
  list.text("--csv", options.csv, "DIR", "Write every table to this folder as CSV");
  list.text("--r", options.r, "DIR", "Write data, plan and the R script of the analysis to this folder").needs(model);
  auto brief = list.flag("--brief", options.brief, "The findings in words, in at most 25 lines");
  list.flag("--all", options.all, "Of a run every finding, with all notes and tables").excludes(brief);
  // Far below 10^-6 and as near to 1 there are no quantiles any more.
  list.number("--alpha", options.alpha, "P", {1e-6, 0.499}, "Significance level; intervals use 1 - alpha");
  list.word("--correct", options.correction, "HOW", {words_for<Correction>().begin(), words_for<Correction>().end()},
            "Correction for families of tests: compositions, planned contrasts");
  list.json();
}

int run(const AnalyzeOptions& options, Console& console) {
  const WorkNotice notice{console, "analysing " + options.input};
  const auto analysis = analysis_of(options);
  if (!options.latex.empty()) write_file_atomically(options.latex, latex_text(analysis, options.alpha));
  if (!options.csv.empty()) write_texts(options.csv, csv_tables(analysis));
  if (console.json()) {
    console.print_json(analysis_json(analysis, options));
    return 0;
  }
  std::string text;
  for (const auto& note : analysis.notes) text += note_text(note);
  if (!options.brief && (options.all || !options.model.empty())) {
    for (const auto& finding : analysis.findings) text += (text.empty() ? "" : "\n") + text_of(finding, console);
    if (!analysis.not_analysed.empty()) text += "\n" + wrapped(not_analysed_text(analysis), kTextWidth) + "\n";
  } else {
    text = page_text(analysis, options, console, text);
  }
  console.print(text);
  return 0;
}

}  // namespace

void add_analyze(Commands& commands) {
  commands.add<AnalyzeOptions>(
      "analyze", "Analyse the results of a study, or test a model on any table",
      {"kith analyze results/paper", "kith analyze people.csv --model 'knowledge ~ strategy*composition + (1|team)'"},
      declare, run);
}

}  // namespace kith::cli
